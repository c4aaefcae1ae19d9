//! The table's angle of rotation according to the gyros.

use nalgebra::Vector3;
use rins_frames::units::DEG;

use super::correction::Hypothesis;
use super::expected::{CHANNELS, Expected};
use super::suspicion::Suspicion;
use super::timing::Timing;
use super::turning::Turning;
use super::units::{Mistake, ReadingUnit, explained, mistakes};
use super::whole_turns::{STANDS, WholeTurns};
use rins_motion::{Recording, median};

/// The angle of rotation of the table \[rad\] below which it holds no information on the gyros.
const LEAST_TURN: f64 = DEG;

/// A mean rate that no gyro has in a static interval \[rad/s\].
const FAST: f64 = 0.5 * DEG;

/// The largest remainder of a gyro's angle after regression on the table's, relative to it.
const UNLIKE: f64 = 0.1;

/// The window over which angles of rotation are compared \[s\]: the noise of an encoder is negligible over it.
const WINDOW: f64 = 1.0;

/// The window in which a rotation that the table did not make is visible \[s\]: short enough that a gyro's bias is constant.
const STRETCH: f64 = 10.0;

/// The largest difference between the angles of gyro and table over it \[rad\] ...
const LARGEST_APART: f64 = 0.5 * DEG;

/// ... with this addition for each radian of rotation: a scale error that depends on the rate.
const LARGEST_NONLINEARITY: f64 = 2e-3;

/// The table's angle of rotation according to the gyros.
pub(super) struct Spin {
    /// The ratio of gyro z's to the table's angle of rotation, without the gyro's bias.
    pub(super) ratio: f64,
    /// The same for all three gyros by regression, including biases.
    pub(super) all: Vector3<f64>,
    /// The table's angle of rotation in each sample \[rad\].
    table: Vec<f64>,
    /// The mean rate of gyro z while the table is static \[rad/s\].
    bias: f64,
    /// The latency of the table angle by a convention of time stamps \[s\].
    late: f64,
}

/// The table angle at the end of each interval \[rad\]: measured, or commanded.
pub(super) fn table_angle(recording: &Recording) -> Option<Vec<f64>> {
    recording.table_angle.clone().or_else(|| {
        let mut angle = 0.0;
        let turned = recording.table_rate.as_ref()?.iter().zip(&recording.increments);
        let add = |(rate, sample): (&f64, &rins_frames::Increments)| {
            angle += rate * sample.interval;
            angle
        };
        Some(turned.map(add).collect())
    })
}

/// Whether the z gyro follows a table that hardly rotates, as one with a wrong unit.
fn follows(windows: &[(f64, f64, f64)]) -> bool {
    let sum = |of: fn(&(f64, f64, f64)) -> f64| windows.iter().map(of).sum::<f64>();
    let (gyro, table) = (sum(|(gyro, _, _)| gyro * gyro), sum(|(_, turn, _)| turn * turn));
    let product = sum(|(gyro, turn, _)| gyro * turn);
    let time = sum(|(_, _, time)| time * time);
    let left = gyro - product * product / table;
    table > 0.0 && gyro > FAST * FAST * time && left < UNLIKE * UNLIKE * gyro
}

/// The ratio of the rates of gyro and table from pairs of windows whose rates differ, of which the median counts (Theil), or
/// `None` if there is none.
fn slope(windows: &[(f64, f64, f64)], fastest: f64) -> Option<f64> {
    let rates = |&(gyro, turn, time): &(f64, f64, f64)| (gyro / time, turn / time);
    let mut rates: Vec<(f64, f64)> = windows.iter().map(rates).collect();
    rates.sort_by(|a, b| a.1.total_cmp(&b.1));
    let pairs = rates.iter().zip(&rates[rates.len() / 2..]);
    let differ = pairs.filter(|(slow, fast)| fast.1 - slow.1 > 0.5 * fastest);
    median(differ.map(|(slow, fast)| (fast.0 - slow.0) / (fast.1 - slow.1)))
}

