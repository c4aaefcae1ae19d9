//! The consistency of axes, signs, attitude and site with gravity, the Earth's rate and rotations.

use nalgebra::Vector3;
use rins_frames::units::{DEG, DEG_PER_HOUR, STANDARD_GRAVITY};
use rins_frames::{Body, Dcm, EARTH_RATE, InFrame, Nav, Site, Table};

use super::correction::{Hypothesis, Weight};
use super::expected::{Expected, RestSeen};
use super::suspicion::Suspicion;
use super::turning::Turning;
use super::whole_turns::WholeTurns;
use rins_motion::Station;

/// The smallest limit of the angle between the specific force and the vertical of the axis' attitude \[rad\].
const LEAST_LEVEL_LIMIT: f64 = 1.0 * DEG;

/// The smallest limit of the difference between a gyro's mean rate and the Earth's rate \[rad/s\].
const LEAST_RATE_LIMIT: f64 = 1.5 * DEG_PER_HOUR;

/// The largest uncertainty of a mean rate, relative to the Earth's rate, for which its direction is meaningful.
const EARTH_RATE_SHOWN: f64 = 0.5;

/// The number of sigmas of a limit.
const SIGMAS: f64 = 5.0;

/// The largest error of the gyros' rotation axis relative to the table's, as a ratio.
const LARGEST_CROSS: f64 = 0.3;

/// The data on axes and signs.
pub(super) struct Evidence<'a> {
    pub(super) expected: &'a Expected,
    pub(super) station: Option<Station>,
    /// The long static intervals, the longest first, and the table angle in each.
    pub(super) rests: Vec<(&'a RestSeen, Option<f64>)>,
    pub(super) whole_turns: Option<&'a WholeTurns>,
    /// The median interval of the samples \[s\].
    pub(super) interval: f64,
    /// The ratio of each gyro's angle of rotation to the table's.
    pub(super) spin: Option<Vector3<f64>>,
    pub(super) turning: Option<Turning>,
}

/// A deviation and its limit.
#[derive(Clone, Copy, Debug)]
struct Limited {
    off: f64,
    limit: f64,
}

impl Limited {
    fn holds(this: Option<Self>) -> bool {
        this.is_none_or(|this| this.off <= this.limit)
    }

    fn worse(self, other: Self) -> Self {
        if other.off / other.limit > self.off / self.limit { other } else { self }
    }
}

/// The mean rates that must equal the Earth's rate.
#[derive(Clone, Copy, Debug)]
enum Rates {
    /// Those of all static intervals and of revolutions.
    All,
    /// That of the longest static interval.
    OfLongestRest,
}

