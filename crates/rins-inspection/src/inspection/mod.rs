//! The inspection of a recording: its properties and its probable errors.

mod channel;
mod correction;
mod exchange;
mod expected;
mod lag;
mod orientation;
mod own_axes;
mod spin;
mod suspicion;
mod timing;
mod turning;
mod units;
mod whole_turns;

use rins_frames::EARTH_RATE;

pub use correction::Correction;
pub use expected::{CHANNELS, Expected, ExpectedAxis, ExpectedTriad, RestSeen};
pub use lag::TableLag;
pub use suspicion::Suspicion;
pub use timing::Timing;
pub use units::{ReadingOf, ReadingUnit};

use self::orientation::Evidence;
use self::spin::{Spin, Suspect, table_angle};
use self::turning::Turning;
use self::units::{explained, mistakes};
use self::whole_turns::WholeTurns;
use crate::repeats::{stuck_at_ends, stuck_for_long};
use crate::static_intervals::{SensorFigures, StaticIntervals, StaticOptions};
use crate::sticking::is_noisy;
use rins_motion::{Recording, RestMean, median};

/// The duration relative to the longest static interval from which static intervals are used like it.
const LONG_REST: f64 = 0.5;

/// The ratio of a static mean rate to the Earth's rate up to which the Earth's rate is visible.
const EARTH_RATE_VISIBLE: f64 = 2.0;

/// The properties of a recording.
#[derive(Clone, Debug, PartialEq)]
pub struct Inspection {
    /// The regularity of the samples.
    pub timing: Timing,
    /// The static intervals, and the candidates that were rejected.
    pub static_intervals: StaticIntervals,
    /// The means over the static intervals that are used.
    pub rests: Vec<RestSeen>,
    /// The number of revolutions about body z, forward and backward added.
    pub turns: f64,
    /// The ratio of gyro z's to the table's angle of rotation, without the gyro's bias, if there is a rotating table.
    pub spin_ratio: Option<f64>,
    /// The latency of the table angle, if it is measured and the rate changes.
    pub table_lag: Option<TableLag>,
    /// For each channel the resolution, if it is observable (SI units of an increment).
    pub resolution: [Option<f64>; 6],
    /// For each channel the length of the longest span of equal readings.
    pub longest_repeat: [usize; 6],
    /// Whether the table makes whole revolutions, over which directions are averaged.
    pub turns_whole: bool,
    /// Whether the static mean rate is close enough to the Earth's rate to contain it.
    pub earth_rate_visible: bool,
    /// The probable errors.
    pub suspicions: Vec<Suspicion>,
}

/// Inspects a recording, and compares it with what is `expected`.
///
/// Wrong axes and signs are visible where the run contains the information: in static specific force and Earth's rate if the
/// axis' attitude and the table angle are known, otherwise in the angle between the two, and in the change of the specific
/// force during a rotation about a tilted axis.
///
/// ```
/// use rins_frames::units::DEG;
/// use rins_frames::{Body, Dcm, EulerAngles, InFrame, Nav, Rates, Site};
/// use rins_inspection::{Expected, ExpectedAxis, Suspicion, inspect};
/// use rins_motion::{Recording, Station};
/// let site = Site { latitude: 34.25 * DEG, longitude: 0.0, height: 0.0 };
/// let station = Station::with_normal_gravity(site);
/// let angles = EulerAngles { roll: 30.0 * DEG, pitch: 20.0 * DEG, yaw: 40.0 * DEG };
/// let body_from_nav = angles.dcm::<Nav, Body>().inverse();
/// let rest = Rates {
///     angular_rate: body_from_nav * site.earth_rate(),
/// // An accelerometer that measures gravity, which points down, instead of specific force.
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
    let figures = |triad: &ExpectedTriad| SensorFigures {
        bias_sigma: triad.bias_sigma,
        ..SensorFigures::default()
    };
    let options = StaticOptions {
        gyro: figures(&expected.gyro),
        accel: figures(&expected.accel),
        ..StaticOptions::default()
    };
    inspect_with(recording, expected, StaticIntervals::of(recording, &options))
}

