//! What a calibration found, and all that follows from it.

use anyhow::Context;
use nalgebra::{DMatrix, SVector};
use rins_calibration::{Consistency, FreeNavigation, MEASUREMENTS, navigate_freely};
use rins_estimation::{Fit, Identifiability, NoiseKnowledge, Reference, Run, Strengths, fit};
use rins_frames::{Dcm, Nav, Table};
use rins_io::ModelFile;
use rins_motion::Recording;
use rins_terms::{Chosen, Model, Role, Surroundings, catalogue, compensated};

use crate::args::NoiseChoice;
use crate::commands::calibrate::budget::{Asked, Budget, Truth};
use crate::commands::calibrate::{NamedModel, Prepared, files, json};
use crate::outcome::Outcome;
use crate::progress;
use crate::view::{certificate_report, certificate_text};

/// A mean NIS above this is no matter of a sensor error more or less.
const ABSURD_NIS: f64 = 100.0;

/// The estimates from one run or several, and what they are worth.
pub(crate) struct Certificate {
    /// What the model is called.
    pub(crate) model: String,
    /// The runs, in the order in which they were given.
    pub(crate) runs: Vec<CertifiedRun>,
    /// The estimates.
    pub(crate) fit: Fit,
    /// What the data tell of each.
    pub(crate) told: Identifiability,
    /// Whether the innovations of all runs are what the model says.
    pub(crate) consistency: Consistency,
    /// Whether the noise was found, or given.
    pub(crate) noise: NoiseChoice,
    /// What else a reader must know.
    pub(crate) remarks: Vec<String>,
}

/// A run with what the estimates make of it.
pub(crate) struct CertifiedRun {
    pub(crate) prepared: Prepared,
    /// The attitude of its axis, as estimated.
    pub(crate) nav_from_table: Dcm<Nav, Table>,
    /// The whitened innovations, one an epoch, and when each ends \[s\].
    pub(crate) innovations: Vec<SVector<f64, MEASUREMENTS>>,
    pub(crate) times: Vec<f64>,
    pub(crate) consistency: Consistency,
    /// Free navigation as recorded.
    pub(crate) before: FreeNavigation,
    /// The same with all that was estimated undone.
    pub(crate) after: FreeNavigation,
    /// What each parameter of this run and of the IMU is worth.
    pub(crate) budget: Budget,
    /// The place of each of these among all parameters.
    pub(crate) places: Vec<usize>,
}

impl Certificate {
    /// Estimates a model from runs of one IMU.
    pub(crate) fn of(
        runs: Vec<Prepared>,
        named: NamedModel,
        noise: NoiseChoice,
    ) -> anyhow::Result<Self> {
        let imu = runs[0].imu;
        if let Some(other) = runs.iter().find(|run| run.imu != imu) {
            anyhow::bail!(
                "{} and {} have different data sheets: several runs must be of one IMU",
                runs[0].name,
                other.name
            );
        }
        let mut remarks: Vec<String> = match &runs[..] {
            [only] => only.remarks.clone(),
            several => several
                .iter()
                .flat_map(|run| run.remarks.iter().map(|told| format!("{}: {told}", run.name)))
                .collect(),
        };
        let preset = named.name == "full";
        let model = on_these_runs(named.model, &runs, preset, &mut remarks);
        let spinner = progress::spinner("calibrating");
        let given: Vec<Run> = runs.iter().map(|run| run.run.clone()).collect();
        let sheet = Strengths::of(&imu);
        let knowledge = match noise {
            NoiseChoice::Likely => NoiseKnowledge::Likely(sheet),
            NoiseChoice::Given => NoiseKnowledge::Given(sheet),
        };
        let found = fit(&given, &model, &imu, knowledge, |iteration| {
            spinner.set_message(format!("calibrating, last step {:.3} sigma", iteration.step));
        });
        spinner.finish_and_clear();
        let names: Vec<&str> = runs.iter().map(|run| run.name.as_str()).collect();
        let fit = found.with_context(|| names.join(", "))?;
        let told = fit.identifiability();
        let mut certified = Vec::with_capacity(runs.len());
        for (place, prepared) in runs.into_iter().enumerate() {
            certified.push(CertifiedRun::of(prepared, &fit, place)?);
        }
        let innovations: Vec<_> =
            certified.iter().flat_map(|run| run.innovations.iter().copied()).collect();
        let consistency = Consistency::of(&innovations).context("too few epochs")?;
        let model = named.name;
        Ok(Self { model, runs: certified, fit, told, consistency, noise, remarks })
    }

