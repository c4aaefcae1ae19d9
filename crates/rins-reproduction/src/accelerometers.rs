//! "Accelerometer error can be modulated by 2π rotation", eq. (A.5): the velocity error of each accelerometer error after whole
//! turns.

use nalgebra::{Matrix3, Vector3};
use rayon::prelude::*;
use rins_frames::{InFrame, Nav, Table};
use rins_imu::TriadError;
use rins_motion::mechanism::{ConstantTurn, SensorErrors};
use rins_motion::{Navigator, Profile, Segment, TrueMotion, VerticalChannel};

use crate::error::ReproductionError;
use crate::grid::{ATTITUDES, RATES, turn};

/// The number of turns of section 4.
pub(crate) const TURNS: f64 = 10.0;

/// The name of the case with all errors.
pub(crate) const ALL: &str = "all together";

/// The number of quadrature steps per turn: exact for trigonometric polynomials of second degree.
const STEPS: u32 = 72;

/// The sample interval of the navigator \[s\].
const INTERVAL: f64 = 0.02;

/// The tolerance for quadrature against the closed form, relative to the magnitude of the error times time:
/// rounding.
const QUADRATURE: f64 = 1e-12;

/// The single errors of a triad, each with its name in a triad without other errors.
pub(crate) fn single_errors(all: &TriadError) -> Vec<(String, TriadError)> {
    let axis = ["x", "y", "z"];
    let mut single = Vec::new();
    for (row, name) in axis.into_iter().enumerate() {
        let mut bias = Vector3::zeros();
        bias[row] = all.bias[row];
        single.push((format!("bias {name}"), TriadError { bias, ..TriadError::default() }));
    }
    let mut of_matrix = |row: usize, column: usize, name: String| {
        let mut matrix = Matrix3::zeros();
        matrix[(row, column)] = all.matrix[(row, column)];
        single.push((name, TriadError { matrix, ..TriadError::default() }));
    };
    for (row, name) in axis.into_iter().enumerate() {
        of_matrix(row, row, format!("scale $K_{name}$"));
    }
    for (row, name) in axis.into_iter().enumerate() {
        for (column, other) in axis.into_iter().enumerate().filter(|(column, _)| *column != row) {
            of_matrix(row, column, format!("misalignment $E_{{{name}{other}}}$"));
        }
    }
    single
}

/// The acceleration error `C_b^n δf^b` at a time of a rotation at constant rate \[m/s²\].
fn acceleration(turn: &ConstantTurn, error: &TriadError, time: f64) -> Vector3<f64> {
    let c_nb = *turn.nav_from_body(time).matrix();
    let force = c_nb.transpose() * Vector3::z() * turn.station.gravity;
    c_nb * (error.bias + error.matrix * force)
}

/// The velocity error that (A.5) omits, `∫ C_b^n δf^b dt`, by Simpson's rule \[m/s\].
pub(crate) fn integrated(turn: &ConstantTurn, error: &TriadError, time: f64) -> Vector3<f64> {
    let turns = (turn.rate * time / std::f64::consts::TAU).abs();
    let steps = (turns * f64::from(STEPS)).ceil();
    let interval = time / steps;
    let at = |time| acceleration(turn, error, time);
    let mut sum = Vector3::zeros();
    let mut step = 0.0;
    while step < steps {
        let now = step * interval;
        sum += at(now) + at(now + 0.5 * interval) * 4.0 + at(now + interval);
        step += 1.0;
    }
    sum * (interval / 6.0)
}

/// The mean of `C_b^n δf^b` over a turn \[m/s²\], which no rotation about the axis cancels.
///
/// In the axis frame a bias keeps its z component, and the mean of a matrix `A` is that of
/// `Rz A Rzᵀ`: `(A_xx + A_yy) / 2` across the axis, `A_zz` along it, and
/// `(A_yx - A_xy) / 2` as a rotation about it.
pub(crate) fn mean_over_a_turn(turn: &ConstantTurn, error: &TriadError) -> Vector3<f64> {
    let a = &error.matrix;
    let (across, about) = (0.5 * (a[(0, 0)] + a[(1, 1)]), 0.5 * (a[(1, 0)] - a[(0, 1)]));
    let mean = Matrix3::new(across, -about, 0.0, about, across, 0.0, 0.0, 0.0, a[(2, 2)]);
    let c_ns = turn.nav_from_table.matrix();
    let force = c_ns.transpose() * Vector3::z() * turn.station.gravity;
    c_ns * (Vector3::z() * error.bias.z + mean * force)
}

