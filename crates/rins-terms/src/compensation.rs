//! What was true, from what was read: a model's terms undone.

use rins_frames::{InFrame, Increments};
use rins_imu::ImuCompensationError;
use rins_motion::Recording;

use crate::model::Model;
use crate::moment::{Moment, Surroundings};
use crate::signals::values;
use crate::track::Track;

/// The most often that readings are compensated; each time leaves of an error what the terms make of it.
const MOST_ROUNDS: usize = 60;

/// What may change in a last round, relative to the largest reading.
const SETTLED: f64 = 1e-13;

/// Why a model's terms cannot be undone.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum NotUndone {
    /// The biases, scale errors and misalignments leave too little of what was true.
    #[error(transparent)]
    Triads(#[from] ImuCompensationError),
    /// The terms are so large that undoing them does not come to an end.
    #[error(
        "the terms cannot be undone: after {MOST_ROUNDS} rounds readings still change by {change} of the largest"
    )]
    Endless {
        /// By how much readings changed in the last round, relative to the largest.
        change: f64,
    },
}

/// The recording that sensors and an encoder without the errors of `model` would have made.
///
/// It is `true = measured - signals(true)`, iterated: terms act on the rates and forces that are found, so that
/// it holds for any motion, a tilting table's included, which stays in the recording. How the table turns is
/// taken from the z gyro less the Earth's rate; the encoder, if there is one, says where it
/// stands, but is not differenced. Terms of noise and of logging cannot be undone, and are passed over.
///
/// # Errors
/// [`NotUndone`] if the terms are too large, or a triad's readings hold nothing of what was true.
///
/// # Examples
/// A gyro that reads 1e-3 of the rate too much:
/// ```
/// use rins_frames::{Dcm, InFrame, Increments, Site};
/// use rins_motion::{Recording, Station};
/// use rins_terms::{Chosen, Model, Surroundings, catalogue, compensated};
///
/// let site = Site { latitude: 0.6, longitude: 1.9, height: 400.0 };
/// let around = Surroundings::new(Station::with_normal_gravity(site), Dcm::identity());
/// let sample = Increments {
///     angle: InFrame::new(0.0, 0.0, 1.001e-2),
///     velocity: InFrame::new(0.0, 0.0, 0.5),
///     interval: 0.05,
/// };
/// let read = Recording { times: vec![0.05], increments: vec![sample], ..Recording::default() };
/// let scale = Chosen::new(&catalogue::GYRO_SCALE).with_values(&[0.0, 0.0, 1e-3]);
/// let undone = compensated(&Model { terms: vec![scale] }, around, &read)?;
/// assert!((undone.increments[0].angle.components().z - 1e-2).abs() < 1e-16);
/// # Ok::<(), rins_terms::NotUndone>(())
/// ```
pub fn compensated(
    model: &Model,
    surroundings: Surroundings,
    recording: &Recording,
) -> Result<Recording, NotUndone> {
    model.split().0.compensation()?;
    let mut found = recording.clone();
    let Some(first) = recording.increments.first() else { return Ok(found) };
    let size = |vectors: &dyn Fn(&Increments) -> f64| {
        recording.increments.iter().map(vectors).fold(f64::MIN_POSITIVE, f64::max)
    };
    let largest_angle = size(&|k| k.angle.norm());
    let largest_velocity = size(&|k| k.velocity.norm());
    let start = recording.times[0] - first.interval;
    let mut change = f64::INFINITY;
    for _ in 0..MOST_ROUNDS {
        let track = turning(&found, surroundings, start);
        change = 0.0;
        for (sample, moment) in track.moments().enumerate() {
            let moment =
                standing(&moment, &track, &found, sample).feeling(&found.increments[sample]);
            let signals = model.signals(&moment);
            let (read, interval) = (&recording.increments[sample], moment.interval);
            let next = Increments {
                angle: read.angle - InFrame::from_components(values(&signals.gyro) * interval),
                velocity: read.velocity
                    - InFrame::from_components(values(&signals.accel) * interval),
                interval,
            };
            let last = std::mem::replace(&mut found.increments[sample], next);
            change = largest(change, (next.angle - last.angle).norm() / largest_angle);
            change = largest(change, (next.velocity - last.velocity).norm() / largest_velocity);
            if let (Some(true_angle), Some(read)) = (&mut found.table_angle, &recording.table_angle)
            {
                let next = read[sample] - signals.angle.re;
                let off = (next - true_angle[sample]).abs();
                change = largest(change, off / next.abs().max(1.0));
                true_angle[sample] = next;
            }
        }
        if change <= SETTLED {
            return Ok(found);
        }
    }
    Err(NotUndone::Endless { change })
}