impl Evidence<'_> {
    /// The errors, each with the single corrections that explain all deviations.
    pub(super) fn suspicions(&self) -> Vec<Suspicion> {
        let given = Hypothesis {
            angles: self.expected.axis.map(|axis| axis.angles),
            latitude: self.station.map_or(0.0, |station| station.site.latitude),
            ..Hypothesis::AS_READ
        };
        let (level, latitude) = (self.level(&given), self.latitude(&given));
        let rate = self.rates(&given).reduce(Limited::worse);
        let turning = self.turning.as_ref().map(|turning| turning.regression(&given));
        let wrong_hand = turning.filter(|turning| !turning.plausible(self.spin.is_some()));
        let all_hold = Limited::holds(level) && Limited::holds(rate) && Limited::holds(latitude);
        if all_hold && wrong_hand.is_none() {
            return Vec::new();
        }
        let weight = if level.is_some() { Weight::Directions } else { Weight::OneFigure };
        let explained = |rates| given.corrections(weight, |other| self.explains(other, rates));
        // Gyros may drift between static intervals, and have errors that rotate with the table: a deviation without a
        // correction is an error in the longest static interval, but not in the others.
        let (corrections, rate) = match explained(Rates::All) {
            none if none.is_empty() => (explained(Rates::OfLongestRest), self.firm_rate(&given)),
            corrections => (corrections, rate),
        };
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

    /// Whether all data are within their limits if `hypothesis` is true.
    fn explains(&self, hypothesis: &Hypothesis, rates: Rates) -> bool {
        let spins = self.spin.is_none_or(|spin| {
            let turned = hypothesis.gyro.apply(&spin) * hypothesis.table_sense;
            (turned - Vector3::z()).norm() < LARGEST_CROSS
        });
        spins
            && Limited::holds(self.level(hypothesis))
            && match rates {
                Rates::All => self.rates(hypothesis).all(|rate| Limited::holds(Some(rate))),
                Rates::OfLongestRest => Limited::holds(self.firm_rate(hypothesis)),
            }
            && Limited::holds(self.latitude(hypothesis))
            && self.turning.as_ref().is_none_or(|turning| turning.regression(hypothesis).certain())
    }

    /// The attitude of the body at a table angle.
    fn body_from_nav(hypothesis: &Hypothesis, table_angle: Option<f64>) -> Option<Dcm<Body, Nav>> {
        let turned = Dcm::<Table, Body>::about_z(table_angle? * hypothesis.table_sense);
        let nav_from_table: Dcm<Nav, Table> = hypothesis.angles?.dcm();
        Some((nav_from_table * turned).inverse())
    }

    fn axis_sigma(&self) -> f64 {
        self.expected.axis.map_or(0.0, |axis| axis.sigma)
    }

    /// The angle between the specific force and the vertical of the attitude, where it is largest relative to its limit.
    fn level(&self, hypothesis: &Hypothesis) -> Option<Limited> {
        let at_rest = self.rests.iter().filter_map(|rest| self.level_at_rest(hypothesis, rest));
        at_rest.chain(self.level_in_turns(hypothesis)).reduce(Limited::worse)
    }

    fn level_at_rest(
        &self,
        hypothesis: &Hypothesis,
        (rest, table_angle): &(&RestSeen, Option<f64>),
    ) -> Option<Limited> {
        let up = Self::body_from_nav(hypothesis, *table_angle)? * InFrame::new(0.0, 0.0, 1.0);
        let force = hypothesis.accel.apply(rest.mean.rates.specific_force.components());
        let sigma = rest.mean.specific_force_sigma.norm();
        Some(Limited {
            off: up.components().angle(&force),
            limit: self.level_limit() + SIGMAS * sigma / force.norm(),
        })
    }

    fn level_in_turns(&self, hypothesis: &Hypothesis) -> Option<Limited> {
        let turns = self.whole_turns?;
        let table_from_nav = hypothesis.angles?.dcm::<Nav, Table>().inverse();
        let up = table_from_nav * InFrame::new(0.0, 0.0, 1.0);
        let force = turns.force(&hypothesis.accel, hypothesis.table_sense);
        Some(Limited {
            off: up.components().angle(&force),
            limit: self.level_limit() + self.turned_late(turns),
        })
    }

    fn level_limit(&self) -> f64 {
        let bias = self.expected.accel.bias_sigma.unwrap_or(0.0) / STANDARD_GRAVITY;
        (SIGMAS * self.axis_sigma()).max(LEAST_LEVEL_LIMIT) + SIGMAS * bias
    }

    /// The largest rotation of the table during its latency.
    fn turned_late(&self, turns: &WholeTurns) -> f64 {
        (self.expected.table_latency.abs() + self.interval) * turns.fastest
    }

    /// The limit of the difference between the static mean rate and the Earth's rate; `None` if even its magnitude differs by
    /// more, which no axes or signs explain, or if the noise of the mean hides its direction.
    fn rate_limit(&self, rest: &RestSeen) -> Option<f64> {
        let bias = SIGMAS * self.expected.gyro.bias_sigma.unwrap_or(0.0);
        let noise = SIGMAS * rest.mean.angular_rate_sigma.norm();
        let limit = bias.max(LEAST_RATE_LIMIT) + noise;
        let magnitude = rest.mean.rates.angular_rate.norm();
        let is_shown = noise < EARTH_RATE_SHOWN * EARTH_RATE;
        (is_shown && (magnitude - EARTH_RATE).abs() < limit).then_some(limit)
    }

    /// The deviation of the mean rate from the Earth's rate at the attitude: in each static interval, the longest first, and
    /// in revolutions.
    fn rates(&self, hypothesis: &Hypothesis) -> impl Iterator<Item = Limited> {
        let at_rest = self.rests.iter().filter_map(|rest| self.rate_at_rest(hypothesis, rest));
        at_rest.chain(self.rate_in_turns(hypothesis))
    }

    /// The same in the longest static interval.
    fn firm_rate(&self, hypothesis: &Hypothesis) -> Option<Limited> {
        self.rests.first().and_then(|rest| self.rate_at_rest(hypothesis, rest))
    }

    fn rate_at_rest(
        &self,
        hypothesis: &Hypothesis,
        (rest, table_angle): &(&RestSeen, Option<f64>),
    ) -> Option<Limited> {
        let site = Site { latitude: hypothesis.latitude, ..self.station?.site };
        let earth = Self::body_from_nav(hypothesis, *table_angle)? * site.earth_rate();
        let seen = hypothesis.gyro.apply(rest.mean.rates.angular_rate.components());
        Some(Limited {
            off: (seen - earth.components()).norm(),
            limit: self.rate_limit(rest)? + SIGMAS * self.axis_sigma() * EARTH_RATE,
        })
    }

    /// The same perpendicular to the table's axis while it rotates, where a bias averages out.
    fn rate_in_turns(&self, hypothesis: &Hypothesis) -> Option<Limited> {
        let turns = self.whole_turns?;
        let site = Site { latitude: hypothesis.latitude, ..self.station?.site };
        let table_from_nav = hypothesis.angles?.dcm::<Nav, Table>().inverse();
        let earth = (table_from_nav * site.earth_rate()).components().xy();
        let (seen, sigma) = turns.rate_across(&hypothesis.gyro, hypothesis.table_sense);
        let direction = SIGMAS * self.axis_sigma() + self.turned_late(turns);
        let limit = LEAST_RATE_LIMIT + SIGMAS * sigma + direction * EARTH_RATE;
        // Gyros that hardly measure the Earth's rate hold no information on its direction.
        (limit < EARTH_RATE_SHOWN * earth.norm())
            .then(|| Limited { off: (seen - earth).norm(), limit })
    }

    /// The latitude from the angle between static specific force and rate.
    fn latitude_seen(&self, hypothesis: &Hypothesis) -> Option<f64> {
        let (rest, _) = self.rests.first()?;
        let force = hypothesis.accel.apply(rest.mean.rates.specific_force.components());
        let rate = hypothesis.gyro.apply(rest.mean.rates.angular_rate.components());
        Some(force.dot(&rate).atan2(force.cross(&rate).norm()))
    }

    /// The deviation of this latitude from the station's; `None` if the attitude is known.
    fn latitude(&self, hypothesis: &Hypothesis) -> Option<Limited> {
        let (rest, table_angle) = self.rests.first()?;
        if Self::body_from_nav(hypothesis, *table_angle).is_some() || self.station.is_none() {
            return None;
        }
        Some(Limited {
            off: (self.latitude_seen(hypothesis)? - hypothesis.latitude).abs(),
            limit: self.rate_limit(rest)? / EARTH_RATE,
        })
    }
}
