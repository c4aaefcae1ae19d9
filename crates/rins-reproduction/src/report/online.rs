//! Online compensation beside batch compensation and none.

use std::fmt::Write;

use super::number::{Table, spread};
use super::results::Results;
use crate::pure_navigation::Outcome;
use crate::running::Followed;
use crate::{Sample, real_test};

pub(super) fn section(results: &Results) -> String {
    let mut out = String::new();
    // Writing to a string cannot fail.
    let _ = write!(
        out,
        "## Online compensation {{#online}}\n\n\
         The conclusions say that errors \"can be estimated and compensated online\". Free navigation over the whole \
         turn, errors at its end, mean ± spread over {} runs of section 4 (all errors of Tables 1 and 2, 360 s) and {} \
         emulated runs of section 5 (900 s). *Online*: each sample is compensated with what the filter had estimated before \
         it, the first with nothing. *Batch*: all samples with the estimate after 360 s (section 4) or 100 s of the turn \
         (section 5).\n\n",
        results.scale.followed, results.scale.emulated,
    );
    let mut table = Table::new(&[
        "",
        "",
        "$V_x$ [m/s]>",
        "$V_y$ [m/s]>",
        "roll [°]>",
        "pitch [°]>",
        "yaw [°]>",
    ]);
    let mut row = |run: &str, name: &str, of: &dyn Fn(usize) -> Sample| {
        let cell = |figure: usize| spread(&of(figure), if figure < 2 { 3 } else { 4 });
        let [a, b, c, d, e] = [cell(0), cell(1), cell(2), cell(3), cell(4)];
        table.row(&[run.to_owned(), name.to_owned(), a, b, c, d, e]);
    };
    let runs = &results.followed;
    let section_4 = |of: &dyn Fn(&Followed, usize) -> f64, figure: usize| {
        Sample::of(runs.iter().map(|run| of(run, figure)))
    };
    row("section 4", "none", &|figure| section_4(&|run, at| run.none.figures()[at], figure));
    row("", "online", &|figure| section_4(&|run, at| run.online.figures()[at], figure));
    row("", "batch", &|figure| section_4(&|run, at| run.batch.figures()[at], figure));
    row("", "online − batch", &|figure| {
        section_4(&|run, at| difference(&run.online, &run.batch, at), figure)
    });
    let emulated = &results.emulated;
    let spread_of = |of: &dyn Fn(&real_test::Emulated) -> [f64; 5], figure: usize| {
        real_test::spread(emulated, of, figure)
    };
    row("section 5", "none", &|figure| spread_of(&|run| run.before.figures(), figure));
    row("", "online", &|figure| spread_of(&|run| run.online.figures(), figure));
    row("", "batch", &|figure| spread_of(&|run| run.after.figures(), figure));
    row("", "online − batch", &|figure| {
        Sample::of(emulated.iter().map(|run| difference(&run.online, &run.after, figure)))
    });
    out.push_str(&table.finish());
    out.push_str(&verdict(results));
    out
}

/// The largest share, over the five figures of section 4's runs, of what batch compensation gains that online
/// compensation loses: root mean squares.
pub(super) fn lost(results: &Results) -> f64 {
    let rms = |of: &dyn Fn(&Followed) -> f64| {
        Sample::of(results.followed.iter().map(|run| of(run).powi(2))).mean.sqrt()
    };
    let of = |figure: usize| {
        let lost = rms(&|run| difference(&run.online, &run.batch, figure));
        lost / rms(&|run| difference(&run.none, &run.batch, figure))
    };
    (0..5).map(of).fold(0.0, f64::max)
}

fn difference(one: &Outcome, other: &Outcome, figure: usize) -> f64 {
    one.figures()[figure] - other.figures()[figure]
}

fn verdict(results: &Results) -> String {
    format!(
        "Online compensation loses at most {} of what batch compensation gains in section 4's run. The loss is made in the first \
         samples, before there is an estimate: the tilt of that time stays and is integrated. What batch compensation leaves, \
         online compensation leaves too: accelerometer errors, the alignment, and the table's rate.\n\n",
        super::ranking::percent(lost(results)),
    )
}