/// The larger number; what is not a number is larger than any.
fn largest(a: f64, b: f64) -> f64 {
    if a.is_nan() || b.is_nan() { f64::NAN } else { a.max(b) }
}

/// The track of a table that turns as the z gyro says, and begins where the encoder's first reading puts it.
fn turning(recording: &Recording, surroundings: Surroundings, start: f64) -> Track {
    let times = &recording.times;
    let turn = |sample: usize, increments: &Increments| {
        // Where samples are missing the table is taken to have gone on as it did.
        let before = if sample == 0 { start } else { times[sample - 1] };
        let rate = increments.angle.components().z / increments.interval;
        (rate - surroundings.earth_rate.z) * (times[sample] - before)
    };
    let mut angles = Vec::with_capacity(times.len() + 1);
    let first = recording.increments.first().map_or(0.0, |increments| turn(0, increments));
    angles.push(recording.table_angle.as_ref().map_or(0.0, |angle| angle[0] - first));
    for (sample, increments) in recording.increments.iter().enumerate() {
        angles.push(angles[sample] + turn(sample, increments));
    }
    let intervals = recording.increments.iter().map(|increments| increments.interval).collect();
    Track::new(surroundings, times.clone(), intervals, angles, recording.temperature.clone())
}

/// The moment of a table that turns as `track` does and stands where the encoder, if there is one, says.
fn standing(moment: &Moment, track: &Track, recording: &Recording, sample: usize) -> Moment {
    let mut moment = *moment;
    if let Some(angle) = &recording.table_angle {
        let off = angle[sample] - track.angles()[sample + 1];
        moment.mean.angle += off;
        moment.end.angle += off;
    }
    moment
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::catalogue;
    use crate::making::Making;
    use crate::model::Chosen;
    use proptest::prelude::*;
    use rins_frames::units::{ARCSEC, DEG, DEG_PER_SECOND, PPM};
    use rins_frames::{EulerAngles, Site};
    use rins_imu::{ImuError, TriadError};
    use rins_motion::{Profile, Segment, Station, TrueMotion};

    /// A tilted table that rests, turns forth with a ramp, and back.
    fn motion() -> TrueMotion {
        let site = Site { latitude: 34.25 * DEG, longitude: 108.9 * DEG, height: 400.0 };
        let attitude = EulerAngles { roll: 30.0 * DEG, pitch: 20.0 * DEG, yaw: 40.0 * DEG };
        let segments =
            [0.0, 10.0, -20.0].map(|rate| Segment { rate: rate * DEG_PER_SECOND, duration: 12.0 });
        TrueMotion {
            station: Station::with_normal_gravity(site),
            nav_from_table: attitude.dcm(),
            profile: Profile::new(&segments, Some(5.0 * DEG_PER_SECOND)).unwrap(),
        }
    }

    /// What happens on the table, and what is read there: with an encoder, or without.
    fn run(model: &Model, encoder: bool) -> (Surroundings, Recording, Recording) {
        let motion = motion();
        let around = Surroundings::new(motion.station, motion.nav_from_table);
        let samples: Vec<_> = motion.samples(0.02).collect();
        let times: Vec<f64> = samples.iter().map(|sample| sample.time).collect();
        let angles = std::iter::once(0.0).chain(samples.iter().map(|sample| sample.angle));
        let temperature: Vec<f64> = times.iter().map(|time| 20.0 + 0.01 * time).collect();
        let track = Track::new(
            around,
            times.clone(),
            vec![0.02; times.len()],
            angles.collect(),
            Some(temperature.clone()),
        );
        let truth = Recording {
            times,
            increments: samples.iter().map(|sample| sample.increments).collect(),
            table_angle: encoder.then(|| samples.iter().map(|sample| sample.angle).collect()),
            temperature: Some(temperature),
            ..Recording::default()
        };
        let mut making = Making::new(model, &track);
        let mut read = truth.clone();
        for (sample, moment) in track.moments().enumerate() {
            let reading = making.read(&moment, &truth.increments[sample]);
            read.increments[sample] = reading.increments;
            if let Some(angle) = &mut read.table_angle {
                angle[sample] += reading.angle_error;
            }
        }
        (around, truth, read)
    }

    /// Checks `found` against `truth`: 1e-12 of the largest signal.
    fn assert_same(found: &Recording, truth: &Recording) {
        for (found, truth) in found.increments.iter().zip(&truth.increments) {
            let turn = 20.0 * DEG * 0.02;
            assert!((found.angle - truth.angle).norm() < 1e-12 * turn, "{found:?} {truth:?}");
            let push = 9.8 * 0.02;
            assert!((found.velocity - truth.velocity).norm() < 1e-12 * push, "{found:?} {truth:?}");
        }
        let angles = |recording: &Recording| recording.table_angle.clone().unwrap_or_default();
        for (found, truth) in angles(found).iter().zip(angles(truth)) {
            assert!((found - truth).abs() < 1e-12, "{found} {truth}");
        }
    }

    proptest! {
        #![proptest_config(ProptestConfig::with_cases(16))]

        #[test]
        fn what_was_made_is_undone(
            errors in prop::array::uniform24(-1e-2..1e-2_f64),
            zero in -1.0..1.0_f64,
            encoder in any::<bool>(),
        ) {
            let triad = |p: &[f64]| TriadError {
                bias: nalgebra::Vector3::from_column_slice(&p[..3]),
                matrix: nalgebra::Matrix3::from_column_slice(&p[3..]),
            };
            let error = ImuError { gyro: triad(&errors[..12]), accel: triad(&errors[12..]) };
            let model = Model::from(&error)
                .with(Chosen::new(&catalogue::ENCODER_ZERO).with_values(&[zero]));
            let (around, truth, read) = run(&model, encoder);
            prop_assert!((read.increments[0].angle - truth.increments[0].angle).norm() > 1e-6);
            assert_same(&compensated(&model, around, &read).unwrap(), &truth);
        }
    }

    /// An IMU on a tilting table feels the tilt, and goes on feeling it.
    #[test]
    fn true_motion_stays() {
        let scale = Chosen::new(&catalogue::GYRO_SCALE).with_values(&[100.0 * PPM; 3]);
        let mounting = Chosen::new(&catalogue::MOUNTING).with_values(&[100.0 * ARCSEC, 0.0]);
        let tilting = Model { terms: vec![mounting.clone()] };
        let (around, _, felt) = run(&tilting, true);
        let both = tilting.with(scale);
        let (_, _, read) = run(&both, true);
        let found = compensated(&both, around, &read).unwrap();
        assert_same(&found, &felt);
    }

    #[test]
    fn what_cannot_be_undone_is_refused() {
        let refusal = |scale: [f64; 3]| {
            let chosen = Chosen::new(&catalogue::GYRO_SCALE).with_values(&scale);
            let model = Model { terms: vec![chosen] };
            let (around, _, read) = run(&model, true);
            compensated(&model, around, &read).err()
        };
        assert_eq!(refusal([0.1, 0.0, 0.0]), None);
        assert!(matches!(refusal([0.0, -1.0, 0.0]), Some(NotUndone::Triads(_))));
        assert!(matches!(refusal([0.0, 1.5, 0.0]), Some(NotUndone::Endless { .. })));
    }

    #[test]
    fn nothing_is_made_of_no_samples() {
        let motion = motion();
        let around = Surroundings::new(motion.station, motion.nav_from_table);
        let none = Recording::default();
        assert_eq!(compensated(&Model::full(), around, &none), Ok(none));
    }
}
