//! The library of rotation schedules.

mod nineteen;

use std::fmt::Write as _;

use rins_frames::units::DEG;
use rins_frames::{Dcm, EulerAngles, Nav, SignedAxes, Table};
use rins_motion::{Profile, Segment};

use self::nineteen::nineteen_positions;
use crate::candidate::Candidate;
use crate::limits::Limits;
use crate::planned::Planned;

/// The rotation in one direction of the axis: rates relative to the largest.
struct Shape {
    name: &'static str,
    rates: &'static [f64],
}

/// The shapes, the simplest first.
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

/// The durations of a run in each direction of the axis \[s\].
const DURATIONS: [f64; 11] =
    [60.0, 90.0, 120.0, 180.0, 240.0, 360.0, 480.0, 720.0, 1080.0, 1440.0, 2880.0];

/// All schedules within the limits, ordered by the number of directions of the axis, then by duration, then by simplicity.
pub(crate) fn candidates(given: &Planned, limits: &Limits) -> Vec<Candidate> {
    let mut all = Vec::new();
    for directions in 1..=limits.directions.min(3) {
        let longest = limits.duration / directions as f64;
        // If the limit is shorter than all of them, the limit itself.
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

/// The usual schedules in runs of one power-on, each as long as the limit: four static intervals, a reversal, and a reversal in two and in
/// three orientations of the axis; if the IMU can be mounted with each of its axes along the spin axis, also 19 positions. Those that a ramp
/// does not fit are left out.
pub fn usual_schedules(
    given: &Planned,
    limits: &Limits,
    mountings: &[SignedAxes],
) -> Vec<Candidate> {
    let Limits { rate, acceleration, duration, .. } = *limits;
    let attitude = given.nav_from_table();
    let yaw = attitude.euler_angles().yaw + 120.0 * DEG;
    let tilt = attitude.matrix()[(2, 2)].clamp(-1.0, 1.0).acos();
    let turned = |tilt: f64, yaw: f64| EulerAngles { roll: 0.0, pitch: tilt, yaw }.dcm();
    let second = if tilt > 15.0 * DEG { 5.0 * DEG } else { 30.0 * DEG };
    let quarter = 90.0 * DEG / rate;
    let dwells: Vec<Segment> = (0..7)
        .map(|place| {
            if place % 2 == 1 {
                Segment { rate, duration: quarter }
            } else {
                Segment { rate: 0.0, duration: (duration - 3.0 * quarter) / 4.0 }
            }
        })
        .collect();
    let reversal = |runs: f64| {
        [rate, -rate].map(|rate| Segment { rate, duration: 0.5 * duration / runs }).to_vec()
    };
    let all = [
        ("four dwells", dwells, vec![attitude]),
        ("reversal", reversal(1.0), vec![attitude]),
        ("two tilts", reversal(2.0), vec![attitude, turned(second, yaw)]),
        (
            "three orientations",
            reversal(3.0),
            vec![attitude, turned(tilt, yaw), turned(1.0 * DEG, yaw - 120.0 * DEG)],
        ),
    ];
    all.into_iter()
        .filter_map(|(words, segments, attitudes)| {
            let profile = Profile::new(&segments, Some(acceleration)).ok()?;
            let run = |attitude| given.moved(profile.clone(), attitude).since(0);
            let runs = attitudes.into_iter().map(run).collect();
            Some(Candidate { words: words.into(), runs, segments, duration })
        })
        .chain(nineteen_positions(given, limits, mountings))
        .collect()
}

/// A schedule of this shape; `None` if a ramp does not fit.
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

/// The given direction of the axis; a second one with a tilt of 5 deg, or of 30 deg if the first is nearly vertical; and a
/// third one with a tilt of 45 deg. The azimuths differ by 120 deg.
fn attitudes(given: Dcm<Nav, Table>, directions: usize) -> Vec<Dcm<Nav, Table>> {
    let tilt = given.matrix()[(2, 2)].clamp(-1.0, 1.0).acos();
    let second = if tilt > 15.0 * DEG { 5.0 * DEG } else { 30.0 * DEG };
    let turned = |tilt: f64, thirds: f64| {
        let yaw = given.euler_angles().yaw + thirds * 120.0 * DEG;
        EulerAngles { roll: 0.0, pitch: tilt, yaw }.dcm()
    };
    [given, turned(second, 1.0), turned(45.0 * DEG, 2.0)].into_iter().take(directions).collect()
}
