//! How the parameters of an IMU vary between runs: homogeneity, causes, and the next run.

mod estimates;
mod outcome;
mod page;
mod result;
mod source;
mod text;

use std::path::PathBuf;

use rins_history::{Conditions, Explanation, Forecast, History, Past, baselines};
use rins_io::Calibration;

use self::estimates::Observed;
pub use self::result::{
    ForecastResult, HistoryResult, IntervalResult, PredictionResult, RunConditionsResult,
    RunValueResult, ScoreResult,
};
use self::source::sources;
use crate::basis::BasisResult;
use crate::error::Result;
use crate::homogeneity::RunComparison;
use crate::log::DAY;
use crate::progress::Progress;
use crate::references::IndependentCovariances;

/// A run is predicted from the runs before it if these are as many.
const FEWEST_BEFORE: usize = 3;

/// What a history is asked for.
#[derive(Clone, Debug, Default)]
pub struct HistoryOptions {
    /// The date of the run to be predicted, since 1970 \[s\]; by default as long after the last run as runs were apart at the median.
    pub date: Option<f64>,
    /// Its temperature \[°C\]; by default the median of the runs.
    pub temperature: Option<f64>,
    /// Its time since power-on \[s\]; by default the median of the runs.
    pub since_power_on: Option<f64>,
    /// Who hears how far it is.
    pub progress: Progress,
}

/// The history of the parameters of an IMU, or of several.
#[derive(Clone, Debug)]
pub struct RunHistory {
    comparison: RunComparison,
    /// The conditions of the run that is predicted.
    next: Conditions,
    /// Of every parameter, its forecast in that run, or why there is none.
    forecasts: Vec<Predicted>,
    /// How well each run is predicted from the runs before it.
    scores: Vec<Score>,
    remarks: Vec<String>,
    basis: BasisResult,
}

/// A forecast, or why there is none.
#[derive(Clone, Debug)]
enum Predicted {
    Forecast(Forecast),
    Lacks(String),
}

/// How well the runs of a parameter are predicted, each from those before.
#[derive(Clone, Debug, Default)]
struct Score {
    /// The runs that were predicted: place, forecast, value, 1σ.
    runs: Vec<(usize, Forecast, f64, f64)>,
    /// The mean scores (CRPS) of the forecast, of the last value, of the mean and of the line over the date, in the parameter's unit.
    crps: Option<[f64; 4]>,
}

/// How the parameters of an IMU vary over its runs.
///
/// Each path is a calibration file, a rig file whose log is calibrated by itself with the full model, or a folder of these.
///
/// # Errors
/// If a file cannot be read, if a log cannot be calibrated, or if there are fewer than two runs with a parameter in common that both observe.
///
/// ```no_run
/// use rins::{HistoryOptions, Outcome};
/// let history = rins::history(&["runs".into()], &HistoryOptions::default())?;
/// print!("{history}");
/// for cause in history.result().causes {
///     println!("{}: {}", cause.id, cause.variation);
/// }
/// # Ok::<(), rins::Error>(())
/// ```
pub fn history(paths: &[PathBuf], options: &HistoryOptions) -> Result<RunHistory> {
    Ok(of_paths(paths, options)?)
}

