//! Construction of epochs: residuals for each sample, derivatives for each piece.

use nalgebra::{Matrix3, Vector3};
use rins_terms::{Acting, Dual64, KinematicState, KinematicStates, Model, Signals, Track, values};

use crate::epoch::{Epoch, Span, Turning};
use crate::gains::Growing;
use crate::run::{Reference, Run};
use crate::sway::Sway;

/// The prediction of a run: a model, and the parameters for which derivatives are calculated.
pub(crate) struct Compared<'a> {
    run: &'a Run,
    /// The terms with an effect: a model may hold hundreds of inactive candidates.
    present: Vec<Acting<'a>>,
    /// For each column, the term with the derivative by one of its parameters, and the terms that depend on it.
    columns: Vec<Vec<Acting<'a>>>,
    readings: Option<&'a [f64]>,
    sway: Option<Sway>,
    /// The matrices `(I + S + M)⁻¹` of gyros and accelerometers, which convert errors of readings to errors of the true
    /// quantities.
    inverse_gains: [Matrix3<f64>; 2],
}

impl<'a> Compared<'a> {
    /// The prediction of a run along a track; derivatives are calculated over pieces of it.
    pub(crate) fn new(
        run: &'a Run,
        model: &'a Model,
        free: &[(usize, usize)],
        readings: Option<&'a [f64]>,
        (track, pieces): (&Track, &Track),
    ) -> Self {
        let triads = model.split().0;
        let inverse_gains = [triads.gyro.matrix, triads.accel.matrix]
            .map(|matrix| (Matrix3::identity() + matrix).try_inverse().unwrap_or_default());
        Self {
            run,
            present: Acting::present(model, track),
            columns: Acting::by(model, pieces, free),
            readings,
            sway: Sway::of(run),
            inverse_gains,
        }
    }

    /// The logarithm of the volume that the measurements of an epoch take up per volume of the true quantities. Residuals are differences
    /// of true quantities, and are smaller the larger the scale errors are; the density of the readings is theirs over this volume.
    pub(crate) fn ln_volume(&self) -> f64 {
        let [gyro, accel] = &self.inverse_gains;
        let gyro = match self.run.rig.reference {
            Reference::Gravity => gyro.fixed_view::<2, 2>(0, 0).determinant(),
            Reference::Encoder { .. } | Reference::Command { .. } | Reference::Rest => {
                gyro.determinant()
            }
        };
        -(gyro * accel.determinant()).abs().ln()
    }
}

/// The construction of successive epochs.
pub(crate) struct Build<'a> {
    compared: &'a Compared<'a>,
    /// The kinematic states of each sample and of each piece.
    fine: KinematicStates<'a>,
    pieces: KinematicStates<'a>,
    growing: Growing,
}

impl<'a> Build<'a> {
    /// Starts at the kinematic states of the first sample and of the first piece.
    pub(crate) fn new(
        compared: &'a Compared<'a>,
        fine: KinematicStates<'a>,
        pieces: KinematicStates<'a>,
    ) -> Self {
        let growing = Growing::new(compared.columns.len());
        Self { compared, fine, pieces, growing }
    }

    /// Processes a piece only for the reading errors at its end.
    pub(crate) fn pass_piece(&mut self) {
        if let Some(piece) = self.pieces.advance() {
            self.compared.set_columns(&mut self.growing, piece);
            self.growing.begin();
        }
    }

    /// The next epoch: residuals for each sample, columns for each piece.
    pub(crate) fn epoch(&mut self, span: &Span, ends: impl Iterator<Item = usize>) -> Epoch {
        let mut turning = Turning::default();
        let (mut duration, mut rotation) = (0.0, 0.0);
        let mut first = span.samples.start;
        let recording = &self.compared.run.recording;
        for end in ends {
            let mut from_body = [Matrix3::zeros(); 2];
            for sample in first..end {
                let Some(moment) = self.fine.advance() else { break };
                let interval = recording.increments[sample].interval;
                rotation += moment.mean.rate * interval;
                from_body = self.compared.residual(&mut self.growing, sample, moment);
                let of_gyros = from_body[0];
                turning.twice += (turning.turned + of_gyros * (0.5 * interval)) * interval;
                turning.turned += of_gyros * interval;
                turning.mean += turning.turned;
                duration += interval;
            }
            let Some(piece) = self.pieces.advance() else { break };
            if end - first > 1 && self.compared.sway.is_none() {
                from_body = turned_over(piece);
            }
            self.compared.set_columns(&mut self.growing, piece);
            if span.fresh && first == span.samples.start {
                self.growing.begin();
            }
            let inverse_gains = &self.compared.inverse_gains;
            let turned = [0, 1].map(|triad| from_body[triad] * inverse_gains[triad]);
            self.growing.add(&turned, &piece.surroundings, (piece.interval, end - first));
            first = end;
        }
        let readings = span.samples.len() as f64;
        turning.mean /= readings;
        Epoch {
            samples: (span.samples.start, span.samples.end),
            duration,
            rotation,
            fresh: span.fresh,
            left_out: false,
            gains: self.growing.finish(readings),
            turning,
            held: None,
            rounding: 0.0,
        }
    }
}

impl Compared<'_> {
    /// Sets the derivatives of the readings in a piece by the parameters.
    fn set_columns(&self, growing: &mut Growing, piece: &KinematicState) {
        for (column, acting) in self.columns.iter().enumerate() {
            let mut signals = Acting::together(acting, piece);
            self.leave_what_is_read(&mut signals);
            growing.set(column, &signals);
        }
    }

    /// Removes the angle error for a commanded rate: the command does not depend on the table.
    fn leave_what_is_read(&self, signals: &mut Signals) {
        if let Reference::Command { .. } = self.run.rig.reference {
            signals.angle = Dual64::from_re(0.0);
        }
    }

    /// Adds the residual of a sample; returns the attitude of the body in the axis frame as in [`turned_over`].
    fn residual(
        &self,
        growing: &mut Growing,
        sample: usize,
        moment: &KinematicState,
    ) -> [Matrix3<f64>; 2] {
        let measured = &self.run.recording.increments[sample];
        let mut from_body = turned_over(moment);
        let mut predicted = Acting::together(&self.present, moment);
        self.leave_what_is_read(&mut predicted);
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
            from_body = [*middle.matrix(); 2];
        }
        gyro -= values(&predicted.gyro);
        accel -= values(&predicted.accel);
        let [of_gyros, of_accels] = &self.inverse_gains;
        let rates = [from_body[0] * (of_gyros * gyro), from_body[1] * (of_accels * accel), of_axis];
        growing.add_residual(rates, around, measured.interval);
        from_body
    }
}

/// The mean attitude of a body on a table in the axis frame over a sample, for gyros and for accelerometers. That for gyros
/// is the mean over the angle instead of the time, because most of their error is proportional to the table rate.
fn turned_over(moment: &KinematicState) -> [Matrix3<f64>; 2] {
    [turned_by(moment.middle_angle()), turned_by(moment.mean.angle)]
}

/// The attitude of a body on a table in the axis frame, at this table angle.
fn turned_by(angle: f64) -> Matrix3<f64> {
    let (sin, cos) = angle.sin_cos();
    Matrix3::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0)
}