/// [`inspect`] with known static intervals.
pub fn inspect_with(
    recording: &Recording,
    expected: &Expected,
    static_intervals: StaticIntervals,
) -> Inspection {
    let channels: [Vec<f64>; 6] = std::array::from_fn(|channel| {
        recording.increments.iter().map(|sample| reading(sample, channel)).collect()
    });
    let rests: Vec<RestSeen> = static_intervals
        .spans(0.0)
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
    let mut suspicions = stuck_throughout(&channels, longest_repeat);
    let of_channels = channel::suspicions(recording, expected, &stands);
    let is_cut = |name: &str| {
        of_channels.iter().any(|of| {
            matches!(of, Suspicion::Saturated { channel, .. } | Suspicion::FlatTop { channel, .. }
                if *channel == name)
        })
    };
    let stuck = CHANNELS.into_iter().zip(stuck_for_long(recording)).enumerate();
    suspicions.extend(stuck.filter_map(|(place, (channel, mut rows))| {
        if rows.is_empty() && !is_cut(channel) {
            rows = stuck_at_ends(recording, place);
        }
        let longest = rows.first()?;
        let (count, time) = (longest.len(), recording.times[longest.start]);
        Some(Suspicion::Sticks { channel, rows: rows.len(), count, time })
    }));
    suspicions.extend(of_channels);
    let timing = Timing::of(recording);
    let longest = rests.iter().max_by(|a, b| a.mean.duration.total_cmp(&b.mean.duration));
    let table_angle = table_angle(recording);
    let whole_turns = WholeTurns::of(recording, table_angle.as_deref());
    // A slowly rotating table determines gravity as well as a static interval does.
    let force = longest
        .map(|rest| rest.mean.rates.specific_force.norm())
        .or_else(|| whole_turns.as_ref().and_then(|turns| turns.force));
    let gravity = force.and_then(|force| gravity_suspicion(force, expected, &timing));
    let table_lag = TableLag::of(recording);
    let late = table_lag.and_then(|lag| lag.by_convention(timing.interval)).unwrap_or_default();
    let spin = Spin::of(recording, table_angle.as_deref(), late);
    let turning = Turning::of(recording, &stands);
    let suspect = Suspect::of(whole_turns.as_ref(), turning.as_ref());
    let spun = spin.as_ref().and_then(|spin| spin.suspicion(recording, &timing, expected, suspect));
    let exchanged = exchange::suspicion(recording, table_angle.as_deref()).or_else(|| {
        // If the units are right, exchanged columns need not be considered.
        let turns = whole_turns.as_ref().filter(|_| gravity.is_some() && spun.is_some())?;
        exchange::in_turns(turns)
    });
    let right_units =
        gravity.is_none() && exchanged.is_none() && spin.as_ref().is_none_or(Spin::counts);
    // Other symptoms of exchanged columns are not reported separately.
    // The angle of a table that moved differently is wrong too, but perhaps not in static intervals.
    let followed = !matches!(spun, Some(Suspicion::SpinProfile { .. }));
    let of_units = if exchanged.is_some() { [exchanged, None] } else { [gravity, spun] };
    suspicions.extend(of_units.into_iter().flatten());
    // Directions are meaningful only if the units are right.
    if right_units {
        let share = if followed { LONG_REST } else { 1.0 };
        let lasting = longest.map_or(0.0, |rest| share * rest.mean.duration);
        let mut long: Vec<&RestSeen> =
            rests.iter().filter(|rest| rest.mean.duration >= lasting).collect();
        long.sort_by(|a, b| b.mean.duration.total_cmp(&a.mean.duration));
        let angle = |rest: &RestSeen| {
            table_angle.as_ref().and_then(|angle| median(angle[rest.span.clone()].iter().copied()))
        };
        let evidence = Evidence {
            expected,
            station: expected.station,
            rests: long.into_iter().map(|rest| (rest, angle(rest))).collect(),
            whole_turns: whole_turns.as_ref().filter(|_| followed),
            interval: timing.interval,
            spin: spin.as_ref().map(|spin| spin.all),
            turning,
        };
        suspicions.extend(evidence.suspicions());
    }
    Inspection {
        turns: recording.increments.iter().map(|s| s.angle.components().z.abs()).sum::<f64>()
            / std::f64::consts::TAU,
        spin_ratio: spin.map(|spin| spin.ratio),
        table_lag,
        turns_whole: whole_turns.is_some(),
        resolution: std::array::from_fn(|index| {
            channel::resolution_of(&channels[index], recording, timing.interval)
        }),
        longest_repeat,
        earth_rate_visible: rests
            .iter()
            .any(|rest| rest.mean.rates.angular_rate.norm() < EARTH_RATE_VISIBLE * EARTH_RATE),
        rests,
        static_intervals,
        timing,
        suspicions,
    }
}

/// The channels that repeat one reading throughout.
///
/// A coarse sensor, or one without noise, may do so in a static run: the other sensors of its triad decide. Three zeros are
/// no reading.
fn stuck_throughout(channels: &[Vec<f64>; 6], longest_repeat: [usize; 6]) -> Vec<Suspicion> {
    let is_stuck = |channel: &usize| {
        let triad = &channels[channel / 3 * 3..][..3];
        let is_zero = triad.iter().flatten().all(|reading| *reading == 0.0);
        let length = channels[*channel].len();
        length > 1
            && longest_repeat[*channel] == length
            && (is_zero || triad.iter().any(|readings| is_noisy(readings)))
    };
    let stuck = (0..6).filter(is_stuck);
    stuck.map(|channel| Suspicion::StuckChannel { channel: CHANNELS[channel] }).collect()
}

fn reading(sample: &rins_frames::Increments, channel: usize) -> f64 {
    if channel < 3 {
        sample.angle.components()[channel]
    } else {
        sample.velocity.components()[channel - 3]
    }
}

fn gravity_suspicion(seen: f64, expected: &Expected, timing: &Timing) -> Option<Suspicion> {
    let gravity = expected.station?.gravity;
    let mistakes = mistakes(&ReadingUnit::ACCEL, expected.accel.unit, timing, "readings");
    let cause = explained(seen / gravity, &mistakes).err()?;
    Some(Suspicion::Gravity { seen, expected: gravity, cause })
}