    /// What the command delivers.
    pub(crate) fn outcome(&self) -> Outcome {
        let several = self.runs.len() > 1;
        let mut delivered = vec![(
            "model.toml".into(),
            ModelFile::of(files::model(&self.fit)).to_toml().into_bytes(),
        )];
        for run in 0..self.runs.len() {
            let name = match (several, run) {
                (true, 1..) => format!("calibration-{}.toml", run + 1),
                _ => "calibration.toml".into(),
            };
            let file = files::calibration(&self.fit, &self.told, run);
            delivered.push((name, file.to_toml().into_bytes()));
        }
        Outcome {
            json: json::certificate(self),
            text: certificate_text(self),
            failure: self.absurd(),
            report: Some(certificate_report(self)),
            files: delivered,
            ..Outcome::default()
        }
    }

    /// The value and the 1σ of what the data tell of a parameter: of itself, or of the sum that it is in, in SI units.
    pub(crate) fn value(&self, place: usize) -> (f64, f64) {
        self.fit.sum(place, &self.told.seen[place].aliases)
    }

    /// What the calibration is called.
    pub(crate) fn title(&self) -> String {
        let names: Vec<&str> = self.runs.iter().map(|run| run.prepared.name.as_str()).collect();
        format!("Calibration of {}", names.join(", "))
    }

    /// Why estimates mean nothing, if the innovations are beyond what any sensor error explains.
    fn absurd(&self) -> Option<String> {
        let nis = self.consistency.nis_mean;
        (nis > ABSURD_NIS).then(|| {
            format!(
                "the innovations are {:.0} times larger than the noise that was found allows: units, axes, signs, \
                 attitude or table profile are wrong, and so are the estimates",
                (nis / self.consistency.nis_dof as f64).sqrt()
            )
        })
    }
}

/// The model with what is known of these runs: how their axes stand, and where gravity is the angle
/// reference, a lever arm.
fn on_these_runs(
    mut model: Model,
    runs: &[Prepared],
    preset: bool,
    remarks: &mut Vec<String>,
) -> Model {
    let by_gravity = runs.iter().any(|run| run.run.rig.reference == Reference::Gravity);
    let arm = &catalogue::ACCEL_LEVER_ARM;
    if by_gravity && preset && !model.terms.iter().any(|chosen| chosen.term.id == arm.id) {
        model = model.with(Chosen::new(arm).estimated());
        remarks.push(
            "The accelerometers' lever arm is estimated too: without it gravity's turning would not tell the angle."
                .into(),
        );
    }
    let chosen = model.terms.iter_mut().filter(|chosen| chosen.term.id == "axis.attitude");
    for (axis, role) in chosen.flat_map(|chosen| chosen.roles.iter_mut().enumerate()) {
        if *role != Role::Free {
            continue;
        }
        // One prior for all runs: the widest.
        let sigmas = runs.iter().map(|run| run.attitude.sigma[axis]);
        *role = sigmas
            .collect::<Option<Vec<f64>>>()
            .map_or(Role::Held, |all| Role::Within(all.into_iter().fold(0.0, f64::max)));
    }
    model
}

impl CertifiedRun {
    fn of(prepared: Prepared, fit: &Fit, run: usize) -> anyhow::Result<Self> {
        let station = &prepared.loaded.station;
        let model = &fit.models[run];
        let nav_from_table = prepared.run.rig.nav_from_table * attitude_of(model);
        let recorded = &prepared.run.recording;
        let around = Surroundings::new(*station, nav_from_table);
        let undone = compensated(model, around, recorded)
            .with_context(|| format!("{}: what was estimated cannot be undone", prepared.name))?;
        let track = fit.linear[run].track();
        let navigate = |recording: &Recording| {
            navigate_freely(recording, track.angles(), nav_from_table, station, None)
        };
        let (before, after) = (navigate(recorded), navigate(&undone));
        let innovations = fit.innovations(run);
        let consistency = Consistency::of(&innovations).context("too few epochs")?;
        let of_run = |place: &usize| fit.parameters[*place].run.is_none_or(|of| of == run);
        let places: Vec<usize> = (0..fit.parameters.len()).filter(of_run).collect();
        let asked: Vec<Asked<'_>> = places
            .iter()
            .map(|&place| {
                let estimate = &fit.parameters[place];
                Asked {
                    chosen: &model.terms[estimate.parameter.term],
                    parameter: estimate.parameter.parameter,
                    value: estimate.value,
                    sigma: estimate.sigma,
                }
            })
            .collect();
        let covariance = DMatrix::from_fn(places.len(), places.len(), |row, column| {
            fit.covariance[(places[row], places[column])]
        });
        let truth = Truth { station, nav_from_table, recording: &undone, track };
        let budget = Budget::of(&truth, &asked, &covariance);
        let times = fit.linear[run].ends(&recorded.times);
        Ok(Self {
            prepared,
            nav_from_table,
            innovations,
            times,
            consistency,
            before,
            after,
            budget,
            places,
        })
    }
}

/// The rotation by which a model says that the axis frame differs from the survey.
fn attitude_of(model: &Model) -> Dcm<Table, Table> {
    let axes = ["x", "y", "z"].map(|axis| model.value(&format!("axis.attitude.{axis}")));
    Dcm::from_rotation_vector(&axes.map(Option::unwrap_or_default).into())
}
