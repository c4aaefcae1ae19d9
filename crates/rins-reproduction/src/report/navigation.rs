//! Table 4 and Figure 5: pure navigation before and after compensation, and the unexplained velocities.

use std::fmt::Write;

use super::number::{Table, fixed, signed, significant, spread, tuple, with_unit};
use super::results::{Results, VelocityCase};
use crate::printed;
use crate::pure_navigation::Outcome;
use crate::statistics::Sample;

pub(super) fn section(results: &Results) -> String {
    let mut out = String::from("## Table 4: navigation before and after {#table-4}\n\n");
    out.push_str(
        "Errors after 360 s of navigation without aid. *30 runs* have all errors of Tables 1 and 2 and their noise, each \
         compensated with its own estimates.\n\n",
    );
    let mut table =
        Table::new(&["", "$V_x$ [m/s]>", "$V_y$ [m/s]>", "roll [°]>", "pitch [°]>", "yaw [°]>"]);
    let decimals = [3, 3, 4, 4, 4];
    let mut row = |name: &str, cell: &dyn Fn(usize) -> String| {
        table.row(&[name.to_owned(), cell(0), cell(1), cell(2), cell(3), cell(4)]);
    };
    // As many digits as in the paper.
    let printed_cell = |navigation: &printed::Navigation, digits: usize| {
        let figures = navigation.figures();
        move |place: usize| {
            format!("**{}**", fixed(figures[place], if place < 2 { digits } else { 3 }))
        }
    };
    let outcome_cell =
        |outcome: Outcome| move |place: usize| fixed(outcome.figures()[place], decimals[place]);
    row("**printed before** (text's sign of $V_y$)", &printed_cell(&printed::TABLE_4_BEFORE, 3));
    for variant in &results.variants {
        row(variant.name, &outcome_cell(variant.outcome));
    }
    let campaign = &results.with_bias;
    let cell = |of: &dyn Fn(usize) -> Sample, place: usize| spread(&of(place), decimals[place]);
    let before = |place| campaign.navigated(|run| run.before, place);
    row("30 runs", &|place| cell(&before, place));
    row("roll 20°, pitch 30°, as section 4.1 prints", &outcome_cell(results.swapped));
    row("**printed after, Table 4**", &printed_cell(&printed::TABLE_4_AFTER, 4));
    row("**printed after, text**", &printed_cell(&printed::TEXT_4_AFTER, 3));
    for variant in &results.after_variants {
        row(variant.name, &outcome_cell(variant.outcome));
    }
    let after = |place| campaign.navigated(|run| run.after, place);
    row("30 runs", &|place| cell(&after, place));
    out.push_str(&table.finish());
    out.push_str(ERRATA);
    figure_5(&mut out, results);
    out
}

const ERRATA: &str = "\
> **Errata.** Table 4 prints $V_y$ before compensation without its minus, which the text has. Section 4.1 has roll 20°
> and pitch 30°, Table 4 roll 30° and pitch 20°: only the latter gives the printed
> velocities. The text gives the attitude errors of roll and pitch in each other's place, before and after, and
> without signs before. The velocities before are those of the gyro errors alone: with the accelerometers of Table 1,
> $V_x$ is 0.2 m/s larger. After compensation, text and table disagree, and no row above has either: see
> [below](#table-4-velocities).

";

fn figure_5(out: &mut String, results: &Results) {
    out.push_str(
        "### Figure 5: velocity before compensation {#figure-5}\n\n\
         The first of the 30 runs. The strapdown system has the sign opposite to eqs. (8) and (9) as printed.\n\n\
         ![Velocity east and north against time, navigated and by eqs. (8) and (9)](figures/figure-5.svg)\n\n",
    );
    choices(out, results);
}

/// The effects of the modeling choices that the paper leaves open.
fn choices(out: &mut String, results: &Results) {
    let three = &results.variants[0].outcome.velocity;
    let noise = |figure| results.without_bias.navigated(|run| run.before, figure).deviation;
    let _ = write!(
        out,
        "### How far models of this run may differ {{#table-4-models}}\n\n\
         A model independent of the navigator, which integrates the differential equations, and what each choice \
         that the paper leaves open is worth. For the three errors along the spin axis the navigator has {} m/s. A run's \
         noise spreads the two by {} and {} m/s. The (2.967, −17.431) m/s of another model, which the [theory \
         page](theory/error-mechanism.md#what-table-4-shows) quotes, is 0.004 m/s away in $V_x$: no choice of the \
         Earth makes that, first-order integration does, and the noise of one run could.\n\n",
        tuple(three, 4),
        fixed(noise(0), 4),
        fixed(noise(1), 4),
    );
    let mut table =
        Table::new(&["choice", "$V_x$ [m/s]>", "$V_y$ [m/s]>", "change of $V_x$>", "of $V_y$>"]);
    for (choice, velocity) in &results.plain {
        table.row(&[
            choice.name().to_owned(),
            fixed(velocity.x, 4),
            fixed(velocity.y, 4),
            signed(velocity.x - results.plain[0].1.x, 4),
            signed(velocity.y - results.plain[0].1.y, 4),
        ]);
    }
    out.push_str(&table.finish());
}

pub(super) fn velocities(results: &Results) -> String {
    let mut out = String::from("## Table 4's velocities: not explained {#table-4-velocities}\n\n");
    let [before, table, text] = &results.velocities;
    let _ = write!(
        out,
        "Printed less model, with all gyro errors of Table 2 in the data and Table 3 compensated: {} m/s before, {} \
         (Table 4) and {} (text) after. A run's noise spreads by {} and {} m/s: only $V_x$ before may be noise. Each cause below is taken alone, at the size that fits best; *left* is the part of the misfit that \
         stays, 0 % if it explains both components.\n\n",
        tuple(&before.misfit, 4),
        tuple(&table.misfit, 4),
        tuple(&text.misfit, 4),
        fixed(results.without_bias.navigated(|run| run.before, 0).deviation, 4),
        fixed(results.without_bias.navigated(|run| run.before, 1).deviation, 4),
    );
    let mut rows = Table::new(&[
        "cause",
        "before>",
        "left>",
        "after, Table 4>",
        "left>",
        "after, text>",
        "left>",
    ]);
    for best in &before.explanations {
        let cell = |case: &VelocityCase| {
            let same = case.explanations.iter().find(|other| other.cause == best.cause);
            same.map_or([String::new(), String::new()], |found| {
                let unit = found.cause.unit().0;
                let size = with_unit(&significant(found.size, 2), unit);
                [size, with_unit(&fixed(100.0 * found.left, 0), "%")]
            })
        };
        let ([a, b], [c, d], [e, f]) = (cell(before), cell(table), cell(text));
        rows.row(&[best.cause.name(), a, b, c, d, e, f]);
    }
    out.push_str(&rows.finish());
    let _ = write!(
        out,
        "No cause has one size in all three columns, and none that fits a column has a size that the paper states: a start \
         attitude off by arc seconds is no start \"without attitude error\", and accelerometer biases of 10 mg are none of \
         a 100 µg sensor. The accelerometer errors of Table 1, at their stated size, take $V_x$ 0.15 to 0.2 m/s away from every \
         printed pair. Compensating with the measured rate moves the velocities after by 0.005 m/s. An end at another moment \
         does not help: after compensation the model's velocity is never nearer than {} m/s to Table 4's, and {} m/s to the \
         text's. **Not explained.**\n\n",
        fixed(table.nearest.1, 3),
        fixed(text.nearest.1, 3),
    );
    out
}
