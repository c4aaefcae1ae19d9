//! What the gyros count of the table's turn.

use nalgebra::Vector3;
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR};

use super::Expected;
use super::suspicion::Suspicion;
use super::timing::Timing;
use super::{CHANNELS, median, nearest_factor};
use crate::recording::Recording;

/// A table that turns by less in all \[rad\] says nothing of the gyros.
const LEAST_TURN: f64 = DEG;

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

impl Spin {
    /// `None` without a table that turns.
    pub(super) fn of(recording: &Recording, table_angle: Option<&[f64]>) -> Option<Self> {
        let angle = table_angle?;
        let samples = recording.increments.get(1..)?;
        let table: Vec<f64> = angle.windows(2).map(|pair| pair[1] - pair[0]).collect();
        let square: f64 = table.iter().map(|turn| turn * turn).sum();
        let turned: f64 = table.iter().map(|turn| turn.abs()).sum();
        if turned < LEAST_TURN {
            return None;
        }
        // Regression of each gyro on the table, sample by sample; a table at rest says nothing.
        let mut product = Vector3::zeros();
        for (sample, turn) in samples.iter().zip(&table) {
            product += sample.angle.components() * *turn;
        }
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
        let fastest =
            windows.iter().fold(0.0, |most: f64, (_, turn, time)| most.max((turn / time).abs()));
        let standing =
            windows.iter().filter(|(_, turn, time)| (turn / time).abs() < 1e-3 * fastest);
        let bias = median(standing.map(|(gyro, _, time)| gyro / time).collect()).unwrap_or(0.0);
        let turning = windows.iter().filter(|(_, turn, time)| (turn / time).abs() > 0.5 * fastest);
        let ratio = median(turning.map(|(gyro, turn, time)| (gyro - bias * time) / turn).collect());
        let all = product / square;
        Some(Self { ratio: ratio.unwrap_or(all.z), all, table, bias })
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
    ) -> Option<Suspicion> {
        let axis = self.all.iamax();
        // A sensor whose z axis follows the table at all does so best, whatever its unit.
        if axis != 2 && self.all[axis].abs() > 10.0 * self.all.z.abs() {
            return Some(Suspicion::SpinAxis { channel: CHANNELS[axis], ratio: self.all[axis] });
        }
        let cause = nearest_factor(
            self.ratio,
            &[
                (-1.0, "the table's sense is opposite to the gyro's"),
                (1.0 / DEG, "readings in deg were declared as rad, or the table's unit is wrong"),
                (DEG, "readings in rad were declared as deg, or the table's unit is wrong"),
                (DEG / DEG_PER_HOUR, "readings in deg/h were declared as deg/s"),
                (DEG_PER_HOUR / DEG, "readings in deg/s were declared as deg/h"),
                (1.0 / ARCSEC, "readings in arcsec were declared as rad, or in deg/h as rad/s"),
                (ARCSEC, "readings in rad were declared as arcsec, or in rad/s as deg/h"),
                (timing.interval, "angle increments were declared as rates"),
                (1.0 / timing.interval, "rates were declared as angle increments"),
            ],
            &[
                (0.9, "a table angle in gon was declared as deg, or gyros in deg as gon"),
                (1.0 / 0.9, "a table angle in deg was declared as gon, or gyros in gon as deg"),
            ],
        );
        match cause {
            Ok(()) => self.profile_suspicion(recording, expected),
            Err(cause) => Some(Suspicion::SpinScale { ratio: self.ratio, cause }),
        }
    }

    /// Whether, with ratio and bias allowed for, both turn at the same time.
    fn profile_suspicion(&self, recording: &Recording, expected: &Expected) -> Option<Suspicion> {
        let samples = recording.increments.get(1..)?;
        let mut apart = Vec::with_capacity(self.table.len() + 1);
        apart.push((recording.times.first().copied()?, 0.0, 0.0));
        for (sample, turn) in samples.iter().zip(&self.table) {
            let (time, gained, turned) = *apart.last()?;
            let gain =
                sample.angle.components().z - self.ratio * turn - self.bias * sample.interval;
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
        let usual = median(gains.clone())?;
        let scatter = 1.4826 * median(gains.iter().map(|gain| (gain - usual).abs()).collect())?;
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
