//! A designed schedule, in words.

use rins_estimation::Observable;
use rins_frames::units::PPM;
use rins_report::number::figure;
use rins_terms::catalogue;

use super::goal::{DesignGoal, meaning};
use super::notes::notes;
use super::result::DesignedRunResult;
use super::study::{Compared, DesignStudy};
use crate::identifiability::{gauge_sentences, rank_sentence};
use crate::table::aligned;

/// A number to three digits.
fn short(value: f64) -> String {
    figure(value, 3)
}

/// A value of the criterion with its unit.
fn shown(study: &DesignStudy, value: f64) -> String {
    let (value, unit) = study.figure(value);
    let shown = if value.is_finite() { short(value) } else { "undetermined".into() };
    if unit.is_empty() { shown } else { format!("{shown} {unit}") }
}

/// How many times better one value is than another.
fn factor(study: &DesignStudy, better: f64, worse: f64) -> f64 {
    let [better, worse] = [better, worse].map(|value| study.figure(value).0);
    if matches!(study.goal, DesignGoal::Separation(_)) { better / worse } else { worse / better }
}

fn times_in_words(times: f64) -> String {
    if times > 1000.0 { "more than 1000 times".into() } else { format!("{} times", short(times)) }
}

/// The result in a few sentences.
pub(super) fn summary(study: &DesignStudy) -> Vec<String> {
    let optimal = &study.optimal;
    let runs = match optimal.runs.len() {
        1 => "one run".to_owned(),
        count => format!("{count} runs in one power-on"),
    };
    let mut sentences = vec![format!(
        "Optimal schedule: {runs}, {} s in all. The {} is {}.",
        study.limits.duration,
        meaning(&study.goal, &study.service),
        shown(study, optimal.value)
    )];
    let others: Vec<String> = study
        .compared
        .iter()
        .filter(|one| one.name != "optimal")
        .filter_map(|one| {
            let value = one.value?;
            let times = factor(study, optimal.value, value);
            Some(format!("{} {} ({})", one.name, shown(study, value), times_in_words(times)))
        })
        .collect();
    if !others.is_empty() {
        sentences.push(format!("Other schedules: {}.", others.join(", ")));
    }
    sentences.push(format!(
        "Equivalence theorem: the gap is {:.2} %. No schedule of these motions in these orientations is better than {}; this one has an \
         efficiency of {:.1} % with its ramps and ends.",
        100.0 * optimal.gap,
        shown(study, study.bound),
        100.0 * study.efficiency
    ));
    let best_usual = study
        .compared
        .iter()
        .filter(|one| !matches!(one.name.as_str(), "optimal" | "given"))
        .filter_map(|one| one.value)
        .fold(f64::INFINITY, f64::min);
    if best_usual.is_finite() && factor(study, optimal.value, best_usual) < 1.02 {
        sentences.push("There is no gain over the best of the usual schedules.".into());
    }
    sentences.extend(scale_sentence(study));
    sentences
}

/// The bound of the scale error about the spin axis.
fn scale_sentence(study: &DesignStudy) -> Option<String> {
    let reached = |compared: &Compared| {
        let place = compared.identifiability.find(&format!("{}.z", catalogue::GYRO_SCALE.id))?;
        Some(compared.identifiability.parameters[place].sigma / PPM)
    };
    let own = reached(study.compared.last()?)?;
    let reversal = study.compared.iter().find(|one| one.name == "reversal").and_then(reached);
    let beside =
        reversal.map_or_else(String::new, |one| format!(", a reversal {} ppm", short(one)));
    Some(format!(
        "{}.z: white noise bounds its σ by N/(ω√T) = {} ppm; this schedule has {} ppm{beside}.",
        catalogue::GYRO_SCALE.id,
        short(study.scale_bound() / PPM),
        short(own)
    ))
}

