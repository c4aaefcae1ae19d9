//! The head of the page: every table, figure and equation of the paper, with the result of its reproduction.

use super::number::{Table, fixed, significant, spread, tuple};
use super::results::Results;
use super::{online, ranking, rotation, uncertainty};
use crate::accelerometers::Left;
use crate::enhancement::{enhancements, share_of_all};
use crate::monte_carlo::Campaign;
use crate::printed;
use crate::pure_navigation::Outcome;
use crate::real_test::{self, Emulated};

pub(super) fn section(results: &Results) -> String {
    let mut out = String::from(HEAD);
    let mut table = Table::new(&["paper", "printed", "here", "", "why"]);
    for row in items(results) {
        table.row(&row);
    }
    out.push_str(&table.finish());
    out.push_str(CLAIMS);
    let mut table = Table::new(&["claim", "", "found", "where"]);
    for row in claims(results) {
        table.row(&row);
    }
    out.push_str(&table.finish());
    out.push_str(EQUATIONS);
    let mut table = Table::new(&["equation", "", "of", "what was found"]);
    for row in equations() {
        table.row(&row);
    }
    out.push_str(&table.finish());
    out
}

const HEAD: &str = "\
# The paper, run again

Every table, figure and equation of [nie2019](references.md#nie2019), with its printed figures beside ours.
`cargo xtask reproduce` runs all of it and writes this page; `cargo xtask reproduce --check` fails if the page and the
code disagree. Runs are seeded, and the same whatever the number of threads.

✔ comes out &nbsp; ± comes out once a sign, a term, a label or a latency is corrected &nbsp; ✘ does not come out &nbsp;
○ nothing to be tested

## At a glance {#at-a-glance}

";

const CLAIMS: &str = "\
### Claims {#claims}

";

const EQUATIONS: &str = "\
### Equations {#equations}

";

type Item = [String; 5];

fn items(results: &Results) -> Vec<Item> {
    [filter_items(results), navigation_items(results), real_test_items(results)].concat()
}

fn row(cells: [&str; 5]) -> Item {
    cells.map(str::to_owned)
}

fn filter_items(results: &Results) -> Vec<Item> {
    let three =
        |campaign: &Campaign| tuple(&[0, 1, 2].map(|place| campaign.estimates(place).mean), 2);
    vec![
        row([
            "Figure 1",
            "frames",
            "[notation](notation.md)",
            "○",
            "a drawing; α = 0: east, north, up",
        ]),
        row(["Figure 2", "the filter's flow", "[the filter](theory/filter.md)", "○", "a drawing"]),
        row([
            "[Tables 1, 2](#tables-1-2)",
            "errors",
            "scenario files",
            "±",
            "section 4.1 has other biases and noises",
        ]),
        [
            "[Table 3](#table-3)".into(),
            tuple(&printed::TABLE_3, 2),
            three(&results.with_bias),
            "✘".into(),
            format!("biases hide in the estimates; without them {}", three(&results.without_bias)),
        ],
        row([
            "[Figure 3](#figure-3)",
            "covariance converges",
            "it does, and the spread follows",
            "✔",
            "",
        ]),
        [
            "– its meaning".into(),
            "\"good observability\"".into(),
            format!(
                "[over-confident {} times](#over-confidence)",
                fixed(results.with_bias.overconfidence(0), 0)
            ),
            "✘".into(),
            "one rate does not distinguish a bias; a reversal does".into(),
        ],
        row([
            "[Figure 4](#figure-4)",
            "30 runs converge",
            "they do, off the truth",
            "±",
            "the same bias in each",
        ]),
    ]
}

fn navigation_items(results: &Results) -> Vec<Item> {
    let gyros = &results.variants[2].outcome;
    let lag = &results.lags[0];
    let velocity = |place: usize| fixed(gyros.velocity[place], 3);
    vec![
        row([
            "[Figure 5](#figure-5)",
            "velocity grows with $t^2$",
            "it does",
            "✔",
            "with the strapdown sign",
        ]),
        [
            "[Table 4](#table-4), velocity before".into(),
            "(2.982, 17.548) m/s".into(),
            format!("({}, {}) m/s", velocity(0), velocity(1)),
            "±".into(),
            "minus lost; gyro errors alone; 0.04 m/s stay".into(),
        ],
        [
            "[Table 4](#table-4-attitudes), attitudes".into(),
            "0.03 to 0.09° left after".into(),
            format!(
                "{}° rms off without, {}° with a latency",
                fixed(lag.none.root_mean_square(), 3),
                fixed(lag.fitted.root_mean_square(), 4)
            ),
            "±".into(),
            format!(
                "read out {} samples late",
                fixed(lag.fitted.lag / results.simulation.scenario.interval, 2)
            ),
        ],
        row([
            "[Table 4](#table-4-velocities), velocity after",
            "(0.0447, 0.1184), text (0.065, −0.024) m/s",
            "neither",
            "✘",
            "no named cause of a stated size makes them",
        ]),
    ]
}

fn real_test_items(results: &Results) -> Vec<Item> {
    let yaw = |navigation: &printed::Navigation| fixed(navigation.attitude_error[2], 4);
    let emulated = |of: &dyn Fn(&Emulated) -> Outcome| {
        spread(&real_test::spread(&results.emulated, |run| of(run).figures(), 4), 2)
    };
    vec![
        [
            "[Table 5](#table-5-uncertainty)".into(),
            tuple(&printed::TABLE_5, 4),
            uncertainty::supported(results).join(", "),
            "○".into(),
            "no log published; uncertainty ($k = 2$) from the table's rate and the gyros' biases"
                .into(),
        ],
        row([
            "[Table 6](#table-6), velocities",
            "(4.92, −1.98), (0.295, 0.589) m/s",
            "within the data sheet",
            "✔",
            "it allows 0.7 and 1.8 m/s",
        ]),
        [
            "[Table 6](#table-6-causes), yaw".into(),
            format!("{}°, {}°", yaw(&printed::TABLE_6_BEFORE), yaw(&printed::TABLE_6_AFTER)),
            format!("{}°, {}°", emulated(&|run| run.before), emulated(&|run| run.after)),
            "✔".into(),
            "the table's rate, accurate to 10 ppm, is in $S_z$ and comes back as yaw".into(),
        ],
        row([
            "[Table 6](#table-6-roll), roll",
            "−0.0734° after",
            "0°",
            "✘",
            "no sensor error, for the velocities show none: the axis itself, or a misprint",
        ]),
        row([
            "[Table 6](#table-6-difference), before − after",
            "",
            "5 to 23 % off",
            "✘",
            "Table 5 is not all that was changed",
        ]),
        row([
            "Figures 6 to 8",
            "curves of Tables 5 and 6",
            "[emulated](#real-test)",
            "○",
            "no log published; text and captions disagree on their numbers",
        ]),
    ]
}

/// The paper's claims in words.
fn claims(results: &Results) -> Vec<[String; 4]> {
    let percent = |share: f64| ranking::percent(share);
    let each = enhancements(&results.emulated);
    let least = each.iter().map(|one| one.printed).fold(f64::INFINITY, f64::min);
    let met = share_of_all(&results.emulated);
    let [tilted, _] = &results.accelerometers;
    let left = tilted.first().map_or(f64::NAN, Left::horizontal);
    let [across, along] = rotation::restrained(results);
    let rows = [
        [
            "\"precision … enhanced at least 20 %\"".into(),
            "±".into(),
            format!(
                "printed: {} or more; here in {} of the runs for all five figures",
                percent(least),
                percent(met)
            ),
            "[by figure](#enhancement)".into(),
        ],
        [
            "\"converges very quickly\"".into(),
            "✔".into(),
            "as fast as gyro noise lets any estimator, to a value that holds the biases and the table's rate".into(),
            "[convergence](#convergence)".into(),
        ],
        [
            "\"can restrain divergence of attitude error\"".into(),
            "±".into(),
            format!(
                "{} times less across the axis from all but $M_{{xz}}$, $M_{{yz}}$, $S_z$; these make more than rotation takes away",
                significant(across, 2)
            ),
            "[static and rotating](#static-and-rotating)".into(),
        ],
        [
            "\"drift on the spin axis still diverge\"".into(),
            "✔".into(),
            format!("it does, with $S_z$ {} times faster than static", significant(along, 2)),
            "[static and rotating](#static-and-rotating)".into(),
        ],
        [
            "\"accelerometer error … can be modulated by 2π rotation\"".into(),
            "✘".into(),
            format!("{} m/s stay after ten turns about Table 4's axis", fixed(left, 3)),
            "[(A.5)](#accelerometers)".into(),
        ],
        [
            "\"estimated and compensated online\"".into(),
            "✔".into(),
            format!("at most {} of the gain of batch compensation is lost", percent(online::lost(results))),
            "[online](#online)".into(),
        ],
    ];
    rows.into()
}

fn equations() -> Vec<[String; 4]> {
    let rows = [
        (
            "(1) to (3)",
            "✔",
            "[sensor model](theory/frames.md#what-a-gyro-gets-wrong)",
            "the matrix multiplies the *true* rate; (3) leaves out the biases that Table 3 then holds",
        ),
        (
            "(4), (5)",
            "✔",
            "[attitude](theory/frames.md#attitude)",
            "exactly $R_z(\\varphi_G) R_x(\\theta) R_y(\\gamma)$",
        ),
        ("(6)", "±", "[attitude error](theory/error-mechanism.md#attitude)", "[sign](#mechanism)"),
        (
            "(7)",
            "✔",
            "[level acceleration](theory/error-mechanism.md#velocity)",
            "holds for the sign that (6) has not",
        ),
        (
            "(8), (9)",
            "±",
            "[velocity error](theory/error-mechanism.md#velocity)",
            "[sign](#mechanism); without Earth rate and Schuler loop 7 % at 360 s",
        ),
        (
            "(10) to (12)",
            "✔",
            "[states and attitude](theory/filter.md#dynamics)",
            "a perturbed strapdown run follows them",
        ),
        ("(13)", "±", "[velocity](theory/filter.md#dynamics)", "[sign in row 2](#misprints)"),
        (
            "(14), (15)",
            "✔",
            "[position, gyros](theory/filter.md#dynamics)",
            "(15) has the biases that [(10) leaves out](#over-confidence)",
        ),
        (
            "(16) to (18)",
            "✔",
            "[zero velocity](theory/filter.md#measurements)",
            "at one rate they add next to nothing to (20)",
        ),
        ("(19)", "±", "[rate](theory/filter.md#measurements)", "[side and sign](#misprints)"),
        ("(20)", "✔", "[rate](theory/filter.md#measurements)", "follows from the corrected (19)"),
        ("(21)", "±", "[rate](theory/filter.md#measurements)", "[columns of δθ](#misprints)"),
        (
            "(A.1) to (A.4)",
            "±",
            "[derivation](theory/error-mechanism.md#velocity)",
            "(A.2) has the sign that (7) has not",
        ),
        (
            "(A.5)",
            "✘",
            "[derivation](theory/error-mechanism.md#velocity)",
            "[accelerometer errors along a tilted axis stay](#accelerometers)",
        ),
        ("(A.6)", "±", "[derivation](theory/error-mechanism.md#velocity)", "as (8)"),
        (
            "(A.7)",
            "±",
            "[derivation](theory/error-mechanism.md#velocity)",
            "[as (9), but for a copy with a minus](#misprints)",
        ),
    ];
    rows.map(|(equation, verdict, place, found)| {
        [equation, verdict, place, found].map(str::to_owned)
    })
    .into()
}
