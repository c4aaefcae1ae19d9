//! The error budget of free inertial navigation: the drift that each parameter causes over the motion of a run.

use nalgebra::{DMatrix, Matrix3xX, Vector3};
use rins_frames::{Body, Dcm, InFrame, Increments, Nav, Table};
use rins_motion::{Navigator, Recording, Station, VerticalChannel};
use rins_terms::{Acting, KinematicState, Model, TermInstance, Track, catalogue, derivatives};

/// The duration of free inertial navigation \[s\]: that of the paper's tables.
const LASTING: f64 = 360.0;

/// Errors of velocity and attitude.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Drift {
    /// The error of the velocity, east, north and up \[m/s\].
    pub velocity: Vector3<f64>,
    /// The error of the attitude, about east, north and up \[rad\].
    pub attitude: Vector3<f64>,
}

/// The contribution of one parameter to the error budget.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Contribution {
    /// The drift due to its 1σ.
    pub by_sigma: Drift,
    /// The drift due to its value if it is not compensated.
    pub by_value: Drift,
}

/// The drift due to each parameter, and due to the uncertainties of all parameters together.
#[derive(Clone, Debug, PartialEq)]
pub struct Budget {
    /// The duration of free inertial navigation \[s\].
    pub after: f64,
    /// One for each estimated parameter of the run.
    pub contributions: Vec<Contribution>,
    /// The 1σ of the drift due to all parameters, with their correlations.
    pub total: Drift,
}

/// A parameter with its estimate.
#[derive(Clone, Copy, Debug)]
pub struct EstimatedParameter<'a> {
    /// The term, with its settings.
    pub chosen: &'a TermInstance,
    /// The index of the parameter within the term.
    pub parameter: usize,
    /// Its value, in SI units.
    pub value: f64,
    /// Its 1σ, in SI units.
    pub sigma: f64,
}

/// The true motion: readings without errors, and the initial state.
#[derive(Clone, Copy, Debug)]
pub struct Truth<'a> {
    /// The site of the table.
    pub station: &'a Station,
    /// The attitude of the axis frame.
    pub nav_from_table: Dcm<Nav, Table>,
    /// Readings without errors.
    pub recording: &'a Recording,
    /// The trajectory of the table during these readings.
    pub track: &'a Track,
}

impl Budget {
    /// The error budget over the first minutes of a run; `covariance` (n × n, SI units) is that of the n `parameters`.
    ///
    /// A contribution is the difference of two solutions: free inertial navigation with this one error, and without errors.
    pub fn of(
        truth: &Truth<'_>,
        parameters: &[EstimatedParameter<'_>],
        covariance: &DMatrix<f64>,
    ) -> Self {
        let times = &truth.recording.times;
        let from = times.first().copied().unwrap_or_default();
        let samples = times.iter().take_while(|time| **time - from < LASTING).count();
        let moments: Vec<KinematicState> = truth
            .track
            .moments()
            .zip(&truth.recording.increments)
            .take(samples)
            .map(|(moment, felt)| moment.feeling(felt))
            .collect();
        let none = Dcm::<Table, Table>::identity();
        let without = navigated(truth, &truth.recording.increments[..samples], none);
        let contributions: Vec<Contribution> =
            parameters.iter().map(|one| contribution(truth, &moments, one, &without)).collect();
        let total = |of: fn(&Drift) -> Vector3<f64>| {
            let per_unit: Vec<Vector3<f64>> = contributions
                .iter()
                .zip(parameters)
                .map(|(contribution, parameter)| of(&contribution.by_sigma) / parameter.sigma)
                .collect();
            if per_unit.is_empty() {
                return Vector3::zeros();
            }
            let response = Matrix3xX::from_columns(&per_unit);
            (&response * covariance * response.transpose()).diagonal().map(|x| x.max(0.0).sqrt())
        };
        let after = times[..samples].last().map_or(0.0, |time| time - from);
        Self {
            after,
            total: Drift { velocity: total(|d| d.velocity), attitude: total(|d| d.attitude) },
            contributions,
        }
    }
}

/// The final state of free inertial navigation.
struct End {
    velocity: Vector3<f64>,
    nav_from_body: Dcm<Nav, Body>,
}

fn contribution(
    truth: &Truth<'_>,
    moments: &[KinematicState],
    estimated: &EstimatedParameter<'_>,
    without: &End,
) -> Contribution {
    let alone = Model { terms: vec![estimated.chosen.clone()] };
    let acting = Acting::by(&alone, truth.track, &[(0, estimated.parameter)]).concat();
    let effect: Vec<[Vector3<f64>; 3]> = moments
        .iter()
        .map(|moment| {
            let by = Acting::together(&acting, moment);
            [derivatives(&by.gyro), derivatives(&by.accel), derivatives(&by.tilt)]
        })
        .collect();
    let felt = effect.iter().any(|[gyro, accel, _]| gyro.norm() > 0.0 || accel.norm() > 0.0);
    // Navigation starts from the attitude of the axis, which this error changes.
    let start = if estimated.chosen.term.is(&catalogue::AXIS_ATTITUDE) {
        effect.first().map_or(Vector3::zeros(), |[.., tilt]| *tilt)
    } else {
        Vector3::zeros()
    };
    if !felt && start == Vector3::zeros() {
        return Contribution::default();
    }
    let drift = |size: f64| {
        let increments: Vec<Increments> = truth
            .recording
            .increments
            .iter()
            .zip(&effect)
            .map(|(true_one, [gyro, accel, _])| Increments {
                angle: true_one.angle + InFrame::from_components(gyro * (size * true_one.interval)),
                velocity: true_one.velocity
                    + InFrame::from_components(accel * (size * true_one.interval)),
                interval: true_one.interval,
            })
            .collect();
        let off = Dcm::<Table, Table>::from_rotation_vector(&(start * -size));
        let with = navigated(truth, &increments, off);
        // Computed = (I - φ×) true.
        let turned = (with.nav_from_body * without.nav_from_body.inverse()).rotation_vector();
        Drift { velocity: with.velocity - without.velocity, attitude: -turned }
    };
    Contribution { by_sigma: drift(estimated.sigma), by_value: drift(estimated.value) }
}

fn navigated(truth: &Truth<'_>, increments: &[Increments], off: Dcm<Table, Table>) -> End {
    let angle = truth.track.angles().first().copied().unwrap_or_default();
    let start = truth.nav_from_table * off * Dcm::<Table, Body>::about_z(angle);
    let mut navigator = Navigator::at_rest(truth.station, start, VerticalChannel::Held);
    for sample in increments {
        navigator.step(sample);
    }
    let state = navigator.state();
    End { velocity: *state.velocity.components(), nav_from_body: state.nav_from_body }
}
