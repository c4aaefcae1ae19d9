//! What a recording holds, and what looks wrong with it.

mod channel;
mod correction;
mod exchange;
mod lag;
mod orientation;
mod spin;
mod suspicion;
mod timing;
mod turning;

use std::ops::Range;

use rins_frames::units::{MICRO_G, STANDARD_GRAVITY};
use rins_frames::{EARTH_RATE, EulerAngles};

pub use correction::{Correction, SignedAxes};
pub use lag::TableLag;
pub use suspicion::Suspicion;
pub use timing::Timing;

use self::orientation::Evidence;
use self::spin::{Spin, table_angle};
use self::turning::Turning;
use crate::recording::Recording;
use crate::rest::{RestMean, rest_spans};
use crate::station::Station;

/// How far a ratio may be from a suspected factor: a sensor as it comes from the factory may be off
/// by ten percent and more, a wrong unit by seven times at least.
const FACTOR_WITHIN: f64 = 0.2;

/// The same of a factor that is itself within ten percent or so of one.
const NARROW_FACTOR_WITHIN: f64 = 0.005;

/// The shortest rest that is reported \[s\].
const SHORTEST_REST: f64 = 1.0;

/// A mean rate at rest up to this many times the Earth's still shows the Earth's.
const EARTH_RATE_VISIBLE: f64 = 2.0;

/// The names of the six channels, in the order of every list here.
pub const CHANNELS: [&str; 6] = ["gyro.x", "gyro.y", "gyro.z", "accel.x", "accel.y", "accel.z"];

/// What was seen in a stretch of rest.
#[derive(Clone, Debug, PartialEq)]
pub struct RestSeen {
    /// The samples.
    pub span: Range<usize>,
    /// The means over them.
    pub mean: RestMean,
}

/// What a triad's data sheet says that its readings can be held against.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct ExpectedTriad {
    /// How far a bias may be from zero, 1σ \[rad/s\] or \[m/s²\].
    pub bias_sigma: Option<f64>,
    /// The largest rate or specific force that can be read \[rad/s\] or \[m/s²\].
    pub range: Option<f64>,
}

/// The attitude that the spin axis is said to have.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ExpectedAxis {
    /// Of the axis frame at table angle zero, `C_s^n`.
    pub angles: EulerAngles,
    /// Their 1σ \[rad\].
    pub sigma: f64,
}

/// What is known of a run beforehand; what is not, nothing is held against.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct Expected {
    /// The place and its gravity.
    pub station: Option<Station>,
    /// The attitude of the spin axis.
    pub axis: Option<ExpectedAxis>,
    /// By how much the table's angle or rate is late \[s\].
    pub table_latency: f64,
    /// The gyros.
    pub gyro: ExpectedTriad,
    /// The accelerometers.
    pub accel: ExpectedTriad,
}

/// What a recording holds.
#[derive(Clone, Debug, PartialEq)]
pub struct Inspection {
    /// How regularly samples came.
    pub timing: Timing,
    /// When the IMU stood still.
    pub rests: Vec<RestSeen>,
    /// How many turns were made about body z, forwards and backwards added up.
    pub turns: f64,
    /// The gyro z's turn over the table's, its bias left out, if there is a table that turns.
    pub spin_ratio: Option<f64>,
    /// How late the table's angle is, if it was read and the rate changes.
    pub table_lag: Option<TableLag>,
    /// For each channel the step between neighbouring readings, if there are few of them (SI units of an increment).
    pub resolution: [Option<f64>; 6],
    /// For each channel the longest run of equal readings.
    pub longest_repeat: [usize; 6],
    /// Whether the mean rate at rest is near enough to the Earth's to show it.
    pub earth_rate_visible: bool,
    /// What looks wrong.
    pub suspicions: Vec<Suspicion>,
}