/// The possible units of the table's readings, with the effect of each on the ratio.
fn table_mistakes(recording: &Recording, expected: &Expected, timing: &Timing) -> Vec<Mistake> {
    let (all, what): (&[ReadingUnit], _) = match (&recording.table_angle, expected.table_unit) {
        (Some(_), _) => (&ReadingUnit::TABLE_ANGLE, "readings of the table's angle"),
        (None, Some(_)) => (&ReadingUnit::TABLE_RATE, "readings of the table's rate"),
        // A commanded profile has its units in the rig file, one for each quantity.
        (None, None) => return Vec::new(),
    };
    let mut mistakes = mistakes(all, expected.table_unit, timing, what);
    for mistake in &mut mistakes {
        mistake.factor = 1.0 / mistake.factor;
    }
    mistakes
}

/// The wrong sensor if gyros and table disagree.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Suspect {
    Gyro,
    Table,
    Either,
}

impl Suspect {
    /// The decision by gravity, which is fixed in the table's axes if the table angle is right, and rotates in the body
    /// according to the gyros if these are right.
    pub(super) fn of(turns: Option<&WholeTurns>, turning: Option<&Turning>) -> Self {
        let table = turns.is_some_and(|turns| turns.standing()[0] > STANDS);
        let gyro =
            turning.is_some_and(|turning| turning.regression(&Hypothesis::AS_READ).certain());
        match (table, gyro) {
            (true, false) => Self::Gyro,
            (false, true) => Self::Table,
            _ => Self::Either,
        }
    }
}

