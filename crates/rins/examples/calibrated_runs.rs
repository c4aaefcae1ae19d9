//! Whether a schedule calibrates as well as it is predicted to: runs are simulated with sensor errors that are drawn from the data sheet,
//! and calibrated together.
//!
//! ```sh
//! cargo run --release -p rins --example calibrated_runs -- RUNS SCENARIO...
//! ```
//!
//! For each parameter of the IMU, the predicted standard deviation, the root mean square of the errors of the calibrations, and their
//! ratio; at the end the same of the position error after 24 h of a system that turns back and forth at the fastest rate: linearly after an
//! alignment, and navigated by strapdown from an exact start with what each calibration leaves of the errors.

use std::path::Path;

use nalgebra::{DMatrix, DVector};
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;
use rayon::prelude::*;
use rins::estimation::{
    Fit, Joint, NoiseKnowledge, NoiseParameters, Reference, Rig, Run, fit, joint,
};
use rins::frames::{Dcm, SignedAxes};
use rins::imu::{ImuSpec, NoiseModel, Seed};
use rins::io::ScenarioFile;
use rins::motion::{CarriedTable, Carrier, Segment};
use rins::simulation::{Scenario, simulate};
use rins::terms::{FreeParameter, Model, Owner, Surroundings};
use rins_design::{Draw, Service, Voyage};

/// The time in service \[s\].
const DAY: f64 = 86_400.0;

/// The interval of its navigation \[s\].
const INTERVAL: f64 = 0.1;

const USAGE: &str = "usage: calibrated_runs RUNS SCENARIO...";

/// The scenarios of one schedule.
struct Schedule {
    scenarios: Vec<Scenario>,
    /// The axes of each run relative to the sensors' own.
    axes: Vec<SignedAxes>,
    imu: ImuSpec,
    encoder: f64,
    wobble: f64,
    model: Model,
    free: Vec<FreeParameter>,
}

impl Schedule {
    fn read(paths: &[String]) -> anyhow::Result<Self> {
        let files = paths
            .iter()
            .map(|path| Ok(ScenarioFile::read(Path::new(path))?))
            .collect::<anyhow::Result<Vec<ScenarioFile>>>()?;
        let first = simulate(&files[0].scenario)?.recording;
        let rig = rins::io::Rig::parse(&files[0].rig_toml(&first), Path::new(&paths[0]))?;
        let imu = *rig.require_imu()?;
        let encoder = rig.log.table_angle().and_then(|angle| angle.noise);
        let encoder =
            encoder.ok_or_else(|| anyhow::anyhow!("the scenario has no encoder noise"))?;
        let wobble = rig.table.as_ref().and_then(|table| table.wobble).unwrap_or(encoder);
        let model = Model::full();
        let free = model.free(&imu);
        let axes = files.iter().map(|file| SignedAxes::from(file.spin)).collect();
        let scenarios = files.into_iter().map(|file| file.scenario).collect();
        Ok(Self { scenarios, axes, imu, encoder, wobble, model, free })
    }

    /// The runs, with the attitudes of their axes known but for an error.
    fn runs(&self, scenarios: &[Scenario]) -> anyhow::Result<Vec<Run>> {
        let all = scenarios.iter().zip(&self.scenarios).zip(&self.axes);
        all.map(|((scenario, nominal), &axes)| {
            let rig = Rig {
                station: nominal.station,
                nav_from_table: nominal.nav_from_table,
                reference: Reference::Encoder { noise: self.encoder },
                wobble: self.wobble,
                velocity: 1e-6,
            };
            Ok(Run::new(rig, simulate(scenario)?.recording)?.with_axes(axes).since(0))
        })
        .collect()
    }

    fn predicted(&self) -> anyhow::Result<Joint> {
        let plain: Vec<Scenario> =
            self.scenarios.iter().map(|scenario| scenario.clone().without_errors()).collect();
        let noise = NoiseParameters::of(&self.imu);
        Ok(joint(&self.runs(&plain)?, &self.model, &self.imu, &noise)?)
    }

