//! Whether axes, signs, attitude and place agree with gravity, the Earth's rate and the turns made.

use nalgebra::Vector3;
use rins_frames::units::{DEG, DEG_PER_HOUR};
use rins_frames::{Body, Dcm, EARTH_RATE, InFrame, Nav, Site, Table};

use super::correction::{Hypothesis, SignedAxes, Weight};
use super::spin::Spin;
use super::suspicion::Suspicion;
use super::turning::Turning;
use super::{Expected, RestSeen};
use crate::station::Station;

/// The least angle by which the specific force may be off the axis' attitude \[rad\].
const LEAST_LEVEL_LIMIT: f64 = 1.0 * DEG;

/// The least rate by which a gyro that shows the Earth's rate may be off it \[rad/s\].
const LEAST_RATE_LIMIT: f64 = 1.5 * DEG_PER_HOUR;

/// How many sigma are odd.
const SIGMAS: f64 = 5.0;

/// How far the gyros may be off one axis by which the table turns, as a ratio.
const LARGEST_CROSS: f64 = 0.3;

/// What bears on axes and signs.
pub(super) struct Evidence<'a> {
    expected: &'a Expected,
    station: Option<Station>,
    /// The longest rest, and the table's angle then.
    rest: Option<(&'a RestSeen, Option<f64>)>,
    /// Each gyro's turn over the table's.
    spin: Option<Vector3<f64>>,
    turning: Option<Turning>,
}

/// A figure and how large it may be.
#[derive(Clone, Copy, Debug)]
struct Limited {
    off: f64,
    limit: f64,
}

impl Limited {
    fn holds(this: Option<Self>) -> bool {
        this.is_none_or(|this| this.off <= this.limit)
    }
}

