//! What an IMU and an encoder read where a model's terms act.

use nalgebra::Vector3;
use rins_frames::{Dcm, InFrame, Increments, Table};

use crate::acting::Acting;
use crate::kinematic_state::KinematicState;
use crate::model::Model;
use crate::signals::values;
use crate::track::Track;

/// What is read over one sample, without noise.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Reading {
    /// By the sensors.
    pub increments: Increments,
    /// By how much the table angle that is read differs from the true one \[rad\].
    pub angle_error: f64,
    /// The rotation vector, in the axis frame, by which the table is tilted at the sample's end \[rad\].
    pub tilt: Vector3<f64>,
}

/// A model at work: it makes readings from true motion.
#[derive(Clone, Debug)]
pub struct MeasurementModel<'a> {
    terms: Vec<Acting<'a>>,
    tilt: Vector3<f64>,
}

impl<'a> MeasurementModel<'a> {
    /// A model at work from the start of `track` on.
    pub fn new(model: &'a Model, track: &Track) -> Self {
        let terms = Acting::present(model, track);
        let tilt = track.opening().map(|moment| values(&Acting::together(&terms, &moment).tilt));
        Self { terms, tilt: tilt.unwrap_or_default() }
    }

    /// The tilt before the next sample: a rotation vector in the axis frame \[rad\].
    pub const fn tilt(&self) -> Vector3<f64> {
        self.tilt
    }

    /// What is read over the sample of `moment`, during which an IMU on an axis that stands still measures
    /// `truth`.
    ///
    /// Terms act on the rate and force that are felt, which `truth` holds more exactly than `moment`.
    ///
    /// # Panics
    /// May panic for a moment of a longer track.
    pub fn read(&mut self, moment: &KinematicState, truth: &Increments) -> Reading {
        let mut signals = Acting::together(&self.terms, &moment.feeling(truth));
        let (before, after) = (self.tilt, values(&signals.tilt));
        self.tilt = after;
        let mut felt = *truth;
        if before != Vector3::zeros() || after != Vector3::zeros() {
            felt = tilted(moment, truth, &before, &after);
            signals = Acting::together(&self.terms, &moment.feeling(&felt));
        }
        let interval = felt.interval;
        Reading {
            increments: Increments {
                angle: felt.angle + InFrame::from_components(values(&signals.gyro) * interval),
                velocity: felt.velocity
                    + InFrame::from_components(values(&signals.accel) * interval),
                interval,
            },
            angle_error: signals.angle.re,
            tilt: after,
        }
    }
}

/// What an IMU feels on a table that is tilted, the tilt going from `before` to `after` \[rad\].
///
/// The body's attitude is `Rot(tilt) Rz(ζ)`: all vectors of the axis frame are seen from the tilted
/// frame, half-way, and the tilt's own rate is felt.
fn tilted(
    moment: &KinematicState,
    truth: &Increments,
    before: &Vector3<f64>,
    after: &Vector3<f64>,
) -> Increments {
    let middle = (before + after) * 0.5;
    let from_tilted = Dcm::<Table, Table>::from_rotation_vector(&middle).inverse();
    let seen = |vector: &Vector3<f64>| {
        let turned = *(from_tilted * InFrame::<Table>::from_components(*vector)).components();
        moment.in_body(&(turned - vector))
    };
    let around = &moment.surroundings;
    // The rate of a rotation vector seen from the frame that it turns: its rate, less half its turning.
    let own = (after - before) - middle.cross(&(after - before)) * 0.5;
    let angle = seen(&around.earth_rate) * truth.interval + moment.in_body(&own);
    let velocity = seen(&around.specific_force) * truth.interval;
    Increments {
        angle: truth.angle + InFrame::from_components(angle),
        velocity: truth.velocity + InFrame::from_components(velocity),
        interval: truth.interval,
    }
}
