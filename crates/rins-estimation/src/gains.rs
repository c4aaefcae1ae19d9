//! Gains: the changes of attitude error, velocity error and attitude measurement over an epoch, one number for each column.
#![expect(
    clippy::inline_always,
    reason = "what is not inlined is compiled without the vector instructions"
)]

use nalgebra::{Matrix3, SVector, Vector3};
use rins_lanes::{Arch, Lane, Matrix, Real, Simd, Vector, WithSimd};
use rins_terms::{Signals, Surroundings};

/// Rows are padded with zeros to whole SIMD vectors of the widest machine.
pub(crate) const WIDEST: usize = 8;

/// The number of rows: three components of each of three gains.
pub(crate) const ROWS: usize = 9;

/// The gains of the columns over an epoch: first the column of the residuals of the readings, then a column for each parameter,
/// the derivative by it.
///
/// There are nine rows with a number for each column: the change of φ, the change of v, and the attitude measurement. The
/// latter is the mean over the readings of φ and of the predicted minus the actual reading.
#[derive(Clone, Debug)]
pub(crate) struct Gains {
    columns: usize,
    width: usize,
    numbers: Vec<f64>,
}

impl Gains {
    /// Zero gains of this number of columns.
    pub(crate) fn none(columns: usize) -> Self {
        let width = columns.next_multiple_of(WIDEST);
        Self { columns, width, numbers: vec![0.0; ROWS * width] }
    }

    /// The changes of φ and v: six rows.
    pub(crate) fn navigation(&self) -> &[f64] {
        &self.numbers[..6 * self.width]
    }

    /// The attitude measurement: three rows.
    pub(crate) fn shown(&self) -> &[f64] {
        &self.numbers[6 * self.width..]
    }

    /// A column: the changes of φ and v, and the attitude measurement.
    pub(crate) fn column(&self, column: usize) -> SVector<f64, ROWS> {
        SVector::from_fn(|row, _| self.numbers[row * self.width + column])
    }

    /// The weighted sum of the columns, as one column.
    pub(crate) fn combined(&self, weights: &[f64]) -> Self {
        let mut sum = Self::none(1);
        let rows = self.numbers.chunks_exact(self.width);
        for (row, to) in rows.zip(sum.numbers.chunks_exact_mut(WIDEST)) {
            to[0] = row.iter().zip(weights).map(|(number, weight)| number * weight).sum();
        }
        sum
    }

    /// The same with additional columns: copies of the given columns, or zeros for `None`.
    #[must_use]
    pub(crate) fn with(&self, more: &[Option<usize>]) -> Self {
        let mut all = Self::none(self.columns + more.len());
        let rows = self.numbers.chunks_exact(self.width);
        for (row, to) in rows.zip(all.numbers.chunks_exact_mut(all.width)) {
            to[..self.columns].copy_from_slice(&row[..self.columns]);
            for (to, from) in to[self.columns..].iter_mut().zip(more) {
                *to = from.map_or(0.0, |column| row[column]);
            }
        }
        all
    }
}

/// The Earth's rate and the specific force in the axis frame, in the form for kernels.
#[derive(Clone, Copy, Debug)]
struct Around {
    earth_rate: [f64; 3],
    force: [f64; 3],
}

/// The rates of change of one column or of several in parallel: of φ, of v, and the error of a reading.
struct Rates<T> {
    attitude: Vector<T>,
    velocity: Vector<T>,
    reading: Vector<T>,
}

/// The changes of one column, or of several, since the epoch began; those of the measurement are summed over the readings.
#[derive(Clone, Copy, Debug)]
struct Gained<T> {
    attitude: Vector<T>,
    velocity: Vector<T>,
    shown: Vector<T>,
}

impl<T: Real> Gained<T> {
    /// Adds `samples` samples with constant rates. The error of a reading changes linearly from `before` to its new value.
    #[inline(always)]
    fn add(
        &mut self,
        rates: &Rates<T>,
        before: &Vector<T>,
        around: &Around,
        (interval, samples): (f64, f64),
    ) {
        let like = rates.attitude[0];
        let earth_rate = Vector::constant(like, around.earth_rate);
        let force = Vector::constant(like, around.force);
        // φ' = -E × φ + rate; the interval is so short that second-order terms of the rotation are negligible.
        let halfway = self.attitude + rates.attitude.scaled(0.5 * interval);
        let change = (rates.attitude - earth_rate.cross(&halfway)).scaled(interval);
        let after = self.attitude + change;
        let middle = (self.attitude + after).scaled(0.5);
        self.velocity = self.velocity + (rates.velocity + middle.cross(&force)).scaled(interval);
        self.attitude = after;
        // The readings are at the ends of the samples.
        let missing = change + rates.reading - *before;
        self.shown = self.shown + (after + rates.reading).scaled(samples)
            - missing.scaled(0.5 * (samples - 1.0));
    }
}

/// The gains of an epoch under construction.
pub(crate) struct Growing {
    columns: usize,
    width: usize,
    /// The column of the residuals.
    residual: Gained<f64>,
    /// The columns of the parameters, in nine rows.
    gained: Vec<f64>,
    /// The derivatives by the parameters of gyro and accelerometer readings in body axes and of the attitude reading: nine
    /// rows. `before` holds the last three rows at the previous piece.
    by: Vec<f64>,
    before: Vec<f64>,
}

