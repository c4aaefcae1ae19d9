//! Online compensation compared with batch compensation and none.

use std::fmt::Write;

use super::number::{Table, significant};
use super::results::Results;
use crate::pure_navigation::Outcome;
use crate::running::Followed;
use crate::statistics::Sample;

pub(super) fn section(results: &Results) -> String {
    let mut out = String::new();
    // Writing to a string cannot fail.
    let _ = write!(
        out,
        "## Online compensation {{#online}}\n\n\
         The conclusions say that errors \"can be estimated and compensated online\". Free navigation over the whole \
         turn, root mean squares of the errors at its end over {} runs of section 4 (all errors of Tables 1 and 2, 360 s) and {} \
         emulated runs of section 5 (900 s). *Online*: each sample is compensated with what the filter had estimated before \
         it, the first with nothing. *Batch*: all samples with the estimate after 360 s (section 4) or 100 s of the turn \
         (section 5).\n\n",
        results.scale.followed, results.scale.emulated,
    );
    let titles = ["", "$V_x$ [m/s]>", "$V_y$ [m/s]>", "roll [°]>", "pitch [°]>", "yaw [°]>"];
    let mut table = Table::new(&titles);
    let mut row = |name: &str, squares: &dyn Fn(usize) -> f64| {
        let cell = |figure| significant(squares(figure).sqrt(), 3);
        table.row(&[name.to_owned(), cell(0), cell(1), cell(2), cell(3), cell(4)]);
    };
    let simulated: Vec<[Outcome; 3]> =
        results.followed.iter().map(|run| [run.none, run.online, run.batch]).collect();
    let emulated: Vec<[Outcome; 3]> =
        results.emulated.iter().map(|run| [run.before, run.online, run.after]).collect();
    for (section, runs) in [("section 4", &simulated), ("section 5", &emulated)] {
        for (place, name) in ["none", "online", "batch"].into_iter().enumerate() {
            row(&format!("{section}: {name}"), &|figure| {
                Sample::of(runs.iter().map(|run| run[place].figures()[figure].powi(2))).mean
            });
        }
        row("– online less batch", &|figure| {
            let of = |[_, online, batch]: &[Outcome; 3]| difference(online, batch, figure).powi(2);
            Sample::of(runs.iter().map(of)).mean
        });
    }
    out.push_str(&table.finish());
    out.push_str(&verdict(results));
    out
}

/// The largest fraction, over the five figures of section 4's runs, of the gain of batch compensation that online
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
