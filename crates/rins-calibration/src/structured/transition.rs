//! The prediction: eqs. (11)-(15) over one interval, as a product of sparse factors.

use core::marker::PhantomData;

use rins_frames::EARTH_RATE;
use rins_lanes::{Matrix, Real, Vector};

use super::covariance::Covariance;
use super::measurement::Rows;
use super::{ATTITUDE, NAVIGATION, POSITION, VELOCITY};

/// The sensor that a constant affects, along a body axis, or none.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Input {
    /// A gyro.
    Gyro(usize),
    /// An accelerometer.
    Accel(usize),
    /// No sensor: the constant affects only the measurements.
    None,
}

impl Input {
    /// The gyro that it affects, if any.
    const fn gyro(self) -> Option<usize> {
        if let Self::Gyro(axis) = self { Some(axis) } else { None }
    }

    /// The accelerometer that it affects, if any.
    const fn accel(self) -> Option<usize> {
        if let Self::Accel(axis) = self { Some(axis) } else { None }
    }
}

/// The states of a filter, known at compile time: nine navigation errors, then constants.
pub trait States<const N: usize> {
    /// The sensor that each constant affects; the elements of the navigation errors are not used.
    const INPUTS: [Input; N];
    /// The place of the axis frame's three attitude errors, if they are among the constants.
    const AXIS: Option<usize>;
}

/// The transition of the errors over one interval: `Φ = Θ Ψ V Θ`.
///
/// The factors are half of the position's change, then the velocity's with the attitude at the middle, then the attitude's,
/// then the other half of the position's. The product is `exp(F T)` to second order in all fast terms; the neglected
/// second-order products of the Earth's rate and the curvature are below 10⁻¹¹.
#[derive(Clone, Copy, Debug)]
pub struct Transition<T, M, const N: usize> {
    /// The change of an angle per unit velocity in half an interval \[s/m\].
    half_angle: T,
    /// The change of a height per unit velocity in half an interval \[s\].
    half_rise: f64,
    /// The relative decrease of the angles by climbing in half an interval.
    shrink: T,
    /// Velocity by position: the three nonzero elements, by `δθ_y`, `δθ_x` and `δh`.
    weight: [T; 3],
    /// Velocity by velocity.
    coriolis: Vector<T>,
    /// Velocity by attitude.
    force: Matrix<T>,
    /// Attitude by attitude.
    nav_turn: Vector<T>,
    /// Attitude by the gyros' errors.
    turn_by_gyro: Matrix<T>,
    /// Velocity by the accelerometers' errors.
    push_by_accel: Matrix<T>,
    /// The effect of one unit of each constant on its sensor, as a mean rate or force.
    regressors: [T; N],
    /// The variance that an interval adds to each velocity \[m²/s²\] and each attitude \[rad²\].
    noise: [f64; 2],
    constants: PhantomData<M>,
}

/// The means over an interval that determine the error dynamics.
#[derive(Clone, Copy, Debug)]
pub struct Means<T> {
    /// The interval \[s\].
    pub interval: f64,
    /// `1 / (R_M + h)` and `1 / (R_N + h)` \[1/m\].
    pub curvatures: [T; 2],
    /// The sine and cosine of the latitude.
    pub latitude: [T; 2],
    /// \[m/s\], in n.
    pub velocity: Vector<T>,
    /// Gravity's magnitude \[m/s²\].
    pub gravity: f64,
    /// `f^n` \[m/s²\].
    pub specific_force: Vector<T>,
    /// `C_b^n`.
    pub nav_from_body: Matrix<T>,
}

impl<T: Real, M: States<N>, const N: usize> Transition<T, M, N> {
    /// The transition for these means. A unit of each constant changes its sensor by `regressors`, and accelerometers and
    /// gyros have white noise of these densities.
    #[inline(always)]
    pub fn new(
        means: &Means<T>,
        regressors: [T; N],
        [accel_density, gyro_density]: [f64; 2],
    ) -> Self {
        let Means { interval, curvatures: [meridian, transverse], velocity, gravity, .. } = *means;
        let [sin, cos] = means.latitude;
        let zero = sin.constant(0.0);
        let earth = Vector([zero, cos * EARTH_RATE, sin * EARTH_RATE]);
        let east = velocity[0] * transverse;
        let transport = Vector([-(velocity[1] * meridian), east, east * sin / cos]);
        let nav_rate = earth + transport;
        let weight = sin.constant(gravity * interval);
        let force = Matrix::cross(&means.specific_force.scaled(interval));
        let turn_by_gyro = means.nav_from_body.scaled(-interval);
        let nav_turn = nav_rate.scaled(-interval);
        Self {
            half_angle: meridian * (0.5 * interval),
            half_rise: 0.5 * interval,
            shrink: velocity[2] * meridian * (-0.5 * interval),
            weight: [-weight, weight, weight * meridian * 2.0],
            coriolis: (earth + nav_rate).scaled(-interval),
            force: force + force * Matrix::cross(&nav_turn.scaled(0.5)),
            nav_turn,
            turn_by_gyro,
            push_by_accel: means.nav_from_body.scaled(interval),
            regressors,
            noise: [
                accel_density * accel_density * interval,
                gyro_density * gyro_density * interval,
            ],
            constants: PhantomData,
        }
    }

