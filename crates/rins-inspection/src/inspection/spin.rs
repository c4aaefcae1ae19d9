//! What the gyros count of the table's turn.

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

/// A table that turns by less \[rad\] says nothing of the gyros.
const LEAST_TURN: f64 = DEG;

/// A mean rate that no gyro has at rest \[rad/s\].
const FAST: f64 = 0.5 * DEG;

/// What of a gyro's turn that follows the table's may be left, as a share.
const UNLIKE: f64 = 0.1;

/// The stretch over which turns are compared \[s\]: an encoder's noise is nothing then.
const WINDOW: f64 = 1.0;

/// The stretch over which a turn that the table did not make shows \[s\]: short enough that a
/// gyro's bias does not wander.
const STRETCH: f64 = 10.0;

/// How far the gyro's and the table's turn may come apart over that \[rad\] ...
const LARGEST_APART: f64 = 0.5 * DEG;

/// ... and that much more for each radian turned: a scale error that depends on the rate.
const LARGEST_NONLINEARITY: f64 = 2e-3;

/// What the gyros count of the table's turn.
pub(super) struct Spin {
    /// The turn over the table's, of the gyro z, its bias left out.
    pub(super) ratio: f64,
    /// The same of all three gyros by regression, biases left in.
    pub(super) all: Vector3<f64>,
    /// The table's turn over each sample \[rad\].
    table: Vec<f64>,
    /// The mean rate of gyro z while the table stands \[rad/s\].
    bias: f64,
    /// By how much the table's angle is late by a convention of time stamps \[s\].
    late: f64,
}

/// The angle of the table at the end of each interval \[rad\]: as read, or as commanded.
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

/// Whether the z gyro follows a table that hardly turns, as of one whose unit is wrong.
fn follows(windows: &[(f64, f64, f64)]) -> bool {
    let sum = |of: fn(&(f64, f64, f64)) -> f64| windows.iter().map(of).sum::<f64>();
    let (gyro, table) = (sum(|(gyro, _, _)| gyro * gyro), sum(|(_, turn, _)| turn * turn));
    let product = sum(|(gyro, turn, _)| gyro * turn);
    let time = sum(|(_, _, time)| time * time);
    let left = gyro - product * product / table;
    table > 0.0 && gyro > FAST * FAST * time && left < UNLIKE * UNLIKE * gyro
}

/// The units that the table's readings may be in, with what each does to the ratio.
fn table_mistakes(recording: &Recording, expected: &Expected, timing: &Timing) -> Vec<Mistake> {
    let (all, what): (&[ReadingUnit], _) = match (&recording.table_angle, expected.table_unit) {
        (Some(_), _) => (&ReadingUnit::TABLE_ANGLE, "readings of the table's angle"),
        (None, Some(_)) => (&ReadingUnit::TABLE_RATE, "readings of the table's rate"),
        // A commanded profile has its units in the rig file, one each.
        (None, None) => return Vec::new(),
    };
    let mut mistakes = mistakes(all, expected.table_unit, timing, what);
    for mistake in &mut mistakes {
        mistake.factor = 1.0 / mistake.factor;
    }
    mistakes
}

/// Which of the two is wrong where gyros and table count differently.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Suspect {
    Gyro,
    Table,
    Either,
}

impl Suspect {
    /// By gravity, which stands still where the table's angle is right, and turns in the body as the
    /// gyros say where they are.
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
    /// `None` without a table that turns. Its angle is `late` by a convention of time stamps \[s\].
    pub(super) fn of(
        recording: &Recording,
        table_angle: Option<&[f64]>,
        late: f64,
    ) -> Option<Self> {
        let angle = table_angle?;
        let samples = recording.increments.get(1..)?;
        let table: Vec<f64> = angle.windows(2).map(|pair| pair[1] - pair[0]).collect();
        // A log may be wrong for some seconds, so that what most seconds say counts.
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
        // Regression of each gyro on the table, sample by sample; a table at rest says nothing.
        let square: f64 = table.iter().map(|turn| turn * turn).sum();
        let mut product = Vector3::zeros();
        for (sample, turn) in samples.iter().zip(&table) {
            product += sample.angle.components() * *turn;
        }
        let fastest =
            windows.iter().fold(0.0, |most: f64, (_, turn, time)| most.max((turn / time).abs()));
        let standing =
            windows.iter().filter(|(_, turn, time)| (turn / time).abs() < 1e-3 * fastest);
        let bias = median(standing.map(|(gyro, _, time)| gyro / time)).unwrap_or(0.0);
        let turning = windows.iter().filter(|(_, turn, time)| (turn / time).abs() > 0.5 * fastest);
        let ratio = median(turning.map(|(gyro, turn, time)| (gyro - bias * time) / turn));
        let all = product / square;
        Some(Self { ratio: ratio.unwrap_or(all.z), all, table, bias, late })
    }

    /// Whether gyros and table count alike but for axes and signs.
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
        // A sensor whose z axis follows the table at all does so best, whatever its unit.
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

    /// Whether, with ratio and bias allowed for, both turn at the same time.
    fn profile_suspicion(&self, recording: &Recording, expected: &Expected) -> Option<Suspicion> {
        let samples = recording.increments.get(1..)?;
        let first = samples.first().zip(self.table.first());
        let mut before = first.map_or(0.0, |(sample, turn)| turn / sample.interval);
        let mut apart = Vec::with_capacity(self.table.len() + 1);
        apart.push((recording.times.first().copied()?, 0.0, 0.0));
        for (sample, turn) in samples.iter().zip(&self.table) {
            let (time, gained, turned) = *apart.last()?;
            // An angle that is read late misses what the table gained in rate since.
            let rate = turn / sample.interval;
            let turn_in_time = turn + self.late * (rate - before);
            before = rate;
            let gain = sample.angle.components().z
                - self.ratio * turn_in_time
                - self.bias * sample.interval;
            apart.push((time + sample.interval, gained + gain, turned + turn.abs()));
        }
        // Each stretch: its end, how long it lasts, what was gained and what the table turned.
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
        // Where the table never stands the bias is what most of the difference is.
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
