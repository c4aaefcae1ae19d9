//! Discrepancies between the printed paper and the model: each claim with its figures, cause and evidence.

use super::number::{Table, fixed, tuple};
use super::results::Results;
use super::uncertainty;
use crate::accelerometers::Left;
use crate::printed;

pub(super) fn section(results: &Results) -> String {
    let mut out = String::from(
        "\n## What is printed and is not so {#errata}\n\n\
         All of the above in one list: claim, figures, cause, and where the evidence is.\n\n",
    );
    let mut table = Table::new(&["where", "printed", "ours", "cause", "evidence"]);
    for row in [computed(results), measured(results), stated()].concat() {
        table.row(&row);
    }
    out.push_str(&table.finish());
    out.truncate(out.trim_end().len());
    out.push('\n');
    out
}

/// The rows whose figures are computed.
fn computed(results: &Results) -> Vec<[String; 5]> {
    let ten_turns = results.grid.iter().find(|row| row.time > 300.0);
    let velocity = |of: &dyn Fn(&crate::grid::Row) -> nalgebra::Vector3<f64>, decimals| {
        ten_turns.map_or_else(String::new, |row| tuple(&of(row).as_slice()[..2], decimals))
    };
    let mean = |campaign: &crate::monte_carlo::Campaign| {
        tuple(&[0, 1, 2].map(|place| campaign.estimates(place).mean), 2)
    };
    let outcome = |place: usize| tuple(&results.variants[place].outcome.velocity, 3);
    let lag = &results.lags[0];
    let rows = [
        [
            "(6), (8), (9)".into(),
            format!("{} m/s at 360 s", velocity(&|row| row.printed.velocity, 3)),
            format!("{} m/s", velocity(&|row| row.navigated.velocity, 3)),
            "(A.2) integrates $+C_b^n\\,\\delta\\omega$".into(),
            "[verify](#mechanism)".into(),
        ],
        [
            "section 4.1: roll 20°, pitch 30°".into(),
            "(2.982, −17.548) m/s".into(),
            format!(
                "{} m/s; roll 30°, pitch 20°: {}",
                tuple(&results.swapped.velocity, 3),
                outcome(0)
            ),
            "the two are swapped; Table 4 has them right".into(),
            "[Table 4](#table-4)".into(),
        ],
        [
            "Table 4, $V_y$ before".into(),
            "17.548 m/s".into(),
            format!("{} m/s", fixed(results.variants[2].outcome.velocity[1], 3)),
            "the minus, which the text has, is lost".into(),
            "[Table 4](#table-4)".into(),
        ],
        [
            "Table 4: errors of all sensors".into(),
            "(2.982, −17.548) m/s".into(),
            format!("{} m/s; gyros alone: {}", outcome(4), outcome(2)),
            "the accelerometers' errors are not in it".into(),
            "[Table 4](#table-4)".into(),
        ],
        [
            "Table 4, attitudes".into(),
            "0.03, −0.05, −0.09° after".into(),
            format!(
                "{}° rms off, {}° with the latency",
                fixed(lag.none.root_mean_square(), 3),
                fixed(lag.fitted.root_mean_square(), 4)
            ),
            format!("read out {} ms, half a sample, late", fixed(1e3 * lag.fitted.lag, 2)),
            "[latency](#table-4-attitudes)".into(),
        ],
        [
            "Table 4 and text, velocities after".into(),
            "(0.0447, 0.1184), (0.065, −0.024) m/s".into(),
            format!("{} m/s", tuple(&results.after_variants[0].outcome.velocity, 3)),
            "not found".into(),
            "[causes tried](#table-4-velocities)".into(),
        ],
        [
            "Table 3 with the biases of Table 2".into(),
            tuple(&printed::TABLE_3, 2),
            format!("{}; without biases {}", mean(&results.with_bias), mean(&results.without_bias)),
            "$M + B/w$ is all that one rate shows".into(),
            "[Table 3](#table-3)".into(),
        ],
        [
            "Figure 3: the covariance is the accuracy".into(),
            "–".into(),
            format!("errors {} times the 1σ", fixed(results.with_bias.overconfidence(0), 0)),
            "the biases are no states and are not distinguishable".into(),
            "[coverage](#over-confidence)".into(),
        ],
    ];
    rows.into()
}

/// The rows on claims and measurements of the paper.
fn measured(results: &Results) -> Vec<[String; 5]> {
    let (before, after) = (printed::TABLE_6_BEFORE.figures(), printed::TABLE_6_AFTER.figures());
    let change = [0, 1].map(|place| before[place] - after[place]);
    let rows = [
        [
            "(A.5): whole turns cancel accelerometer errors".into(),
            "0 m/s".into(),
            format!(
                "{} m/s after ten turns about Table 4's axis",
                fixed(results.accelerometers[0].first().map_or(f64::NAN, Left::horizontal), 3)
            ),
            "what lies along a tilted axis stays".into(),
            "[whole turns](#accelerometers)".into(),
        ],
        [
            "Table 5, four decimals".into(),
            tuple(&printed::TABLE_5, 4),
            format!("{} ($k = 2$)", uncertainty::supported(results).join(", ")),
            "the table's rate, accurate to 10 ppm, is taken for exact".into(),
            "[uncertainty](#table-5-uncertainty)".into(),
        ],
        [
            "Table 6, before − after".into(),
            format!("{} m/s", tuple(&change, 3)),
            format!("{} m/s", tuple(&results.predicted.velocity, 3)),
            "more than Table 5 was changed in between".into(),
            "[difference](#table-6-difference)".into(),
        ],
    ];
    rows.into()
}

/// The rows on contradictions within the paper.
fn stated() -> Vec<[String; 5]> {
    [
        [
            "Tables 1, 2 and section 4.1",
            "bias 0.05 or 0.1 °/h; noises differ too",
            "the tables are used",
            "two versions of the run",
            "[Tables 1 and 2](#tables-1-2)",
        ],
        [
            "section 4.2, attitude errors",
            "roll 0.467°, pitch 0.303° before; roll −0.044°, pitch 0.034° after",
            "Table 4: pitch 0.467°, roll −0.303°; pitch −0.046°, roll 0.030°",
            "roll and pitch in each other's place",
            "[Table 4](#table-4)",
        ],
        [
            "section 5.2, attitude errors",
            "pitch 0.0426°, yaw 0.8712° before; roll 0.0834° after",
            "Table 6: 0.0413°, 0.8612°, 0.0734°",
            "sums",
            "[Table 6](#table-6)",
        ],
        [
            "section 5.2, figures",
            "estimates in Figure 3, velocity after in Figure 7",
            "Figure 7, Figure 8",
            "references not renumbered",
            "captions",
        ],
        [
            "(13), row 2",
            "$-(\\rho+2\\Omega)_x v_z$",
            "$+(\\rho+2\\Omega)_x\\,\\delta v_z$",
            "sign of a cross product",
            "[misprints](#misprints)",
        ],
        [
            "(19)",
            "$(I-\\phi\\times)\\,C_n^b$",
            "$C_n^b\\,(I+\\phi\\times)$",
            "transposed in part",
            "[misprints](#misprints)",
        ],
        [
            "(21)",
            "no columns for $\\delta\\theta$",
            "$C_n^b[\\omega_{ie}^n\\times]$ there",
            "$\\phi$ taken for $\\psi$",
            "[misprints](#misprints)",
        ],
    ]
    .map(|row| row.map(str::to_owned))
    .into()
}
