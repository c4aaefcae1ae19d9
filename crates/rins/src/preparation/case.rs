//! An estimation problem: runs of one IMU, and the model to be estimated from them.

use std::collections::{BTreeMap, BTreeSet};

use rins_estimation::{NoiseKnowledge, NoiseParameters, Reference, Run};
use rins_frames::EARTH_RATE;
use rins_frames::units::DEG_PER_HOUR;
use rins_imu::ImuSpec;
use rins_io::{InputFile, shown};
use rins_report::number::figure;
use rins_terms::{Model, Role, TermInstance, catalogue};

use super::prepared::Prepared;
use crate::log::ensure_temperature;
use crate::options::{FULL, NamedModel, NoiseChoice};

/// An estimation problem: the runs, the model, and the prior knowledge.
pub(crate) struct EstimationProblem {
    /// The runs, in the order in which they were given.
    pub(crate) runs: Vec<Prepared>,
    /// The name of the model.
    pub(crate) name: String,
    /// The model, with the priors of these runs.
    pub(crate) model: Model,
    /// Whether the noise parameters are estimated or given.
    pub(crate) noise: NoiseChoice,
    /// Whether nobody asked for this model.
    pub(crate) is_default: bool,
    /// Further remarks for the report.
    pub(crate) remarks: Vec<String>,
    /// The file of the model, if it has one.
    pub(crate) model_file: Option<InputFile>,
}

impl EstimationProblem {
    /// Whether the model is the full one without a g-sensitivity, and an IMU was at rest in several attitudes.
    pub(crate) fn can_be_g_sensitive(&self) -> bool {
        let has = self.model.terms.iter().any(|own| own.term.is(&catalogue::GYRO_G_SENSITIVITY));
        let is_turned_over = |log: usize| {
            self.runs[log].run.rig.reference == Reference::Rest && self.shares_turn_on(log)
        };
        self.name == FULL && !has && (0..self.runs.len()).any(is_turned_over)
    }

    /// Whether a log has several static intervals, or its turn-on biases are those of another log too.
    pub(crate) fn shares_turn_on(&self, log: usize) -> bool {
        let is_shared = |(other, _): (usize, &Prepared)| {
            other != log && self.first_of(other) == self.first_of(log)
        };
        !self.runs[log].others.is_empty() || self.runs.iter().enumerate().any(is_shared)
    }

    /// The first log that was recorded in the power-on of a log.
    fn first_of(&self, log: usize) -> usize {
        let series = |run: &Prepared| run.loaded.rig.run.series.clone();
        let same =
            |other: &Prepared| series(other).is_some() && series(other) == series(&self.runs[log]);
        self.runs.iter().position(same).unwrap_or(log)
    }

    /// The model with the g-sensitivity of the gyros.
    pub(crate) fn with_g_sensitivity(&self) -> Model {
        self.model.clone().with(TermInstance::new(&catalogue::GYRO_G_SENSITIVITY).estimated())
    }

    /// Adds the g-sensitivity of the gyros to the model.
    pub(crate) fn add_g_sensitivity(&mut self) {
        let term = &catalogue::GYRO_G_SENSITIVITY;
        self.model = self.with_g_sensitivity();
        self.name = format!("{FULL} with {}", term.id);
        self.remarks.push(format!(
            "The gyro biases differ between the attitudes by more than noise and bias instability explain: {} is estimated too.",
            term.id
        ));
    }