    /// The errors of one calibration, in the order of the parameters of the IMU.
    fn calibrated(&self, seed: u64) -> anyhow::Result<Vec<f64>> {
        let mut random = Pcg64::seed_from_u64(seed);
        let mut draw = || -> f64 { StandardNormal.sample(&mut random) };
        let mut effects = Model::sensors();
        let mut truth = Vec::new();
        for free in self.of_imu() {
            let value = free.sigma * draw();
            effects.terms[free.term].values[free.parameter] = value;
            truth.push(value);
        }
        let mut scenarios = self.scenarios.clone();
        for (place, scenario) in scenarios.iter_mut().enumerate() {
            let sigma = |free: &FreeParameter| free.sigma * draw();
            let own: Vec<f64> = self.free.iter().filter(|f| !is_of_imu(f)).map(sigma).collect();
            let off = nalgebra::Vector3::from_column_slice(&own);
            scenario.nav_from_table = scenario.nav_from_table * Dcm::from_rotation_vector(&off);
            scenario.effects = effects.carried(&self.axes[place]);
            scenario.seed = Seed::new(1000 * seed + place as u64);
        }
        let runs = self.runs(&scenarios)?;
        let knowledge = NoiseKnowledge::Given(NoiseParameters::of(&self.imu));
        // The model is along the axes of the first run: no term of it has a setting or a value, so that it is the same along all axes.
        let found: Fit = fit(&runs, &self.model, &self.imu, knowledge, |_| {})?;
        let found = found.along(SignedAxes::IDENTITY);
        let value = |free: &&FreeParameter| {
            found.parameters.iter().find(|one| one.parameter.id == free.id).map(|one| one.value)
        };
        let values: Option<Vec<f64>> = self.of_imu().map(|free| value(&free)).collect();
        let values = values.ok_or_else(|| anyhow::anyhow!("a parameter was not estimated"))?;
        Ok(values.iter().zip(truth).map(|(value, truth)| value - truth).collect())
    }

    fn of_imu(&self) -> impl Iterator<Item = &FreeParameter> {
        self.free.iter().filter(|free| is_of_imu(free))
    }

    /// A turn at the fastest rate of the schedule, and back.
    fn there_and_back(&self) -> [Segment; 2] {
        let profile = &self.scenarios[0].profile;
        let turn = |rate: f64| Segment { rate, duration: std::f64::consts::TAU / rate.abs() };
        let steps = (0..1000).map(|step| profile.duration() * f64::from(step) / 1000.0);
        let fastest = steps.map(|time| profile.rate(time).abs()).fold(0.0, f64::max);
        [turn(fastest), turn(-fastest)]
    }

    fn places(&self) -> Vec<(usize, usize)> {
        self.of_imu().map(|free| (free.term, free.parameter)).collect()
    }

    /// The position error after 24 h (2 × n).
    fn position(&self) -> anyhow::Result<DMatrix<f64>> {
        let scenario = &self.scenarios[0];
        let places = self.places();
        let service = Service {
            surroundings: Surroundings::new(scenario.station, scenario.nav_from_table),
            cycle: &self.there_and_back(),
            model: &self.model,
            parameters: &places,
            noise: [0.0; 2],
        };
        let position = service.position_after_alignment(DAY)?;
        Ok(DMatrix::from_fn(2, places.len(), |row, column| position[(row, column)]))
    }

    /// The root mean square of the radial position error \[m\] after 24 h of strapdown navigation with these errors of the sensors, and of the
    /// linear model for errors of this covariance.
    fn navigated(
        &self,
        errors: &[Vec<f64>],
        covariance: &DMatrix<f64>,
    ) -> anyhow::Result<[f64; 2]> {
        let scenario = &self.scenarios[0];
        let place = (scenario.station, scenario.nav_from_table);
        let table = CarriedTable::new(place, Carrier::at_rest(), &self.there_and_back(), false)?;
        let places = self.places();
        let silent = NoiseModel::default();
        let voyage =
            Voyage { table: &table, model: &self.model, parameters: &places, noise: [&silent; 2] };
        let draws: Vec<Draw> = errors
            .iter()
            .map(|errors| Draw {
                errors: errors.clone(),
                attitude: nalgebra::Vector3::zeros(),
                seed: Seed::new(1),
            })
            .collect();
        let portion = draws.len().div_ceil(rayon::current_num_threads());
        let found = draws
            .par_chunks(portion)
            .map(|draws| voyage.simulated(draws, INTERVAL, &[DAY], &|_| {}))
            .collect::<Result<Vec<_>, _>>()?;
        let squares = found.iter().flatten().map(|draw| draw[0][0].powi(2) + draw[0][1].powi(2));
        let seen = (squares.sum::<f64>() / draws.len() as f64).sqrt();
        let growth = voyage.growth(&[DAY])?;
        let of_states = growth[0].covariance(covariance, &nalgebra::SMatrix::zeros());
        Ok([seen, rins_design::Growth::radial(&of_states)])
    }
}

