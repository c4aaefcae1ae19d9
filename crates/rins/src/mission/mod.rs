//! What a system is worth in service: navigation errors over days, scheme by scheme.

mod case;
mod figure;
mod outcome;
mod page;
mod radial;
mod result;
mod scheme;
mod simulated;
mod uncertainty;
mod want;

use std::path::{Path, PathBuf};
use std::sync::atomic::AtomicUsize;

use rayon::prelude::*;
use rins_io::{Calibration, InputFile, MissionFile};
use rins_terms::Model;

use self::case::Case;
pub use self::figure::WantedFigure;
pub(crate) use self::result::NAUTICAL_MILE;
pub use self::result::{
    BudgetResult, MissionResult, SchemeResult, SimulatedResult, WantResult, WantedParameterResult,
};
use self::scheme::SchemeInService;
use self::simulated::{Simulated, Wish};
use self::uncertainty::Uncertainty;
use crate::basis::BasisResult;
use crate::error::Result;
use crate::progress::Progress;

/// What a mission is asked for.
#[derive(Clone, Debug, Default)]
pub struct MissionOptions {
    /// A calibration file: what is left of the sensor errors after it was applied has its covariance.
    pub calibration: Option<PathBuf>,
    /// How many missions with drawn errors are navigated beside the linear propagation; by default none.
    pub runs: Option<u32>,
    /// The seed of the draws.
    pub seed: u64,
    /// A position error that is to be held: which uncertainties hold it?
    pub want: Option<WantedFigure>,
    /// Who hears how far it is.
    pub progress: Progress,
}

/// The navigation errors of a system in service under several schemes.
#[derive(Clone, Debug)]
pub struct Mission {
    name: String,
    /// The time of each result since the start \[s\].
    times: Vec<f64>,
    schemes: Vec<SchemeInService>,
    /// The sampling rate of simulated navigation \[Hz\].
    sample_rate: f64,
    remarks: Vec<String>,
    basis: BasisResult,
}

/// The navigation errors of a system in service, from a mission file.
///
/// # Errors
/// If a file cannot be read, the mission file states neither errors nor a data sheet, or what is asked for needs a data sheet or a
/// calibration that is not there.
///
/// ```
/// use rins::{MissionOptions, Outcome};
/// let folder = tempfile::tempdir()?;
/// let file = folder.path().join("mission.toml");
/// std::fs::write(&file, r#"
/// site = { latitude = "45 deg", longitude = "0 deg", height = "0 m" }
/// mission = { duration = "24 h" }
/// scheme = [{ name = "static" }, { name = "continuous", rate = "6 deg/s" }]
/// errors = { gyro = { scale = ["0 ppm", "0 ppm", "5 ppm"] } }
/// "#)?;
/// let mission = rins::mission(&file, &MissionOptions::default())?;
/// // A scale error of 5 ppm costs 78 nautical miles a day in continuous rotation.
/// let east = mission.result().schemes[1].east_nmi.clone().unwrap();
/// assert!((east[23] - 77.8).abs() < 0.3);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn mission(path: &Path, options: &MissionOptions) -> Result<Mission> {
    Ok(of_file(path, options)?)
}

fn of_file(path: &Path, options: &MissionOptions) -> anyhow::Result<Mission> {
    let file = MissionFile::read(path)?;
    let mut inputs = vec![InputFile::of(path)?];
    let calibration = match &options.calibration {
        None => None,
        Some(path) => {
            inputs.push(InputFile::of(path)?);
            Some(Calibration::read(path)?)
        }
    };
    let shown = rins_io::shown(path);
    anyhow::ensure!(
        file.errors.is_some() || file.imu.is_some() || calibration.is_some(),
        "{shown}: neither [errors] nor [imu] nor a calibration: there is no error to propagate"
    );
    let model = Model::sensors();
    let places: Vec<(usize, usize)> = model.places().collect();
    let uncertainty = Uncertainty::of(&model, file.imu.as_ref(), calibration.as_ref());
    let before = calibration.as_ref().and(Uncertainty::of(&model, file.imu.as_ref(), None));
    anyhow::ensure!(
        uncertainty.is_some() || (options.runs.is_none() && options.want.is_none()),
        "{shown}: simulated missions and a wanted figure need uncertainties: state [imu], or a calibration"
    );
    anyhow::ensure!(options.runs != Some(0), "at least one mission must be simulated");
    let case = Case {
        file: &file,
        model: &model,
        places: &places,
        uncertainty: uncertainty.as_ref(),
        before: before.as_ref(),
        want: options.want.as_ref(),
    };
    let stage = options.progress.begin("propagating", None);
    let schemes = file.schemes.par_iter().map(|scheme| SchemeInService::of(&case, scheme));
    let mut schemes: Vec<SchemeInService> = schemes.collect::<anyhow::Result<_>>()?;
    drop(stage);
    if let Some(runs) = options.runs {
        let wanted = options.want.as_ref().and_then(|want| want.place(&file.times).ok());
        let times = file.times.len() + wanted.map_or(0, |place| place + 1);
        let steps = Simulated::steps(runs, times) * schemes.len();
        let stage = options.progress.begin("navigating", Some(steps));
        let wish = Wish { runs, seed: options.seed, stage: &stage, done: &AtomicUsize::new(0) };
        for (scheme, stated) in schemes.iter_mut().zip(&file.schemes) {
            scheme.simulate(&case, stated, &wish)?;
        }
    }
    Ok(Mission {
        name: shown,
        schemes,
        remarks: remarks(&case),
        sample_rate: 1.0 / file.sample_interval,
        times: file.times,
        basis: BasisResult::of_files(inputs),
    })
}

/// What else is to be known.
fn remarks(case: &Case<'_>) -> Vec<String> {
    let carrier = if case.file.carrier.is_some() {
        "The carrier moves as stated"
    } else {
        "The carrier is at rest"
    };
    let mut remarks = vec![format!(
        "{carrier}, and its height is known. The sensor errors are constant from switching on to the end, except for the noise of the data \
         sheet: white noise, bias instability and random walk as far as it states them."
    )];
    let turns = case.file.schemes.iter().any(|scheme| scheme.stabilized);
    if turns {
        remarks.push(
            "A stabilized table turns against the yaw of the carrier: its rates are about the local level.".into(),
        );
    }
    if let Some(Uncertainty { without, .. }) = case.uncertainty
        && !without.is_empty()
    {
        remarks.push(format!(
            "Neither the calibration nor a data sheet states an uncertainty of {}: taken as exact.",
            without.join(", ")
        ));
    }
    remarks
}