/// Looks through a recording, and holds what is `expected` against it.
///
/// Wrong axes and signs show where the run shows them: in the specific force and the Earth's rate at
/// rest if the axis' attitude and the table's angle are known, in the angle between the two else,
/// and in how the specific force moves while turning about a tilted axis.
///
/// ```
/// use rins_frames::units::DEG;
/// use rins_frames::{Body, Dcm, EulerAngles, InFrame, Nav, Rates, Site};
/// use rins_motion::{Expected, ExpectedAxis, Recording, Station, Suspicion, inspect};
/// let site = Site { latitude: 34.25 * DEG, longitude: 0.0, height: 0.0 };
/// let station = Station::with_normal_gravity(site);
/// let angles = EulerAngles { roll: 30.0 * DEG, pitch: 20.0 * DEG, yaw: 40.0 * DEG };
/// let body_from_nav = angles.dcm::<Nav, Body>().inverse();
/// let rest = Rates {
///     angular_rate: body_from_nav * site.earth_rate(),
///     // An accelerometer that reads gravity, which points down, for specific force.
///     specific_force: body_from_nav * InFrame::new(0.0, 0.0, -station.gravity),
/// };
/// let recording = Recording {
///     times: (1..=60).map(f64::from).collect(),
///     increments: vec![rest.over(1.0); 60],
///     table_angle: Some(vec![0.0; 60]),
///     ..Recording::default()
/// };
/// let axis = Some(ExpectedAxis { angles, sigma: 0.1 * DEG });
/// let expected = Expected { station: Some(station), axis, ..Expected::default() };
/// let inspection = inspect(&recording, &expected);
/// assert!(inspection.suspicions.iter().any(|s| matches!(s, Suspicion::Level { off, .. } if *off > 3.1)));
/// ```
pub fn inspect(recording: &Recording, expected: &Expected) -> Inspection {
    let channels: [Vec<f64>; 6] = std::array::from_fn(|channel| {
        recording.increments.iter().map(|sample| reading(sample, channel)).collect()
    });
    let rests: Vec<RestSeen> = rest_spans(recording, SHORTEST_REST)
        .into_iter()
        .filter_map(|span| {
            RestMean::of(recording, span.clone()).map(|mean| RestSeen { span, mean })
        })
        .collect();
    let mut stands = vec![false; recording.len()];
    for rest in &rests {
        stands[rest.span.clone()].fill(true);
    }
    let longest_repeat = std::array::from_fn(|index| channel::longest_repeat(&channels[index]));
    let mut suspicions: Vec<Suspicion> = (0..6)
        .filter(|&channel| recording.len() > 1 && longest_repeat[channel] == recording.len())
        .map(|channel| Suspicion::StuckChannel { channel: CHANNELS[channel] })
        .collect();
    suspicions.extend(channel::suspicions(recording, expected, &stands));
    let timing = Timing::of(recording);
    let longest = rests.iter().max_by(|a, b| a.mean.duration.total_cmp(&b.mean.duration));
    let gravity = longest
        .zip(expected.station.as_ref())
        .and_then(|(rest, station)| gravity_suspicion(rest, station, &timing));
    let table_angle = table_angle(recording);
    let spin = Spin::of(recording, table_angle.as_deref());
    let exchanged = exchange::suspicion(recording, table_angle.as_deref());
    let spun = spin.as_ref().and_then(|spin| spin.suspicion(recording, &timing, expected));
    let right_units =
        gravity.is_none() && exchanged.is_none() && spin.as_ref().is_none_or(Spin::counts);
    // What exchanged columns look like beside is nothing of its own.
    let of_units = if exchanged.is_some() { [exchanged, None] } else { [gravity, spun] };
    suspicions.extend(of_units.into_iter().flatten());
    // Directions mean something once units are right.
    if right_units {
        let rest = longest.map(|rest| {
            let angle =
                table_angle.as_ref().and_then(|angle| median(angle[rest.span.clone()].to_vec()));
            (rest, angle)
        });
        let turning = Turning::of(recording, &stands);
        let evidence = Evidence::new(expected, rest, spin.as_ref(), turning);
        suspicions.extend(evidence.suspicions());
    }
    Inspection {
        turns: recording.increments.iter().map(|s| s.angle.components().z.abs()).sum::<f64>()
            / std::f64::consts::TAU,
        spin_ratio: spin.map(|spin| spin.ratio),
        table_lag: TableLag::of(recording),
        resolution: std::array::from_fn(|index| channel::resolution(&channels[index])),
        longest_repeat,
        earth_rate_visible: rests
            .iter()
            .any(|rest| rest.mean.rates.angular_rate.norm() < EARTH_RATE_VISIBLE * EARTH_RATE),
        rests,
        timing,
        suspicions,
    }
}

fn reading(sample: &rins_frames::Increments, channel: usize) -> f64 {
    if channel < 3 {
        sample.angle.components()[channel]
    } else {
        sample.velocity.components()[channel - 3]
    }
}

fn gravity_suspicion(rest: &RestSeen, station: &Station, timing: &Timing) -> Option<Suspicion> {
    let (seen, expected) = (rest.mean.rates.specific_force.norm(), station.gravity);
    let cause = nearest_factor(
        seen / expected,
        &[
            (STANDARD_GRAVITY, "readings in m/s^2 were declared as g"),
            (1.0 / STANDARD_GRAVITY, "readings in g were declared as m/s^2"),
            (1e3, "readings in mg were declared as g"),
            (1e-3, "readings in g were declared as mg"),
            (1.0 / (1e3 * MICRO_G), "readings in mg were declared as m/s^2"),
            (1e3 * MICRO_G, "readings in m/s^2 were declared as mg"),
            (timing.interval, "velocity increments were declared as specific force"),
            (1.0 / timing.interval, "specific force was declared as velocity increments"),
        ],
        &[],
    );
    cause.err().map(|cause| Suspicion::Gravity { seen, expected, cause })
}

/// Whether a ratio is near one or, if not, the mistake that makes it what it is.
///
/// Of the factors within [`FACTOR_WITHIN`] the nearest counts; those of `narrow` are so near to
/// one that a sensor as it comes from the factory may be as far off, so that they must fit well.
fn nearest_factor(
    ratio: f64,
    causes: &[(f64, &'static str)],
    narrow: &[(f64, &'static str)],
) -> Result<(), Option<&'static str>> {
    let off = |factor: f64| (ratio / factor - 1.0).abs();
    let all = causes
        .iter()
        .map(|cause| (cause, FACTOR_WITHIN))
        .chain(narrow.iter().map(|cause| (cause, NARROW_FACTOR_WITHIN)));
    let nearest = all
        .filter(|((factor, _), within)| off(*factor) < *within)
        .min_by(|((a, _), _), ((b, _), _)| off(*a).total_cmp(&off(*b)));
    match nearest {
        Some(((factor, cause), _)) if off(*factor) < off(1.0) => Err(Some(*cause)),
        _ if off(1.0) < FACTOR_WITHIN => Ok(()),
        Some(((_, cause), _)) => Err(Some(*cause)),
        None => Err(None),
    }
}

fn median(mut values: Vec<f64>) -> Option<f64> {
    values.sort_by(f64::total_cmp);
    values.get(values.len() / 2).copied()
}
