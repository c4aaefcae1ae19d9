//! Epochs in the making: residuals sample by sample, derivatives piece by piece.

use nalgebra::{Matrix3, Vector3};
use rins_terms::{Acting, Dual64, KinematicState, KinematicStates, Model, Signals, Track, values};

use crate::epoch::{Epoch, Span, Turning};
use crate::gains::Growing;
use crate::run::{Reference, Run};
use crate::sway::Sway;

/// What a run is compared with: a model, and the parameters by which derivatives are taken.
pub(crate) struct Compared<'a> {
    run: &'a Run,
    /// The terms that do anything: hundreds may stand by to be tried.
    present: Vec<Acting<'a>>,
    /// Of each column the term, with a derivative by one of its parameters, and what follows from that one too.
    columns: Vec<Vec<Acting<'a>>>,
    readings: Option<&'a [f64]>,
    sway: Option<Sway>,
    /// What turns a difference in readings into one in what was true, `(I + [S, M])⁻¹`, of gyros and accelerometers.
    inverse_gains: [Matrix3<f64>; 2],
}

impl<'a> Compared<'a> {
    /// What a run is compared with along a track, derivatives being taken over pieces of it.
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
}

/// Epochs in the making, one after the other.
pub(crate) struct Build<'a> {
    compared: &'a Compared<'a>,
    /// What is going on over each sample, and over each piece.
    fine: KinematicStates<'a>,
    pieces: KinematicStates<'a>,
    growing: Growing,
}

impl<'a> Build<'a> {
    /// From the moments of the first sample and of the first piece on.
    pub(crate) fn new(
        compared: &'a Compared<'a>,
        fine: KinematicStates<'a>,
        pieces: KinematicStates<'a>,
    ) -> Self {
        let growing = Growing::new(compared.columns.len());
        Self { compared, fine, pieces, growing }
    }

    /// Takes a piece only to know what readings differ by at its end.
    pub(crate) fn pass_piece(&mut self) {
        if let Some(piece) = self.pieces.advance() {
            self.compared.set_columns(&mut self.growing, piece);
            self.growing.begin();
        }
    }

    /// An epoch: its residuals sample by sample, its columns piece by piece.
    pub(crate) fn epoch(&mut self, span: &Span, ends: impl Iterator<Item = usize>) -> Epoch {
        let mut turning = Turning::default();
        let mut duration = 0.0;
        let mut first = span.samples.start;
        let recording = &self.compared.run.recording;
        for end in ends {
            let mut from_body = [Matrix3::zeros(); 2];
            for sample in first..end {
                let Some(moment) = self.fine.advance() else { break };
                let interval = recording.increments[sample].interval;
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
    /// What the parameters add to what is read in a piece.
    fn set_columns(&self, growing: &mut Growing, piece: &KinematicState) {
        for (column, acting) in self.columns.iter().enumerate() {
            let mut signals = Acting::together(acting, piece);
            self.leave_what_is_read(&mut signals);
            growing.set(column, &signals);
        }
    }

    /// Leaves of some signals what is read: a command goes on whatever the table does.
    fn leave_what_is_read(&self, signals: &mut Signals) {
        if let Reference::Command { .. } = self.run.rig.reference {
            signals.angle = Dual64::from_re(0.0);
        }
    }

    /// What a sample was read beyond the model; the attitude of the body in the axis frame, as [`turned_over`] has it.
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

/// The mean attitude over a moment of a body on a table in the axis frame, for what gyros read and what accelerometers do:
/// most of what gyros read goes with the table's rate, and counts by how far it turns, not by how long.
fn turned_over(moment: &KinematicState) -> [Matrix3<f64>; 2] {
    [turned_by(moment.middle_angle()), turned_by(moment.mean.angle)]
}

/// The attitude of a body on a table in the axis frame.
fn turned_by(angle: f64) -> Matrix3<f64> {
    let (sin, cos) = angle.sin_cos();
    Matrix3::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0)
}
