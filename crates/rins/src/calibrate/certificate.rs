//! What a calibration found, and all that follows from it.

use std::collections::BTreeMap;
use std::sync::Arc;

use anyhow::Context;
use nalgebra::{DMatrix, SVector};
use rins_calibration::{Consistency, FreeNavigation, MEASUREMENTS, navigate_freely};
use rins_design::{Budget, EstimatedParameter, Truth};
use rins_estimation::{
    Departure, Estimate, Fit, FitError, Identifiability, InRun, NoiseParameters, Quantity,
    Reference, Run, Unobservable, fit, fit_near,
};
use rins_frames::units::DEG;
use rins_frames::{Dcm, Nav, SignedAxes, Table};
use rins_io::InputFile;
use rins_motion::Recording;
use rins_terms::{
    Model, NotUndone, Owner, Role, Surroundings, TermInstance, catalogue, compensated,
};

use super::uncertainty::{Contribution, Moves, Uncertainty, by_reference, moves, weaken};
use crate::basis::BasisResult;
use crate::check::steady_rates;
use crate::homogeneity::RunComparison;
use crate::options::NoiseChoice;
use crate::preparation::{EstimationProblem, Prepared};
use crate::progress::Progress;

/// The gain of the log marginal likelihood for which an effect joins the model that no one asked for: odds of 150 to 1.
const LIKELIER: f64 = 5.0;

/// At most so many rates of a run are told one by one.
const MOST_RATES: usize = 7;

/// The estimates from one run or several, with their observability and error budget.
#[derive(Debug)]
pub(crate) struct Certificate {
    /// What the model is called.
    pub(crate) model: String,
    /// The runs, in the order in which they were given.
    pub(crate) runs: Vec<CertifiedRun>,
    /// The estimates, along the sensors' own axes.
    pub(crate) fit: Fit,
    /// What the data tell of each.
    pub(crate) identifiability: Identifiability,
    /// The parameters that keep the values that were expected of them.
    pub(crate) held: Vec<usize>,
    /// What the accuracy of the references adds to the uncertainty.
    pub(crate) contributions: Vec<Contribution>,
    /// The tolerances of the errors, by parameter, in the units of results.
    pub(crate) tolerances: BTreeMap<String, f64>,
    /// What was found, against the data sheet and what else was stated beforehand.
    pub(crate) departures: Vec<Departure>,
    /// Whether the innovations of all runs are what the model says.
    pub(crate) consistency: Consistency,
    /// Whether the noise was found, or given.
    pub(crate) noise: NoiseChoice,
    /// What else was found that the model is to hold, such as noise: what it adds to no signal.
    pub(crate) besides: Vec<TermInstance>,
    /// The parameters of the sensors in each log by itself, if there are several.
    pub(crate) comparison: Option<RunComparison>,
    /// What else a reader must know.
    pub(crate) remarks: Vec<String>,
    /// The file of the model, if it has one.
    pub(crate) model_file: Option<InputFile>,
}

/// A run with what the estimates make of it.
#[derive(Debug)]
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
    /// The error budget of the first run.
    pub(crate) budget: Budget,
    /// The place of each of these among all parameters.
    pub(crate) places: Vec<usize>,
    /// How it moved, in words.
    pub(crate) motion: String,
}

impl Certificate {
    /// Estimates the model of a case from its runs.
    ///
    /// Gyro biases of a g-sensitive MEMS differ between static intervals in different attitudes. If the g-sensitivity makes the
    /// data more likely by [`LIKELIER`], it is estimated too, unless the user asked for the model; it is also estimated if the
    /// estimate does not converge without it.
    pub(crate) fn of(mut case: EstimationProblem, progress: &Progress) -> anyhow::Result<Self> {
        let stage = progress.begin("calibrating", None);
        let fitted = |case: &EstimationProblem| {
            fit(&case.given(), &case.model, case.imu(), case.knowledge(), |iteration| {
                stage.at(&format!("calibrating, last step {:.3} sigma", iteration.step));
            })
        };
        let fit = match fitted(&case) {
            Err(error @ FitError::Diverged { .. }) if case.can_be_g_sensitive() => {
                case.add_g_sensitivity();
                fitted(&case).ok().ok_or(error)
            }
            Ok(plain) if case.is_default && case.can_be_g_sensitive() => {
                let model = case.with_g_sensitivity();
                match fit_near(&plain, &case.given(), &model, case.imu(), case.knowledge()) {
                    Ok(other) if other.log_likelihood > plain.log_likelihood + LIKELIER => {
                        case.add_g_sensitivity();
                        Ok(other)
                    }
                    _ => Ok(plain),
                }
            }
            found => found,
        };
        drop(stage);
        let fit = fit.with_context(|| case.names())?;
        let comparison = RunComparison::of_logs(&case, progress);
        let moves = moves(&case, &fit);
        Ok(Self { comparison, ..Self::with_moves(case, fit, &moves)? })
    }

