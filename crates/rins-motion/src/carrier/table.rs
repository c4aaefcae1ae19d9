//! A single-axis table on a carrier, and the output of a perfect IMU on it.

use nalgebra::{ComplexField, Matrix3, Vector3};
use rins_frames::{Body, Dcm, InFrame, Increments, Nav, Site, Table};

use super::{Carrier, CarrierState};
use crate::station::Station;
use crate::turntable::{Profile, Segment};

/// Nodes and weights of three-point Gauss-Legendre quadrature on [-1, 1].
const GAUSS: [(f64, f64); 3] =
    [(0.0, 8.0 / 9.0), (0.774_596_669_241_483_4, 5.0 / 9.0), (-0.774_596_669_241_483_4, 5.0 / 9.0)];

/// A table on a carrier, whose motion repeats.
#[derive(Clone, Debug, PartialEq)]
pub struct CarriedTable {
    /// Where the voyage begins; the ratio of its gravity to the normal gravity is that of the whole voyage.
    pub station: Station,
    /// The attitude of the axis frame while the carrier heads north and does not sway.
    pub mounting: Dcm<Nav, Table>,
    /// The carrier.
    pub carrier: Carrier,
    /// Whether the table is isolated from the yaw of the carrier: its rates are then about the local level, not about the carrier.
    pub stabilized: bool,
    cycle: Profile,
    corners: Vec<f64>,
    turn: f64,
}

/// The state of a table on a carrier, and of the body on the table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CarriedState {
    /// Velocity over the Earth, east, north and up \[m/s\].
    pub velocity: Vector3<f64>,
    /// The specific force in n \[m/s²\].
    pub force: Vector3<f64>,
    /// The table angle relative to the carrier, unwrapped \[rad\].
    pub angle: f64,
    /// The table rate relative to the carrier \[rad/s\].
    pub rate: f64,
    /// Attitude, `C_b^n`.
    pub nav_from_body: Matrix3<f64>,
    /// The angular rate `ω_ib^b` \[rad/s\].
    pub body_rate: Vector3<f64>,
    /// The specific force `f^b` \[m/s²\].
    pub body_force: Vector3<f64>,
}

/// One interval of the true motion of a body on a carried table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CarriedSample {
    /// The end of the interval \[s\].
    pub time: f64,
    /// The output of a perfect IMU over it.
    pub increments: Increments,
    /// The place at its end.
    pub site: Site,
}

impl CarriedTable {
    /// A table that runs through this cycle of rates, each reached at once, again and again.
    ///
    /// # Errors
    /// [`ProfileError`](crate::ProfileError) if the cycle is not as it must be.
    pub fn new(
        (station, mounting): (Station, Dcm<Nav, Table>),
        carrier: Carrier,
        cycle: &[Segment],
        stabilized: bool,
    ) -> Result<Self, crate::ProfileError> {
        let profile = Profile::new(cycle, None)?;
        let mut end = 0.0;
        let corners = cycle.iter().map(|segment| {
            end += segment.duration;
            end
        });
        let corners = corners.collect();
        let turn = profile.angle(profile.duration());
        Ok(Self { station, mounting, carrier, stabilized, cycle: profile, corners, turn })
    }

    /// The fastest rate of the cycle \[rad/s\].
    pub fn fastest(&self) -> f64 {
        let rate = |end: &f64| self.cycle.rate(end * (1.0 - 1e-12)).abs();
        self.corners.iter().map(rate).fold(0.0, f64::max)
    }

    /// The state at `time` \[s\] at a place; at a corner, that after it.
    pub fn state(&self, time: f64, site: &Site) -> CarriedState {
        self.at(time, &Place::of(site, &self.station))
    }