    /// Whether any constant affects an accelerometer.
    const PUSHES: bool = {
        let mut any = false;
        let mut index = NAVIGATION;
        while index < N {
            any |= matches!(M::INPUTS[index], Input::Accel(_));
            index += 1;
        }
        any
    };

    /// Propagates the covariance over the interval: `Φ P Φᵀ + Q`.
    #[inline(always)]
    pub fn carry(&self, p: &mut Covariance<T, N>) {
        self.half_position(p);
        let mut turns = self.turns(p);
        self.velocity(p, &turns);
        // Of the covariances of the gyros' errors only those with the velocities have changed.
        for k in VELOCITY..VELOCITY + 3 {
            let (gyros, _) = self.sensed_by(&p.rows[k]);
            let turn = self.turn_by_gyro * gyros;
            for axis in 0..3 {
                turns[axis][k] = turn[axis];
            }
        }
        self.attitude(p, &turns);
        self.half_position(p);
        let [of_velocity, of_attitude] = self.noise;
        for axis in 0..3 {
            let (v, a) = (VELOCITY + axis, ATTITUDE + axis);
            p.rows[v][v] = p.rows[v][v] + of_velocity;
            p.rows[a][a] = p.rows[a][a] + of_attitude;
        }
    }

    /// The propagation of one column of errors: `Φ x`.
    #[inline(always)]
    pub fn times(&self, mut x: [T; N]) -> [T; N] {
        let half_way = |x: &mut [T; N]| {
            let moved = self.moved([x[0], x[1], x[2]], [x[3], x[4], x[5]]);
            x[POSITION..POSITION + 3].copy_from_slice(&moved);
        };
        half_way(&mut x);
        let (gyros, accels) = self.sensed_by(&x);
        let column = [x[0], x[1], x[2], x[3], x[4], x[5], x[6], x[7], x[8]];
        let turn = self.turn_by_gyro * gyros;
        let pushed = self.pushed(column, &turn, &accels);
        x[VELOCITY..VELOCITY + 3].copy_from_slice(&pushed.0);
        let turned = self.turned(&Vector([x[6], x[7], x[8]]), &turn);
        x[ATTITUDE..ATTITUDE + 3].copy_from_slice(&turned.0);
        half_way(&mut x);
        x
    }

    /// The variance that the interval adds to each velocity \[m²/s²\] and to each attitude \[rad²\].
    pub const fn noise(&self) -> [f64; 2] {
        self.noise
    }

    /// Three position errors with these velocity errors after half an interval.
    #[inline(always)]
    fn moved(&self, [x, y, up]: [T; 3], [east, north, rise]: [T; 3]) -> [T; 3] {
        [
            x + x * self.shrink - north * self.half_angle,
            y + y * self.shrink + east * self.half_angle,
            up + rise * self.half_rise,
        ]
    }

    #[inline(always)]
    fn half_position(&self, p: &mut Covariance<T, N>) {
        for j in 0..N {
            let column = [p.rows[0][j], p.rows[1][j], p.rows[2][j]];
            let [x, y, up] = self.moved(column, [p.rows[3][j], p.rows[4][j], p.rows[5][j]]);
            p.rows[0][j] = x;
            p.rows[1][j] = y;
            p.rows[2][j] = up;
        }
        // Where the rows intersect their own columns, these change as well.
        let mut crossing = [[p.rows[0][0]; 3]; 3];
        for k in 0..3 {
            let row = &p.rows[k];
            crossing[k] = self.moved([row[0], row[1], row[2]], [row[3], row[4], row[5]]);
        }
        p.set_crossing(POSITION, &crossing);
        p.mirror(POSITION);
    }

    /// The covariances with every state of the constants' effects on the sensors along `kind`'s axes.
    #[inline(always)]
    fn sensed(&self, p: &Covariance<T, N>, kind: fn(Input) -> Option<usize>) -> Rows<T, N> {
        let mut sums = [[self.half_angle.constant(0.0); N]; 3];
        let mut begun = [false; 3];
        for index in NAVIGATION..N {
            let Some(axis) = kind(M::INPUTS[index]) else { continue };
            let (sum, amount) = (&mut sums[axis], self.regressors[index]);
            if begun[axis] {
                for j in 0..N {
                    sum[j] = sum[j] + p.rows[index][j] * amount;
                }
            } else {
                for j in 0..N {
                    sum[j] = p.rows[index][j] * amount;
                }
            }
            begun[axis] = true;
        }
        sums
    }