    /// The estimation problem of a model and runs, which must be of one IMU.
    pub(crate) fn of(
        runs: Vec<Prepared>,
        named: NamedModel,
        noise: NoiseChoice,
    ) -> anyhow::Result<Self> {
        let mut remarks: Vec<String> = match &runs[..] {
            [only] => only.remarks.clone(),
            several => several
                .iter()
                .flat_map(|run| run.remarks.iter().map(|told| format!("{}: {told}", run.name)))
                .collect(),
        };
        remarks.extend(counted_twice(&runs, &named));
        remarks.extend(series_in_words(&runs));
        let spins: BTreeSet<String> =
            runs.iter().map(|run| run.loaded.rig.spin.spin_name()).collect();
        if spins.len() > 1 {
            let spins: Vec<String> = spins.into_iter().collect();
            remarks.push(format!(
                "The runs have different spin axes ({}): sensor errors are estimated along the sensors' own axes from all runs \
                 together.",
                spins.join(", ")
            ));
        }
        let preset = named.name == FULL;
        let model = on_these_runs(named.model, &runs, preset, &mut remarks);
        let case = Self {
            runs,
            name: named.name,
            model,
            noise,
            is_default: false,
            remarks,
            model_file: named.file,
        };
        case.runs.iter().try_for_each(|run| case.ensure_same_imu(run))?;
        let has_temperature = |run: &Prepared| {
            ensure_temperature(&run.name, "the model", &case.model, &run.run.recording)
        };
        case.runs.iter().try_for_each(has_temperature)?;
        Ok(case)
    }

    /// Refuses a run of another IMU.
    pub(crate) fn ensure_same_imu(&self, other: &Prepared) -> anyhow::Result<()> {
        anyhow::ensure!(
            other.imu == *self.imu(),
            "{} and {} have different data sheets: several runs must be of one IMU",
            self.runs[0].name,
            other.name
        );
        Ok(())
    }

    /// The data sheet.
    pub(crate) fn imu(&self) -> &ImuSpec {
        &self.runs[0].imu
    }

    /// The runs in the order of the estimator: one of each log, then the other static intervals of the first log, of the second,
    /// and so on.
    pub(crate) fn given(&self) -> Vec<Run> {
        let of_log = |(log, _): (usize, &Prepared), run: &Run| {
            if self.shares_turn_on(log) {
                run.clone().since(self.first_of(log))
            } else {
                run.clone()
            }
        };
        let logs = || self.runs.iter().enumerate();
        let first = logs().map(|log| of_log(log, &log.1.run));
        let others = logs().flat_map(|log| log.1.others.iter().map(move |run| of_log(log, run)));
        first.chain(others).collect()
    }

    /// For each log, the indices of its runs in the list of [`given`](Self::given), in the order of time.
    pub(crate) fn given_of_logs(&self) -> Vec<Vec<usize>> {
        let mut next = self.runs.len();
        let of_log = |(log, prepared): (usize, &Prepared)| {
            let mut places = vec![log];
            places.extend(next..next + prepared.others.len());
            next += prepared.others.len();
            let starts: Vec<f64> = prepared.rests().map(|run| run.recording.times[0]).collect();
            let mut order: Vec<usize> = (0..places.len()).collect();
            order.sort_by(|&a, &b| starts[a].total_cmp(&starts[b]));
            order.into_iter().map(|rest| places[rest]).collect()
        };
        self.runs.iter().enumerate().map(of_log).collect()
    }

    /// The prior knowledge of the noise: the data sheet's noise parameters, with those of the model.
    pub(crate) fn knowledge(&self) -> NoiseKnowledge {
        let sheet = NoiseParameters::of(self.imu()).with(&self.model);
        match self.noise {
            NoiseChoice::Likely => NoiseKnowledge::Likely(sheet),
            NoiseChoice::Given => NoiseKnowledge::Given(sheet),
        }
    }

    /// The names of the runs, separated by commas.
    pub(crate) fn names(&self) -> String {
        self.runs.iter().map(|run| run.name.as_str()).collect::<Vec<_>>().join(", ")
    }
}

/// Which logs the priors of the model come from already.
fn counted_twice(runs: &[Prepared], named: &NamedModel) -> Option<String> {
    let is_known = |run: &&Prepared| {
        let log = shown(&run.loaded.rig.log.path);
        let mut inputs = run.basis.provenance.inputs.iter();
        inputs.any(|input| input.path == log && named.digests.contains(&input.sha256))
    };
    let known: Vec<&str> = runs.iter().filter(is_known).map(|run| run.name.as_str()).collect();
    (!known.is_empty()).then(|| {
        format!(
            "The values and sigmas of {} are estimates from {} already: these data count twice, and the sigmas are too small. Use the \
             calibration file that was written with the model, or another run.",
            named.name,
            known.join(", ")
        )
    })
}

