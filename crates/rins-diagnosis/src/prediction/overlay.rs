//! A simulation with a fitted model, laid over the measurement.

use rins_estimation::{Fit, Run};
use rins_frames::{InFrame, Increments};
use rins_terms::{MeasurementModel, Model, Track, catalogue};
use rustfft::num_complex::Complex;

/// A table that turns more slowly has no angle or order to speak of \[rad/s\].
const TURNING: f64 = 1e-2;

/// What was measured less what a fitted model says, sample by sample.
#[derive(Clone, Debug, PartialEq)]
pub struct Overlay {
    /// Of gyros x, y, z \[rad/s\] and accelerometers x, y, z \[m/s²\].
    pub residuals: Vec<[f64; 6]>,
    /// The table angle in the middle of each sample, without the encoder's errors \[rad\].
    pub angles: Vec<f64>,
    /// The table's rate over it \[rad/s\].
    pub rates: Vec<f64>,
}

impl Overlay {
    /// Simulates run `place` of a fit along the way that its table went, and takes that from what was measured.
    ///
    /// The way is the encoder's, or what else tells the angle, smoothed over an epoch, with the gyro's details: what is
    /// faster does not show in gyro z.
    pub fn of(run: &Run, fit: &Fit, place: usize) -> Self {
        let (model, track) = along(run, fit, place);
        let residuals =
            readings(&model, &track).zip(&run.recording.increments).map(|(said, read)| {
                let (said, read) = (said.0.rates(), read.rates());
                let gyro = read.angular_rate.components() - said.angular_rate.components();
                let accel = read.specific_force.components() - said.specific_force.components();
                [gyro.x, gyro.y, gyro.z, accel.x, accel.y, accel.z]
            });
        Self {
            residuals: residuals.collect(),
            angles: track.moments().map(|moment| moment.mean.angle).collect(),
            rates: track.moments().map(|moment| moment.mean.rate).collect(),
        }
    }
}

impl Overlay {
    /// Where the table turned, sample by sample: its angle \[rad\], or nothing while it stood.
    pub fn turned(&self) -> impl Iterator<Item = Option<f64>> {
        let each = self.angles.iter().zip(&self.rates);
        each.map(|(angle, rate)| (rate.abs() > TURNING).then_some(*angle))
    }

    /// The mean amplitude of each of `orders` in the residuals across the axis while the table turns: of gyros
    /// \[rad/s\], and of accelerometers \[m/s²\].
    ///
    /// An order `n` is the part `c exp(i n ζ)` of `x + i y`: what stands still in the body has order 0, in the axis
    /// frame -1, and what differs between x and y mirrors that at +1.
    pub fn orders(&self, orders: &[f64]) -> Vec<[f64; 2]> {
        let each = self.residuals.iter().zip(self.turned());
        let moments: Vec<(&[f64; 6], f64)> =
            each.filter_map(|(residual, angle)| Some((residual, angle?))).collect();
        let of = |order: &f64| {
            let mut sums = [Complex::new(0.0, 0.0); 2];
            for (residual, angle) in &moments {
                let turned = Complex::from_polar(1.0, -order * angle);
                for (sum, first) in sums.iter_mut().zip([0, 3]) {
                    *sum += Complex::new(residual[first], residual[first + 1]) * turned;
                }
            }
            sums.map(|sum| sum.norm() / moments.len().max(1) as f64)
        };
        orders.iter().map(of).collect()
    }
}

/// The model of run `place` of a fit, and the way that its table went, without the encoder's errors.
pub(crate) fn along(run: &Run, fit: &Fit, place: usize) -> (Model, Track) {
    let track = fit.linear[place].track();
    let mut model = fit.models[place].clone();
    // They are in the track's surroundings.
    let around = [&catalogue::AXIS_ATTITUDE, &catalogue::AXIS_AZIMUTH];
    model.terms.retain(|chosen| !around.iter().any(|term| term.is(chosen.term)));
    let errors: Vec<f64> = readings(&model, track).map(|reading| reading.1).collect();
    let first = errors.first().copied().unwrap_or_default();
    let errors = std::iter::once(first).chain(errors);
    let angles: Vec<f64> = track.angles().iter().zip(errors).map(|(a, e)| a - e).collect();
    let recording = &run.recording;
    let track = Track::new(
        track.surroundings,
        recording.times.clone(),
        recording.increments.iter().map(|sample| sample.interval).collect(),
        angles,
        recording.temperature.clone(),
    );
    (model, track)
}

/// What is read along a track without noise, and by how much the angle that is read is off \[rad\].
pub(crate) fn readings<'a>(
    model: &'a Model,
    track: &'a Track,
) -> impl Iterator<Item = (Increments, f64)> + use<'a> {
    let mut making = MeasurementModel::new(model, track);
    track.moments().map(move |moment| {
        let truth = Increments {
            angle: InFrame::from_components(moment.rate * moment.interval),
            velocity: InFrame::from_components(moment.force * moment.interval),
            interval: moment.interval,
        };
        let reading = making.read(&moment, &truth);
        (reading.increments, reading.angle_error)
    })
}
