//! Epochs in the making: residuals sample by sample, derivatives piece by piece.

use nalgebra::{Matrix3, Matrix3xX, Vector3};
use rins_terms::{
    Chosen, Dual64, Model, Moment, Moments, Signals, Surroundings, derivatives, values,
};

use crate::linear::{Epoch, Span};
use crate::run::Run;
use crate::sway::Sway;

/// Epochs in the making.
pub(crate) struct Build<'a> {
    run: &'a Run,
    /// The terms that do anything: hundreds may stand by to be tried.
    present: Model,
    /// Of each column the term, and its parameters with a derivative by one of them.
    columns: Vec<(&'a Chosen, Vec<Dual64>)>,
    readings: Option<&'a [f64]>,
    sway: Option<Sway>,
    /// What turns a difference in readings into one in what was true, `(I + [S, M])⁻¹`, of gyros and accelerometers.
    inverse_gains: [Matrix3<f64>; 2],
    /// What each column's reading differed by last.
    last: Vec<Vector3<f64>>,
}

impl<'a> Build<'a> {
    pub(crate) fn new(
        run: &'a Run,
        model: &'a Model,
        free: &'a [(usize, usize)],
        readings: Option<&'a [f64]>,
    ) -> Self {
        let triads = model.split().0;
        let inverse_gains = [triads.gyro.matrix, triads.accel.matrix]
            .map(|matrix| (Matrix3::identity() + matrix).try_inverse().unwrap_or_default());
        let mut present = model.clone();
        present.terms.retain(|chosen| chosen.values.iter().any(|value| *value != 0.0));
        let sway = Sway::of(run);
        let column = |&(term, parameter): &(usize, usize)| {
            let chosen = &model.terms[term];
            let mut duals: Vec<Dual64> =
                chosen.values.iter().map(|&value| Dual64::from_re(value)).collect();
            duals[parameter].eps = 1.0;
            (chosen, duals)
        };
        let columns = free.iter().map(column).collect();
        let last = vec![Vector3::zeros(); free.len()];
        Self { run, present, columns, readings, sway, inverse_gains, last }
    }

    /// An epoch: its residuals sample by sample, its columns piece by piece.
    pub(crate) fn epoch(
        &mut self,
        span: &Span,
        ends: impl Iterator<Item = usize>,
        fine: &mut Moments<'_>,
        pieces: &mut Moments<'_>,
    ) -> Epoch {
        let mut epoch = Epoch::empty(span, self.columns.len() + 1);
        let mut first = span.samples.start;
        for (end, piece) in ends.zip(pieces) {
            let mut from_body = Matrix3::zeros();
            for (sample, moment) in (first..end).zip(&mut *fine) {
                from_body = self.residual(&mut epoch, sample, &moment);
            }
            if end - first > 1 && self.sway.is_none() {
                from_body = turned_by(piece.mean.angle);
            }
            let begins = span.fresh && first == span.samples.start;
            self.columns(&mut epoch, &from_body, &piece, (end - first, begins));
            first = end;
        }
        let count = epoch.count();
        epoch.mean_attitude /= count;
        epoch.mean_turned /= count;
        epoch.reading /= count;
        epoch
    }

