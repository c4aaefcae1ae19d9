//! Schedules that a table could run.

use std::fmt::Write as _;

use rins_frames::units::{DEG, DEG_PER_SECOND};
use rins_frames::{Dcm, EulerAngles, Nav, Table};
use rins_motion::{Profile, Segment};

use crate::planned::Planned;

/// The rate of a table of which nothing is said \[rad/s\].
pub const TYPICAL_RATE: f64 = 10.0 * DEG_PER_SECOND;

/// The acceleration of a table of which nothing is said \[rad/s²\].
pub const TYPICAL_ACCELERATION: f64 = 5.0 * DEG_PER_SECOND;

/// What a table can do, and how long one is ready to wait.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Limits {
    /// The fastest that it turns \[rad/s\].
    pub rate: f64,
    /// How hard it changes its rate \[rad/s²\].
    pub acceleration: f64,
    /// The longest that all runs may take together \[s\].
    pub duration: f64,
    /// Into how many directions the axis may be brought.
    pub directions: usize,
}

/// How the table turns in one direction of its axis: rates as parts of the fastest.
struct Shape {
    name: &'static str,
    rates: &'static [f64],
}

/// From the simplest on.
const SHAPES: [Shape; 5] = [
    Shape { name: "one rate", rates: &[1.0] },
    Shape { name: "forward and back", rates: &[1.0, -1.0] },
    Shape { name: "forward and back twice", rates: &[1.0, -1.0, 1.0, -1.0] },
    Shape { name: "two rates, forward and back", rates: &[1.0, -1.0, 0.5, -0.5] },
    Shape {
        name: "a static interval and three rates, forward and back",
        rates: &[0.0, 1.0, -1.0, 0.5, -0.5, 0.25, -0.25],
    },
];

/// The durations in each direction of the axis that are tried \[s\].
const DURATIONS: [f64; 11] =
    [60.0, 90.0, 120.0, 180.0, 240.0, 360.0, 480.0, 720.0, 1080.0, 1440.0, 2880.0];

/// A schedule that could be run next.
#[derive(Clone, Debug)]
pub struct Candidate {
    /// What it is, in words.
    pub words: String,
    /// What it is made of, one for each direction of the axis.
    pub runs: Vec<Planned>,
    /// The rates and durations of each \[rad/s, s\].
    pub segments: Vec<Segment>,
    /// How long all takes \[s\].
    pub duration: f64,
}

impl Candidate {
    /// Whether it takes as long in as many directions of the axis.
    pub(crate) fn is_as_long_as(&self, other: &Self) -> bool {
        self.runs.len() == other.runs.len() && self.duration.total_cmp(&other.duration).is_eq()
    }
}

/// All schedules within the limits, those first that need fewer directions of the axis, then the shorter ones, then
/// the simpler.
pub(crate) fn candidates(given: &Planned, limits: &Limits) -> Vec<Candidate> {
    let mut all = Vec::new();
    for directions in 1..=limits.directions.min(3) {
        let longest = limits.duration / directions as f64;
        // Where the limit is shorter than all of them, the limit.
        let shorter = (longest < DURATIONS[0]).then_some(longest);
        let usual = DURATIONS.into_iter().filter(|duration| *duration <= longest);
        for duration in usual.chain(shorter) {
            for shape in &SHAPES {
                all.extend(candidate(given, limits, directions, duration, shape));
            }
        }
    }
    all
}

/// None if a ramp does not fit.
fn candidate(
    given: &Planned,
    limits: &Limits,
    directions: usize,
    duration: f64,
    shape: &Shape,
) -> Option<Candidate> {
    let each = duration / shape.rates.len() as f64;
    let segments: Vec<Segment> = shape
        .rates
        .iter()
        .map(|part| Segment { rate: part * limits.rate, duration: each })
        .collect();
    let profile = Profile::new(&segments, Some(limits.acceleration)).ok()?;
    let runs = attitudes(given.nav_from_table(), directions)
        .into_iter()
        .map(|attitude| given.moved(profile.clone(), attitude))
        .collect();
    let total = duration * directions as f64;
    let mut words = format!("{} for {duration:.0} s", shape.name);
    if directions > 1 {
        let _ = write!(words, " in each of {directions} directions of the axis");
    }
    Some(Candidate { words, runs, segments, duration: total })
}

/// The given direction of the axis; a second, tilted by 5 deg, or by 30 deg where the first is nearly upright; and a
/// third, tilted by 45 deg. Each is a third of a turn further about the vertical.
fn attitudes(given: Dcm<Nav, Table>, directions: usize) -> Vec<Dcm<Nav, Table>> {
    let tilt = given.matrix()[(2, 2)].clamp(-1.0, 1.0).acos();
    let second = if tilt > 15.0 * DEG { 5.0 * DEG } else { 30.0 * DEG };
    let turned = |tilt: f64, thirds: f64| {
        let yaw = given.euler_angles().yaw + thirds * 120.0 * DEG;
        EulerAngles { roll: 0.0, pitch: tilt, yaw }.dcm()
    };
    [given, turned(second, 1.0), turned(45.0 * DEG, 2.0)].into_iter().take(directions).collect()
}
