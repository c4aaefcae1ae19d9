//! Free inertial navigation over a calibrated run, and its errors.

use nalgebra::Vector3;
use rins_frames::{Body, Dcm, EulerAngles, Increments, Nav, Site, Table};
use rins_imu::Compensation;
use rins_motion::{Navigator, Recording, Station, VerticalChannel};

use crate::history::Thinning;

/// The result of free inertial navigation on a fixed table.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeNavigation {
    /// The final velocity, whose true value is zero \[m/s\].
    pub velocity: Vector3<f64>,
    /// The final position error, east, north and up \[m\].
    pub position_error: Vector3<f64>,
    /// The final errors of the axis frame's computed roll, pitch and yaw \[rad\].
    pub attitude_error: EulerAngles,
    /// The errors during the run.
    pub history: Vec<NavigationPoint>,
}

/// The errors of free inertial navigation at one time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NavigationPoint {
    /// \[s\]
    pub time: f64,
    /// \[m/s\]
    pub velocity: Vector3<f64>,
    /// East, north, up \[m\].
    pub position_error: Vector3<f64>,
    /// \[rad\]
    pub attitude_error: EulerAngles,
}

/// Integrates a recording from rest by free inertial navigation, with its vertical channel held.
///
/// The initial attitude is that of the axis frame, `nav_from_table`, rotated by the first of `angles`. These are the table
/// angles before each sample and after the last, one more than the samples. The attitude error is that of the axis frame, so
/// that it does not contain the table's rotation.
pub fn navigate_freely(
    recording: &Recording,
    angles: &[f64],
    nav_from_table: Dcm<Nav, Table>,
    station: &Station,
    compensation: Option<&Compensation>,
) -> FreeNavigation {
    navigate_compensating(recording, angles, nav_from_table, station, |_, sample| {
        compensation.map_or(*sample, |compensation| compensation.compensate(sample))
    })
}

/// [`navigate_freely`] with a compensation that may change from sample to sample; `compensated` receives a sample's index in
/// the recording and the sample.
pub(crate) fn navigate_compensating(
    recording: &Recording,
    angles: &[f64],
    nav_from_table: Dcm<Nav, Table>,
    station: &Station,
    mut compensated: impl FnMut(usize, &Increments) -> Increments,
) -> FreeNavigation {
    let turned = |angle: f64| Dcm::<Table, Body>::about_z(angle);
    let start = nav_from_table * turned(angles.first().copied().unwrap_or_default());
    let mut navigator = Navigator::at_rest(station, start, VerticalChannel::Held);
    let reference = nav_from_table.euler_angles();
    let mut history = Vec::new();
    let thinning = Thinning::of(recording.len());
    let mut last = NavigationPoint {
        time: recording.times.first().copied().unwrap_or_default(),
        velocity: Vector3::zeros(),
        position_error: Vector3::zeros(),
        attitude_error: EulerAngles::default(),
    };
    for (index, sample) in recording.increments.iter().enumerate() {
        navigator.step(&compensated(index, sample));
        if thinning.keeps(index) {
            let state = navigator.state();
            let table: Dcm<Nav, Table> = state.nav_from_body * turned(angles[index + 1]).inverse();
            last = NavigationPoint {
                time: recording.times[index],
                velocity: *state.velocity.components(),
                position_error: displacement(&station.site, &state.position),
                attitude_error: difference(&table.euler_angles(), &reference),
            };
            history.push(last);
        }
    }
    FreeNavigation {
        velocity: last.velocity,
        position_error: last.position_error,
        attitude_error: last.attitude_error,
        history,
    }
}

/// The displacement from `origin` to `place`, east, north and up \[m\], for small distances.
fn displacement(origin: &Site, place: &Site) -> Vector3<f64> {
    let east = (origin.transverse_radius() + origin.height) * origin.latitude.cos();
    Vector3::new(
        (place.longitude - origin.longitude) * east,
        (place.latitude - origin.latitude) * (origin.meridian_radius() + origin.height),
        place.height - origin.height,
    )
}

fn difference(computed: &EulerAngles, reference: &EulerAngles) -> EulerAngles {
    use std::f64::consts::{PI, TAU};
    let wrapped = |angle: f64| (angle + PI).rem_euclid(TAU) - PI;
    EulerAngles {
        roll: wrapped(computed.roll - reference.roll),
        pitch: wrapped(computed.pitch - reference.pitch),
        yaw: wrapped(computed.yaw - reference.yaw),
    }
}
