//! From logs to sensor errors, with their uncertainty, what is observable, and what compensating them gains.

mod budget;
mod certificate;
mod compensation;
mod compensation_guide;
mod conformity;
mod departure;
mod files;
mod noise;
mod outcome;
mod page;
mod paper;
mod result;
mod uncertainty;
mod uncertainty_result;
mod uncertainty_words;

pub use self::budget::{BudgetResult, ContributionResult, DriftResult};
pub(crate) use self::certificate::{Certificate, held};
pub use self::conformity::{Conformity, ConformityResult};
use self::paper::PaperCalibration;
pub(crate) use self::result::departures;
pub use self::result::{
    AccelNoiseResult, CalibrateResult, DepartureResult, GyroNoiseResult, IterationResult,
    NoiseResult, ParameterResult, RunResult,
};
pub use self::uncertainty_result::{ContributionOfReference, UncertaintyResult};
use rins_calibration::CalibrationError;

use crate::error::Result;
use crate::log::Log;
use crate::options::{ModelChoice, NamedModel, NoiseChoice};
use crate::preparation::{EstimationProblem, Prepared};
use crate::progress::Progress;

/// What a calibration is asked for.
#[derive(Clone, Debug, Default)]
pub struct CalibrateOptions {
    /// The error model. By default it is the paper's for one log with a table angle or rate, if the attitude of the axis is given or
    /// can be found; otherwise it is all of eq. (1).
    pub model: Option<ModelChoice>,
    /// Whether the noise is estimated, as it is by default, or the data sheet trusted; the paper's filter trusts it.
    pub noise: NoiseChoice,
    /// Who hears how far it is.
    pub progress: Progress,
}

/// The sensor errors that logs show.
#[derive(Debug)]
pub struct Calibration(Kind);

#[derive(Debug)]
enum Kind {
    /// By the paper's filter.
    Paper(Box<PaperCalibration>),
    /// By the estimator that takes any model.
    Certificate(Box<Certificate>),
}

/// Estimates sensor errors from the logs of one IMU, and navigates each log freely with them compensated.
///
/// # Errors
/// If units, signs or axes are mistaken, if the logs are not of one IMU, or if the model cannot be estimated from them.
///
/// # Panics
/// If there are no logs.
///
/// ```
/// use rins::{CalibrateOptions, Outcome};
/// let folder = tempfile::tempdir()?;
/// let log = rins::demo::log(folder.path())?;
/// let calibration = rins::calibrate(vec![log], &CalibrateOptions::default())?;
/// print!("{calibration}");
/// assert_eq!(calibration.result().parameters[0].id, "gyro.misalignment.xz");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn calibrate(logs: Vec<Log>, options: &CalibrateOptions) -> Result<Calibration> {
    Ok(calibrated(logs, options)?)
}

fn calibrated(mut logs: Vec<Log>, options: &CalibrateOptions) -> anyhow::Result<Calibration> {
    let mut remark = None;
    let tolerances = conformity::tolerances(&logs)?;
    let states =
        |log: &&Log| log.loaded.rig.accuracy.is_stated() || log.loaded.rig.tolerance.is_some();
    let stated = logs.iter().find(states);
    let choice = match &options.model {
        Some(ModelChoice::Paper12) => {
            if let Some(log) = stated {
                anyhow::bail!(
                    "{}: the rig file states the accuracy of a reference or tolerances, which the paper's filter does not take into account: full does",
                    log.name
                );
            }
            anyhow::ensure!(
                logs.len() == 1,
                "the paper's filter takes one log; full takes several"
            );
            return paper(logs.remove(0), options);
        }
        Some(choice) => choice.clone(),
        None if stated.is_some() => {
            let why = "The model is full: the accuracy of a reference or a tolerance is stated, which paper12 does not take into account.";
            remark = has_table_reading(&logs[0]).then(|| why.to_owned());
            ModelChoice::Full
        }
        None => match &logs[..] {
            [only] if has_table_reading(only) && only.loaded.rig.attitude.is_some() => {
                return paper(logs.remove(0), options);
            }
            [only] if has_table_reading(only) => match paper(only.clone(), options) {
                Err(error) if lacks_attitude(&error) => {
                    remark =
                        Some(format!("The model is full, as paper12 is not possible: {error:#}."));
                    ModelChoice::Full
                }
                done => return done,
            },
            _ => ModelChoice::Full,
        },
    };
    let named = NamedModel::of(&choice, &logs[0].loaded.rig.spin)?;
    let stage = options.progress.begin("preparing", None);
    let runs = logs.into_iter().map(|log| Prepared::of(log, options.noise));
    let runs = runs.collect::<anyhow::Result<Vec<_>>>()?;
    drop(stage);
    let mut problem = EstimationProblem::of(runs, named, options.noise)?;
    problem.remarks.extend(remark);
    problem.is_default = options.model.is_none();
    let certificate = Certificate { tolerances, ..Certificate::of(problem, &options.progress)? };
    Ok(Calibration(Kind::Certificate(Box::new(certificate))))
}

/// The calibration file of one log, by the full model.
pub(crate) fn single_calibration(
    log: Log,
    progress: &Progress,
) -> anyhow::Result<rins_io::Calibration> {
    let options = CalibrateOptions {
        model: Some(ModelChoice::Full),
        progress: progress.clone(),
        ..CalibrateOptions::default()
    };
    match calibrated(vec![log], &options)?.0 {
        Kind::Certificate(certificate) => Ok(certificate.calibration_file(0)),
        Kind::Paper(_) => anyhow::bail!("the full model is not the paper's"),
    }
}

fn paper(log: Log, options: &CalibrateOptions) -> anyhow::Result<Calibration> {
    let paper = PaperCalibration::of(log, &options.progress)?;
    Ok(Calibration(Kind::Paper(Box::new(paper))))
}

fn has_table_reading(log: &Log) -> bool {
    let recording = &log.loaded.recording;
    recording.table_angle.is_some() || recording.table_rate.is_some()
}

/// Whether the paper's filter failed because the attitude of the spin axis is neither given nor found.
fn lacks_attitude(error: &anyhow::Error) -> bool {
    matches!(
        error.downcast_ref::<CalibrationError>(),
        Some(CalibrationError::NoAttitude { .. } | CalibrationError::Alignment(_))
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_papers_filter_and_the_estimator_take_the_same_samples() {
        let folder = tempfile::tempdir().unwrap();
        let mut log = crate::demo::log(folder.path()).unwrap();
        // A driver that hands out a sample again, so that preparing the log changes it.
        let samples = &mut log.loaded.recording.increments;
        for place in [3000, 3001, 3002, 3100, 3101] {
            (samples[place].angle, samples[place].velocity) =
                (samples[place - 1].angle, samples[place - 1].velocity);
        }
        let given = log.loaded.recording.len();
        let paper = PaperCalibration::of(log.clone(), &Progress::default()).unwrap();
        let prepared = Prepared::of(log, NoiseChoice::Given).unwrap();
        assert!(paper.recording().len() < given, "nothing was taken out");
        assert_eq!(*paper.recording(), *prepared.run.recording);
    }
}
