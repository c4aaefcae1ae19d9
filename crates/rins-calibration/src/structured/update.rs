//! The measurements of zero velocity and of the table in a sample, and the correction by both.

use rins_lanes::{Matrix, Real, Vector};

use super::covariance::Covariance;
use super::measurement::{Correction, Rows};
use super::transition::{Input, States};
use super::{ATTITUDE, NAVIGATION, POSITION, VELOCITY};

/// The three measurement rows of the table: `H`, noise, and measured difference.
#[derive(Clone, Copy, Debug)]
pub struct Comparison<T, const N: usize> {
    /// Computed minus measured.
    pub difference: Vector<T>,
    /// The derivative by the attitude error ψ; its first two columns are also that by the position's δθ.
    pub by_attitude: Matrix<T>,
    /// The derivative by the constants.
    pub with: With<T, N>,
    /// The variances of the three rows.
    pub noise: [f64; 3],
    /// The covariance of ψ's error with the noise of the rows, if it is not zero.
    pub cross: Option<Matrix<T>>,
}

/// The reference of the three rows apart from the attitude.
#[derive(Clone, Copy, Debug)]
pub enum With<T, const N: usize> {
    /// The attitude of the axis frame: its error has the same derivative as ψ with the opposite sign.
    Axis,
    /// The gyros' rates: the effect of a unit of each constant on its gyro.
    Rates([T; N]),
}

/// The result of an update.
#[derive(Clone, Copy, Debug)]
pub struct UpdateResult<T, const N: usize> {
    /// The whitened innovations: independent and N(0, 1) if the model is correct.
    pub whitened: [T; 6],
    /// The inverse standard deviations of the innovations, each conditional on those before it; NaN if their covariance is
    /// not positive definite.
    pub inverse_scales: [T; 6],
    /// The estimated errors of the states.
    pub state: [T; N],
}

impl<T: Real, const N: usize> Covariance<T, N> {
    /// Corrects the covariance by the zero velocity measurement, Z1, with this error `velocity` of the computed velocity and
    /// this noise \[m/s\], and then by three further rows.
    #[inline(always)]
    pub fn update<M: States<N>>(
        &mut self,
        comparison: &Comparison<T, N>,
        velocity: &Vector<T>,
        velocity_noise: f64,
    ) -> UpdateResult<T, N> {
        let zero_velocity = velocity_noise * velocity_noise;
        let mut with_state =
            [self.rows[VELOCITY], self.rows[VELOCITY + 1], self.rows[VELOCITY + 2]];
        let mut s = crossing(&with_state, VELOCITY);
        for axis in 0..3 {
            s[axis][axis] = s[axis][axis] + zero_velocity;
        }
        let first = Correction::new(&mut with_state, lower(&s));
        let first_whitened = first.whiten(velocity);
        first.reduce(self);
        let mut state = [velocity[0].constant(0.0); N];
        first.add_to(&mut state, &first_whitened);

        let mut with_state = comparison.with_state::<M>(self);
        let innovation = comparison.innovation::<M>(&with_state);
        let second = Correction::new(&mut with_state, innovation);
        let expected = comparison.rows_of::<M>(&state);
        let second_whitened = second.whiten(&(comparison.difference - expected));
        second.reduce(self);
        second.add_to(&mut state, &second_whitened);
        let ([a, b, c], [d, e, f]) = (first_whitened.0, second_whitened.0);
        let ([i, j, k], [l, m, n]) = (first.inverse_scales, second.inverse_scales);
        UpdateResult { whitened: [a, b, c, d, e, f], inverse_scales: [i, j, k, l, m, n], state }
    }

    /// The ratios of the variances of the predicted measurements, with correlations between states neglected, to the noise
    /// variances: of zero velocity, then of the three rows.
    #[inline(always)]
    pub fn ratios<M: States<N>>(
        &self,
        comparison: &Comparison<T, N>,
        velocity_noise: f64,
    ) -> [T; 6] {
        let like = self.rows[0][0];
        let mut ratios = [like.constant(0.0); 6];
        let zero_velocity = 1.0 / (velocity_noise * velocity_noise);
        let mut attitude = ratios;
        for axis in 0..3 {
            let variance = |index: usize| self.rows[index][index];
            ratios[axis] = variance(VELOCITY + axis) * zero_velocity;
            let mut sum = variance(ATTITUDE + axis);
            if axis < 2 {
                sum = sum + variance(POSITION + axis);
            }
            if let (With::Axis, Some(first)) = (&comparison.with, M::AXIS) {
                sum = sum + variance(first + axis);
            }
            attitude[axis] = sum;
        }
        for row in 0..3 {
            let by = &comparison.by_attitude[row];
            let mut sum = like.constant(0.0);
            for axis in 0..3 {
                sum = sum + by[axis] * by[axis] * attitude[axis];
            }
            if let With::Rates(amounts) = &comparison.with {
                for index in NAVIGATION..N {
                    if M::INPUTS[index] == Input::Gyro(row) {
                        sum = sum + amounts[index] * amounts[index] * self.rows[index][index];
                    }
                }
            }
            ratios[3 + row] = sum * (1.0 / comparison.noise[row]);
        }
        ratios
    }
}