/// Which logs have the same turn-on biases, as the rig files state it.
fn series_in_words(runs: &[Prepared]) -> Option<String> {
    if runs.len() < 2 {
        return None;
    }
    let mut series: BTreeMap<&str, Vec<&str>> = BTreeMap::new();
    for run in runs {
        if let Some(name) = &run.loaded.rig.run.series {
            series.entry(name).or_default().push(&run.name);
        }
    }
    if series.is_empty() {
        return Some(
            "Each log has turn-on biases of its own. Logs between which the IMU was not switched off have the same ones: state \
             one `[run] series = \"...\"` in their rig files."
                .into(),
        );
    }
    let several = series.into_iter().filter(|(_, logs)| logs.len() > 1);
    let told: Vec<String> = several
        .map(|(name, logs)| {
            format!(
                "The logs of the series {name:?} have the same turn-on biases: {}.",
                logs.join(", ")
            )
        })
        .collect();
    (!told.is_empty()).then(|| told.join(" "))
}

/// The model with the error of the Earth's horizontal rate, if the azimuth of a run is unknown.
fn with_azimuth(
    mut model: Model,
    runs: &[Prepared],
    preset: bool,
    remarks: &mut Vec<String>,
) -> Model {
    let rate = |run: &Prepared| EARTH_RATE * run.loaded.station.site.latitude.cos();
    let of_run =
        |run: &Prepared| Some(run.attitude.horizontal_rate()?.map(|part| part * rate(run)));
    let sigmas: Vec<[f64; 2]> = runs.iter().filter_map(of_run).collect();
    // All runs share one prior, the widest.
    let Some([north, east]) = sigmas.into_iter().reduce(|a, b| [a[0].max(b[0]), a[1].max(b[1])])
    else {
        return model;
    };
    let azimuth = &catalogue::AXIS_AZIMUTH;
    if preset && !model.terms.iter().any(|chosen| chosen.term.is(azimuth)) {
        model = model.with(TermInstance::new(azimuth).estimated());
        remarks.push(format!(
            "The azimuth of the axis is not known: the error of the horizontal Earth rate at the assumed azimuth is estimated \
             too ({}; a priori 0 ± {} deg/h north, 0 ± {} deg/h east).",
            azimuth.id,
            figure(north / DEG_PER_HOUR, 2),
            figure(east / DEG_PER_HOUR, 2)
        ));
    }
    let chosen = model.terms.iter_mut().filter(|chosen| chosen.term.is(azimuth));
    let roles = chosen.flat_map(|chosen| chosen.roles.iter_mut().zip([north, east]));
    for (role, sigma) in roles.filter(|(role, _)| **role == Role::Free) {
        *role = Role::Within(sigma);
    }
    model
}

/// The model with the priors of these runs: the attitudes of their axes and, if gravity is the angle reference, a
/// lever arm.
fn on_these_runs(
    mut model: Model,
    runs: &[Prepared],
    preset: bool,
    remarks: &mut Vec<String>,
) -> Model {
    let by_gravity = runs.iter().any(|run| run.run.rig.reference == Reference::Gravity);
    let arm = &catalogue::ACCEL_LEVER_ARM;
    if by_gravity && preset && !model.terms.iter().any(|chosen| chosen.term.is(arm)) {
        model = model.with(TermInstance::new(arm).estimated());
        remarks.push(
            "The accelerometers' lever arm is estimated too: without it the rotation of gravity would not show the angle."
                .into(),
        );
    }
    let mut model = with_azimuth(model, runs, preset, remarks);
    let chosen = model.terms.iter_mut().filter(|chosen| chosen.term.is(&catalogue::AXIS_ATTITUDE));
    for (axis, role) in chosen.flat_map(|chosen| chosen.roles.iter_mut().enumerate()) {
        if *role != Role::Free {
            continue;
        }
        // All runs share one prior, the widest.
        let sigmas = runs.iter().map(|run| run.attitude.sigma[axis]);
        *role = sigmas
            .collect::<Option<Vec<f64>>>()
            .map_or(Role::Held, |all| Role::Within(all.into_iter().fold(0.0, f64::max)));
    }
    model
}
