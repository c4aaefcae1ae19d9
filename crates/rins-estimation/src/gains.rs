//! What attitude, velocity and readings gain over an epoch: a number for each column.
#![expect(
    clippy::inline_always,
    reason = "what is not inlined is compiled without the vector instructions"
)]

use nalgebra::{Matrix3, SVector, Vector3};
use rins_lanes::{Arch, Lane, Matrix, Real, Simd, Vector, WithSimd};
use rins_terms::{Signals, Surroundings};

/// Rows are filled up with zeros to whole vectors of the widest machine.
pub(crate) const WIDEST: usize = 8;

/// Three components of each of three gains.
pub(crate) const ROWS: usize = 9;

/// What the columns gain over an epoch: that of what was read beyond the model, then one a parameter, the derivative
/// by it.
///
/// Nine rows, a number a column: what φ gains, what v gains, and what is shown of the attitude, the mean over
/// the readings of φ and of what they are predicted to be beyond it, less what they were.
#[derive(Clone, Debug)]
pub(crate) struct Gains {
    columns: usize,
    width: usize,
    numbers: Vec<f64>,
}

impl Gains {
    /// Of so many columns, nothing.
    pub(crate) fn none(columns: usize) -> Self {
        let width = columns.next_multiple_of(WIDEST);
        Self { columns, width, numbers: vec![0.0; ROWS * width] }
    }

    /// What φ and v gain: six rows.
    pub(crate) fn navigation(&self) -> &[f64] {
        &self.numbers[..6 * self.width]
    }

    /// What is shown of the attitude: three rows.
    pub(crate) fn shown(&self) -> &[f64] {
        &self.numbers[6 * self.width..]
    }

    /// A column: what φ and v gain, and what is shown of the attitude.
    pub(crate) fn column(&self, column: usize) -> SVector<f64, ROWS> {
        SVector::from_fn(|row, _| self.numbers[row * self.width + column])
    }

    /// The columns summed up into one, each times its weight.
    pub(crate) fn combined(&self, weights: &[f64]) -> Self {
        let mut sum = Self::none(1);
        let rows = self.numbers.chunks_exact(self.width);
        for (row, to) in rows.zip(sum.numbers.chunks_exact_mut(WIDEST)) {
            to[0] = row.iter().zip(weights).map(|(number, weight)| number * weight).sum();
        }
        sum
    }

    /// The same with columns more: copies of these, and such of nothing.
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

/// What surrounds the table, as kernels take it.
#[derive(Clone, Copy, Debug)]
struct Around {
    earth_rate: [f64; 3],
    force: [f64; 3],
}

/// The rates of one column, or of several side by side: of φ, of v, and what a reading differs by.
struct Rates<T> {
    attitude: Vector<T>,
    velocity: Vector<T>,
    reading: Vector<T>,
}

/// What one column, or several, have gained since the epoch began; what is shown is summed up over the readings.
#[derive(Clone, Copy, Debug)]
struct Gained<T> {
    attitude: Vector<T>,
    velocity: Vector<T>,
    shown: Vector<T>,
}

impl<T: Real> Gained<T> {
    /// So many more samples, over which the rates are the same; what a reading differs by goes evenly from what it
    /// was `before` to what it is.
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
        // φ' = -E × φ + rate, over a time too short for the square of its turn to count.
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

/// The gains of an epoch in the making.
pub(crate) struct Growing {
    columns: usize,
    width: usize,
    /// Of what was read beyond the model.
    residual: Gained<f64>,
    /// Nine rows of what the parameters' columns have gained.
    gained: Vec<f64>,
    /// What a parameter adds to gyros and accelerometers, in body axes, and to a reading: nine rows, and the last three
    /// as they were before.
    by: Vec<f64>,
    before: Vec<f64>,
}

/// What turns what a column adds into what was true, in the axis frame: of gyros and accelerometers.
pub(crate) type Turned = [Matrix3<f64>; 2];

impl Growing {
    /// Of so many parameters.
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

    /// What the parameter of this place adds to what is read: its signals' derivatives.
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

    /// What readings differ by is from now on where the parameters have it.
    pub(crate) fn begin(&mut self) {
        self.before.copy_from_slice(&self.by[6 * self.width..]);
    }

    /// One more sample of what was read beyond the model: rates in the axis frame, and what a reading was less.
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

    /// So many more samples, taken as one, of the parameters' columns.
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

    /// The gains of an epoch of so many readings; the next one begins.
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

/// The columns of a piece, as many at once as the machine's vectors hold.
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
            // One after the other: `map` of an array is not always inlined, and then has no vector instructions.
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