impl<'a> Evidence<'a> {
    pub(super) fn new(
        expected: &'a Expected,
        rest: Option<(&'a RestSeen, Option<f64>)>,
        spin: Option<&Spin>,
        turning: Option<Turning>,
    ) -> Self {
        let station = expected.station;
        Self { expected, station, rest, spin: spin.map(|spin| spin.all), turning }
    }

    /// What is wrong, each with the single corrections that put all of it right.
    pub(super) fn suspicions(&self) -> Vec<Suspicion> {
        let given = Hypothesis {
            gyro: SignedAxes::IDENTITY,
            accel: SignedAxes::IDENTITY,
            angles: self.expected.axis.map(|axis| axis.angles),
            latitude: self.station.map_or(0.0, |station| station.site.latitude),
            table_sense: 1.0,
        };
        let (level, rate, latitude) =
            (self.level(&given), self.rate(&given), self.latitude(&given));
        let turning = self.turning.as_ref().map(|turning| turning.regression(&given));
        let wrong_hand = turning.filter(|turning| !turning.plausible(self.spin.is_some()));
        let all_hold = Limited::holds(level) && Limited::holds(rate) && Limited::holds(latitude);
        if all_hold && wrong_hand.is_none() {
            return Vec::new();
        }
        let weight = if level.is_some() { Weight::Directions } else { Weight::OneFigure };
        let corrections = given.corrections(weight, |hypothesis| self.explains(hypothesis));
        let odd = |limited: Option<Limited>| limited.filter(|limited| limited.off > limited.limit);
        let mut found = Vec::new();
        if let Some(Limited { off, limit }) = odd(level) {
            found.push(Suspicion::Level { off, limit, corrections: corrections.clone() });
        }
        if let Some(Limited { off, limit }) = odd(rate) {
            found.push(Suspicion::EarthRate { off, limit, corrections: corrections.clone() });
        }
        if let (Some(_), Some(seen)) = (odd(latitude), self.latitude_seen(&given)) {
            let expected = given.latitude;
            let corrections = corrections.clone();
            found.push(Suspicion::Latitude { seen, expected, corrections });
        }
        if let Some(turning) = wrong_hand {
            let (ratio, correlation) = (turning.ratio, turning.correlation);
            found.push(Suspicion::Handedness { ratio, correlation, corrections });
        }
        found
    }

    /// Whether all that is seen is as it should be if `hypothesis` were true.
    fn explains(&self, hypothesis: &Hypothesis) -> bool {
        let spins = self.spin.is_none_or(|spin| {
            let turned = hypothesis.gyro.apply(&spin) * hypothesis.table_sense;
            (turned - Vector3::z()).norm() < LARGEST_CROSS
        });
        spins
            && Limited::holds(self.level(hypothesis))
            && Limited::holds(self.rate(hypothesis))
            && Limited::holds(self.latitude(hypothesis))
            && self.turning.as_ref().is_none_or(|turning| turning.regression(hypothesis).certain())
    }

    /// The body's attitude in the longest rest.
    fn body_from_nav(&self, hypothesis: &Hypothesis) -> Option<Dcm<Body, Nav>> {
        let (_, table_angle) = self.rest?;
        let turned = Dcm::<Table, Body>::about_z(table_angle? * hypothesis.table_sense);
        let nav_from_table: Dcm<Nav, Table> = hypothesis.angles?.dcm();
        Some((nav_from_table * turned).inverse())
    }

    fn axis_sigma(&self) -> f64 {
        self.expected.axis.map_or(0.0, |axis| axis.sigma)
    }

    /// The angle between the specific force at rest and the vertical that the attitude has.
    fn level(&self, hypothesis: &Hypothesis) -> Option<Limited> {
        let (rest, _) = self.rest?;
        let up = self.body_from_nav(hypothesis)? * InFrame::new(0.0, 0.0, 1.0);
        let force = hypothesis.accel.apply(rest.mean.rates.specific_force.components());
        let gravity = force.norm();
        let bias = self.expected.accel.bias_sigma.unwrap_or(0.0);
        let sensors = SIGMAS * (bias + rest.mean.specific_force_sigma.norm()) / gravity;
        Some(Limited {
            off: up.components().angle(&force),
            limit: (SIGMAS * self.axis_sigma()).max(LEAST_LEVEL_LIMIT) + sensors,
        })
    }

    /// How far the mean rate at rest may be from the Earth's; `None` if it is farther even in its
    /// magnitude, which no axis or sign explains.
    fn rate_limit(&self) -> Option<f64> {
        let (rest, _) = self.rest?;
        let bias = SIGMAS * self.expected.gyro.bias_sigma.unwrap_or(0.0);
        let noise = SIGMAS * rest.mean.angular_rate_sigma.norm();
        let limit = bias.max(LEAST_RATE_LIMIT) + noise;
        let magnitude = rest.mean.rates.angular_rate.norm();
        ((magnitude - EARTH_RATE).abs() < limit).then_some(limit)
    }

    /// How far the mean rate at rest is from the Earth's by the attitude.
    fn rate(&self, hypothesis: &Hypothesis) -> Option<Limited> {
        let (rest, _) = self.rest?;
        let site = Site { latitude: hypothesis.latitude, ..self.station?.site };
        let earth = self.body_from_nav(hypothesis)? * site.earth_rate();
        let seen = hypothesis.gyro.apply(rest.mean.rates.angular_rate.components());
        Some(Limited {
            off: (seen - earth.components()).norm(),
            limit: self.rate_limit()? + SIGMAS * self.axis_sigma() * EARTH_RATE,
        })
    }

    /// The latitude that the angle between specific force and rate at rest is of.
    fn latitude_seen(&self, hypothesis: &Hypothesis) -> Option<f64> {
        let (rest, _) = self.rest?;
        let force = hypothesis.accel.apply(rest.mean.rates.specific_force.components());
        let rate = hypothesis.gyro.apply(rest.mean.rates.angular_rate.components());
        Some(force.dot(&rate).atan2(force.cross(&rate).norm()))
    }

    /// How far that is from the station's; with an attitude it is not asked.
    fn latitude(&self, hypothesis: &Hypothesis) -> Option<Limited> {
        if self.body_from_nav(hypothesis).is_some() || self.station.is_none() {
            return None;
        }
        Some(Limited {
            off: (self.latitude_seen(hypothesis)? - hypothesis.latitude).abs(),
            limit: self.rate_limit()? / EARTH_RATE,
        })
    }
}
