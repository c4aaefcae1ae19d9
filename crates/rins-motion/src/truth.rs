//! The output of a perfect IMU on a tilted table on the rotating Earth.

use nalgebra::{ComplexField, Vector3};
use rins_frames::{Dcm, InFrame, Increments, Nav, Table};

use crate::station::Station;
use crate::turntable::{Piece, Profile};

/// Nodes and weights of five-point Gauss-Legendre quadrature on [-1, 1].
const GAUSS: [(f64, f64); 5] = [
    (0.0, 0.5688888888888889),
    (0.5384693101056831, 0.47862867049936647),
    (-0.5384693101056831, 0.47862867049936647),
    (0.906179845938664, 0.23692688505618908),
    (-0.906179845938664, 0.23692688505618908),
];

/// The largest angle of rotation \[rad\] of one quadrature: its error there, about 0.25¹¹ (5!)⁴ / (11 (10!)³), is 10⁻¹⁹.
const LARGEST_TURN: f64 = 0.25;

/// A table on the Earth, and its motion.
#[derive(Clone, Debug, PartialEq)]
pub struct TrueMotion {
    /// The site of the table.
    pub station: Station,
    /// The attitude of the axis frame, which is constant.
    pub nav_from_table: Dcm<Nav, Table>,
    /// The table's motion.
    pub profile: Profile,
}

/// One interval of true motion.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TrueSample {
    /// The end of the interval \[s\].
    pub time: f64,
    /// The output of a perfect IMU over it.
    pub increments: Increments,
    /// The table angle at its end \[rad\].
    pub angle: f64,
    /// The mean table rate over it \[rad/s\].
    pub mean_rate: f64,
}

impl TrueMotion {
    /// The increments of a perfect IMU from time `from` to `to` \[s\], exact to rounding.
    ///
    /// `ω_ib^b = Rz(ζ)ᵀ ω_ie^s + ζ' z` (eq. (2)) and `f^b = -Rz(ζ)ᵀ g^s` are integrated over the true table angle ζ(t) by
    /// quadrature, whose error is below rounding.
    ///
    /// `from` must not be later than `to`. Outside the profile the first or last motion continues.
    pub fn increments(&self, from: f64, to: f64) -> Increments {
        let table_from_nav = self.nav_from_table.inverse();
        let earth_rate = table_from_nav * self.station.site.earth_rate();
        let reaction = table_from_nav * -self.station.gravity_vector();
        let (mut cos, mut sin) = (0.0, 0.0);
        for (piece, begin, end) in self.profile.pieces_within(from, to) {
            let (c, s) = integrals(piece, begin, end);
            cos += c;
            sin += s;
        }
        let turn = self.profile.angle(to) - self.profile.angle(from);
        let interval = to - from;
        let integral = |vector: InFrame<Table>| {
            let v = vector.components();
            Vector3::new(v.x * cos + v.y * sin, v.y * cos - v.x * sin, v.z * interval)
        };
        Increments {
            angle: InFrame::from_components(integral(earth_rate) + Vector3::z() * turn),
            velocity: InFrame::from_components(integral(reaction)),
            interval,
        }
    }

    /// The whole profile in intervals of `interval` \[s\]; an incomplete last interval is omitted.
    ///
    /// An interval that is not positive gives no samples.
    pub fn samples(&self, interval: f64) -> impl Iterator<Item = TrueSample> {
        // Half a nanosecond per day: rounding must not remove the last of n intervals.
        let count = if interval > 0.0 {
            (self.profile.duration() / interval * (1.0 + 1e-12)).floor()
        } else {
            0.0
        };
        let mut sample = 0.0;
        core::iter::from_fn(move || {
            if sample >= count {
                return None;
            }
            let (from, to) = (sample * interval, (sample + 1.0) * interval);
            sample += 1.0;
            let angle = self.profile.angle(to);
            Some(TrueSample {
                time: to,
                increments: Increments { interval, ..self.increments(from, to) },
                angle,
                mean_rate: (angle - self.profile.angle(from)) / interval,
            })
        })
    }
}

/// `∫ cos ζ dt` and `∫ sin ζ dt` over a part of a piece.
fn integrals(piece: &Piece, begin: f64, end: f64) -> (f64, f64) {
    let fastest = piece.rate_at(begin).abs().max(piece.rate_at(end).abs());
    let parts = (fastest * (end - begin) / LARGEST_TURN).ceil().max(1.0);
    let half = (end - begin) / parts / 2.0;
    let (mut cos, mut sin) = (0.0, 0.0);
    let mut part = 0.0;
    while part < parts {
        let middle = begin + half * (2.0 * part + 1.0);
        for (node, weight) in GAUSS {
            let (s, c) = ComplexField::sin_cos(piece.angle_at(middle + half * node));
            cos += weight * half * c;
            sin += weight * half * s;
        }
        part += 1.0;
    }
    (cos, sin)
}
