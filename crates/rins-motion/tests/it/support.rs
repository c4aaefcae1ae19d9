//! Code that is common to the tests: sites, tables, and a motion with increments by quadrature.

use nalgebra::Vector3;
use proptest::prelude::*;
use rins_frames::units::{ARCSEC, DEG, DEG_PER_SECOND, PPM};
use rins_frames::{Body, Dcm, EulerAngles, InFrame, Increments, Nav, Site, Table};
use rins_motion::mechanism::{ConstantTurn, SpinAxisErrors};
use rins_motion::{Profile, Segment, Station, TrueMotion};
use rins_testing::any_euler_angles;

/// The latitude of Xi'an, the site of the paper's table.
pub(crate) const PAPER_LATITUDE: f64 = 34.25 * DEG;

pub(crate) fn station(latitude: f64) -> Station {
    Station::with_normal_gravity(Site { latitude, longitude: 0.0, height: 0.0 })
}

/// The paper's simulated run: Table 4's attitude, 10 °/s.
pub(crate) fn paper_turn() -> ConstantTurn {
    let angles = EulerAngles { roll: 30.0 * DEG, pitch: 20.0 * DEG, yaw: 40.0 * DEG };
    ConstantTurn {
        station: station(PAPER_LATITUDE),
        nav_from_table: angles.dcm(),
        rate: 10.0 * DEG_PER_SECOND,
    }
}

/// The paper's simulated gyro errors of the spin axis.
pub(crate) fn paper_errors() -> SpinAxisErrors {
    SpinAxisErrors {
        misalignment_xz: 60.0 * ARCSEC,
        misalignment_yz: 60.0 * ARCSEC,
        scale_z: 300.0 * PPM,
    }
}

pub(crate) fn scaled(errors: &SpinAxisErrors, factor: f64) -> SpinAxisErrors {
    SpinAxisErrors {
        misalignment_xz: errors.misalignment_xz * factor,
        misalignment_yz: errors.misalignment_yz * factor,
        scale_z: errors.scale_z * factor,
    }
}

pub(crate) fn any_attitude() -> impl Strategy<Value = Dcm<Nav, Table>> {
    any_euler_angles().prop_map(|[roll, pitch, yaw]| EulerAngles { roll, pitch, yaw }.dcm())
}

/// Any table rate from 1 to 60 °/s, in both directions \[rad/s\].
pub(crate) fn any_rate() -> impl Strategy<Value = f64> {
    (1.0..60.0_f64, prop::bool::ANY)
        .prop_map(|(rate, back)| if back { -rate } else { rate } * DEG_PER_SECOND)
}

pub(crate) fn any_turn() -> impl Strategy<Value = ConstantTurn> {
    (any_attitude(), any_rate()).prop_map(|(nav_from_table, rate)| ConstantTurn {
        station: station(PAPER_LATITUDE),
        nav_from_table,
        rate,
    })
}

/// Any errors of up to five arcminutes and 500 ppm.
pub(crate) fn any_spin_axis_errors() -> impl Strategy<Value = SpinAxisErrors> {
    [-1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64].prop_map(|[xz, yz, z]| SpinAxisErrors {
        misalignment_xz: xz * 300.0 * ARCSEC,
        misalignment_yz: yz * 300.0 * ARCSEC,
        scale_z: z * 500.0 * PPM,
    })
}

/// Any vector with components up to `largest`.
pub(crate) fn any_vector(largest: f64) -> impl Strategy<Value = Vector3<f64>> {
    [-1.0..1.0_f64, -1.0..1.0_f64, -1.0..1.0_f64].prop_map(move |v| Vector3::from(v) * largest)
}

/// The true motion of a table with a constant rate over `duration` \[s\].
pub(crate) fn constant_motion(turn: &ConstantTurn, duration: f64) -> TrueMotion {
    TrueMotion {
        station: turn.station,
        nav_from_table: turn.nav_from_table,
        profile: Profile::new(&[Segment { rate: turn.rate, duration }], None).unwrap(),
    }
}

/// The attitude of the body at table angle zero.
pub(crate) fn at_angle_zero(nav_from_table: Dcm<Nav, Table>) -> Dcm<Nav, Body> {
    nav_from_table * Dcm::<Table, Body>::identity()
}

/// A motion given by its attitude, velocity and position, with their rates.
pub(crate) trait Motion {
    /// `C_b^n`.
    fn nav_from_body(&self, time: f64) -> Dcm<Nav, Body>;
    /// `ω_nb^b` \[rad/s\].
    fn turn_rate(&self, time: f64) -> Vector3<f64>;
    /// The velocity over the Earth \[m/s\].
    fn velocity(&self, time: f64) -> Vector3<f64>;
    /// The rate of the velocity's components in n \[m/s²\].
    fn acceleration(&self, time: f64) -> Vector3<f64>;
    /// The position.
    fn site(&self, time: f64) -> Site;

    /// The output of a perfect IMU from `from` to `to`, by Simpson's rule.
    fn increments(&self, from: f64, to: f64) -> Increments {
        // With a twentieth of a radian per panel, the error of Simpson's rule is below 1e-9 of the signal.
        const PANELS: u32 = 32;
        let step = (to - from) / f64::from(PANELS);
        let (mut angle, mut velocity) = (Vector3::zeros(), Vector3::zeros());
        for node in 0..=2 * PANELS {
            let weight = match node {
                0 => 1.0,
                _ if node == 2 * PANELS => 1.0,
                _ if node % 2 == 1 => 4.0,
                _ => 2.0,
            };
            let (rate, force) = self.measured_at(from + 0.5 * step * f64::from(node));
            angle += rate * (weight * step / 6.0);
            velocity += force * (weight * step / 6.0);
        }
        Increments {
            angle: InFrame::from_components(angle),
            velocity: InFrame::from_components(velocity),
            interval: to - from,
        }
    }

    /// `ω_ib^b` and `f^b`.
    fn measured_at(&self, time: f64) -> (Vector3<f64>, Vector3<f64>) {
        let site = self.site(time);
        let v = self.velocity(time);
        let body_from_nav = self.nav_from_body(time).inverse();
        let w_ie = *site.earth_rate().components();
        let w_en = *site.transport_rate(&InFrame::from_components(v)).components();
        let gravity = Vector3::new(0.0, 0.0, -site.normal_gravity());
        let force = self.acceleration(time) + (w_ie * 2.0 + w_en).cross(&v) - gravity;
        let turn = body_from_nav.matrix() * (w_ie + w_en);
        (self.turn_rate(time) + turn, body_from_nav.matrix() * force)
    }
}

/// The rotation vector between two attitudes \[rad\], resolved in n: computed relative to true.
pub(crate) fn attitude_apart(computed: Dcm<Nav, Body>, truth: Dcm<Nav, Body>) -> Vector3<f64> {
    let apart: Dcm<Nav, Nav> = computed * truth.inverse();
    apart.rotation_vector()
}