fn is_of_imu(free: &FreeParameter) -> bool {
    free.owner != Owner::Placement
}

fn main() -> anyhow::Result<()> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let [runs, paths @ ..] = &arguments[..] else { anyhow::bail!(USAGE) };
    anyhow::ensure!(!paths.is_empty(), USAGE);
    let runs: u64 = runs.parse()?;
    let schedule = Schedule::read(paths)?;
    let joint = schedule.predicted()?;
    let sigmas = DVector::from_iterator(
        joint.unknowns.len(),
        joint.unknowns.iter().map(|unknown| unknown.sigma),
    );
    let mut information = joint.evidence.information.clone();
    for (place, sigma) in sigmas.iter().enumerate() {
        information[(place, place)] += sigma.powi(-2);
    }
    let scaled = information.component_mul(&(&sigmas * sigmas.transpose()));
    let covariance = scaled.try_inverse().ok_or_else(|| anyhow::anyhow!("singular"))?;
    let covariance = covariance.component_mul(&(&sigmas * sigmas.transpose()));
    let place = |free: &FreeParameter| joint.unknowns.iter().position(|one| one.id == free.id);
    let places: Option<Vec<usize>> = schedule.of_imu().map(place).collect();
    let places = places.ok_or_else(|| anyhow::anyhow!("a parameter is not predicted"))?;
    let covariance = covariance.select_rows(&places).select_columns(&places);
    let errors = (1..=runs)
        .into_par_iter()
        .map(|seed| schedule.calibrated(seed))
        .collect::<anyhow::Result<Vec<Vec<f64>>>>()?;
    let position = schedule.position()?;
    let rms = |of: &dyn Fn(&[f64]) -> f64| -> f64 {
        (errors.iter().map(|errors| of(errors)).sum::<f64>() / errors.len() as f64).sqrt()
    };
    let mut lines = Vec::new();
    for (column, free) in schedule.of_imu().enumerate() {
        let predicted = covariance[(column, column)].sqrt() / free.unit.factor;
        let seen = rms(&|errors: &[f64]| errors[column].powi(2)) / free.unit.factor;
        let (id, unit) = (&free.id, free.unit.symbol);
        lines.push(format!(
            "{id:22} {unit:8} {predicted:12.6} {seen:12.6} {:8.4}",
            seen / predicted
        ));
    }
    let predicted = (&position * &covariance * position.transpose()).trace().sqrt() / 1852.0;
    let seen =
        rms(&|errors: &[f64]| (&position * DVector::from_column_slice(errors)).norm_squared())
            / 1852.0;
    lines.push(format!("position after 24 h [nmi] {predicted} {seen} {}", seen / predicted));
    // What is left after a compensation is the error of the estimate, with the opposite sign.
    let left: Vec<Vec<f64>> =
        errors.iter().map(|errors| errors.iter().map(|error| -error).collect()).collect();
    let [seen, predicted] = schedule.navigated(&left, &covariance)?.map(|rms| rms / 1852.0);
    lines.push(format!("navigated for 24 h [nmi] {predicted} {seen} {}", seen / predicted));
    let mut out = std::io::stdout().lock();
    for line in [format!("{runs} calibrations: parameter, unit, predicted, rms error, ratio")]
        .into_iter()
        .chain(lines)
    {
        std::io::Write::write_all(&mut out, (line + "\n").as_bytes())?;
    }
    Ok(())
}
