//! The scenarios of a campaign of a model: prepared once, simulated and estimated in each run.

use std::sync::Arc;

use anyhow::Context;
use rins_campaign::{Chunk, RunFailure};
use rins_estimation::{Reference, fit};
use rins_imu::Seed;
use rins_io::{JournalRun, Loaded, Rig, ScenarioFile};
use rins_motion::Recording;
use rins_simulation::{Scenario, simulate};
use rins_terms::FreeParameter;

use super::run::{CampaignParameter, ModelRun, numbers, to_journal};
use super::truth::{TrueModel, drawn};
use crate::campaign::execution::Runs;
use crate::campaign::options::{MonteCarloOptions, TruthChoice};
use crate::log::Log;
use crate::options::{NamedModel, NoiseChoice};
use crate::preparation::{EstimationProblem, Prepared};

/// The largest number of parameters of a model.
const MOST_PARAMETERS: usize = 256;

/// The scenarios of a campaign of a model.
pub(in crate::campaign) struct ModelRuns {
    cells: Vec<ModelCell>,
}

/// A scenario of the grid.
struct ModelCell {
    estimation: Estimation,
    truth: TrueModel,
    source: TruthChoice,
    seed: Seed,
    /// The model with the priors of this scenario.
    model: rins_terms::Model,
    free: Vec<FreeParameter>,
    parameters: Arc<[CampaignParameter]>,
    /// Their units in SI units.
    factors: Vec<f64>,
}

/// The estimation of a recording, as by `rins calibrate`.
struct Estimation {
    name: String,
    rig: Rig,
    named: NamedModel,
    noise: NoiseChoice,
}

impl Estimation {
    /// The estimation problem of a simulated log.
    fn problem(&self, recording: Recording) -> anyhow::Result<EstimationProblem> {
        let loaded = Loaded::of_recording(&self.rig, recording)?;
        let log = Log { name: self.name.clone(), loaded, inputs: Vec::new() };
        let prepared = Prepared::of(log, self.noise)?;
        EstimationProblem::of(vec![prepared], self.named.clone(), self.noise)
    }
}

impl ModelRuns {
    /// Prepares the scenarios of a grid, each with its place in a message.
    pub(in crate::campaign) fn of<'f>(
        files: impl Iterator<Item = (&'f ScenarioFile, String)>,
        named: &NamedModel,
        seed: u64,
        options: &MonteCarloOptions,
    ) -> anyhow::Result<Self> {
        let cells = files
            .map(|(file, place)| {
                ModelCell::of(file, named.clone(), seed, options).with_context(|| place)
            })
            .collect::<anyhow::Result<Vec<ModelCell>>>()?;
        let ids = |cell: &ModelCell| -> Vec<String> {
            cell.parameters.iter().map(|one| one.id.clone()).collect()
        };
        anyhow::ensure!(
            cells.iter().all(|cell| ids(cell) == ids(&cells[0])),
            "the scenarios of the grid have different parameters of the model {}; make a campaign of each",
            named.name
        );
        Ok(Self { cells })
    }

    /// The number of estimated parameters.
    pub(in crate::campaign) fn parameters(&self) -> usize {
        self.cells[0].parameters.len()
    }
}

impl ModelCell {
    /// Prepares a scenario: simulates and prepares its first run, but estimates nothing.
    fn of(
        file: &ScenarioFile,
        named: NamedModel,
        seed: u64,
        options: &MonteCarloOptions,
    ) -> anyhow::Result<Self> {
        let seed = Seed::new(seed);
        let scenario = Scenario { seed, ..file.scenario.clone() };
        let first = simulate(&scenario)?.recording;
        let rig = Rig::parse(&file.rig_toml(&first), &file.path)?;
        let given = rig.attitude.with_context(
            || "a campaign of a model needs the prior of the axis: state [attitude] with its sigma",
        )?;
        anyhow::ensure!(
            first.table_angle.is_some() || first.table_rate.is_some(),
            "a campaign of a model needs a table reading: state table_angle or table_rate in [log]"
        );
        let name = rins_io::shown(&file.path);
        let model_name = named.name.clone();
        let estimation = Estimation { name, rig, named, noise: options.noise };
        let of_model = || format!("the model {model_name}");
        let problem = estimation.problem(first).with_context(of_model)?;
        debug_assert!(!matches!(
            problem.runs[0].run.rig.reference,
            Reference::Gravity | Reference::Rest
        ));
        let model = problem.model.clone();
        let free = model.free(problem.imu());
        anyhow::ensure!(
            (1..=MOST_PARAMETERS).contains(&free.len()),
            "the model {model_name} estimates {} parameters; 1 to {MOST_PARAMETERS} are possible",
            free.len()
        );
        let truth = TrueModel::new(&scenario, &given.angles.dcm(), &model, &free);
        let parameters = free
            .iter()
            .map(|one| CampaignParameter {
                id: one.id.clone(),
                unit: one.unit.symbol.into(),
                prior_sigma: one.sigma / one.unit.factor,
            })
            .collect();
        let factors = free.iter().map(|one| one.unit.factor).collect();
        let cell = Self {
            estimation,
            truth,
            source: options.truth,
            seed,
            model,
            free,
            parameters,
            factors,
        };
        // A model with an effect that this run does not have is refused here, before any run.
        simulate(&cell.scenario(0).1).with_context(of_model)?;
        Ok(cell)
    }

    /// The true values of a run \[SI\], and its scenario.
    fn scenario(&self, run: u64) -> (Vec<f64>, Scenario) {
        let truth = self.true_values(run);
        let scenario = self.truth.with(&truth, Seed { run, ..self.seed });
        (truth, scenario)
    }

    /// The true values of a run \[SI\].
    fn true_values(&self, run: u64) -> Vec<f64> {
        match self.source {
            TruthChoice::Prior => drawn(&self.model, &self.free, Seed { run, ..self.seed }),
            TruthChoice::Scenario => self.truth.stated(),
        }
    }

    /// The numbers of a run, simulated and estimated.
    fn run(&self, run: u64) -> JournalRun {
        self.estimated(run).map_err(|error| RunFailure { reason: format!("{error:#}") })
    }

    fn estimated(&self, run: u64) -> anyhow::Result<Vec<f64>> {
        let (truth, scenario) = self.scenario(run);
        let recording = simulate(&scenario)?.recording;
        let problem = self.estimation.problem(recording)?;
        let found =
            fit(&problem.given(), &problem.model, problem.imu(), problem.knowledge(), |_| {})?;
        let estimated = found.parameters.iter().map(|one| &one.parameter.id);
        anyhow::ensure!(
            estimated.eq(self.parameters.iter().map(|one| &one.id)),
            "the run has other parameters than the first one"
        );
        to_journal(&found, &truth)
    }
}

impl Runs for ModelRuns {
    type Run = ModelRun;

    // A run takes from a tenth of a second to minutes.
    const CHUNK: u64 = 1;

    fn cells(&self) -> usize {
        self.cells.len()
    }

    fn numbers(&self) -> usize {
        numbers(self.parameters())
    }

    fn run(&self, chunk: &Chunk) -> Vec<JournalRun> {
        chunk.runs.clone().map(|run| self.cells[chunk.cell].run(run)).collect()
    }

    fn of_journal(&self, cell: usize, number: u64, numbers: JournalRun) -> ModelRun {
        let ModelCell { parameters, factors, .. } = &self.cells[cell];
        let truth = self.cells[cell].true_values(number);
        ModelRun::of_journal((cell, number), parameters, factors, &truth, numbers)
    }
}