/// The horizontal velocity error at the end of a navigation with accelerometer errors only \[m/s\].
///
/// # Errors
/// [`ReproductionError::Profile`] if rate and time are not a valid profile.
pub(crate) fn navigated(
    turn: &ConstantTurn,
    error: &TriadError,
    time: f64,
) -> Result<Vector3<f64>, ReproductionError> {
    let motion = TrueMotion {
        station: turn.station,
        nav_from_table: turn.nav_from_table,
        profile: Profile::new(&[Segment { rate: turn.rate, duration: time }], None)?,
    };
    let sensors = SensorErrors {
        accel_bias: InFrame::from_components(error.bias),
        accel_matrix: error.matrix,
        ..SensorErrors::none()
    };
    let start = turn.nav_from_body(0.0);
    let mut navigator = Navigator::at_rest(&turn.station, start, VerticalChannel::Held);
    for sample in motion.samples(INTERVAL) {
        navigator.step(&sensors.measured(&sample.increments));
    }
    Ok(*navigator.state().velocity.components())
}

/// The velocity error due to an accelerometer error after whole turns, by every method \[m/s\].
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Left {
    /// The error.
    pub(crate) name: String,
    /// Roll, pitch, yaw \[deg\].
    pub(crate) attitude: [f64; 3],
    /// The table rate \[deg/s\].
    pub(crate) rate: f64,
    /// The duration of the turns \[s\].
    pub(crate) time: f64,
    /// By quadrature, east, north and up.
    pub(crate) integrated: Vector3<f64>,
    /// The mean over a turn times the time.
    pub(crate) closed: Vector3<f64>,
    /// By the navigator, east and north.
    pub(crate) navigated: Vector3<f64>,
    /// The magnitude of the error times the time.
    pub(crate) scale: f64,
    /// The tolerance for the navigator because of the Schuler oscillation and the Earth rate, relative to the scale.
    pub(crate) neglected: f64,
}

impl Left {
    /// The velocity error after [`TURNS`] turns.
    ///
    /// # Errors
    /// [`ReproductionError::Profile`] if the rate is not valid for a profile.
    pub(crate) fn of(
        name: &str,
        error: &TriadError,
        attitude: [f64; 3],
        rate: f64,
    ) -> Result<Self, ReproductionError> {
        let turn = turn(attitude, rate);
        let time = TURNS * std::f64::consts::TAU / turn.rate.abs();
        let site = turn.station.site;
        let radius = site.meridian_radius();
        // For a constant acceleration: the tilt due to its velocity reduces the velocity by (t / τ)² / 6 of it, and
        // twice the Earth rate rotates the velocity by Ω t.
        let schuler = turn.station.gravity / radius * time * time / 6.0;
        let coriolis = rins_frames::EARTH_RATE * time;
        Ok(Self {
            name: name.to_owned(),
            attitude,
            rate,
            time,
            integrated: integrated(&turn, error, time),
            closed: mean_over_a_turn(&turn, error) * time,
            navigated: navigated(&turn, error, time)?,
            scale: (error.bias.norm() + error.matrix.norm() * turn.station.gravity) * time,
            neglected: schuler + coriolis,
        })
    }

    /// The horizontal part of the quadrature \[m/s\].
    pub(crate) fn horizontal(&self) -> f64 {
        self.integrated.xy().norm()
    }

    /// The violated bounds, in words.
    pub(crate) fn broken(&self) -> Vec<String> {
        let mut broken = Vec::new();
        let mut demand = |what: &str, off: f64, within: f64| {
            if off.is_nan() || off > within {
                let Self { name, attitude: [roll, pitch, yaw], rate, .. } = self;
                broken.push(format!(
                    "{what} for {name} at {rate} deg/s, roll {roll}, pitch {pitch}, yaw {yaw} deg: \
                     off by {off:.1e} m/s, at most {within:.1e} m/s"
                ));
            }
        };
        let off = (self.integrated - self.closed).norm();
        demand("the quadrature is off the mean over a turn", off, QUADRATURE * self.scale);
        let off = (self.integrated.xy() - self.navigated.xy()).norm();
        demand("the navigator is off the quadrature", off, self.neglected * self.scale);
        if self.is_level() {
            // The constant part is vertical, except for a scale error of gravity there.
            demand("a level axis leaves a velocity", self.horizontal(), QUADRATURE * self.scale);
        }
        broken
    }

    /// Whether the axis is vertical.
    pub(crate) fn is_level(&self) -> bool {
        self.attitude[..2].iter().all(|angle| angle.abs() < f64::MIN_POSITIVE)
    }
}

