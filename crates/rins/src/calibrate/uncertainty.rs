//! What the accuracy of the references adds to the uncertainty of the estimates (JCGM 100:2008, type B).

use std::sync::Arc;

use nalgebra::DVector;
use rins_design::coverage_factor;
use rins_estimation::{Alias, Departure, Estimate, Fit, Run, fit_near};
use rins_frames::SignedAxes;
use rins_io::{Accuracy, LogFormat, Reading, Rig};
use rins_motion::Recording;
use rins_terms::{Model, TermInstance, catalogue};

use crate::preparation::EstimationProblem;

/// A reference of a calibration whose accuracy is stated.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Reference {
    /// The table's rate, with an error of one sign in the direction of rotation.
    Rate,
    /// The table's angle, with an error once per revolution; one component of it.
    AngleCos,
    /// The other component.
    AngleSin,
    /// The latitude.
    Latitude,
    /// Gravity.
    Gravity,
    /// The clock of the log.
    Clock,
}

impl Reference {
    const ALL: [Self; 6] =
        [Self::Rate, Self::AngleCos, Self::AngleSin, Self::Latitude, Self::Gravity, Self::Clock];

    /// The key that states its accuracy.
    pub(crate) const fn key(self) -> &'static str {
        match self {
            Self::Rate => "table.rate_accuracy",
            Self::AngleCos => "table.angle_accuracy (cos)",
            Self::AngleSin => "table.angle_accuracy (sin)",
            Self::Latitude => "site.latitude_accuracy",
            Self::Gravity => "site.gravity_accuracy",
            Self::Clock => "log.clock_accuracy",
        }
    }

    /// The standard uncertainty that limits of an error mean: that of a rectangular distribution (JCGM 100:2008, 4.3.7). The phase of an
    /// error once per revolution is not known, and each component has half of its square.
    fn standard_uncertainty(self, accuracy: &Accuracy) -> Option<f64> {
        let limit = match self {
            Self::Rate => accuracy.table_rate,
            Self::AngleCos | Self::AngleSin => {
                accuracy.table_angle.map(|limit| limit / std::f64::consts::SQRT_2)
            }
            Self::Latitude => accuracy.latitude,
            Self::Gravity => accuracy.gravity,
            Self::Clock => accuracy.clock,
        };
        Some(limit? / 3.0_f64.sqrt())
    }

    /// The error of a model that has this error of the reference, in runs at a place of this gravity \[m/s²\].
    fn term(self, error: f64, gravity: f64) -> Option<TermInstance> {
        let with = |term, values: &[f64]| Some(TermInstance::new(term).with_values(values));
        match self {
            Self::AngleCos => with(&catalogue::ENCODER_ECCENTRICITY, &[error, 0.0]),
            Self::AngleSin => with(&catalogue::ENCODER_ECCENTRICITY, &[0.0, error]),
            Self::Latitude => with(&catalogue::WRONG_LATITUDE, &[error]),
            Self::Gravity => with(&catalogue::WRONG_GRAVITY, &[error / gravity]),
            Self::Rate | Self::Clock => None,
        }
    }

    /// Corrects a run for this error of the reference.
    fn correct(self, error: f64, run: &mut Run, rig: &Rig) {
        match self {
            Self::Rate => correct_rate(error, Arc::make_mut(&mut run.recording)),
            Self::Clock => correct_clock(error, Arc::make_mut(&mut run.recording), rig),
            Self::AngleCos | Self::AngleSin | Self::Latitude | Self::Gravity => {}
        }
    }
}

/// The table turns faster than stated by this, in either sense \[rad/s\].
fn correct_rate(error: f64, recording: &mut Recording) {
    let rates: Vec<f64> = match &recording.table_rate {
        Some(rates) => rates.clone(),
        None => {
            let intervals = recording.increments.iter();
            intervals.map(|sample| sample.angle.components().z / sample.interval).collect()
        }
    };
    // A table that stands has no error of its rate.
    let fastest = rates.iter().fold(0.0_f64, |most, rate| most.max(rate.abs()));
    let of = |rate: f64| if rate.abs() > 1e-3 * fastest { error * rate.signum() } else { 0.0 };
    if let Some(angles) = &mut recording.table_angle {
        let mut sum = 0.0;
        for ((angle, rate), sample) in angles.iter_mut().zip(&rates).zip(&recording.increments) {
            sum += of(*rate) * sample.interval;
            *angle += sum;
        }
    }
    if let Some(stated) = &mut recording.table_rate {
        for rate in stated {
            *rate += of(*rate);
        }
    }
}

/// The clock is slow by this fraction: intervals are longer than stated. Rates are right all the same, and so are increments.
fn correct_clock(error: f64, recording: &mut Recording, rig: &Rig) {
    let slower = 1.0 + error;
    let are_rates = match &rig.log.format {
        LogFormat::Columns(columns) => {
            [&columns.gyro, &columns.accel].map(|of| matches!(of.reading, Reading::Rate(_)))
        }
        _ => [false; 2],
    };
    for time in &mut recording.times {
        *time *= slower;
    }
    for sample in &mut recording.increments {
        sample.interval *= slower;
        if are_rates[0] {
            sample.angle = sample.angle * slower;
        }
        if are_rates[1] {
            sample.velocity = sample.velocity * slower;
        }
    }
}

