//! What a system is worth in service: navigation errors over days, scheme by scheme.

mod outcome;
mod page;
mod radial;
mod result;

use std::path::{Path, PathBuf};

use nalgebra::{DMatrix, SMatrix};
use rins_design::{GROWTH_STATES, Growth, Service};
use rins_imu::{ImuSpec, TriadSpec};
use rins_io::{Calibration, InputFile, MissionFile, RotationScheme};
use rins_terms::{Model, Surroundings};

use self::radial::probable_radius;
pub(crate) use self::result::NAUTICAL_MILE;
pub use self::result::{BudgetResult, MissionResult, SchemeResult};
use crate::basis::BasisResult;
use crate::error::Result;
use crate::progress::Progress;

/// What a mission is asked for.
#[derive(Clone, Debug, Default)]
pub struct MissionOptions {
    /// A calibration file: what is left of the sensor errors after it was applied has its covariance.
    pub calibration: Option<PathBuf>,
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
    remarks: Vec<String>,
    basis: BasisResult,
}

/// A scheme with its navigation errors.
#[derive(Clone, Debug)]
struct SchemeInService {
    name: String,
    /// The position error east and north by the stated errors, at each time \[m\].
    by_errors: Option<Vec<[f64; 2]>>,
    /// The secular growth of the error east by the stated errors \[m/s\], if a cycle is whole revolutions.
    law: Option<f64>,
    /// The radial position error by the uncertainties, at each time.
    by_uncertainty: Option<Vec<Radial>>,
    /// The radial position error at the end by each source alone, 1σ \[m\]; the largest first.
    budget: Vec<(String, f64)>,
}

/// A random radial position error \[m\].
#[derive(Clone, Copy, Debug)]
struct Radial {
    /// The root mean square.
    rms: f64,
    /// The radius that holds half of the cases.
    half: f64,
    /// The radius that holds 95 % of them.
    most: f64,
}

/// The navigation errors of a system in service, from a mission file.
///
/// # Errors
/// If a file cannot be read, or the mission file states neither errors nor a data sheet.
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
    anyhow::ensure!(
        file.errors.is_some() || file.imu.is_some() || calibration.is_some(),
        "{}: neither [errors] nor [imu] nor a calibration: there is no error to propagate",
        rins_io::shown(path)
    );
    let model = Model::sensors();
    let uncertainty = Uncertainty::of(&model, file.imu.as_ref(), calibration.as_ref());
    let mut remarks = vec![
        "The carrier is at rest, and its height is known. The errors are constant from switching on to the end; white noise is that of the \
         data sheet."
            .to_owned(),
    ];
    if file.imu.as_ref().is_some_and(|imu| drifts(&imu.gyro) || drifts(&imu.accel)) {
        remarks.push("Bias instability and random walk of the data sheet are not included.".into());
    }
    if let Some(Uncertainty { without, .. }) = &uncertainty
        && !without.is_empty()
    {
        remarks.push(format!(
            "Neither the calibration nor a data sheet states an uncertainty of {}: taken as exact.",
            without.join(", ")
        ));
    }
    let stage = options.progress.begin("propagating", Some(file.schemes.len()));
    let mut schemes = Vec::with_capacity(file.schemes.len());
    for scheme in &file.schemes {
        schemes.push(SchemeInService::of(&file, scheme, &model, uncertainty.as_ref())?);
        stage.done(schemes.len());
    }
    drop(stage);
    Ok(Mission {
        name: rins_io::shown(path),
        times: file.times,
        schemes,
        remarks,
        basis: BasisResult::of_files(inputs),
    })
}

fn drifts(triad: &TriadSpec) -> bool {
    [triad.bias_instability, triad.random_walk].iter().flatten().any(|strength| *strength > 0.0)
}

/// How uncertain the sensor errors are, in SI units.
struct Uncertainty {
    covariance: DMatrix<f64>,
    noise: [f64; 2],
    /// The parameters of which nothing states an uncertainty.
    without: Vec<String>,
}

