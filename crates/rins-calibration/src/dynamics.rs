//! The error dynamics, eqs. (11)-(15), and their transition over one interval.

use nalgebra::{Matrix3, SMatrix, Vector3};
use rins_frames::{InFrame, Nav, Site};

use crate::layout::{ATTITUDE, POSITION, SPIN_AXIS_ERRORS, STATES, VELOCITY};

/// A matrix over the whole state.
pub(crate) type StateMatrix = SMatrix<f64, STATES, STATES>;

/// What the error dynamics depend on, as means over an interval.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Regime {
    pub(crate) position: Site,
    pub(crate) velocity: InFrame<Nav>,
    /// Gravity's magnitude \[m/s²\].
    pub(crate) gravity: f64,
    /// `f^n` \[m/s²\].
    pub(crate) specific_force: Vector3<f64>,
    /// `C_b^n`.
    pub(crate) nav_from_body: Matrix3<f64>,
    /// `ω_ib,z^b` \[rad/s\].
    pub(crate) spin_rate: f64,
}

/// The matrix `F` of eqs. (11)-(15).
///
/// Row two of (13) carries `+(ρ + 2Ω)_x δv_z`, which the paper prints with a minus.
pub(crate) fn dynamics(regime: &Regime) -> StateMatrix {
    let Regime { position, velocity, gravity, .. } = regime;
    let earth_rate = position.earth_rate();
    let nav_rate = earth_rate + position.transport_rate(velocity);
    let coriolis = earth_rate + nav_rate;
    let radius = position.meridian_radius() + position.height;
    let climb = velocity.components().z / radius;

    let mut f = StateMatrix::zeros();
    // (14), with the level wander-free over so short a way.
    let along = Matrix3::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, radius) / radius;
    POSITION.set(VELOCITY, &mut f, &along);
    let shrink = Matrix3::from_diagonal(&Vector3::new(-climb, -climb, 0.0));
    POSITION.set(POSITION, &mut f, &shrink);
    // (13)
    let weight = Matrix3::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 2.0 / radius) * *gravity;
    VELOCITY.set(POSITION, &mut f, &weight);
    VELOCITY.set(VELOCITY, &mut f, &-coriolis.cross_matrix());
    VELOCITY.set(ATTITUDE, &mut f, &regime.specific_force.cross_matrix());
    // (12) and (15)
    ATTITUDE.set(ATTITUDE, &mut f, &-nav_rate.cross_matrix());
    ATTITUDE.set(SPIN_AXIS_ERRORS, &mut f, &(regime.nav_from_body * -regime.spin_rate));
    f
}

