//! Causes in the order of the fraction of an error that they explain, and whether that is sufficient.

use super::number::{Table, fixed, significant, with_unit};
use crate::causes::{Basis, Cause, Graded, ranked, share_of_all};

/// The number of standard deviations from the emulation's mean that counts as chance.
pub(super) const CHANCE: f64 = 3.0;

/// Causes that need more than this multiple of their permitted size are not listed.
pub(super) const HOPELESS: f64 = 1000.0;

/// The names of the five figures.
pub(super) const FIGURES: [&str; 5] =
    ["$V_x$ [m/s]", "$V_y$ [m/s]", "roll [°]", "pitch [°]", "yaw [°]"];

/// The number of causes that are listed for a figure.
const SHOWN: usize = 3;

/// A table of the five figures: the error to be explained, the causes with the largest fractions at their
/// permitted sizes, and a verdict.
pub(super) fn table(causes: &[Graded], wanted: [f64; 5], title: &str) -> String {
    let title = format!("{title}>");
    let titles =
        ["", title.as_str(), "largest causes and their share", "stated causes together>", ""];
    let mut table = Table::new(&titles);
    let stated: Vec<Graded> =
        causes.iter().filter(|graded| graded.basis == Basis::Stated).copied().collect();
    for (figure, name) in FIGURES.into_iter().enumerate() {
        let wanted = wanted[figure];
        let order = ranked(causes, figure, wanted);
        let largest: Vec<String> = order
            .iter()
            .take(SHOWN)
            .map(|(graded, share)| format!("{}: {}", cause_name(graded), percent(*share)))
            .collect();
        let together = share_of_all(&stated, figure, wanted);
        table.row(&[
            name.to_owned(),
            fixed(wanted, 4),
            largest.join("; "),
            percent(together),
            verdict(&stated, causes, figure, wanted).to_owned(),
        ]);
    }
    table.finish()
}

fn verdict(stated: &[Graded], all: &[Graded], figure: usize, wanted: f64) -> &'static str {
    let enough =
        |causes: &[Graded]| ranked(causes, figure, wanted).first().is_some_and(|c| c.1 >= 1.0);
    if enough(stated) {
        "explained"
    } else if share_of_all(stated, figure, wanted) >= 1.0 {
        "explained by several"
    } else if enough(all) {
        "explained by an assumed size"
    } else {
        "**unexplained**"
    }
}

/// A cause's name, with a mark if its permitted size is assumed.
pub(super) fn cause_name(graded: &Graded) -> String {
    match graded.basis {
        Basis::Stated => graded.cause.name(),
        Basis::Plausible => format!("{} (assumed)", graded.cause.name()),
    }
}

/// A fraction in per cent, with two digits.
pub(super) fn percent(share: f64) -> String {
    with_unit(&significant(100.0 * share, 2), "%")
}

/// The size of a cause, in its unit, that causes the error `wanted` in a figure.
pub(super) fn needed(causes: &[Graded], cause: Cause, figure: usize, wanted: f64) -> f64 {
    let found = causes.iter().find(|graded| graded.cause == cause);
    found.map_or(f64::NAN, |graded| graded.needed(figure, wanted))
}