/// The results for all errors of a triad together and for each alone, at every attitude and rate of the grid of
/// [`crate::grid`].
///
/// # Errors
/// [`ReproductionError::Profile`] if a rate is not valid for a profile.
pub(crate) fn left_over(all: &TriadError) -> Result<Vec<Left>, ReproductionError> {
    let mut errors = vec![(ALL.to_owned(), *all)];
    errors.extend(single_errors(all));
    let places: Vec<(&str, &TriadError, [f64; 3], f64)> = ATTITUDES
        .iter()
        .flat_map(|&attitude| RATES.iter().map(move |&rate| (attitude, rate)))
        .flat_map(|(attitude, rate)| {
            errors.iter().map(move |(name, error)| (name.as_str(), error, attitude, rate))
        })
        .collect();
    places
        .par_iter()
        .map(|&(name, error, attitude, rate)| Left::of(name, error, attitude, rate))
        .collect()
}

/// The velocity error in n due to an error `bias` \[m/s²\] along the axis after `time` \[s\]: in the direction of the
/// axis, which is up on a level table.
pub(crate) fn along_the_axis(turn: &ConstantTurn, bias: f64, time: f64) -> InFrame<Nav> {
    turn.nav_from_table * InFrame::<Table>::new(0.0, 0.0, bias * time)
}

#[cfg(test)]
mod tests {
    use super::*;
    use rins_frames::units::{ARCSEC, MICRO_G, PPM};
    use rins_imu::Axis;
    use rins_motion::mechanism::{LinearModel, NavErrors};
    use rins_testing::assert_close;

    fn unequal() -> TriadError {
        TriadError { bias: Vector3::new(50.0, -80.0, 100.0) * MICRO_G, ..TriadError::default() }
            .with_scale(Axis::X, 40.0 * PPM)
            .with_scale(Axis::Y, -70.0 * PPM)
            .with_scale(Axis::Z, 120.0 * PPM)
            .with_misalignment(Axis::X, Axis::Y, 9.0 * ARCSEC)
            .with_misalignment(Axis::X, Axis::Z, -14.0 * ARCSEC)
            .with_misalignment(Axis::Y, Axis::X, -30.0 * ARCSEC)
            .with_misalignment(Axis::Y, Axis::Z, 17.0 * ARCSEC)
            .with_misalignment(Axis::Z, Axis::X, 25.0 * ARCSEC)
            .with_misalignment(Axis::Z, Axis::Y, -6.0 * ARCSEC)
    }

    #[test]
    fn no_bound_is_broken_by_errors_of_which_no_two_are_equal() {
        for attitude in [ATTITUDES[0], ATTITUDES[2]] {
            for (name, error) in single_errors(&unequal()) {
                let left = Left::of(&name, &error, attitude, -20.0).unwrap();
                assert_eq!(left.broken(), Vec::<String>::new());
            }
        }
    }

    #[test]
    fn each_bound_breaks_for_a_figure_that_is_wrong() {
        let left = Left::of("all", &unequal(), ATTITUDES[0], 20.0).unwrap();
        assert!(left.broken().is_empty());
        let closed = left.closed * 1.001;
        assert_eq!(Left { closed, ..left.clone() }.broken().len(), 1);
        let navigated = left.navigated * 1.5;
        assert_eq!(Left { navigated, ..left.clone() }.broken().len(), 1);
        // As if the axis were level.
        assert_eq!(Left { attitude: [0.0; 3], ..left }.broken().len(), 1);
    }

    #[test]
    fn the_navigator_has_the_linear_models_velocity() {
        let (turn, error, time) = (turn(ATTITUDES[0], 20.0), unequal(), 180.0);
        let sensors = SensorErrors {
            accel_bias: InFrame::from_components(error.bias),
            accel_matrix: error.matrix,
            ..SensorErrors::none()
        };
        let model = LinearModel::new(turn, VerticalChannel::Held);
        let linear = model.propagate(&NavErrors::none(), &sensors, time).velocity;
        let navigated = navigated(&turn, &error, time).unwrap();
        assert_close!((navigated - linear.components()).norm(), 0.0, 1e-4 * navigated.norm());
        assert!(navigated.xy().norm() > 0.05);
    }

    #[test]
    fn equal_scale_errors_leave_the_bias_along_the_axis_alone() {
        let turn = turn(ATTITUDES[0], 10.0);
        let equal = TriadError { bias: Vector3::repeat(100.0 * MICRO_G), ..TriadError::default() }
            .with_scale(Axis::X, 100.0 * PPM)
            .with_scale(Axis::Y, 100.0 * PPM)
            .with_scale(Axis::Z, 100.0 * PPM);
        let left = integrated(&turn, &equal, 360.0);
        let expected = along_the_axis(&turn, 100.0 * MICRO_G, 360.0);
        assert_close!((left.xy() - expected.components().xy()).norm(), 0.0, 1e-12);
        assert!(left.xy().norm() > 0.2);
    }
}