/// `exp(F T)` to second order, which over a sample leaves out less than rounding does to P.
pub(crate) fn transition(dynamics: &StateMatrix, interval: f64) -> StateMatrix {
    let step = dynamics * interval;
    StateMatrix::identity() + step + step * step * 0.5
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::SVector;
    use rins_frames::units::DEG;
    use rins_frames::{Dcm, EulerAngles, Increments};
    use rins_motion::{
        NavState, Navigator, Profile, Segment, Station, TrueMotion, VerticalChannel,
    };

    const INTERVAL: f64 = 0.02;
    const RATE: f64 = 20.0 * DEG;
    const STEPS: usize = 100;

    type State = SVector<f64, STATES>;

    /// How far the prediction may be off, relative to the error that it started from: the products
    /// of two seconds with the Earth's rate and the curvature that the model leaves out.
    const WITHIN: f64 = 2e-3;

    fn motion() -> TrueMotion {
        let site = Site { latitude: 0.6, longitude: 0.3, height: 200.0 };
        let angles = EulerAngles { roll: 0.5, pitch: 0.3, yaw: 0.7 };
        let turn = Segment { rate: RATE, duration: STEPS as f64 * INTERVAL };
        TrueMotion {
            station: Station::with_normal_gravity(site),
            nav_from_table: angles.dcm(),
            profile: Profile::new(&[turn], None).unwrap(),
        }
    }

    /// Small errors of each kind: a metre of way, a millimetre a second, a second of arc.
    fn scale() -> State {
        let mut scale = State::repeat(5e-6);
        POSITION.set_in(&mut scale, &Vector3::new(2e-7, 2e-7, 1.0));
        VELOCITY.set_in(&mut scale, &Vector3::repeat(1e-3));
        scale
    }

    /// The rotation of the level by a displacement; the geographic frame also turns about up.
    fn d_theta(error: &State, latitude: f64) -> Vector3<f64> {
        let d = POSITION.of(error);
        Vector3::new(d.x, d.y, d.y * latitude.tan())
    }

    fn with_error(truth: &NavState, error: &State) -> NavState {
        let Site { latitude, longitude, height } = truth.position;
        let d = POSITION.of(error);
        let phi = ATTITUDE.of(error) + d_theta(error, latitude);
        NavState {
            position: Site {
                latitude: latitude - d.x,
                longitude: longitude + d.y / latitude.cos(),
                height: height + d.z,
            },
            velocity: truth.velocity + InFrame::from_components(VELOCITY.of(error)),
            nav_from_body: Dcm::from_rotation_vector(&-phi) * truth.nav_from_body,
        }
    }

    fn error_between(computed: &NavState, truth: &NavState, gyro: &Vector3<f64>) -> State {
        let latitude = truth.position.latitude;
        let mut error = State::zeros();
        let d = Vector3::new(
            latitude - computed.position.latitude,
            (computed.position.longitude - truth.position.longitude) * latitude.cos(),
            computed.position.height - truth.position.height,
        );
        POSITION.set_in(&mut error, &d);
        let velocity = computed.velocity - truth.velocity;
        VELOCITY.set_in(&mut error, velocity.components());
        let phi = -(computed.nav_from_body * truth.nav_from_body.inverse()).rotation_vector();
        let psi = phi - d_theta(&error, latitude);
        ATTITUDE.set_in(&mut error, &psi);
        SPIN_AXIS_ERRORS.set_in(&mut error, gyro);
        error
    }

    #[test]
    fn transition_predicts_a_perturbed_strapdown_run() {
        let motion = motion();
        let start = Navigator::at_rest(
            &motion.station,
            motion.nav_from_table * Dcm::about_z(0.0),
            VerticalChannel::Free,
        );
        for state in 0..SPIN_AXIS_ERRORS.end() {
            let mut error = State::zeros();
            error[state] = scale()[state];
            let gyro = SPIN_AXIS_ERRORS.of(&error);
            let mut truth = start.clone();
            let mut computed = Navigator::new(
                with_error(start.state(), &error),
                &motion.station,
                VerticalChannel::Free,
            );
            let mut predicted = error;
            for sample in motion.samples(INTERVAL) {
                let before = *truth.state();
                let angle = sample.increments.angle.components();
                let measured = Increments {
                    angle: InFrame::from_components(angle + gyro * angle.z),
                    ..sample.increments
                };
                truth.step(&sample.increments);
                computed.step(&measured);
                let regime = Regime {
                    position: before.position,
                    velocity: before.velocity,
                    gravity: motion.station.gravity,
                    specific_force: truth.force_gain().components() / INTERVAL,
                    nav_from_body: (before.nav_from_body.matrix()
                        + truth.state().nav_from_body.matrix())
                        * 0.5,
                    spin_rate: angle.z / INTERVAL,
                };
                predicted = transition(&dynamics(&regime), INTERVAL) * predicted;
            }
            let found = error_between(computed.state(), truth.state(), &gyro);
            // In units of what each state means to the others, so that no kind drowns another.
            let relative = (found - predicted).component_div(&scale());
            assert!(
                relative.amax() < WITHIN * (predicted.component_div(&scale()).amax()),
                "state {state}: off by {relative}, predicted {predicted}"
            );
        }
    }
}
