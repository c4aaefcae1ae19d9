//! The parameters of several runs, compared.

use rins_estimation::{Fit, Run, fit};
use rins_frames::SignedAxes;
use rins_history::{
    Cause, Conditions, Explanation, Forecast, History, Homogeneity, Quantity, RunEstimate,
};
use rins_imu::ImuSpec;
use rins_io::Measured;
use rins_terms::{Model, Owner};

use super::conditions::conditions;
use crate::log::measured;
use crate::preparation::{EstimationProblem, Prepared};
use crate::progress::Progress;

/// The family-wise significance level of the homogeneity test.
const SIGNIFICANT: f64 = 0.01;

/// The parameters of several runs, compared: whether they are the same, and how they vary.
#[derive(Clone, Debug)]
pub(crate) struct RunComparison {
    /// The names of the runs.
    pub(crate) names: Vec<String>,
    /// The unit of each parameter.
    pub(crate) units: Vec<&'static str>,
    /// The estimates of each run, in these units.
    pub(crate) history: History,
    /// The test of each parameter.
    pub(crate) homogeneity: Vec<Homogeneity>,
    /// How they vary.
    pub(crate) explanation: Explanation,
}

impl RunComparison {
    pub(crate) fn of(names: Vec<String>, units: Vec<&'static str>, history: History) -> Self {
        let (homogeneity, explanation) = (history.homogeneity(), history.explain());
        Self { names, units, history, homogeneity, explanation }
    }

    /// The sensor errors of the logs of an estimation problem, each log estimated by itself; `None` for one log, or if fewer than two can
    /// be estimated by themselves.
    pub(crate) fn of_logs(problem: &EstimationProblem, progress: &Progress) -> Option<Self> {
        if problem.runs.len() < 2 {
            return None;
        }
        let stage = progress.begin("comparing the runs", Some(problem.runs.len()));
        let (given, of_logs) = (problem.given(), problem.given_of_logs());
        let mut fits: Vec<(&Prepared, Fit)> = Vec::new();
        for (done, (prepared, places)) in problem.runs.iter().zip(&of_logs).enumerate() {
            stage.done(done);
            let own: Vec<_> = places.iter().map(|&place| given[place].clone()).collect();
            // A log that shows too little by itself says nothing of differences.
            fits.extend(by_itself(problem, &own, &problem.model).map(|fit| (prepared, fit)));
        }
        let quantities = quantities(fits.iter().map(|(_, fit)| fit), problem.imu());
        let conditions = conditions(&fits.iter().map(|(log, _)| of_log(log)).collect::<Vec<_>>());
        let runs = fits.iter().zip(conditions);
        let runs: Option<Vec<RunEstimate>> =
            runs.map(|((_, fit), at)| estimate(fit, &quantities, at)).collect();
        let names = fits.iter().map(|(log, _)| log.name.clone()).collect();
        let (units, quantities) = quantities.into_iter().map(|(unit, of)| (unit.1, of)).unzip();
        Some(Self::of(names, units, History::new(quantities, runs?).ok()?))
    }

    /// The parameters that are not the same in all runs, and would not be if those that differ more were free.
    pub(crate) fn inhomogeneous(&self) -> impl Iterator<Item = &Homogeneity> {
        let among = self.homogeneity.len();
        self.homogeneity.iter().filter(move |one| is_significant(one, among))
    }

    /// The causes.
    pub(crate) fn causes(&self) -> &[Cause] {
        self.explanation.causes()
    }

    /// The forecast of a parameter for a run under these conditions, if the runs determine it.
    pub(super) fn forecast(&self, id: &str, conditions: Conditions) -> Option<Forecast> {
        let place = self.history.quantities().iter().position(|one| one.id == id)?;
        self.explanation.forecast(place, conditions).ok().flatten()
    }

    /// The unit of a parameter.
    pub(crate) fn unit(&self, id: &str) -> &'static str {
        let place = self.history.quantities().iter().position(|one| one.id == id);
        place.map_or("", |place| self.units[place])
    }
}

/// Whether the estimates of a parameter differ significantly, as one of so many, and would do so if those that differ more were free.
pub(super) fn is_significant(one: &Homogeneity, among: usize) -> bool {
    one.ln_p.max(one.ln_p_beside) < (SIGNIFICANT / among as f64).ln()
}

/// A model estimated from the runs of one log, along the sensors' own axes; `None` if the log shows too little for that.
pub(super) fn by_itself(problem: &EstimationProblem, runs: &[Run], model: &Model) -> Option<Fit> {
    let fit = fit(runs, model, problem.imu(), problem.knowledge(), |_| ()).ok()?;
    Some(fit.along(SignedAxes::IDENTITY))
}

/// When and how a log was made.
pub(super) fn of_log(prepared: &Prepared) -> Measured {
    measured(&prepared.loaded.rig, prepared.rests().map(|run| &*run.recording))
}

/// The errors of the sensors that any of these fits estimates: the unit with its symbol, and the typical range of variations.
pub(super) fn quantities<'a>(
    fits: impl IntoIterator<Item = &'a Fit>,
    imu: &ImuSpec,
) -> Vec<((f64, &'static str), Quantity)> {
    let mut all: Vec<((f64, &'static str), Quantity)> = Vec::new();
    for fit in fits {
        for estimate in &fit.parameters {
            let of = &estimate.parameter;
            let is_known = all.iter().any(|(_, other)| other.id == of.id);
            let Some(here) = fit.in_run(estimate, 0).filter(|_| !is_known) else { continue };
            if of.owner == Owner::Sensor {
                let term = fit.models[0].terms[here.term].term;
                let (low, high) = term.parameters[here.parameter].range(imu);
                let unit = of.unit.factor;
                let typical = (low / unit, high / unit);
                let quantity = Quantity { id: of.id.clone(), typical };
                all.push(((unit, of.unit.symbol), quantity));
            }
        }
    }
    all
}

/// What the log of a fit says of the sensors' errors, all else integrated out; `None` if that is not finite.
pub(super) fn estimate(
    fit: &Fit,
    quantities: &[((f64, &'static str), Quantity)],
    conditions: Conditions,
) -> Option<RunEstimate> {
    let place = |id: &str| fit.parameters.iter().position(|one| one.parameter.id == id);
    let (own, kept): (Vec<usize>, Vec<usize>) = quantities
        .iter()
        .enumerate()
        .filter_map(|(at, (_, of))| Some((at, place(&of.id)?)))
        .unzip();
    let said = fit.marginal_evidence(&kept)?;
    let n = quantities.len();
    let mut estimate = RunEstimate {
        conditions,
        information: nalgebra::DMatrix::zeros(n, n),
        score: nalgebra::DVector::zeros(n),
    };
    for (a, &row) in own.iter().enumerate() {
        let unit = quantities[row].0.0;
        estimate.score[row] = unit * said.score[a];
        for (b, &column) in own.iter().enumerate() {
            let entry = said.information[(a, b)] * unit * quantities[column].0.0;
            estimate.information[(row, column)] = entry;
            // The score is about the estimate.
            let value = fit.parameters[kept[b]].value / quantities[column].0.0;
            estimate.score[row] += entry * value;
        }
    }
    Some(estimate)
}
