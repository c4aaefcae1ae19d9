//! How far free inertial navigation drifts over what was held out.

use std::ops::Range;

use rins_calibration::navigate_freely;
use rins_estimation::{Fit, Run, Turned, attitudes};
use rins_frames::{Dcm, EulerAngles, Nav, Table};
use rins_motion::Recording;
use rins_terms::compensated;

use crate::prediction::gain::GainError;

/// How long is navigated \[s\], if what was held out is so long.
const LASTING: [f64; 2] = [60.0, 300.0];

/// The drift of free inertial navigation, each window from rest and from the attitude that the IMU is found to have by then.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Drift {
    /// After how long \[s\].
    pub after: f64,
    /// Over how many windows its root mean square is.
    pub windows: usize,
    /// The horizontal velocity with the errors undone that the model given finds, and those of the extended one \[m/s\].
    pub velocity: [f64; 2],
    /// The same of the attitude error \[rad\].
    pub attitude: [f64; 2],
}

/// A run as an IMU without the errors of a fitted model would have recorded it, and its attitude all the way.
struct Undone<'a> {
    recording: Recording,
    /// The table angle before each sample and after the last \[rad\].
    angles: &'a [f64],
    nav_from_table: Dcm<Nav, Table>,
    /// How the axis frame is turned from there.
    turned: Vec<Turned>,
}

impl<'a> Undone<'a> {
    fn of(run: &Run, fit: &'a Fit, place: usize) -> Result<Self, GainError> {
        let linear = &fit.linear[place];
        let around = linear.track().surroundings;
        Ok(Self {
            recording: compensated(&fit.models[place], around, &run.recording)?,
            angles: linear.track().angles(),
            nav_from_table: around.nav_from_table,
            turned: attitudes(run, linear, &fit.noise[place])?,
        })
    }

    /// The attitude of the axis frame before a sample, as the data up to there show it.
    fn attitude(&self, sample: usize) -> Dcm<Nav, Table> {
        let by_then = self.turned.partition_point(|turned| turned.samples <= sample);
        let known = self.turned.get(by_then.saturating_sub(1));
        known.map_or(self.nav_from_table, |turned| self.nav_from_table * turned.by)
    }

    /// The squares of the drift of velocity and attitude over a window.
    fn squares(&self, run: &Run, window: &Range<usize>) -> (f64, f64) {
        let start = self.attitude(window.start);
        let end = navigate_freely(
            &self.recording.slice(window.start, window.end),
            &self.angles[window.start..=window.end],
            start,
            &run.rig.station,
            None,
        );
        let (from, off) = (start.euler_angles(), end.attitude_error);
        let navigated: Dcm<Nav, Table> = EulerAngles {
            roll: from.roll + off.roll,
            pitch: from.pitch + off.pitch,
            yaw: from.yaw + off.yaw,
        }
        .dcm();
        let off = self.attitude(window.end).inverse() * navigated;
        (end.velocity.xy().norm_squared(), off.rotation_vector().norm_squared())
    }
}

/// The drifts over these spans of runs, with the errors undone that each of two fits finds.
pub(crate) fn drifts(
    runs: &[Run],
    spans: &[Vec<Range<usize>>],
    fits: [&Fit; 2],
) -> Result<Vec<Drift>, GainError> {
    let mut undone = Vec::with_capacity(runs.len());
    for (place, run) in runs.iter().enumerate() {
        undone.push([Undone::of(run, fits[0], place)?, Undone::of(run, fits[1], place)?]);
    }
    let longest = spans
        .iter()
        .zip(runs)
        .flat_map(|(spans, run)| spans.iter().map(|span| lasting(&run.recording, span)));
    let longest = longest.fold(0.0, f64::max);
    let mut drifts = Vec::new();
    for after in LASTING.map(|after| after.min(longest)) {
        let (mut windows, mut velocity, mut attitude) = (0, [0.0; 2], [0.0; 2]);
        for ((run, spans), undone) in runs.iter().zip(spans).zip(&undone) {
            for window in spans.iter().flat_map(|span| cut(&run.recording, span, after)) {
                windows += 1;
                for (place, undone) in undone.iter().enumerate() {
                    let (of_velocity, of_attitude) = undone.squares(run, &window);
                    velocity[place] += of_velocity;
                    attitude[place] += of_attitude;
                }
            }
        }
        let mean = |sum: f64| (sum / windows.max(1) as f64).sqrt();
        let drift =
            Drift { after, windows, velocity: velocity.map(mean), attitude: attitude.map(mean) };
        if windows > 0 && !drifts.contains(&drift) {
            drifts.push(drift);
        }
    }
    Ok(drifts)
}

fn lasting(recording: &Recording, span: &Range<usize>) -> f64 {
    recording.increments[span.clone()].iter().map(|sample| sample.interval).sum()
}

/// A span in windows of so many seconds, from its start on.
fn cut(recording: &Recording, span: &Range<usize>, after: f64) -> Vec<Range<usize>> {
    let mut windows = Vec::new();
    let (mut first, mut elapsed) = (span.start, 0.0);
    for sample in span.clone() {
        let interval = recording.increments[sample].interval;
        elapsed += interval;
        if elapsed > after - 0.5 * interval {
            windows.push(first..sample + 1);
            (first, elapsed) = (sample + 1, 0.0);
        }
    }
    windows
}