    /// What follows from a case and what was estimated from it.
    ///
    /// Readings from which the errors cannot be undone are navigated as they were recorded, and that is said.
    pub(crate) fn with(case: EstimationProblem, fit: Fit) -> anyhow::Result<Self> {
        Self::with_moves(case, fit, &[])
    }

    /// The same with what the accuracy of the references adds to the uncertainty.
    fn with_moves(mut case: EstimationProblem, fit: Fit, moves: &[Moves]) -> anyhow::Result<Self> {
        let given = case.given_of_logs();
        // How an IMU stood in each of many rests is nothing to keep; where an axis points about which it turns is.
        let is_kept = |run: usize, id: &str| match case.runs.get(run) {
            Some(_) if !case.shares_turn_on(run) => true,
            Some(log) => log.run.rig.reference != Reference::Rest && id != axis_attitude("z"),
            None => false,
        };
        let is_kept = |Estimate { parameter, run, .. }: &Estimate| {
            parameter.owner != Owner::Placement || run.is_none_or(|run| is_kept(run, &parameter.id))
        };
        let whole = fit.along(SignedAxes::IDENTITY);
        let kept: Vec<usize> = (0..whole.parameters.len())
            .filter(|&place| is_kept(&whole.parameters[place]))
            .collect();
        let fit = whole.without_linear().marginal(is_kept);
        let mut identifiability = fit.identifiability();
        if let [_] = case.runs[..] {
            identifiability.unknowns.iter_mut().for_each(|unknown| unknown.run = None);
        }
        let mut departures =
            fit.prior_departures(&identifiability, &NoiseParameters::of(case.imu()));
        // An IMU may be quieter than its grade.
        let states_noise =
            |run: &Prepared| run.loaded.rig.imu.is_some() && run.loaded.rig.preset.is_none();
        if !case.runs.iter().all(states_noise) {
            departures.retain(|departure| matches!(departure.of, Quantity::Parameter(_)));
        }
        let held = held(&identifiability, |place| role(&fit, place));
        // The attitudes that are not kept change with the parameters that are left at their prior values.
        let places: Vec<usize> = held.iter().map(|&place| kept[place]).collect();
        let fit = whole.with_prior_values_at(&places).marginal(is_kept);
        let contributions: Vec<Contribution> = moves.iter().map(|one| one.of(&fit)).collect();
        for departure in &mut departures {
            if let Quantity::Parameter(place) = departure.of {
                let aliases = &identifiability.parameters[place].aliases;
                weaken(departure, &by_reference(place, aliases, &contributions));
            }
        }
        let fit = contributions.iter().fold(fit, |fit, one| fit.with_unknown(&one.moves));
        let mut certified = Vec::with_capacity(case.runs.len());
        for (place, (prepared, given)) in case.runs.into_iter().zip(&given).enumerate() {
            let undone = undone(&prepared.run, &fit.models[place]);
            if let Err(error) = &undone {
                case.remarks.push(format!(
                    "{}: the estimates cannot be compensated ({error}): navigation is as recorded.",
                    prepared.name
                ));
            }
            certified.push(CertifiedRun::of((prepared, undone.ok()), &fit, place, given)?);
        }
        let innovations: Vec<_> =
            certified.iter().flat_map(|run| run.innovations.iter().copied()).collect();
        let consistency = Consistency::of(&innovations).context("too few epochs")?;
        let EstimationProblem { name: model, noise, remarks, model_file, .. } = case;
        let besides = Vec::new();
        Ok(Self {
            model,
            runs: certified,
            fit,
            identifiability,
            held,
            contributions,
            tolerances: BTreeMap::new(),
            departures,
            consistency,
            noise,
            besides,
            comparison: None,
            remarks,
            model_file,
        })
    }

    /// The value and the 1σ of what the data tell of a parameter: of itself, or of the sum that it is in, in SI units.
    pub(crate) fn value(&self, place: usize) -> (f64, f64) {
        self.fit.sum(place, &self.identifiability.parameters[place].aliases)
    }

    /// The uncertainty of a parameter, or of the combination in which it is observable, if the accuracy of a reference is stated.
    pub(crate) fn uncertainty(&self, place: usize) -> Option<Uncertainty> {
        let aliases = &self.identifiability.parameters[place].aliases;
        let (_, sigma) = self.value(place);
        let of = || Uncertainty::of(place, aliases, sigma, &self.contributions);
        (!self.contributions.is_empty()).then(of)
    }

    /// What reading the logs has repaired or left out, log by log.
    pub(crate) fn repairs(&self) -> Vec<String> {
        self.runs.iter().flat_map(|run| run.prepared.basis.repairs.iter().cloned()).collect()
    }

    /// The basis of the estimates.
    pub(crate) fn basis(&self) -> BasisResult {
        BasisResult::together(self.runs.iter().map(|run| &run.prepared.basis))
            .with_files(self.model_file.clone())
    }

    /// What the calibration is called.
    pub(crate) fn title(&self) -> String {
        let names: Vec<&str> = self.runs.iter().map(|run| run.prepared.name.as_str()).collect();
        format!("Calibration of {}", names.join(", "))
    }
}

