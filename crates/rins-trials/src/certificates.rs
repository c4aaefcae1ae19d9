//! Trials of the uncertainty budget: laboratories whose references are off by what they state, and the coverage of the expanded
//! uncertainty (JCGM 101:2008).

use std::collections::BTreeSet;
use std::f64::consts::PI;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;
use std::process::Command;
use std::sync::Mutex;

use nalgebra::Rotation3;
use rand::RngExt;
use rins_blind::{Log, Random, random};
use rins_terms::{Model, catalogue};
use serde_json::Value;

use crate::laboratory::{Grade, Laboratory, Length, Level, Schedule, log_uniform};
use crate::stand::{Stand, attitude};
use crate::statistics::Share;
use crate::trouble::Trouble;
use crate::workers::at_once;

const DEGREE: f64 = PI / 180.0;
const ARCSECOND: f64 = DEGREE / 3600.0;

/// A table turns if it is faster than this part of its fastest rate.
const TURNS: f64 = 1e-3;

const HEAD: &str = "# Trials of the uncertainty budget

An expanded uncertainty of 95 % contains the true value in 95 % of all laboratories that state the same accuracies. Each laboratory of
these trials draws an IMU, a schedule, an accuracy of each reference, and the error of each reference within it: rate and angle of the
table, latitude, gravity, and the clock of the log. The simulator is that of the [blind trials](blind.md). `rins calibrate` reads the log
and the rig file, which states the accuracies. `cargo xtask certificates` runs the laboratories and writes this page.

The noise is white in one half of the runs. In the other half it has bias instability of 0.2 to 5 times the usual one of the grade, which
the data sheet does not state. The estimate allows for bias instability, which a short run cannot exclude: where noise predominates and is
white, the intervals are conservative.

| reference | stated accuracy, log-uniform |
| --- | --- |
| rate of the table | 0.00001 to 0.001 deg/s |
| angle of the table | 0.3 to 10 arcsec |
| latitude | 1 to 60 arcsec |
| gravity | 0.000001 to 0.0001 m/s² |
| clock | 1 to 50 ppm |

";

/// The stated accuracies of a laboratory, as limits.
#[derive(Clone, Copy, Debug)]
struct Accuracies {
    rate: f64,
    angle: f64,
    latitude: f64,
    gravity: f64,
    clock: f64,
}

impl Accuracies {
    fn draw(random: &mut Random) -> Self {
        let mut within = |low, high| log_uniform(random, low, high);
        Self {
            rate: within(1e-5, 1e-3) * DEGREE,
            angle: within(0.3, 10.0) * ARCSECOND,
            latitude: within(1.0, 60.0) * ARCSECOND,
            gravity: within(1e-6, 1e-4),
            clock: within(1e-6, 50e-6),
        }
    }

    /// A rig file that states them.
    fn stated_in(&self, rig: &str) -> String {
        let Self { rate, angle, latitude, gravity, clock } = self;
        let table = format!(
            "[table]\nrate_accuracy = \"{:.9} deg/s\"\nangle_accuracy = \"{:.6} arcsec\"\n",
            rate / DEGREE,
            angle / ARCSECOND
        );
        let site = format!(
            "[site]\nlatitude_accuracy = \"{:.6} arcsec\"\ngravity_accuracy = \"{gravity:.9} m/s^2\"\n",
            latitude / ARCSECOND
        );
        let log = format!("[log]\nclock_accuracy = \"{:.6} ppm\"\n", clock / 1e-6);
        let rig = rig.replace("[site]\n", &site).replace("[log]\n", &log);
        if rig.contains("[table]\n") {
            rig.replace("[table]\n", &table)
        } else {
            format!("{rig}\n{table}")
        }
    }
}

/// What one reported parameter of one laboratory came to.
#[derive(Clone, Debug)]
struct CertifiedParameter {
    id: String,
    /// The error in units of the expanded uncertainty.
    error: f64,
    /// The part of the variance that the references contribute.
    of_references: f64,
}

