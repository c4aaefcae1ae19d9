//! What each error is worth in navigation: the drift that it makes over a run's own motion.

use nalgebra::{DMatrix, Matrix3xX, Vector3};
use rins_frames::{Body, Dcm, InFrame, Increments, Nav, Table};
use rins_motion::{Navigator, Recording, Station, VerticalChannel};
use rins_terms::{Acting, KinematicState, Model, TermInstance, Track, catalogue, derivatives};

/// How long is navigated \[s\]: the time of the paper's tables.
const LASTING: f64 = 360.0;

/// A change of velocity and attitude.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Drift {
    /// Of the velocity, east, north and up \[m/s\].
    pub velocity: Vector3<f64>,
    /// Of the attitude, about east, north and up \[rad\].
    pub attitude: Vector3<f64>,
}

/// What one parameter is worth.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Worth {
    /// The drift that its 1σ makes.
    pub by_sigma: Drift,
    /// The drift that its value makes where it is left in.
    pub by_value: Drift,
}

/// The drift by each parameter, and by what is unknown of all together.
#[derive(Clone, Debug, PartialEq)]
pub struct Budget {
    /// After how long \[s\].
    pub after: f64,
    /// One for each parameter that belongs to the run.
    pub worth: Vec<Worth>,
    /// The 1σ of the drift by all parameters, with their correlations.
    pub total: Drift,
}

/// A parameter whose worth is asked for.
#[derive(Clone, Copy, Debug)]
pub struct Asked<'a> {
    /// The term, with its settings.
    pub chosen: &'a TermInstance,
    /// Which of the term's parameters it is.
    pub parameter: usize,
    /// Its value, in SI units.
    pub value: f64,
    /// The 1σ of that, in SI units.
    pub sigma: f64,
}

/// What is navigated: readings without errors, and where they begin.
#[derive(Clone, Copy, Debug)]
pub struct Truth<'a> {
    /// Where the table stands.
    pub station: &'a Station,
    /// The attitude of the axis frame.
    pub nav_from_table: Dcm<Nav, Table>,
    /// Readings without errors.
    pub recording: &'a Recording,
    /// How the table moved over these readings.
    pub track: &'a Track,
}

impl Budget {
    /// The worth of each parameter over the first minutes of a run; `covariance`, n by n in SI units, is that of the n `asked`.
    ///
    /// Each is free navigation with that one error in the readings, against free navigation without.
    pub fn of(truth: &Truth<'_>, asked: &[Asked<'_>], covariance: &DMatrix<f64>) -> Self {
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
        let worth: Vec<Worth> =
            asked.iter().map(|asked| worth(truth, &moments, asked, &without)).collect();
        let total = |of: fn(&Drift) -> Vector3<f64>| {
            let per_unit: Vec<Vector3<f64>> = worth
                .iter()
                .zip(asked)
                .map(|(worth, asked)| of(&worth.by_sigma) / asked.sigma)
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
            worth,
        }
    }
}

/// Where free navigation ends.
struct End {
    velocity: Vector3<f64>,
    nav_from_body: Dcm<Nav, Body>,
}

fn worth(truth: &Truth<'_>, moments: &[KinematicState], asked: &Asked<'_>, without: &End) -> Worth {
    let alone = Model { terms: vec![asked.chosen.clone()] };
    let acting = Acting::by(&alone, truth.track, &[(0, asked.parameter)]).concat();
    let effect: Vec<[Vector3<f64>; 3]> = moments
        .iter()
        .map(|moment| {
            let by = Acting::together(&acting, moment);
            [derivatives(&by.gyro), derivatives(&by.accel), derivatives(&by.tilt)]
        })
        .collect();
    let felt = effect.iter().any(|[gyro, accel, _]| gyro.norm() > 0.0 || accel.norm() > 0.0);
    // Navigation starts from the attitude of the axis, without this error in it.
    let start = if asked.chosen.term.is(&catalogue::AXIS_ATTITUDE) {
        effect.first().map_or(Vector3::zeros(), |[.., tilt]| *tilt)
    } else {
        Vector3::zeros()
    };
    if !felt && start == Vector3::zeros() {
        return Worth::default();
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
    Worth { by_sigma: drift(asked.sigma), by_value: drift(asked.value) }
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