    /// The same with one state, whose covariances are in `row`.
    #[inline(always)]
    fn sensed_by(&self, row: &[T; N]) -> (Vector<T>, Vector<T>) {
        let (mut gyros, mut accels) = (Vector::zeros(row[0]), Vector::zeros(row[0]));
        for index in NAVIGATION..N {
            let (sum, amount) = match M::INPUTS[index] {
                Input::Gyro(axis) => (&mut gyros[axis], self.regressors[index]),
                Input::Accel(axis) => (&mut accels[axis], self.regressors[index]),
                Input::None => continue,
            };
            *sum = *sum + row[index] * amount;
        }
        (gyros, accels)
    }

    /// The velocity error after the interval for one column of any matrix, from nine navigation errors, the rotation by the
    /// gyros' errors, and the accelerometers' errors.
    #[inline(always)]
    fn pushed(&self, column: [T; NAVIGATION], turn: &Vector<T>, accels: &Vector<T>) -> Vector<T> {
        let [x, y, up, east, north, rise, ..] = column;
        let attitude = Vector([column[6], column[7], column[8]]);
        let [by_y, by_x, by_height] = self.weight;
        let velocity = Vector([east, north, rise]);
        // The attitude at the middle of the interval.
        let pushed = Vector([y * by_y, x * by_x, up * by_height])
            + self.coriolis.cross(&velocity)
            + self.force * (attitude + turn.scaled(0.5));
        velocity + if Self::PUSHES { pushed + self.push_by_accel * *accels } else { pushed }
    }

    /// Propagates the velocities; `turns` are the covariances of the rotation by the gyros' errors with every state before.
    #[inline(always)]
    fn velocity(&self, p: &mut Covariance<T, N>, turns: &Rows<T, N>) {
        let accels = if Self::PUSHES { self.sensed(p, Input::accel) } else { *turns };
        for j in 0..N {
            let r = &p.rows;
            let column =
                [r[0][j], r[1][j], r[2][j], r[3][j], r[4][j], r[5][j], r[6][j], r[7][j], r[8][j]];
            let turn = Vector([turns[0][j], turns[1][j], turns[2][j]]);
            let accels = Vector([accels[0][j], accels[1][j], accels[2][j]]);
            let after = self.pushed(column, &turn, &accels);
            p.rows[VELOCITY][j] = after[0];
            p.rows[VELOCITY + 1][j] = after[1];
            p.rows[VELOCITY + 2][j] = after[2];
        }
        let mut crossing = [[self.half_angle; 3]; 3];
        for k in 0..3 {
            let row = &p.rows[VELOCITY + k];
            let (gyros, accels) = self.sensed_by(row);
            let column = [row[0], row[1], row[2], row[3], row[4], row[5], row[6], row[7], row[8]];
            crossing[k] = self.pushed(column, &(self.turn_by_gyro * gyros), &accels).0;
        }
        p.set_crossing(VELOCITY, &crossing);
        p.mirror(VELOCITY);
    }

    /// The covariances of the rotation by the gyros' errors over the interval with every state.
    #[inline(always)]
    fn turns(&self, p: &Covariance<T, N>) -> Rows<T, N> {
        let mut turns = self.sensed(p, Input::gyro);
        let [a, b, c] = &mut turns;
        for j in 0..N {
            let turn = self.turn_by_gyro * Vector([a[j], b[j], c[j]]);
            a[j] = turn[0];
            b[j] = turn[1];
            c[j] = turn[2];
        }
        turns
    }

    /// The attitude error after the interval.
    #[inline(always)]
    fn turned(&self, attitude: &Vector<T>, turn: &Vector<T>) -> Vector<T> {
        *attitude + self.nav_turn.cross(attitude) + *turn
    }

    /// Propagates the attitudes in the same way.
    #[inline(always)]
    fn attitude(&self, p: &mut Covariance<T, N>, turns: &Rows<T, N>) {
        for j in 0..N {
            let column = Vector([p.rows[6][j], p.rows[7][j], p.rows[8][j]]);
            let after = self.turned(&column, &Vector([turns[0][j], turns[1][j], turns[2][j]]));
            p.rows[6][j] = after[0];
            p.rows[7][j] = after[1];
            p.rows[8][j] = after[2];
        }
        let mut crossing = [[self.half_angle; 3]; 3];
        for k in 0..3 {
            let row = &p.rows[ATTITUDE + k];
            let (gyros, _) = self.sensed_by(row);
            let turn = self.turn_by_gyro * gyros;
            crossing[k] = self.turned(&Vector([row[6], row[7], row[8]]), &turn).0;
        }
        p.set_crossing(ATTITUDE, &crossing);
        p.mirror(ATTITUDE);
    }
}