impl CertifiedRun {
    /// Of a run, and of the same with what was estimated undone.
    fn of(
        (prepared, undone): (Prepared, Option<Recording>),
        fit: &Fit,
        run: usize,
        given: &[usize],
    ) -> anyhow::Result<Self> {
        let station = &prepared.loaded.station;
        let model = &fit.models[run];
        let nav_from_table = prepared.run.rig.nav_from_table * attitude_of(model);
        let recorded = &prepared.run.recording;
        let undone = undone.map_or_else(|| Arc::clone(recorded), Arc::new);
        let track = fit.linear[run].track();
        let navigate = |recording: &Recording| {
            navigate_freely(recording, track.angles(), nav_from_table, station, None)
        };
        let (before, after) = (navigate(recorded), navigate(&undone));
        let innovations: Vec<_> = given.iter().flat_map(|&run| fit.innovations(run)).collect();
        let consistency = Consistency::of(&innovations).context("too few epochs")?;
        let in_run = |place: usize| Some((place, fit.in_run(&fit.parameters[place], run)?));
        let (places, here): (Vec<usize>, Vec<InRun>) =
            (0..fit.parameters.len()).filter_map(in_run).unzip();
        let asked: Vec<EstimatedParameter<'_>> = places
            .iter()
            .zip(&here)
            .map(|(&place, here)| EstimatedParameter {
                chosen: &model.terms[here.term],
                parameter: here.parameter,
                value: here.sign * fit.parameters[place].value,
                sigma: fit.parameters[place].sigma,
            })
            .collect();
        let covariance = DMatrix::from_fn(places.len(), places.len(), |row, column| {
            here[row].sign * here[column].sign * fit.covariance[(places[row], places[column])]
        });
        let truth = Truth { station, nav_from_table, recording: &undone, track };
        let budget = Budget::of(&truth, &asked, &covariance);
        let motion = motion(&prepared, &nav_from_table, given.len());
        let times = given.iter().flat_map(|&rest| fit.linear[rest].ends()).collect();
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
            motion,
        })
    }
}

/// The parameters that are left at the values that were expected of them: those of which the data would tell nothing
/// if all else were known, and those that they hardly tell better than a data sheet. What an earlier calibration said of a
/// parameter is an estimate as good as this one.
pub(crate) fn held(
    identifiability: &Identifiability,
    role: impl Fn(usize) -> Option<Role>,
) -> Vec<usize> {
    let is_held = |&place: &usize| {
        let visible = |lost: &Unobservable| lost.unknown != place || lost.visible;
        role(place) == Some(Role::Free) || !identifiability.rank.lost.iter().all(visible)
    };
    identifiability.unobservable().into_iter().filter(is_held).collect()
}

/// The role of a parameter in the model of a run that has it.
fn role(fit: &Fit, place: usize) -> Option<Role> {
    (0..fit.models.len()).find_map(|run| {
        let here = fit.in_run(&fit.parameters[place], run)?;
        Some(fit.models[run].terms[here.term].roles[here.parameter])
    })
}

/// How a run moved that consists of so many rests, or turns.
fn motion(prepared: &Prepared, nav_from_table: &Dcm<Nav, Table>, rests: usize) -> String {
    if rests > 1 {
        return format!("{rests} static intervals");
    }
    let rates = steady_rates(&prepared.run.recording);
    let tilt = nav_from_table.matrix()[(2, 2)].clamp(-1.0, 1.0).acos() / DEG;
    let rate = |rate: &f64| format!("{:.2}", rate / DEG);
    let at = match rates.as_slice() {
        [] => "no steady table rate".into(),
        [only] => format!("a table rate of {} deg/s", rate(only)),
        [rates @ .., last] if rates.len() < MOST_RATES => {
            let rates: Vec<String> = rates.iter().map(rate).collect();
            format!("table rates of {} and {} deg/s", rates.join(", "), rate(last))
        }
        many => {
            let extreme = |pick: fn(f64, f64) -> f64| many.iter().copied().reduce(pick);
            let [least, most] = [f64::min, f64::max].map(|pick| extreme(pick).unwrap_or_default());
            format!("{} table rates from {} to {} deg/s", many.len(), rate(&least), rate(&most))
        }
    };
    format!("{at}, axis of rotation {tilt:.1} deg off the vertical")
}

/// A run's readings with the errors of a model undone.
fn undone(run: &Run, model: &Model) -> Result<Recording, NotUndone> {
    let nav_from_table = run.rig.nav_from_table * attitude_of(model);
    compensated(model, Surroundings::new(run.rig.station, nav_from_table), &run.recording)
}

/// The rotation by which a model says that the axis frame differs from the survey.
fn attitude_of(model: &Model) -> Dcm<Table, Table> {
    let axes = ["x", "y", "z"].map(|axis| model.value(&axis_attitude(axis)));
    Dcm::from_rotation_vector(&axes.map(Option::unwrap_or_default).into())
}

/// The id of the error of the axis' attitude about one axis of the axis frame.
fn axis_attitude(about: &str) -> String {
    format!("{}.{about}", catalogue::AXIS_ATTITUDE.id)
}
