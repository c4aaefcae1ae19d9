//! The page of the injections into measured logs.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use crate::answer::Analyser;
use crate::injections::{InjectionTrial, injection_trials};
use crate::statistics::Share;
use crate::trouble::Trouble;

const HEAD: &str = "# Injections into measured logs

Simulated noise is what its author expects. These trials add known errors to measured logs, and compare the diagnosis of each log with
and without them. `cargo xtask injections` runs them and writes this page.

Each trial takes a part of a log (a laser gyro and a MEMS IMU in a thermal chamber, both static) or a whole log (a wheel that coasts
down), and adds an error to one channel: a bias step, a bias ramp, an exponential transient, and on the wheel g-sensitivity of a gyro or
a quadratic accelerometer error. The amplitude is 3, 8 or 20 sigma of its generalized least-squares estimate in the log's own noise,
whose spectral density Welch's method estimates; biases, scale errors and misalignments are estimated beside it. An error of 0.1 sigma
cannot be detected: what is named with it and not without it is a false alarm.

- *Found*: the diagnosis names an effect that may be the error (itself, or its credible set contains it), at the time of an event within
  a tenth of the log, which it does not name without it; or its amplitude changes by more than half of the error.
- *Covered*: the error is named alone, and the change of its amplitude differs from the truth by less than 3 sigma.
- *False*: an effect is named that is not the error and is not named without it.

An error that resembles what a log shows by itself is not found: in the thermal chamber the biases follow the temperature during each part,
and the model of the wheel has the largest number of effects without the error, eight.

";

/// Runs so many logs, each with an error of every strength, and writes the page; `told` receives every trial.
///
/// # Errors
/// [`Trouble`] if a log cannot be read or written, or the program not be started.
pub fn injections(
    rigs: &[PathBuf],
    analyser: &Analyser,
    (seed, rounds): (u64, u64),
    (page, revision): (&Path, &str),
    told: impl Fn(&InjectionTrial),
) -> Result<(), Trouble> {
    let mut all = Vec::new();
    for round in 0..rounds {
        for (place, rig) in rigs.iter().enumerate() {
            let own =
                injection_trials(rig, analyser, (seed, round * rigs.len() as u64 + place as u64))?;
            own.iter().for_each(&told);
            all.extend(own);
            fs::write(page, injection_page(&all, seed, revision))?;
        }
    }
    Ok(())
}

/// The page for trials at this revision.
fn injection_page(all: &[InjectionTrial], seed: u64, revision: &str) -> String {
    let mut page = String::from(HEAD);
    let failures = all.iter().filter(|one| one.failure.is_some()).count();
    let _ = writeln!(
        page,
        "{} trials of seed {seed} at revision {revision}; {failures} ended without an answer. Brackets give counts and the bounds of Clopper \
         and Pearson at 95 %.\n",
        all.len()
    );
    let answered: Vec<&InjectionTrial> = all.iter().filter(|one| one.failure.is_none()).collect();
    page.push_str(
        "| log | amplitude | found | covered | false |\n| --- | --- | --- | --- | --- |\n",
    );
    let mut logs: Vec<&str> = all.iter().map(|one| one.log.as_str()).collect();
    logs.sort_unstable();
    logs.dedup();
    for log in logs.iter().map(Some).chain([None]) {
        let mut strengths: Vec<f64> = answered.iter().map(|one| one.injection.strength).collect();
        strengths.sort_by(f64::total_cmp);
        strengths.dedup();
        for strength in strengths {
            let of: Vec<&&InjectionTrial> = answered
                .iter()
                .filter(|one| log.is_none_or(|log| one.log == *log))
                .filter(|one| one.injection.strength.total_cmp(&strength).is_eq())
                .collect();
            let detectable = of.iter().any(|one| one.is_detectable());
            let detected = |share: Share| if detectable { share.text() } else { "–".into() };
            let _ = writeln!(
                page,
                "| {} | {strength} sigma | {} | {} | {} |",
                log.map_or_else(|| "all".into(), |log| format!("`{log}`")),
                detected(Share::count(of.iter().map(|one| one.is_found))),
                detected(Share::count(of.iter().filter_map(|one| one.is_covered()))),
                Share::count(of.iter().map(|one| !one.false_names.is_empty())).text(),
            );
        }
    }
    page.push_str("\n| log | error | amplitude | found | error of the amplitude | false |\n| --- | --- | --- | --- | --- | --- |\n");
    for one in answered {
        let _ = writeln!(
            page,
            "| `{}` | `{}` on channel {} | {} sigma | {} | {} | {} |",
            one.log,
            one.injection.id,
            one.channel(),
            one.injection.strength,
            match one.is_detectable() {
                true if one.is_found => "yes",
                true => "no",
                false => "–",
            },
            one.error
                .filter(|_| one.is_detectable())
                .map_or_else(String::new, |error| format!("{error:.1} sigma")),
            one.false_names.join(", "),
        );
    }
    page
}
