//! Free inertial navigation of a log, from rest.

mod free;
mod outcome;
mod result;

use std::path::PathBuf;

use anyhow::Context;
use rins_calibration::FreeNavigation;
use rins_frames::EulerAngles;
use rins_io::{InputFile, shown};

pub(crate) use self::free::axis_attitude;
use self::free::{Start, navigated, start, undone};
pub use self::result::{NavigateResult, NavigatedResult};
use crate::check::refuse_mistaken;
use crate::error::Result;
use crate::log::{Beyond, Log, beyond};

/// The options of [`navigate`].
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct NavigateOptions {
    /// The calibration file with which readings are compensated, if any.
    pub calibration: Option<PathBuf>,
    /// Whether readings are compensated at temperatures far outside the calibrated range; by default that is an error.
    pub extrapolate: bool,
}

/// Free inertial navigation of a log: as recorded, without the gyro bias found over a static interval, and compensated.
#[derive(Debug)]
pub struct Navigation<'a> {
    log: &'a Log,
    start: Start,
    runs: Vec<(&'static str, FreeNavigation)>,
    beyond: Beyond,
    calibration: Option<InputFile>,
}

/// Computes free inertial navigation of a log from standstill, with the vertical channel held.
///
/// # Errors
/// If units, signs or axes are wrong, if no initial attitude is available, or if the calibration cannot be applied.
///
/// ```
/// use rins::{NavigateOptions, Outcome};
/// let folder = tempfile::tempdir()?;
/// let log = rins::demo::log(folder.path())?;
/// let navigation = rins::navigate(&log, &NavigateOptions::default())?;
/// assert_eq!(navigation.result().runs[0].name, "as recorded");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn navigate<'a>(log: &'a Log, options: &NavigateOptions) -> Result<Navigation<'a>> {
    Ok(navigation(log, options)?)
}

fn navigation<'a>(log: &'a Log, options: &NavigateOptions) -> anyhow::Result<Navigation<'a>> {
    let loaded = &log.loaded;
    refuse_mistaken(loaded)?;
    let start = start(loaded)?;
    let mut runs = vec![("as recorded", navigated(loaded, &start, None))];
    if let Some(bias) = &start.gyro_bias {
        let compensation = bias.compensation()?;
        runs.push(("gyro bias removed", navigated(loaded, &start, Some(&compensation))));
    }
    let mut found = Beyond::default();
    if let Some(file) = &options.calibration {
        let calibration = rins_io::Calibration::read(file)?;
        let (error, terms) = calibration.in_run(&loaded.rig.spin)?;
        found = beyond(&calibration, &terms, loaded, options.extrapolate)?;
        let undone = undone(loaded, &start, (error, terms)).with_context(|| shown(file))?;
        runs.push(("compensated", undone));
    }
    for (name, run) in &runs {
        let EulerAngles { roll, pitch, yaw } = run.attitude_error;
        let numbers = run.velocity.iter().chain(&run.position_error).copied();
        anyhow::ensure!(
            numbers.chain([roll, pitch, yaw]).all(f64::is_finite),
            "{}: navigation ({name}) leaves the range of numbers: readings or calibration are absurd",
            log.name
        );
    }
    let calibration = options.calibration.as_deref().map(InputFile::of).transpose()?;
    Ok(Navigation { log, start, runs, beyond: found, calibration })
}