impl Uncertainty {
    /// That of a data sheet, or of what is left after a calibration; `None` if there is neither.
    fn of(model: &Model, imu: Option<&ImuSpec>, calibration: Option<&Calibration>) -> Option<Self> {
        if imu.is_none() && calibration.is_none() {
            return None;
        }
        let ids: Vec<String> = model.ids().collect();
        let places: Vec<(usize, usize)> = model.places().collect();
        let factor = |place: usize| {
            let (term, parameter) = places[place];
            model.terms[term].term.parameters[parameter].unit.factor
        };
        let mut covariance = DMatrix::zeros(ids.len(), ids.len());
        let mut without = Vec::new();
        for (place, (id, &(term, parameter))) in ids.iter().zip(&places).enumerate() {
            let calibrated = calibration
                .and_then(|file| file.sigmas.iter().find(|sigma| sigma.id == *id))
                .map(|sigma| sigma.value * factor(place));
            let stated = imu.map(|imu| model.terms[term].term.parameters[parameter].sigma(imu));
            match calibrated.or(stated) {
                Some(sigma) => covariance[(place, place)] = sigma * sigma,
                None => without.push(id.clone()),
            }
        }
        if let Some(known) = calibration.and_then(|file| file.covariance.as_ref()) {
            let at = |id: &String| known.ids.iter().position(|other| other == id);
            for (row, own) in ids.iter().enumerate() {
                for (column, other) in ids.iter().enumerate() {
                    if let Some((a, b)) = at(own).zip(at(other)) {
                        covariance[(row, column)] =
                            known.matrix[(a, b)] * factor(row) * factor(column);
                    }
                }
            }
        }
        let noise = imu.map_or([0.0; 2], |imu| [imu.gyro.noise_density, imu.accel.noise_density]);
        Some(Self { covariance, noise, without })
    }
}

impl SchemeInService {
    fn of(
        file: &MissionFile,
        scheme: &RotationScheme,
        model: &Model,
        uncertainty: Option<&Uncertainty>,
    ) -> anyhow::Result<Self> {
        let places: Vec<(usize, usize)> = model.places().collect();
        let service = Service {
            surroundings: Surroundings::new(file.station, file.nav_from_table),
            cycle: &scheme.cycle,
            model,
            parameters: &places,
            noise: uncertainty.map_or([0.0; 2], |of| of.noise),
        };
        let growth = service.growth(&file.times)?;
        let errors: Option<Vec<f64>> = file.errors.as_ref().map(|errors| {
            let stated = Model::from(errors);
            model.ids().map(|id| stated.value(&id).unwrap_or_default()).collect()
        });
        let law = match (&errors, service.secular_east()?) {
            (Some(errors), Some(by)) => {
                Some(by.iter().zip(errors).map(|(by, error)| by * error).sum())
            }
            _ => None,
        };
        let by_errors = errors.map(|errors| growth.iter().map(|at| at.position(&errors)).collect());
        let mut start = SMatrix::<f64, GROWTH_STATES, GROWTH_STATES>::zeros();
        for axis in 0..3 {
            start[(axis, axis)] = file.attitude_sigma.powi(2);
        }
        let by_uncertainty = uncertainty.map(|of| {
            let radial = |at: &Growth| Radial::of(&at.covariance(&of.covariance, &start));
            growth.iter().map(radial).collect()
        });
        let last = growth.last();
        let budget = uncertainty.zip(last).map(|(of, last)| budget(model, of, last, &start));
        Ok(Self {
            name: scheme.name.clone(),
            by_errors,
            law,
            by_uncertainty,
            budget: budget.unwrap_or_default(),
        })
    }
}

/// The radial position error by each source alone, 1σ \[m\], the largest first; correlations are not in it.
fn budget(
    model: &Model,
    of: &Uncertainty,
    last: &Growth,
    start: &SMatrix<f64, GROWTH_STATES, GROWTH_STATES>,
) -> Vec<(String, f64)> {
    let none = DMatrix::zeros(of.covariance.nrows(), of.covariance.ncols());
    let mut sources: Vec<(String, f64)> = model
        .ids()
        .enumerate()
        .map(|(place, id)| {
            let mut alone = vec![0.0; of.covariance.nrows()];
            alone[place] = of.covariance[(place, place)].max(0.0).sqrt();
            let [east, north] = last.position(&alone);
            (id, east.hypot(north))
        })
        .collect();
    let without_noise = Growth { by_noise: SMatrix::zeros(), ..last.clone() };
    sources
        .push(("initial attitude".into(), Growth::radial(&without_noise.covariance(&none, start))));
    sources.push(("white noise".into(), Growth::radial(&last.by_noise)));
    sources.sort_by(|a, b| b.1.total_cmp(&a.1));
    sources
}

impl Radial {
    fn of(covariance: &SMatrix<f64, GROWTH_STATES, GROWTH_STATES>) -> Self {
        let position = Growth::of_position(covariance);
        let spread = position.symmetric_eigenvalues().map(|variance| variance.max(0.0).sqrt());
        let sigmas = [spread.max(), spread.min()];
        Self {
            rms: Growth::radial(covariance),
            half: probable_radius(sigmas, 0.5),
            most: probable_radius(sigmas, 0.95),
        }
    }
}