/// The schedule for a person: one row for each segment.
pub(super) fn schedule_rows(study: &DesignStudy) -> Vec<Vec<String>> {
    let head = [
        "run",
        "spin axis",
        "tilt [deg]",
        "azimuth [deg]",
        "start [s]",
        "rate [deg/s]",
        "duration [s]",
        "table angle at end [deg]",
        "",
    ];
    let mut rows = vec![head.map(String::from).to_vec()];
    for (place, run) in study.optimal.runs.iter().enumerate() {
        let result = DesignedRunResult::of(run);
        for (part, segment) in result.profile.iter().enumerate() {
            let mut row = vec![String::new(); 4];
            if part == 0 {
                row = vec![
                    (place + 1).to_string(),
                    result.spin.clone(),
                    format!("{:.1}", result.tilt_deg),
                    format!("{:.1}", result.attitude_deg.yaw),
                ];
            }
            row.extend([
                format!("{:.1}", segment.start_s),
                short_rate(segment.rate_deg_s),
                format!("{:.1}", segment.duration_s),
                format!("{:.1}", segment.end_angle_deg),
                String::new(),
            ]);
            rows.push(row);
        }
    }
    rows
}

fn short_rate(rate: f64) -> String {
    if rate == 0.0 { "0".into() } else { figure(rate, 4) }
}

/// The schedules side by side: criterion and 1σ of each parameter; a star marks what is not observable by itself.
pub(super) fn comparison(study: &DesignStudy) -> Vec<Vec<String>> {
    let line = |head: &str, of: &dyn Fn(&Compared) -> String| {
        let mut row = vec![head.to_owned()];
        row.extend(study.compared.iter().map(of));
        row.push(String::new());
        row
    };
    let mut rows = vec![
        line("schedule", &|one| one.name.clone()),
        line("duration [s]", &|one| short_duration(one.duration)),
        line(&criterion_head(study), &|one| {
            one.value.map_or_else(|| "–".into(), |value| short(study.figure(value).0))
        }),
        line("observable parameters", &|one| {
            let seen = one.identifiability.parameters.iter();
            seen.filter(|seen| seen.identifiable && seen.shown == Observable::Alone)
                .count()
                .to_string()
        }),
    ];
    let first = &study.compared.last().unwrap_or(&study.compared[0]).identifiability;
    for unknown in first.unknowns.iter().filter(|unknown| unknown.run.is_none_or(|run| run == 0)) {
        let head = format!("{} [{}]", unknown.id, unknown.unit.symbol);
        rows.push(line(&head, &|one| {
            one.identifiability.find(&unknown.id).map_or_else(String::new, |place| {
                let seen = &one.identifiability.parameters[place];
                let mark = if seen.identifiable { "" } else { " *" };
                format!("{}{mark}", short(seen.sigma / unknown.unit.factor))
            })
        }));
    }
    rows
}

fn short_duration(duration: f64) -> String {
    format!("{duration:.0}")
}

fn criterion_head(study: &DesignStudy) -> String {
    let (_, unit) = study.figure(1.0);
    let name = match study.goal {
        DesignGoal::Parameter(_) => "criterion: σ",
        DesignGoal::Position(_) => "position error",
        DesignGoal::Determinant(_) => "D-criterion",
        DesignGoal::MeanSquare(_) => "A-criterion",
        DesignGoal::Separation(_) => "separation",
    };
    if unit.is_empty() { name.into() } else { format!("{name} [{unit}]") }
}

/// What is observable under the schedule.
pub(super) fn observability(study: &DesignStudy) -> Vec<String> {
    let identifiability = study.optimal.joint.identifiability();
    let mut sentences = vec![rank_sentence(&identifiability)];
    sentences.extend(gauge_sentences(&identifiability));
    sentences
}

/// The text for a terminal.
pub(super) fn text(study: &DesignStudy) -> String {
    let mut lines = vec![title(study)];
    lines.extend(summary(study).into_iter().map(|sentence| format!("  {sentence}")));
    lines.push(String::new());
    lines.push(aligned(&schedule_rows(study)));
    lines.push("  1σ with the data sheet as prior; * not observable by itself".into());
    lines.push(aligned(&comparison(study)));
    let last = observability(study).into_iter().chain(notes(study));
    lines.extend(last.map(|sentence| format!("  {sentence}")));
    let text = lines.join("\n");
    text.lines().map(|line| line.trim_end().to_owned() + "\n").collect()
}

pub(super) fn title(study: &DesignStudy) -> String {
    format!("Design of a schedule from {}, model {}", study.name, study.model)
}