/// How far the estimates move with the standard uncertainty of one reference.
#[derive(Clone, Debug)]
pub(crate) struct Moves {
    reference: Reference,
    standard_uncertainty: f64,
    /// By id and run, in SI units.
    each: Vec<(String, Option<usize>, f64)>,
}

impl Moves {
    /// The contribution to the parameters of a fit; those that are in no other fit do not move.
    pub(crate) fn of(&self, fit: &Fit) -> Contribution {
        let moved = |one: &Estimate| {
            let own =
                self.each.iter().find(|(id, run, _)| *id == one.parameter.id && *run == one.run);
            own.map_or(0.0, |(.., moved)| *moved)
        };
        let moves = fit.parameters.iter().map(moved);
        Contribution {
            reference: self.reference,
            standard_uncertainty: self.standard_uncertainty,
            moves: DVector::from_iterator(fit.parameters.len(), moves),
        }
    }
}

/// What one reference adds to the uncertainty of all parameters.
#[derive(Clone, Debug)]
pub(crate) struct Contribution {
    /// The reference.
    pub(crate) reference: Reference,
    /// Its standard uncertainty, in SI units; the largest of all runs.
    pub(crate) standard_uncertainty: f64,
    /// How far each parameter moves with that, in SI units.
    pub(crate) moves: DVector<f64>,
}

/// How far the estimates move with all references whose accuracy is stated: the model is estimated again with each of them off by its
/// standard uncertainty.
pub(crate) fn moves(problem: &EstimationProblem, fit: &Fit) -> Vec<Moves> {
    let stated: Vec<Accuracy> = problem.runs.iter().map(|run| run.loaded.rig.accuracy).collect();
    if !stated.iter().any(Accuracy::is_stated) {
        return Vec::new();
    }
    let along = fit.without_linear().along(SignedAxes::IDENTITY);
    let of = |reference: Reference| {
        let each = stated.iter().filter_map(|accuracy| reference.standard_uncertainty(accuracy));
        let largest = each.reduce(f64::max)?;
        let (runs, model) = with_error(problem, reference, largest);
        let moved = fit_near(fit, &runs, &model, problem.imu(), problem.knowledge()).ok()?;
        let moved = moved.along(SignedAxes::IDENTITY);
        let each = along.parameters.iter().filter_map(|one| {
            let is_same =
                |other: &&Estimate| other.parameter.id == one.parameter.id && other.run == one.run;
            let same = moved.parameters.iter().find(is_same)?;
            Some((one.parameter.id.clone(), one.run, same.value - one.value))
        });
        Some(Moves { reference, standard_uncertainty: largest, each: each.collect() })
    };
    Reference::ALL.into_iter().filter_map(of).collect()
}

/// The runs and the model if a reference is off by this.
fn with_error(problem: &EstimationProblem, reference: Reference, error: f64) -> (Vec<Run>, Model) {
    let mut runs = problem.given();
    let of_logs = problem.given_of_logs();
    for (prepared, places) in problem.runs.iter().zip(of_logs) {
        for place in places {
            reference.correct(error, &mut runs[place], &prepared.loaded.rig);
        }
    }
    let mut model = problem.model.clone();
    model.terms.extend(reference.term(error, problem.runs[0].loaded.station.gravity));
    (runs, model)
}

/// The uncertainty of one estimate: of a parameter, or of the combination that is observable.
#[derive(Clone, Debug)]
pub(crate) struct Uncertainty {
    /// By noise and priors: type A.
    pub(crate) estimated: f64,
    /// Of each reference.
    pub(crate) by_reference: Vec<(Reference, f64)>,
    /// For an interval of 95 %.
    pub(crate) coverage_factor: f64,
}

impl Uncertainty {
    /// That of the sum of a parameter with others, whose 1σ with all contributions is this, in SI units.
    pub(crate) fn of(
        place: usize,
        aliases: &[Alias],
        sigma: f64,
        contributions: &[Contribution],
    ) -> Self {
        let by_reference = by_reference(place, aliases, contributions);
        let estimated = (sigma * sigma - type_b_variance(&by_reference)).max(0.0).sqrt();
        let sizes: Vec<f64> = by_reference.iter().map(|(_, moved)| moved.abs()).collect();
        let coverage_factor = coverage_factor(estimated, &sizes);
        Self { estimated, by_reference, coverage_factor }
    }
}

/// How far the sum of a parameter with others moves with each reference, in SI units.
pub(crate) fn by_reference(
    place: usize,
    aliases: &[Alias],
    contributions: &[Contribution],
) -> Vec<(Reference, f64)> {
    let moved = |one: &Contribution| {
        let others = aliases.iter().map(|alias| alias.coefficient * one.moves[alias.unknown]);
        (one.reference, one.moves[place] + others.sum::<f64>())
    };
    contributions.iter().map(moved).collect()
}

/// The variance by all references: type B.
fn type_b_variance(by_reference: &[(Reference, f64)]) -> f64 {
    by_reference.iter().map(|(_, moved)| moved * moved).sum()
}

/// Weakens a departure from what was stated beforehand: the references may cause it too.
pub(crate) fn weaken(departure: &mut Departure, by_reference: &[(Reference, f64)]) {
    let spread = (departure.value - departure.expected) / departure.sigmas;
    // No departure at all has no spread.
    if spread.is_finite() {
        departure.sigmas *= spread.abs() / spread.hypot(type_b_variance(by_reference).sqrt());
    }
}