    /// What a sample was read beyond the model; the attitude of the body in the axis frame in its middle.
    fn residual(&self, epoch: &mut Epoch, sample: usize, moment: &Moment) -> Matrix3<f64> {
        let measured = &self.run.recording.increments[sample];
        let interval = measured.interval;
        let mut table_from_body = turned_by(moment.mean.angle);
        let predicted = self.present.signals(moment);
        let around = &moment.surroundings;
        let rates = measured.rates();
        let mut gyro = rates.angular_rate.components() - moment.rate;
        let mut accel = rates.specific_force.components() - moment.force;
        let reading = self.readings.map_or(0.0, |readings| readings[sample] - moment.end.angle);
        let mut of_axis = Vector3::z() * (predicted.angle.re - reading) - values(&predicted.tilt);
        if let Some(sway) = &self.sway {
            let [middle, end] = &sway.attitudes[sample];
            gyro = sway.mean_rate - middle.inverse() * around.earth_rate;
            accel = rates.specific_force.components() - middle.inverse() * around.specific_force;
            of_axis += end.scaled_axis();
            table_from_body = *middle.matrix();
        }
        let [of_gyros, of_accels] = self.inverse_gains.map(|inverse| table_from_body * inverse);
        gyro -= values(&predicted.gyro);
        accel -= values(&predicted.accel);
        let rates =
            Rates { attitude: of_gyros * gyro, velocity: of_accels * accel, reading: of_axis };
        epoch.add(0, &rates, around, (interval, 1));
        let mut read = epoch.reading.column_mut(0);
        read += rates.reading;
        epoch.twice_turned += (epoch.turned + table_from_body * (0.5 * interval)) * interval;
        epoch.turned += table_from_body * interval;
        epoch.mean_turned += epoch.turned;
        epoch.duration += interval;
        table_from_body
    }

    /// What some samples, taken as one, add to the derivatives.
    fn columns(
        &mut self,
        epoch: &mut Epoch,
        from_body: &Matrix3<f64>,
        moment: &Moment,
        (samples, begins): (usize, bool),
    ) {
        let [of_gyros, of_accels] = self.inverse_gains.map(|inverse| from_body * inverse);
        for (column, (chosen, duals)) in self.columns.iter().enumerate() {
            let mut by = Signals::default();
            chosen.term.act(duals, &chosen.settings, moment, &mut by);
            let rates = Rates {
                attitude: -(of_gyros * derivatives(&by.gyro)),
                velocity: -(of_accels * derivatives(&by.accel)),
                reading: Vector3::z() * by.angle.eps - derivatives(&by.tilt),
            };
            epoch.add(column + 1, &rates, &moment.surroundings, (moment.interval, samples));
            // From what it was at the end of the piece before, evenly.
            let last = std::mem::replace(&mut self.last[column], rates.reading);
            let before = if begins { rates.reading } else { last };
            let count = samples as f64;
            let mut reading = epoch.reading.column_mut(column + 1);
            reading += rates.reading * count - (rates.reading - before) * (0.5 * (count - 1.0));
        }
    }
}

/// The attitude of a body on a table in the axis frame.
fn turned_by(angle: f64) -> Matrix3<f64> {
    let (sin, cos) = angle.sin_cos();
    Matrix3::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0)
}

/// What one sample adds to one column: rates of φ and v, and what a reading differs by.
struct Rates {
    attitude: Vector3<f64>,
    velocity: Vector3<f64>,
    reading: Vector3<f64>,
}

impl Epoch {
    fn empty(span: &Span, columns: usize) -> Self {
        let none = Matrix3xX::zeros(columns);
        Self {
            samples: (span.samples.start, span.samples.end),
            duration: 0.0,
            fresh: span.fresh,
            left_out: false,
            attitude: none.clone(),
            mean_attitude: none.clone(),
            velocity: none.clone(),
            reading: none,
            turned: Matrix3::zeros(),
            mean_turned: Matrix3::zeros(),
            twice_turned: Matrix3::zeros(),
        }
    }

    /// So many more samples of one column, over which its rates are the same.
    fn add(
        &mut self,
        column: usize,
        rates: &Rates,
        around: &Surroundings,
        (interval, samples): (f64, usize),
    ) {
        let mut attitude = self.attitude.column_mut(column);
        let before = attitude.clone_owned();
        // φ' = -E × φ + rate, over a time too short for the square of its turn to count.
        let turning = around.earth_rate.cross(&(before + rates.attitude * (0.5 * interval)));
        let change = (rates.attitude - turning) * interval;
        attitude += change;
        let after = before + change;
        let middle = (before + after) * 0.5;
        let mut velocity = self.velocity.column_mut(column);
        velocity += (rates.velocity + middle.cross(&around.specific_force)) * interval;
        // The readings are at the ends of the samples.
        let count = samples as f64;
        let mut mean = self.mean_attitude.column_mut(column);
        mean += after * count - change * (0.5 * (count - 1.0));
    }
}
