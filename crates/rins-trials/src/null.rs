//! The page of the false alarms: runs without an unmodeled error.

use std::fmt::Write as _;

use crate::journal::Record;
use crate::laboratory::{Grade, Level, Schedule};
use crate::statistics::Share;

const HEAD: &str = "# False alarms

The false alarm rate is the fraction of runs without an unmodeled error in which `rins diagnose` reports an effect. It is measured
by simulation of the whole procedure: logs from the independent simulator of the [blind trials](blind.md), read and diagnosed by the
command. `cargo xtask false-alarms` runs them and writes this page.

Each run draws:

- the schedule: one rate, both directions, or three rates in both directions, for 360 to 540 s;
- the grade of the IMU: gyro noise of 0.005 to 0.05 deg/h/√Hz (navigation), 30 times (tactical) or 1000 times as much (industrial);
- the noise: white noise alone, or with bias instability of 0.2 to 5 times the usual one of the grade, which the data sheet does not
  state.

";

/// The p-values below which effects are counted.
const BELOW: [f64; 3] = [1e-2, 1e-3, 1e-4];

/// The page for runs without an unmodeled error, diagnosed by the program of this revision.
pub fn null_page(records: &[Record], revision: &str) -> String {
    let answered: Vec<&Record> = records.iter().filter(|record| record.answered()).collect();
    let mut page = String::from(HEAD);
    let _ = writeln!(
        page,
        "{} runs at revision {revision}; {} ended without an answer. Brackets give counts and the bounds of Clopper and Pearson at \
         95 %.\n",
        records.len(),
        records.len() - answered.len()
    );
    page.push_str("| reported | fraction of the runs |\n| --- | --- |\n");
    for below in BELOW {
        let _ = writeln!(page, "| effect with p < {below} | {} |", alarms(&answered, below));
    }
    let structure = answered.iter().map(|record| !record.answer.unexplained.is_empty());
    let _ = writeln!(page, "| residual structure | {} |", Share::count(structure).text());
    page.push_str("\n| runs | effect with p < 0.01 |\n| --- | --- |\n");
    let mut row = |name: &str, is_in: &dyn Fn(&Record) -> bool| {
        let of: Vec<&Record> = answered.iter().copied().filter(|record| is_in(record)).collect();
        let _ = writeln!(page, "| {name} | {} |", alarms(&of, BELOW[0]));
    };
    for grade in Grade::ALL {
        row(grade.name(), &|record| record.grade == grade);
    }
    for schedule in Schedule::ALL {
        row(schedule.name(), &|record| record.schedule == schedule);
    }
    for level in [Level::White, Level::Flicker] {
        row(level.name(), &|record| record.level == level);
    }
    page
}

/// The fraction of runs with an effect that is not there, with a p-value below this one.
fn alarms(records: &[&Record], below: f64) -> String {
    let is_alarm = |record: &&Record| record.false_names().any(|cause| cause.ln_p < below.ln());
    Share::count(records.iter().map(is_alarm)).text()
}