/// What a laboratory reports, or the error of the program.
type Answer = Result<Vec<CertifiedParameter>, String>;

/// Draws laboratory number `index` of those under `seed`, and calibrates in `folder` by this program.
///
/// # Errors
/// [`Trouble`] if the program cannot be used, or its answer cannot be read.
fn laboratory(program: &str, folder: &Path, (seed, index): (u64, u64)) -> Result<Answer, Trouble> {
    let mut random = random(seed, index);
    let schedule = Schedule::ALL[random.random_range(0..Schedule::ALL.len())];
    let grade = Grade::ALL[random.random_range(0..Grade::ALL.len())];
    let level = [Level::White, Level::Flicker][random.random_range(0..2)];
    let own = random.random();
    let Laboratory { experiment, mut known } =
        Laboratory::draw((schedule, Length::Short), (level, grade), own, &mut random);
    let stated = Accuracies::draw(&mut random);
    let mut off = |limit: f64| limit * (2.0 * random.random::<f64>() - 1.0);
    known.place.latitude += off(stated.latitude);
    known.place.gravity += off(stated.gravity);
    let (rate, angle, clock) = (off(stated.rate), off(stated.angle), off(stated.clock));
    let phase = off(PI);
    let mut log = rins_blind::record(&experiment);
    spoil(&mut log, rate, (angle, phase), clock);
    rins_blind::write(folder, &log, &known, experiment.interval)?;
    let rig = folder.join("rig.toml");
    fs::write(&rig, stated.stated_in(&fs::read_to_string(&rig)?))?;
    let output = Command::new(program)
        .args(["calibrate", "--model", "full", "--json"])
        .arg(&rig)
        .env("RAYON_NUM_THREADS", "1")
        .output()?;
    if !output.status.success() {
        return Ok(Err(format!("{index}: {}", String::from_utf8_lossy(&output.stderr).trim())));
    }
    let answer: Value = serde_json::from_slice(&output.stdout)?;
    let truth = Stand::of(&experiment, &known).model;
    // The survey is off by a rotation of the axis frame.
    let [surveyed, own] = [&known.attitude, &experiment.attitude].map(attitude);
    let rotation = surveyed.matrix().transpose() * own.matrix();
    let rotation = Rotation3::from_matrix_unchecked(rotation).scaled_axis();
    let value = |id: &str| {
        let is_about = |axis: &&str| id == format!("{}.{axis}", catalogue::AXIS_ATTITUDE.id);
        let about = ["x", "y", "z"].iter().position(is_about);
        in_unit(&truth, id)
            .map(|(value, factor)| about.map_or(value, |axis| rotation[axis]) / factor)
    };
    let parameters = answer["parameters"].as_array().into_iter().flatten();
    Ok(Ok(parameters.filter_map(|parameter| certified(parameter, &value)).collect()))
}

/// The value of a parameter in SI units, and its unit.
fn in_unit(model: &Model, id: &str) -> Option<(f64, f64)> {
    let (term, parameter) = model.find(id)?;
    let chosen = &model.terms[term];
    Some((chosen.values[parameter], chosen.term.parameters[parameter].unit.factor))
}

/// A reported parameter, or the combination that is reported, beside its true value; `None` of what the data do not show.
fn certified(parameter: &Value, truth: &dyn Fn(&str) -> Option<f64>) -> Option<CertifiedParameter> {
    let is_reported = matches!(parameter["observability"].as_str()?, "observable" | "combination");
    let id = parameter["id"].as_str()?;
    let expanded = parameter["uncertainty"]["expanded"].as_f64()?;
    let [type_a, combined] =
        [&parameter["uncertainty"]["type_a"], &parameter["uncertainty"]["combined"]]
            .map(Value::as_f64);
    let others = parameter["combination"].as_array().into_iter().flatten();
    let others = others.map(|one| Some(one["coefficient"].as_f64()? * truth(one["id"].as_str()?)?));
    let true_value = truth(id)? + others.sum::<Option<f64>>()?;
    is_reported.then(|| CertifiedParameter {
        id: id.into(),
        error: (parameter["value"].as_f64().unwrap_or(f64::NAN) - true_value) / expanded,
        of_references: type_a.zip(combined).map_or(0.0, |(a, all)| 1.0 - (a / all).powi(2)),
    })
}

