//! The dynamics of the navigator: the Schuler oscillation and the vertical channel.

use std::f64::consts::TAU;

use nalgebra::Vector3;
use rins_frames::units::DEG;
use rins_frames::{Body, Dcm, EARTH_RATE, InFrame, Nav, Rates, Site};
use rins_motion::{NavState, Navigator, Station, VerticalChannel};
use rins_testing::assert_close;

use crate::support::{at_angle_zero, station};

const INTERVAL: f64 = 1.0;

/// A level IMU, at rest, pointing north.
fn rates_at_rest(station: &Station) -> Rates {
    Rates {
        angular_rate: InFrame::from_components(*station.site.earth_rate().components()),
        specific_force: InFrame::new(0.0, 0.0, station.gravity),
    }
}

/// The velocity after each second of perfect increments, from an initial state with errors.
fn velocities(
    station: &Station,
    tilt: Vector3<f64>,
    velocity: InFrame<Nav>,
) -> impl Iterator<Item = Vector3<f64>> {
    let level = at_angle_zero(Dcm::identity());
    let tilted: Dcm<Nav, Body> = Dcm::<Nav, Nav>::from_rotation_vector(&-tilt) * level;
    let state = NavState { position: station.site, velocity, nav_from_body: tilted };
    let mut navigator = Navigator::new(state, station, VerticalChannel::Held);
    let increments = rates_at_rest(station).over(INTERVAL);
    std::iter::repeat_with(move || {
        navigator.step(&increments);
        *navigator.state().velocity.components()
    })
}

/// The times of the sign changes of a series of values, one for each interval from the first \[s\].
fn crossings(values: impl Iterator<Item = f64>) -> impl Iterator<Item = f64> {
    values
        .scan((0.0, f64::NAN), |(time, before), value| {
            *time += INTERVAL;
            let crossing =
                (*before * value < 0.0).then(|| *time - INTERVAL * value / (value - *before));
            *before = value;
            Some(crossing)
        })
        .flatten()
}

/// On the equator the east channel rotates about the Earth's axis, so that neither the Earth's rate nor Coriolis acceleration
/// affects it: its period is `2π √(R_N / g)`, 84.4 minutes.
#[test]
fn schuler_period_is_that_of_the_radius_across_the_meridian() {
    let station = station(0.0);
    let period = TAU * (station.site.transverse_radius() / station.gravity).sqrt();
    assert_close!(period / 60.0, 84.4, 0.2);

    let kicked = velocities(&station, Vector3::zeros(), InFrame::new(1.0, 0.0, 0.0));
    let at: Vec<f64> = crossings(kicked.map(|v| v.x)).take(5).collect();
    assert_close!((at[4] - at[0]) / 2.0, period, 1e-4 * period);

    let tilt = Vector3::new(0.0, 1e-5, 0.0);
    let tilted: Vec<f64> =
        crossings(velocities(&station, tilt, InFrame::zeros()).map(|v| v.x)).take(4).collect();
    assert_close!(tilted[3] - tilted[1], period, 1e-4 * period);
    let amplitude = 1e-5 * (station.gravity * station.site.transverse_radius()).sqrt();
    let least = velocities(&station, tilt, InFrame::zeros())
        .take(5400)
        .fold(0.0, |least: f64, v| least.min(v.x));
    // φ about north causes an acceleration of -g φ to the east, and an oscillation of amplitude v = φ √(g R).
    assert_close!(least, -amplitude, 1e-4 * amplitude);
}

/// At latitude L the plane of the oscillation rotates by `-Ω sin L`, as that of Foucault's pendulum.
#[test]
fn schuler_oscillation_turns_as_a_foucault_pendulum() {
    let station = station(50.0 * DEG);
    let radius = (station.site.transverse_radius() * station.site.meridian_radius()).sqrt();
    let period = TAU * (radius / station.gravity).sqrt();
    // The speed has its maximum again after about one period: the direction of the velocity there is the plane.
    let fastest = velocities(&station, Vector3::zeros(), InFrame::new(0.0, 1.0, 0.0))
        .enumerate()
        .filter(|(second, _)| (*second as f64 - period).abs() < 0.1 * period)
        .take_while(|(second, _)| (*second as f64) < 1.05 * period)
        .map(|(_, velocity)| velocity)
        .max_by(|one, other| one.xy().norm().total_cmp(&other.xy().norm()))
        .unwrap();
    let turned = -fastest.x.atan2(fastest.y);
    let theory = -EARTH_RATE * station.site.latitude.sin() * period;
    // Terms of second order in Ω / ω_s, which is 1/17.
    assert_close!(turned, theory, 0.004 * theory.abs());
}

/// `δh'' = κ δh` with the gradient `κ` of gravity, which is `2 g / R` to one percent. Near the pole the Coriolis acceleration
/// is negligible.
#[test]
fn free_vertical_channel_diverges_with_the_slope_of_gravity() {
    const DURATION: f64 = 1800.0;
    let station = station(80.0 * DEG);
    let mut state = NavState {
        position: station.site,
        velocity: InFrame::zeros(),
        nav_from_body: Dcm::identity(),
    };
    state.position.height += 1.0;
    let increments = rates_at_rest(&station).over(0.1);
    let mut navigator = Navigator::new(state, &station, VerticalChannel::Free);
    for _ in 0..18_000 {
        navigator.step(&increments);
    }
    let height = navigator.state().position.height - station.site.height;

    let higher = Site { height: 100.0, ..station.site };
    let slope = (station.gravity - higher.normal_gravity()) / 100.0;
    let by_radius = 2.0 * station.gravity / station.site.transverse_radius();
    assert_close!(slope / by_radius, 1.0, 0.01);
    let grown = (slope.sqrt() * DURATION).cosh();
    assert_close!(grown, 11.7, 0.2);
    // The gradient over 100 m differs from that at the ellipsoid by 2e-5, and the Coriolis effect is 2e-4.
    assert_close!(height, grown, 3e-4 * grown);
}