    fn at(&self, time: f64, place: &Place) -> CarriedState {
        let carrier: CarrierState = self.carrier.at(time);
        let (round, within) = self.within(time);
        let (mut angle, mut rate) =
            (round * self.turn + self.cycle.angle(within), self.cycle.rate(within));
        if self.stabilized {
            angle -= carrier.yaw;
            rate -= carrier.yaw_rate;
        }
        let carrier_from_body =
            self.mounting.matrix() * Dcm::<Table, Body>::about_z(angle).matrix();
        let nav_from_body = carrier.attitude * carrier_from_body;
        let v = carrier.velocity;
        let transport = Vector3::new(
            -v.y * place.meridian,
            v.x * place.transverse,
            v.x * place.transverse * place.tan,
        );
        let rate_of_nav = place.earth_rate + transport;
        let force = carrier.acceleration
            + (place.earth_rate + rate_of_nav).cross(&v)
            + Vector3::z() * place.gravity;
        let body_rate = nav_from_body.transpose() * rate_of_nav
            + carrier_from_body.transpose() * carrier.rate
            + Vector3::z() * rate;
        let body_force = nav_from_body.transpose() * force;
        CarriedState { velocity: v, force, angle, rate, nav_from_body, body_rate, body_force }
    }

    /// The first time after `time` at which a rate of the table or of the carrier jumps \[s\].
    pub fn next_corner(&self, time: f64) -> f64 {
        let (round, within) = self.within(time);
        let next = self.corners.iter().find(|corner| **corner > within);
        let own = next.map_or(f64::INFINITY, |next| round * self.cycle.duration() + next);
        // Rounding must not return the present corner.
        let own = if own > time { own } else { time + self.corners[0] };
        own.min(self.carrier.next_corner(time))
    }

    /// The place at `to`, from that at `from`, both in s: the interval must hold no corner, and be short against the voyage.
    pub fn advanced(&self, site: &Site, from: f64, to: f64) -> Site {
        let place = Place::of(site, &self.station);
        let velocities = [from, 0.5 * (from + to), to].map(|time| self.carrier.at(time).velocity);
        let way = (velocities[0] + velocities[1] * 4.0 + velocities[2]) * ((to - from) / 6.0);
        let latitude = site.latitude + way.y * place.meridian;
        let middle = 0.5 * (site.latitude + latitude);
        let east = way.x * place.transverse / ComplexField::cos(middle);
        Site {
            latitude,
            longitude: site.longitude + east,
            height: self.station.site.height + self.carrier.heave(to),
        }
    }

    /// The motion in intervals of `interval` \[s\], without end.
    ///
    /// Rate and force are integrated by quadrature between the corners; its error over a turn of a degree is below 10⁻¹⁴ of the increment.
    pub fn samples(&self, interval: f64) -> impl Iterator<Item = CarriedSample> + '_ {
        let mut site = self.station.site;
        let mut from = 0.0;
        let mut corner = self.next_corner(0.0);
        (1_u64..).map(move |count| {
            let time = count as f64 * interval;
            let place = Place::of(&site, &self.station);
            let (mut angle, mut velocity) = (Vector3::zeros(), Vector3::zeros());
            let begin = from;
            while from < time {
                let to = corner.min(time);
                let half = 0.5 * (to - from);
                for (node, weight) in GAUSS {
                    let state = self.at(from + half * (1.0 + node), &place);
                    angle += state.body_rate * (weight * half);
                    velocity += state.body_force * (weight * half);
                }
                if half > 0.0 {
                    site = self.advanced(&site, from, to);
                }
                from = to;
                if corner <= time {
                    corner = self.next_corner(corner);
                }
            }
            let increments = Increments {
                angle: InFrame::from_components(angle),
                velocity: InFrame::from_components(velocity),
                interval: time - begin,
            };
            CarriedSample { time, increments, site }
        })
    }

    /// How many cycles have passed, and the time within the present one \[s\].
    fn within(&self, time: f64) -> (f64, f64) {
        let duration = self.cycle.duration();
        let round = (time / duration).floor();
        (round, time - round * duration)
    }
}

/// The Earth's properties at a place.
struct Place {
    earth_rate: Vector3<f64>,
    meridian: f64,
    transverse: f64,
    tan: f64,
    gravity: f64,
}

impl Place {
    fn of(site: &Site, station: &Station) -> Self {
        Self {
            earth_rate: *site.earth_rate().components(),
            meridian: 1.0 / (site.meridian_radius() + site.height),
            transverse: 1.0 / (site.transverse_radius() + site.height),
            tan: ComplexField::tan(site.latitude),
            gravity: site.normal_gravity() * station.gravity / station.site.normal_gravity(),
        }
    }
}