fn of_paths(paths: &[PathBuf], options: &HistoryOptions) -> anyhow::Result<RunHistory> {
    let mut sources = sources(paths, &options.progress)?;
    let started = |source: &source::Source| {
        source.calibration.measured.started.as_ref().map(|started| started.seconds)
    };
    let dated = sources.iter().all(|source| started(source).is_some());
    if dated {
        sources.sort_by(|a, b| started(a).unwrap_or(0.0).total_cmp(&started(b).unwrap_or(0.0)));
    }
    anyhow::ensure!(
        sources.len() > 1,
        "one run has no history: give two calibration files, rig files or folders of them at least"
    );
    let observed = Observed::of(&sources);
    anyhow::ensure!(
        !observed.ids.is_empty(),
        "no parameter of bias, scale error or misalignment is observed by two of the runs"
    );
    let stage = options.progress.begin("comparing hypotheses", None);
    let calibrations: Vec<&Calibration> =
        sources.iter().map(|source| &source.calibration).collect();
    let independent = IndependentCovariances::of(&calibrations);
    let history = observed.history(&sources, &independent.each)?;
    let mut remarks: Vec<String> = independent.assumption.into_iter().collect();
    if !dated {
        remarks.push(
            "Not every run has a date ([run] started in its rig file): the runs are in the order in which they were given, and no drift \
             over the date is a hypothesis."
                .into(),
        );
    }
    let basis = BasisResult::together(sources.iter().map(|source| &source.basis));
    let names = sources.into_iter().map(|source| source.name).collect();
    let parameters = observed.ids.len();
    let comparison = RunComparison::of(names, observed.units, history);
    let next = next(&comparison.history, options);
    let forecasts = (0..parameters).map(|place| predicted(&comparison.explanation, place, next));
    let forecasts = forecasts.collect();
    let scores = scores(&comparison.history)?;
    drop(stage);
    Ok(RunHistory { comparison, next, forecasts, scores, remarks, basis })
}

fn predicted(explanation: &Explanation, place: usize, conditions: Conditions) -> Predicted {
    match explanation.forecast(place, conditions) {
        Ok(Some(forecast)) => Predicted::Forecast(forecast),
        Ok(None) => Predicted::Lacks("no run observes it".into()),
        Err(error) => Predicted::Lacks(error.to_string()),
    }
}

/// The conditions of the run that is predicted: another power-on of the unit of the last run.
fn next(history: &History, options: &HistoryOptions) -> Conditions {
    let runs = history.runs();
    let of = |figure: fn(&Conditions) -> Option<f64>| -> Vec<f64> {
        runs.iter().filter_map(|run| figure(&run.conditions)).collect()
    };
    let dates = of(|one| one.date);
    let apart: Vec<f64> = dates.windows(2).map(|pair| pair[1] - pair[0]).collect();
    let date = dates.last().map(|last| last + median(apart).unwrap_or(0.0));
    let power_ons = runs.iter().map(|run| run.conditions.power_on);
    Conditions {
        unit: runs.last().map_or(0, |run| run.conditions.unit),
        power_on: power_ons.max().unwrap_or(0) + 1,
        date: options.date.map(|seconds| seconds / DAY).or(date),
        since_power_on: options.since_power_on.or_else(|| median(of(|one| one.since_power_on))),
        temperature: options.temperature.or_else(|| median(of(|one| one.temperature))),
        warming: runs.last().and_then(|run| run.conditions.warming),
    }
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}

/// Each run predicted from the runs before it.
fn scores(history: &History) -> anyhow::Result<Vec<Score>> {
    let runs = history.runs();
    let mut scores = vec![Score::default(); history.quantities().len()];
    let mut sums = vec![(0.0, [0.0; 4]); scores.len()];
    for last in FEWEST_BEFORE..runs.len() {
        let before: Vec<usize> = (0..last).collect();
        let explanation = history.of_runs(&before)?.explain();
        let conditions = runs[last].conditions;
        for (place, score) in scores.iter_mut().enumerate() {
            let Some((value, sigma)) = runs[last].value(place) else { continue };
            let Predicted::Forecast(forecast) = predicted(&explanation, place, conditions) else {
                continue;
            };
            let forecast = forecast.estimated_within(sigma);
            let date = |run: usize| runs[run].conditions.date.unwrap_or(run as f64);
            let past: Vec<Past> = before
                .iter()
                .filter_map(|&run| {
                    let (value, _) = runs[run].value(place)?;
                    Some(Past { date: date(run), value })
                })
                .collect();
            if let Some(simple) = baselines(&past, date(last), sigma) {
                let (count, sum) = &mut sums[place];
                *count += 1.0;
                let all = std::iter::once(&forecast).chain(&simple);
                for (sum, forecast) in sum.iter_mut().zip(all) {
                    *sum += forecast.crps(value);
                }
            }
            score.runs.push((last, forecast, value, sigma));
        }
    }
    for (score, (count, sum)) in scores.iter_mut().zip(sums) {
        score.crps = (count > 0.0).then(|| sum.map(|sum| sum / count));
    }
    Ok(scores)
}
