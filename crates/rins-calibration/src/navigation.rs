//! Free inertial navigation over a calibrated run, and how far it goes wrong.

use nalgebra::Vector3;
use rins_frames::{Body, Dcm, EulerAngles, Increments, Nav, Site, Table};
use rins_imu::Compensation;
use rins_motion::{Navigator, Recording, Station, VerticalChannel};

use crate::history::Thinning;

/// What free inertial navigation on a fixed table ended with.
#[derive(Clone, Debug, PartialEq)]
pub struct FreeNavigation {
    /// The velocity at the end \[m/s\]; the truth is zero.
    pub velocity: Vector3<f64>,
    /// How far east, north and up the computed position is off at the end \[m\].
    pub position_error: Vector3<f64>,
    /// How far the axis frame's computed roll, pitch and yaw are off at the end \[rad\].
    pub attitude_error: EulerAngles,
    /// The way there.
    pub history: Vec<NavigationPoint>,
}

/// A moment of free inertial navigation.
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

/// Navigates a recording freely from rest, with its vertical channel held.
///
/// The attitude at its start is the axis frame at `nav_from_table` turned by the first of `angles`,
/// which has one entry more than the recording has samples: the table angle before each and after
/// the last. The error is told of the axis frame, so that the table's own turn does not show.
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

/// [`navigate_freely`] with a compensation that may differ from sample to sample; `compensated` gets a
/// sample's index in the recording and the sample.
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

/// From `origin` to `place`, east, north and up \[m\], for places that are near each other.
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