/// What a laboratory reads whose references are off: its table turns faster than it reads by `rate` in either sense, reads too much once
/// per revolution, and its clock is slow.
fn spoil(log: &mut Log, rate: f64, (angle, phase): (f64, f64), clock: f64) {
    let steps: Vec<f64> = log.angles.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let fastest = steps.iter().fold(0.0_f64, |most, step| most.max(step.abs()));
    let interval = log.times[1] - log.times[0];
    let mut lost = 0.0;
    for place in 0..log.angles.len() {
        let step = steps[place.saturating_sub(1)];
        if step.abs() > TURNS * fastest {
            lost += rate * step.signum() * interval;
        }
        let own = log.angles[place];
        log.angles[place] = own - lost + angle * (own + phase).sin();
    }
    for time in &mut log.times {
        *time *= 1.0 - clock;
    }
}

/// Calibrates in so many laboratories by this program, and writes the page.
///
/// # Errors
/// [`Trouble`] if the program cannot be used, or an answer cannot be read.
pub fn certificates(
    program: &str,
    (seed, laboratories): (u64, u64),
    threads: usize,
    (page, revision): (&Path, &str),
) -> Result<(), Trouble> {
    let all = Mutex::new(Vec::new());
    let indices: Vec<u64> = (0..laboratories).collect();
    at_once(threads, &indices, |index| {
        let folder = tempfile::tempdir()?;
        let own = laboratory(program, folder.path(), (seed, *index))?;
        // The list is whole even if a thread panicked while it held it.
        all.lock().unwrap_or_else(std::sync::PoisonError::into_inner).push(own);
        Ok(())
    })?;
    let all: Vec<Answer> = all.into_inner().unwrap_or_else(std::sync::PoisonError::into_inner);
    Ok(fs::write(page, certificate_page(&all, seed, revision))?)
}

/// The page of what came of the laboratories.
fn certificate_page(answers: &[Answer], seed: u64, revision: &str) -> String {
    let mut page = String::from(HEAD);
    let failures: Vec<&String> = answers.iter().filter_map(|one| one.as_ref().err()).collect();
    let all: Vec<&CertifiedParameter> = answers.iter().flatten().flatten().collect();
    let _ = writeln!(
        page,
        "{} laboratories of seed {seed} at revision {revision}; {} ended without an answer. Brackets give counts and the bounds of \
         Clopper and Pearson at 95 %; parameters of one laboratory are correlated.\n",
        answers.len(),
        failures.len()
    );
    for failure in failures {
        let _ = writeln!(page, "- {failure}");
    }
    let covered = |of: &[&CertifiedParameter]| {
        Share::count(of.iter().map(|one| one.error.abs() <= 1.0)).text()
    };
    let row = |page: &mut String, name: &str, is_in: &dyn Fn(&CertifiedParameter) -> bool| {
        let of: Vec<&CertifiedParameter> = all.iter().copied().filter(|one| is_in(one)).collect();
        let _ = writeln!(page, "| {name} | {} |", covered(&of));
    };
    page.push_str(
        "| reported parameters | intervals that contain the true value |\n| --- | --- |\n",
    );
    row(&mut page, "all", &|_| true);
    row(&mut page, "references contribute less than 10 % of the variance", &|one| {
        one.of_references < 0.1
    });
    row(&mut page, "10 to 90 %", &|one| (0.1..0.9).contains(&one.of_references));
    row(&mut page, "more than 90 %", &|one| one.of_references >= 0.9);
    let ids: BTreeSet<&str> = all.iter().map(|one| one.id.as_str()).collect();
    page.push_str("\n| parameter | intervals that contain the true value |\n| --- | --- |\n");
    for id in ids {
        row(&mut page, &format!("`{id}`"), &|one| one.id == id);
    }
    page
}
