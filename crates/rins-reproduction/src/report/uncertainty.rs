//! Table 5 with its uncertainty by JCGM 100: the table rate, the gyro biases, noise.

use std::fmt::Write;

use rins_frames::units::{ARCSEC, DEG, PPM};

use super::number::{Table, fixed, significant};
use super::results::Results;
use crate::printed;
use crate::real_test::rate_accuracy;
use crate::uncertainty::{Budget, Distribution, alone, table_5};

/// The coverage factor of an expanded uncertainty.
const COVERAGE_FACTOR: f64 = 2.0;

/// The three estimates with the digits that their uncertainty supports, with their units.
pub(super) fn supported(results: &Results) -> [String; 3] {
    let budgets = table_5(&results.real_test, Distribution::Rectangular);
    let mut units = ["″", "″", " ppm"].into_iter();
    budgets.each_ref().map(|budget| expanded(budget) + units.next().unwrap_or_default())
}

/// `value ± expanded uncertainty`, both with the digits that it supports.
fn expanded(budget: &Budget) -> String {
    let decimals = budget.decimals();
    [fixed(budget.value, decimals), fixed(budget.expanded(COVERAGE_FACTOR), decimals)]
        .join("\u{a0}±\u{a0}")
}

pub(super) fn section(results: &Results) -> String {
    let budgets = table_5(&results.real_test, Distribution::Rectangular);
    let accuracy = rate_accuracy(&results.real_test.scenario) / PPM;
    let mut out = String::new();
    // Writing to a string cannot fail.
    let _ = write!(
        out,
        "### Table 5: the uncertainty of the estimates {{#table-5-uncertainty}}\n\n\
         The calibration takes the commanded rate for the true one. Section 5.1 gives the table a \"rotation rate accuracy\" \
         of 0.0001 °/s, which is {} ppm of 10 °/s, without a coverage factor or a distribution. Where only bounds are known, \
         JCGM 100 (4.3.7) assumes a rectangular distribution between them: half-width {} ppm, standard uncertainty {} ppm. \
         A true rate of $(1 + e)\\,\\omega$ adds $e$ to the estimate of $S_z$. The accuracy of the gyros is taken as the \
         standard uncertainty of their biases, the noise is that of Tables 1 and 2. All are type B evaluations: the log was not \
         published, so nothing can be evaluated from its scatter.\n\n",
        fixed(accuracy, 0),
        fixed(accuracy, 0),
        fixed(alone(&budgets[2], 0).combined(), 1),
    );
    out.push_str(&contributions(&budgets));
    let [_, _, scale] = &budgets;
    let by_table = alone(scale, 0);
    let position = 2.0 * ARCSEC / (9000.0 * DEG) / PPM;
    let _ = write!(
        out,
        "Of the four decimals printed, the uncertainty supports {} of $M_{{xz}}$ and $M_{{yz}}$ and {} of $S_z$. \
         By the table's rate alone $S_z$ is {} ppm ($k = 2$), with the z gyro's bias {} ppm. How much depends on \
         what \"accuracy\" means:\n\n",
        scale_of(budgets[0].decimals()),
        scale_of(scale.decimals()),
        expanded(&by_table),
        expanded(scale),
    );
    out.push_str(&readings(results));
    let _ = write!(
        out,
        "The table's \"positional accuracy\" of 2″ is a tighter bound: over 9000° it is {} ppm of the mean rate. It \
         applies only where the controller follows a commanded angle, and leaves the controller's clock against the \
         IMU's. The paper calibrates against the rate, so the accuracy of the rate is used here.\n\n",
        significant(position, 1),
    );
    out
}

fn scale_of(decimals: usize) -> String {
    match decimals {
        0 => "none".to_owned(),
        1 => "one".to_owned(),
        more => more.to_string(),
    }
}

fn contributions(budgets: &[Budget; 3]) -> String {
    let titles = ["", "distribution", "$M_{xz}$ [″]>", "$M_{yz}$ [″]>", "$S_z$ [ppm]>"];
    let mut table = Table::new(&titles);
    for (place, one) in budgets[0].contributions.iter().enumerate() {
        let cell =
            |row: usize| significant(budgets[row].contributions[place].standard_uncertainty(), 2);
        table.row(&[
            one.name.to_owned(),
            match one.distribution {
                Distribution::Normal => "normal".to_owned(),
                Distribution::Rectangular => "rectangular".to_owned(),
            },
            cell(0),
            cell(1),
            cell(2),
        ]);
    }
    let mut row = |name: &str, cell: &dyn Fn(usize) -> String| {
        table.row(&[name.to_owned(), String::new(), cell(0), cell(1), cell(2)]);
    };
    row("combined standard uncertainty", &|row| significant(budgets[row].combined(), 2));
    row("expanded, $k = 2$", &|row| significant(budgets[row].expanded(COVERAGE_FACTOR), 2));
    row("half-width of the 95 % interval", &|row| significant(budgets[row].half_width(0.95), 2));
    row("**printed**", &|row| format!("**{}**", fixed(printed::TABLE_5[row], 4)));
    row("supported ($k = 2$)", &|row| expanded(&budgets[row]));
    table.finish()
}

/// The scale error for each possible meaning of "accuracy".
fn readings(results: &Results) -> String {
    let mut table = Table::new(&[
        "0.0001 °/s is",
        "standard uncertainty [ppm]>",
        "$S_z$ by the table alone, $k = 2$ [ppm]>",
        "with all contributions [ppm]>",
    ]);
    let mut row = |name: &str, budget: Budget| {
        let by_table = alone(&budget, 0);
        table.row(&[
            name.to_owned(),
            fixed(by_table.combined(), 1),
            expanded(&by_table),
            expanded(&budget),
        ]);
    };
    let [_, _, rectangular] = table_5(&results.real_test, Distribution::Rectangular);
    row("the half-width of a rectangular distribution (assumed here)", rectangular);
    let [_, _, standard] = table_5(&results.real_test, Distribution::Normal);
    row("a standard uncertainty", standard.clone());
    let mut halved = standard;
    halved.contributions[0].size *= 0.5;
    row("an expanded uncertainty, $k = 2$", halved);
    table.finish()
}