/// The matrices that convert errors of gyro and accelerometer readings to errors of the true quantities in the axis frame.
pub(crate) type Turned = [Matrix3<f64>; 2];

impl Growing {
    /// Gains for this number of parameters.
    pub(crate) fn new(parameters: usize) -> Self {
        let width = parameters.next_multiple_of(WIDEST);
        let zero = Vector([0.0; 3]);
        Self {
            columns: parameters,
            width,
            residual: Gained { attitude: zero, velocity: zero, shown: zero },
            gained: vec![0.0; ROWS * width],
            by: vec![0.0; ROWS * width],
            before: vec![0.0; 3 * width],
        }
    }

    /// Sets the derivatives of the readings by a parameter: the derivatives of its signals.
    pub(crate) fn set(&mut self, parameter: usize, by: &Signals) {
        let numbers = [
            by.gyro[0].eps,
            by.gyro[1].eps,
            by.gyro[2].eps,
            by.accel[0].eps,
            by.accel[1].eps,
            by.accel[2].eps,
            -by.tilt[0].eps,
            -by.tilt[1].eps,
            by.angle.eps - by.tilt[2].eps,
        ];
        for (row, number) in self.by.chunks_exact_mut(self.width).zip(numbers) {
            row[parameter] = number;
        }
    }

    /// Starts the errors of the attitude readings at their current derivatives.
    pub(crate) fn begin(&mut self) {
        self.before.copy_from_slice(&self.by[6 * self.width..]);
    }

    /// Adds the residual of one sample: rates in the axis frame, and the predicted minus the actual attitude reading.
    pub(crate) fn add_residual(
        &mut self,
        [attitude, velocity, reading]: [Vector3<f64>; 3],
        surroundings: &Surroundings,
        interval: f64,
    ) {
        let rates =
            Rates { attitude: attitude.into(), velocity: velocity.into(), reading: reading.into() };
        let before = rates.reading;
        self.residual.add(&rates, &before, &Around::of(surroundings), (interval, 1.0));
    }

    /// Adds `samples` samples, processed as one, to the columns of the parameters.
    pub(crate) fn add(
        &mut self,
        turned: &Turned,
        surroundings: &Surroundings,
        (interval, samples): (f64, usize),
    ) {
        if self.columns > 0 {
            let around = Around::of(surroundings);
            Arch::new().dispatch(Grow {
                growing: self,
                turned,
                around,
                time: (interval, samples as f64),
            });
        }
    }

    /// The gains of an epoch of this number of readings; starts the next one.
    pub(crate) fn finish(&mut self, readings: f64) -> Gains {
        let mut gains = Gains::none(self.columns + 1);
        let Gained { attitude, velocity, shown } = self.residual;
        let residual = attitude.0.into_iter().chain(velocity.0).chain(shown.0);
        let rows = gains.numbers.chunks_exact_mut(gains.width);
        for (index, (row, residual)) in rows.zip(residual).enumerate() {
            row[0] = residual;
            row[1..=self.columns]
                .copy_from_slice(&self.gained[index * self.width..][..self.columns]);
        }
        for shown in &mut gains.numbers[6 * gains.width..] {
            *shown /= readings;
        }
        let zero = Vector([0.0; 3]);
        self.residual = Gained { attitude: zero, velocity: zero, shown: zero };
        self.gained.fill(0.0);
        gains
    }
}

impl Around {
    fn of(surroundings: &Surroundings) -> Self {
        Self {
            earth_rate: surroundings.earth_rate.into(),
            force: surroundings.specific_force.into(),
        }
    }
}

/// The columns of a piece, with as many in parallel as a SIMD vector holds.
struct Grow<'a> {
    growing: &'a mut Growing,
    turned: &'a Turned,
    around: Around,
    time: (f64, f64),
}

impl WithSimd for Grow<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, simd: S) {
        let Self { growing, turned, around, time } = self;
        let width = growing.width;
        let by = S::as_simd_f64s(&growing.by).0;
        let before = S::as_mut_simd_f64s(&mut growing.before).0;
        let gained = S::as_mut_simd_f64s(&mut growing.gained).0;
        let width = width / S::F64_LANES;
        let vector = |rows: &[S::f64s], first: usize, place: usize| {
            let lane = |row: usize| Lane::new(simd, rows[(first + row) * width + place]);
            // Written out: `map` of an array is not always inlined, and then has no vector instructions.
            Vector([lane(0), lane(1), lane(2)])
        };
        let [of_gyros, of_accels] =
            turned.map(|matrix| Matrix::constant(Lane::splat(simd, 0.0), &matrix));
        for place in 0..width {
            let rates = Rates {
                attitude: -(of_gyros * vector(by, 0, place)),
                velocity: -(of_accels * vector(by, 3, place)),
                reading: vector(by, 6, place),
            };
            let mut sum = Gained {
                attitude: vector(gained, 0, place),
                velocity: vector(gained, 3, place),
                shown: vector(gained, 6, place),
            };
            sum.add(&rates, &vector(before, 0, place), &around, time);
            for (first, numbers) in [(0, sum.attitude), (3, sum.velocity), (6, sum.shown)] {
                for row in 0..3 {
                    gained[(first + row) * width + place] = numbers[row].values();
                }
            }
            for row in 0..3 {
                before[row * width + place] = rates.reading[row].values();
            }
        }
    }
}