impl Spin {
    /// `None` without a rotating table. Its angle has the latency `late` by a convention of time stamps \[s\].
    pub(super) fn of(
        recording: &Recording,
        table_angle: Option<&[f64]>,
        late: f64,
    ) -> Option<Self> {
        let angle = table_angle?;
        let samples = recording.increments.get(1..)?;
        let table: Vec<f64> = angle.windows(2).map(|pair| pair[1] - pair[0]).collect();
        // A log may be wrong for some seconds, so that the majority of the windows decides.
        let (mut window, mut windows) = ((0.0, 0.0, 0.0), Vec::new());
        for (sample, turn) in samples.iter().zip(&table) {
            window.0 += sample.angle.components().z;
            window.1 += turn;
            window.2 += sample.interval;
            if window.2 >= WINDOW {
                windows.push(window);
                window = (0.0, 0.0, 0.0);
            }
        }
        let (least, most) = angle
            .iter()
            .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), x| (a.min(*x), b.max(*x)));
        if most - least < LEAST_TURN && !follows(&windows) {
            return None;
        }
        // Regression of each gyro on the table, sample by sample; a static table holds no information.
        let square: f64 = table.iter().map(|turn| turn * turn).sum();
        let mut product = Vector3::zeros();
        for (sample, turn) in samples.iter().zip(&table) {
            product += sample.angle.components() * *turn;
        }
        let fastest =
            windows.iter().fold(0.0, |most: f64, (_, turn, time)| most.max((turn / time).abs()));
        let gained =
            |ratio: f64| move |(gyro, turn, time): &(f64, f64, f64)| (gyro - ratio * turn) / time;
        let turning = windows.iter().filter(|(_, turn, time)| (turn / time).abs() > 0.5 * fastest);
        let (ratio, bias) = match slope(&windows, fastest) {
            Some(ratio) => (Some(ratio), median(windows.iter().map(gained(ratio)))),
            // At one rate, a bias and an error of the scale factor are not distinguishable.
            None => (median(turning.map(|(gyro, turn, _)| gyro / turn)), None),
        };
        let all = product / square;
        Some(Self {
            ratio: ratio.unwrap_or(all.z),
            all,
            table,
            bias: bias.unwrap_or_default(),
            late,
        })
    }

    /// Whether gyros and table agree except for axes and signs.
    pub(super) fn counts(&self) -> bool {
        (0.7..1.4).contains(&self.all.norm())
    }

    pub(super) fn suspicion(
        &self,
        recording: &Recording,
        timing: &Timing,
        expected: &Expected,
        suspect: Suspect,
    ) -> Option<Suspicion> {
        let axis = self.all.iamax();
        // If the z axis of a sensor follows the table at all, it does so best, whatever its unit.
        if axis != 2 && self.all[axis].abs() > 10.0 * self.all.z.abs() {
            return Some(Suspicion::SpinAxis { channel: CHANNELS[axis], ratio: self.all[axis] });
        }
        let mut mistakes = match suspect {
            Suspect::Table => Vec::new(),
            _ => mistakes(&ReadingUnit::GYRO, expected.gyro.unit, timing, "readings"),
        };
        if suspect != Suspect::Gyro {
            mistakes.extend(table_mistakes(recording, expected, timing));
        }
        let cause = "the direction of rotation of the table is opposite to that of the gyro".into();
        mistakes.push(Mistake { factor: -1.0, cause });
        let cause = explained(self.ratio, &mistakes);
        match cause {
            Ok(()) => self.profile_suspicion(recording, expected),
            Err(cause) => Some(Suspicion::SpinScale { ratio: self.ratio, cause }),
        }
    }

    /// Whether both rotate at the same time, after correction for ratio and bias.
    fn profile_suspicion(&self, recording: &Recording, expected: &Expected) -> Option<Suspicion> {
        let samples = recording.increments.get(1..)?;
        let first = samples.first().zip(self.table.first());
        let mut before = first.map_or(0.0, |(sample, turn)| turn / sample.interval);
        let mut apart = Vec::with_capacity(self.table.len() + 1);
        apart.push((recording.times.first().copied()?, 0.0, 0.0));
        for (sample, turn) in samples.iter().zip(&self.table) {
            let (time, gained, turned) = *apart.last()?;
            // An angle with a latency lacks the recent change of the rate.
            let rate = turn / sample.interval;
            let turn_in_time = turn + self.late * (rate - before);
            before = rate;
            let gain = sample.angle.components().z
                - self.ratio * turn_in_time
                - self.bias * sample.interval;
            apart.push((time + sample.interval, gained + gain, turned + turn.abs()));
        }
        // Each window: its end, its duration, the difference of the angles and the table's angle of rotation.
        let over = |span: f64| {
            let mut end = 0;
            let mut stretches = Vec::with_capacity(apart.len());
            for &(start, gained, turned) in &apart {
                while end + 1 < apart.len() && apart[end].0 - start < span {
                    end += 1;
                }
                let (time, gained, turned) =
                    (apart[end].0, apart[end].1 - gained, apart[end].2 - turned);
                stretches.push((time, time - start, gained, turned));
                if end + 1 == apart.len() {
                    break;
                }
            }
            stretches
        };
        let gains: Vec<f64> = over(WINDOW).iter().map(|stretch| stretch.2).collect();
        // If the table is never static, most of the difference is the bias.
        let usual = median(gains.iter().copied())?;
        let scatter = 1.4826 * median(gains.iter().map(|gain| (gain - usual).abs()))?;
        let rates = self.table.iter().zip(samples).map(|(turn, sample)| turn / sample.interval);
        let fastest = rates.fold(0.0, |most: f64, rate| most.max(rate.abs()));
        let noise = 10.0 * scatter * (STRETCH / WINDOW).sqrt();
        let late = 2.0 * fastest * expected.table_latency.abs();
        let (mut worst, mut excess) = ((0.0, 0.0), 0.0);
        for span in [WINDOW, STRETCH] {
            for (time, lasting, gained, turned) in over(span) {
                let off = (gained - usual * lasting / WINDOW).abs();
                let limit = LARGEST_APART + LARGEST_NONLINEARITY * turned + noise + late;
                if off - limit > excess {
                    (worst, excess) = ((time, off), off - limit);
                }
            }
        }
        let (time, apart) = worst;
        (excess > 0.0).then_some(Suspicion::SpinProfile { apart, time })
    }
}
