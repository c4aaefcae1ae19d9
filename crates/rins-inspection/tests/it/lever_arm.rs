//! An IMU off the axis of a table: its centripetal specific force is no error of axes, and hides none.

use nalgebra::Vector3;
use proptest::prelude::*;
use rins_frames::units::{DEG, DEG_PER_SECOND};
use rins_frames::{EulerAngles, InFrame, SignedAxes};
use rins_inspection::{Expected, ExpectedAxis, Suspicion, inspect};
use rins_motion::{Profile, Recording, Segment};

use crate::axes::read_as;
use crate::run::{CHIP, expected, record_tilted};

/// The recording of accelerometers at `arm` \[m\] from the axis.
fn at(arm: Vector3<f64>, recording: &Recording) -> Recording {
    let mut off_axis = recording.clone();
    let mut before = Vector3::zeros();
    for sample in &mut off_axis.increments {
        let rate = *sample.rates().angular_rate.components();
        let acceleration = (rate - before) / sample.interval;
        before = rate;
        // Tangential and centripetal: α × r + ω × (ω × r).
        let force = acceleration.cross(&arm) + rate.cross(&rate.cross(&arm));
        sample.velocity += InFrame::from_components(force * sample.interval);
    }
    off_axis
}

fn spin(rate: f64) -> Profile {
    let segment = |rate: f64, duration| Segment { rate: rate * DEG_PER_SECOND, duration };
    let segments =
        [segment(0.0, 12.0), segment(rate, 20.0), segment(-rate, 15.0), segment(0.0, 10.0)];
    Profile::new(&segments, Some(100.0 * DEG_PER_SECOND)).expect("it lasts")
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    /// On a level table and on a tilted one, fast or slow, near the axis or far from it.
    #[test]
    fn centripetal_force_is_no_mistake(
        rate in 20.0..250.0_f64,
        tilt in prop_oneof![0.0..2.0_f64, 5.0..40.0_f64],
        arm in 0.0..0.15_f64,
        direction in 0.0..360.0_f64,
        has_attitude in any::<bool>(),
        seed in any::<u64>(),
    ) {
        let angles = EulerAngles { roll: tilt * DEG, pitch: 0.3 * tilt * DEG, yaw: 40.0 * DEG };
        let recording = record_tilted(angles.dcm(), spin(rate), CHIP, seed);
        let (sine, cosine) = (direction * DEG).sin_cos();
        let off_axis = at(Vector3::new(arm * cosine, arm * sine, 0.01), &recording);
        let axis = has_attitude.then_some(ExpectedAxis { angles, sigma: 0.1 * DEG });
        let known = Expected { axis, ..expected(CHIP) };
        let suspicions = inspect(&off_axis, &known).suspicions;
        prop_assert!(suspicions.is_empty(), "{suspicions:?}");
    }

    /// Exchanged accelerometers on a tilted table are suspected as before, wherever the IMU is.
    #[test]
    fn lever_arm_hides_no_exchange(
        rate in 20.0..120.0_f64,
        tilt in 10.0..40.0_f64,
        arm in 0.0..0.1_f64,
        direction in 0.0..360.0_f64,
        seed in any::<u64>(),
    ) {
        let angles = EulerAngles { roll: tilt * DEG, pitch: 0.3 * tilt * DEG, yaw: 40.0 * DEG };
        let recording = record_tilted(angles.dcm(), spin(rate), CHIP, seed);
        let (sine, cosine) = (direction * DEG).sin_cos();
        let off_axis = at(Vector3::new(arm * cosine, arm * sine, 0.01), &recording);
        let exchanged = SignedAxes { source: [1, 0, 2], sign: [1.0; 3] };
        let wrong = read_as(&off_axis, SignedAxes::IDENTITY, exchanged);
        let suspicions = inspect(&wrong, &Expected { axis: None, ..expected(CHIP) }).suspicions;
        let is_handedness = |suspicion: &Suspicion| matches!(suspicion, Suspicion::Handedness { .. });
        prop_assert!(suspicions.iter().any(is_handedness), "{suspicions:?}");
    }
}
