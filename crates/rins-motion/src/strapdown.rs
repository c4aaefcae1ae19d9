//! Strapdown mechanisation: attitude, velocity and position from increments.

mod mechanisation;
mod vicinity;

use rins_frames::{Body, Dcm, InFrame, Increments, Nav, Site};
use rins_lanes::{Matrix, Vector};

pub use self::mechanisation::{Mechanisation, VerticalChannel};
pub use self::vicinity::Figures;
use crate::station::Station;

/// Position, velocity and attitude.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct NavState {
    /// Latitude, longitude and height.
    pub position: Site,
    /// Velocity over the Earth \[m/s\].
    pub velocity: InFrame<Nav>,
    /// Attitude, `C_b^n`.
    pub nav_from_body: Dcm<Nav, Body>,
}

/// A strapdown navigator on the WGS84 Earth.
///
/// It is the [`Mechanisation`] of one run, with frames in its types.
///
/// It must not be used close to a pole, where longitude and north are undefined.
///
/// ```
/// use rins_frames::units::DEG;
/// use rins_frames::{Dcm, InFrame, Rates, Site};
/// use rins_motion::{Navigator, Station, VerticalChannel};
/// let site = Site { latitude: 45.0 * DEG, longitude: 0.0, height: 0.0 };
/// let station = Station::with_normal_gravity(site);
/// // Level, pointing north, at rest, with an east accelerometer bias of 1 mm/s².
/// let read = Rates {
///     angular_rate: InFrame::from_components(*site.earth_rate().components()),
///     specific_force: InFrame::new(1e-3, 0.0, station.gravity),
/// };
/// let mut navigator = Navigator::at_rest(&station, Dcm::identity(), VerticalChannel::Held);
/// for _ in 0..100 {
///     navigator.step(&read.over(0.01));
/// }
/// assert!((navigator.state().velocity.components().x - 1e-3).abs() < 1e-7);
/// ```
#[derive(Clone, Debug)]
pub struct Navigator {
    state: NavState,
    mechanisation: Mechanisation<f64>,
    force_gain: InFrame<Nav>,
}

impl Navigator {
    /// A navigator that starts at `state`, with the gravity measured at `station`.
    pub fn new(state: NavState, station: &Station, vertical: VerticalChannel) -> Self {
        let NavState { position, velocity, nav_from_body } = &state;
        let Site { latitude, longitude, height } = *position;
        let mechanisation = Mechanisation::new(
            [latitude, longitude, height],
            Vector::from(*velocity.components()),
            Matrix::from(nav_from_body.matrix()),
            station,
            vertical,
        );
        Self { state, mechanisation, force_gain: InFrame::zeros() }
    }

    /// A stationary navigator at `station` with this attitude.
    pub fn at_rest(
        station: &Station,
        nav_from_body: Dcm<Nav, Body>,
        vertical: VerticalChannel,
    ) -> Self {
        let state = NavState { position: station.site, velocity: InFrame::zeros(), nav_from_body };
        Self::new(state, station, vertical)
    }

    /// The current position, velocity and attitude.
    pub const fn state(&self) -> &NavState {
        &self.state
    }

    /// The current position, velocity and attitude, for the correction by a filter.
    pub const fn state_mut(&mut self) -> &mut NavState {
        &mut self.state
    }

    /// The specific force over the last interval, integrated and resolved in n: `∫ f^n dt` \[m/s\].
    pub const fn force_gain(&self) -> &InFrame<Nav> {
        &self.force_gain
    }

    /// The current rate of n with respect to inertial space, `ω_in^n` \[rad/s\].
    pub fn rate_of_nav_in_inertial(&self) -> InFrame<Nav> {
        let NavState { position, velocity, .. } = &self.state;
        position.earth_rate() + position.transport_rate(velocity)
    }

    /// Propagates the state over one interval.
    ///
    /// The interval must be longer than zero; it may differ from the previous one. The first step has no previous increments
    /// and therefore no coning and sculling corrections: start at rest.
    pub fn step(&mut self, now: &Increments) {
        let NavState { position, velocity, nav_from_body } = &self.state;
        let kernel = &mut self.mechanisation;
        kernel.place = [position.latitude, position.longitude, position.height];
        kernel.velocity = Vector::from(*velocity.components());
        kernel.nav_from_body = Matrix::from(nav_from_body.matrix());
        kernel.step(
            &Vector::from(*now.angle.components()),
            &Vector::from(*now.velocity.components()),
            now.interval,
        );
        let [latitude, longitude, height] = kernel.place;
        let attitude = kernel.nav_from_body.lane(0);
        self.state = NavState {
            position: Site { latitude, longitude, height },
            velocity: InFrame::from_components(kernel.velocity.into()),
            nav_from_body: Dcm::from_kernel(attitude),
        };
        self.force_gain = InFrame::from_components(kernel.force_gain.into());
    }
}