impl<T: Real, const N: usize> Comparison<T, N> {
    /// `H` times a column over all states.
    #[inline(always)]
    fn rows_of<M: States<N>>(&self, column: &[T; N]) -> Vector<T> {
        let mut attitude = Vector([column[6], column[7], column[8]]);
        attitude[0] = attitude[0] + column[0];
        attitude[1] = attitude[1] + column[1];
        match (&self.with, M::AXIS) {
            (With::Rates(amounts), _) => {
                let mut rows = self.by_attitude * attitude;
                for index in NAVIGATION..N {
                    if let Input::Gyro(axis) = M::INPUTS[index] {
                        rows[axis] = rows[axis] + column[index] * amounts[index];
                    }
                }
                rows
            }
            (With::Axis, Some(first)) => {
                for axis in 0..3 {
                    attitude[axis] = attitude[axis] - column[first + axis];
                }
                self.by_attitude * attitude
            }
            (With::Axis, None) => self.by_attitude * attitude,
        }
    }

    /// `(P Hᵀ + C)ᵀ` of the three rows.
    #[inline(always)]
    fn with_state<M: States<N>>(&self, p: &Covariance<T, N>) -> Rows<T, N> {
        let mut rows = [p.rows[0]; 3];
        for j in 0..N {
            let mut attitude =
                Vector([p.rows[6][j] + p.rows[0][j], p.rows[7][j] + p.rows[1][j], p.rows[8][j]]);
            if let (With::Axis, Some(first)) = (&self.with, M::AXIS) {
                for axis in 0..3 {
                    attitude[axis] = attitude[axis] - p.rows[first + axis][j];
                }
            }
            let seen = self.by_attitude * attitude;
            for row in 0..3 {
                rows[row][j] = seen[row];
            }
        }
        if let With::Rates(amounts) = &self.with {
            for index in NAVIGATION..N {
                if let Input::Gyro(axis) = M::INPUTS[index] {
                    for j in 0..N {
                        rows[axis][j] = rows[axis][j] + p.rows[index][j] * amounts[index];
                    }
                }
            }
        }
        if let Some(cross) = &self.cross {
            for axis in 0..3 {
                for row in 0..3 {
                    rows[row][ATTITUDE + axis] = rows[row][ATTITUDE + axis] + cross[axis][row];
                }
            }
        }
        rows
    }

    /// `S = H (P Hᵀ + C) + Cᵀ Hᵀ + R`, its lower triangle row by row.
    #[inline(always)]
    fn innovation<M: States<N>>(&self, with_state: &Rows<T, N>) -> [T; 6] {
        let mut s = [[with_state[0][0]; 3]; 3];
        for k in 0..3 {
            // The k-th column of S, which is also its k-th row.
            s[k] = self.rows_of::<M>(&with_state[k]).0;
        }
        if let Some(cross) = &self.cross {
            let more = self.by_attitude * *cross;
            for row in 0..3 {
                for column in 0..=row {
                    s[row][column] = s[row][column] + more[row][column];
                }
            }
        }
        for row in 0..3 {
            s[row][row] = s[row][row] + self.noise[row];
        }
        lower(&s)
    }
}

/// The block where three rows intersect three columns.
#[inline(always)]
fn crossing<T: Real, const N: usize>(rows: &Rows<T, N>, first: usize) -> [[T; 3]; 3] {
    let mut block = [[rows[0][0]; 3]; 3];
    for row in 0..3 {
        for column in 0..3 {
            block[row][column] = rows[row][first + column];
        }
    }
    block
}

/// The lower triangle, row by row.
#[inline(always)]
const fn lower<T: Copy>(s: &[[T; 3]; 3]) -> [T; 6] {
    [s[0][0], s[1][0], s[1][1], s[2][0], s[2][1], s[2][2]]
}
