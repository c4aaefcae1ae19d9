//! A filter with any number of constants on a table that rotates forth and back, step by step.

use rins_calibration::structured::{
    Comparison, Covariance, Input, Means, NAVIGATION, States, Transition, With,
};
use rins_lanes::{Matrix, Vector, rotation};

/// 200 Hz \[s\].
const INTERVAL: f64 = 0.005;

/// One revolution forward in one second, and one backward.
const PERIOD: usize = 400;

/// The table's rate \[rad/s\].
const RATE: f64 = core::f64::consts::TAU;

const VELOCITY_NOISE: f64 = 1e-4;
/// Noise densities of accelerometers \[m/s²/√Hz\] and gyros \[rad/s/√Hz\].
const DENSITIES: [f64; 2] = [3e-4, 6e-6];

/// The first twelve constants are errors of the gyros, the others of the accelerometers.
const OF_GYROS: usize = NAVIGATION + 12;

/// Constants that affect the three sensors in turn.
#[derive(Clone, Copy, Debug)]
pub(crate) enum InTurn {}

impl<const N: usize> States<N> for InTurn {
    const INPUTS: [Input; N] = {
        let mut inputs = [Input::None; N];
        let mut index = NAVIGATION;
        while index < N {
            inputs[index] =
                if index < OF_GYROS { Input::Gyro(index % 3) } else { Input::Accel(index % 3) };
            index += 1;
        }
        inputs
    };
    const AXIS: Option<usize> = None;
}

/// The inputs of one step of the period.
#[derive(Clone, Copy, Debug)]
struct Step<const N: usize> {
    means: Means<f64>,
    regressors: [f64; N],
    comparison: Comparison<f64, N>,
}

impl<const N: usize> Step<N> {
    fn at(index: usize) -> Self {
        let half = PERIOD / 2;
        let (rate, done) = if index < half { (RATE, index) } else { (-RATE, PERIOD - index) };
        let angle = RATE * INTERVAL * done as f64;
        let tilted = rotation::exp(&Vector([0.3, 0.4, 0.2]));
        let nav_from_body = tilted * rotation::exp(&Vector([0.0, 0.0, angle]));
        let (sin, cos) = 0.6_f64.sin_cos();
        let means = Means {
            interval: INTERVAL,
            curvatures: [1.0 / 6.35e6, 1.0 / 6.39e6],
            latitude: [sin, cos],
            velocity: Vector([0.0; 3]),
            gravity: 9.8,
            specific_force: Vector([0.01, -0.02, 9.8]),
            nav_from_body,
        };
        // In proportion to the rate, constant, and with harmonics of the angle.
        let regressors = core::array::from_fn(|index| {
            let (first, of_rate) =
                if index < OF_GYROS { (NAVIGATION, rate) } else { (OF_GYROS, 1.0) };
            match index.saturating_sub(first) / 3 {
                0 => of_rate,
                kind => 0.1 * (0.5 * kind as f64 * angle + kind as f64).cos(),
            }
        });
        let gyro = DENSITIES[1] * DENSITIES[1];
        let earth_rate = Vector([0.0, 6e-5, 4e-5]);
        let comparison = Comparison {
            difference: Vector([1e-6, -2e-6, 3e-6]),
            by_attitude: nav_from_body.transpose() * Matrix::cross(&earth_rate),
            with: With::Rates(regressors),
            noise: [gyro / INTERVAL; 3],
            cross: Some(nav_from_body.scaled(-gyro)),
        };
        Self { means, regressors, comparison }
    }
}

/// The filter, and its place in the period.
#[derive(Clone, Debug)]
pub(crate) struct Soak<const N: usize> {
    steps: Vec<Step<N>>,
    pub(crate) covariance: Covariance<f64, N>,
    done: usize,
    /// The sum of innovations and corrections, so that the compiler cannot omit any of them.
    sum: f64,
}

impl<const N: usize> Soak<N> {
    /// A filter before its first step.
    pub(crate) fn new() -> Self {
        let sigma = |index: usize| if index < 3 { 1e-9 } else { 1e-4 };
        let prior = |row, column| if row == column { sigma(row) * sigma(row) } else { 0.0 };
        Self {
            steps: (0..PERIOD).map(Step::at).collect(),
            covariance: Covariance::from_fn(0.0, prior),
            done: 0,
            sum: 0.0,
        }
    }

    /// One prediction and one update by six rows.
    #[inline]
    pub(crate) fn step(&mut self) {
        let Step { means, regressors, comparison } = &self.steps[self.done % PERIOD];
        Transition::<f64, InTurn, N>::new(means, *regressors, DENSITIES)
            .carry(&mut self.covariance);
        let velocity = Vector([1e-5, 2e-5, -3e-5]);
        let found = self.covariance.update::<InTurn>(comparison, &velocity, VELOCITY_NOISE);
        self.sum += found.state[N - 1] + found.whitened[5];
        self.done += 1;
    }

    /// The defect of the covariance, if there is one.
    pub(crate) fn fault(&self) -> Option<String> {
        let p = &self.covariance;
        let mut lower = [[0.0; N]; N];
        for row in 0..N {
            for column in 0..=row {
                if p.get(row, column).to_bits() != p.get(column, row).to_bits() {
                    return Some(format!(
                        "({row}, {column}) is not its mirror's after {}",
                        self.done
                    ));
                }
                let (above, below) = lower.split_at(row);
                let other = if column < row { &above[column] } else { &below[0] };
                let known: f64 = below[0][..column].iter().zip(other).map(|(a, b)| a * b).sum();
                let left = p.get(row, column) - known;
                if row == column && (left.is_nan() || left <= 0.0) {
                    return Some(format!("state {row} has {left:e} left after {}", self.done));
                }
                lower[row][column] = if row == column { left.sqrt() } else { left / other[column] };
            }
        }
        self.sum.is_nan().then(|| format!("a correction is no number after {}", self.done))
    }

    /// The standard deviation of a state.
    pub(crate) fn sigma(&self, state: usize) -> f64 {
        self.covariance.get(state, state).sqrt()
    }
}
