//! The four kinds of runs, with random schedules.

use nalgebra::{UnitQuaternion, Vector3};

use super::imu::{DEG, Grade};
use super::motion::{Motion, Rate, Segment, Site};
use super::random::Random;

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Kind {
    /// Random attitudes by hand.
    Tumble,
    /// Each axis up and down, by hand.
    SixPositions,
    /// A level table; the attitude is not stated.
    LevelTable,
    /// A level table with each axis of the IMU along the spin axis, one log each.
    ThreeMountings,
}

impl Kind {
    pub(crate) const ALL: [Self; 4] =
        [Self::Tumble, Self::SixPositions, Self::LevelTable, Self::ThreeMountings];

    pub(crate) fn is_by_hand(self) -> bool {
        matches!(self, Self::Tumble | Self::SixPositions)
    }

    pub(crate) fn grade(self, random: &mut Random) -> Grade {
        if self == Self::LevelTable {
            Grade::MEMS[random.below(2)]
        } else {
            Grade::ALL[random.below(5)]
        }
    }
}

pub(crate) fn site(random: &mut Random) -> Site {
    Site { latitude: random.between(-70.0, 70.0) * DEG, height: random.between(0.0, 2000.0) }
}

/// A sampling rate \[Hz\] at which a log of `duration` \[s\] has at most so many samples.
pub(crate) fn rate(duration: f64, samples: f64, random: &mut Random) -> f64 {
    let rates = [20.0, 50.0, 100.0, 200.0, 500.0, 1000.0];
    let possible = rates.iter().filter(|rate| **rate * duration <= samples).count();
    rates[random.below(possible)]
}

/// The attitudes of static intervals, with a turn by hand between each two.
fn by_hand(
    site: Site,
    attitudes: &[UnitQuaternion<f64>],
    length: f64,
    random: &mut Random,
) -> Motion {
    let most = 500.0 / attitudes.len() as f64 - 4.0;
    let longest = 2.5_f64.max(length * random.log_between(2.5, 60.0).min(most));
    let mut segments = vec![Segment::still(random.between(2.0, longest))];
    for pair in attitudes.windows(2) {
        let turn = (pair[0].inverse() * pair[1]).scaled_axis();
        let shake = random.vector() * 1.0;
        segments.push(Segment {
            duration: random.between(1.0, 5.0),
            axis: turn.normalize(),
            rate: Rate::Turn(turn.norm()),
            shake,
        });
        segments.push(Segment::still(random.between(2.0, longest)));
    }
    Motion { site, start: attitudes[0], segments }
}

pub(crate) fn tumble(length: f64, random: &mut Random) -> Motion {
    let site = site(random);
    let count = 4 + random.below(27);
    let attitudes: Vec<_> = (0..count).map(|_| random.attitude()).collect();
    by_hand(site, &attitudes, length, random)
}

pub(crate) fn six_positions(length: f64, random: &mut Random) -> Motion {
    let site = site(random);
    let tolerance = random.log_between(0.05, 3.0) * DEG;
    let axes = [Vector3::x(), Vector3::y(), Vector3::z()];
    let mut ups: Vec<Vector3<f64>> = axes.iter().flat_map(|axis| [*axis, -axis]).collect();
    let mut attitudes = Vec::new();
    while !ups.is_empty() {
        let up = ups.swap_remove(random.below(ups.len()));
        let level = UnitQuaternion::rotation_between(&up, &Vector3::z())
            .unwrap_or_else(|| UnitQuaternion::new(Vector3::x() * std::f64::consts::PI));
        let about = UnitQuaternion::new(Vector3::z() * random.between(-3.0, 3.0));
        attitudes.push(UnitQuaternion::new(random.vector() * tolerance) * about * level);
    }
    by_hand(site, &attitudes, length, random)
}

/// A profile of commanded rates, with its acceleration \[rad/s²\].
#[derive(Clone, Debug)]
pub(crate) struct Profile {
    pub(crate) acceleration: f64,
    /// Rates \[rad/s\] and durations \[s\]; a ramp is the first part of its segment.
    pub(crate) rates: Vec<[f64; 2]>,
}

impl Profile {
    /// Standstill, one or two rates forward and back, standstill.
    pub(crate) fn draw(grade: Grade, length: f64, random: &mut Random) -> Self {
        let (low, high) = if Grade::MEMS.contains(&grade) { (20.0, 300.0) } else { (5.0, 60.0) };
        let mut rates = vec![[0.0, random.between(10.0, 10.0 + 30.0 * length)]];
        for _ in 0..=random.below(2) {
            let rate = random.log_between(low, high) * DEG;
            let first = if random.chance(0.5) { rate } else { -rate };
            for rate in [first, -first] {
                rates.push([rate, random.between(15.0, 15.0 + 45.0 * length)]);
            }
        }
        rates.push([0.0, random.between(10.0, 10.0 + 30.0 * length)]);
        Self { acceleration: high * DEG / random.between(1.0, 4.0), rates }
    }

    pub(crate) fn motion(&self, site: Site, start: UnitQuaternion<f64>) -> Motion {
        let mut segments = Vec::new();
        let mut before = 0.0;
        for [rate, duration] in &self.rates {
            let ramp = (rate - before).abs() / self.acceleration;
            if ramp > 0.0 {
                segments.push(Segment::ramp(ramp, before, *rate));
            }
            segments.push(Segment::ramp(duration - ramp, *rate, *rate));
            if *rate == 0.0 {
                segments.pop();
                segments.push(Segment::still(duration - ramp));
            }
            before = *rate;
        }
        Motion { site, start, segments }
    }
}
