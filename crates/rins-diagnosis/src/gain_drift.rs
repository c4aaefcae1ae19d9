//! How far free inertial navigation drifts over what was held out.

use std::ops::Range;
use std::sync::Arc;

use rins_calibration::navigate_freely;
use rins_estimation::{Fit, Run, linearise};
use rins_frames::{Dcm, Nav, Table};
use rins_motion::Recording;
use rins_terms::{Model, NotUndone, compensated};

/// How long is navigated \[s\], if what was held out is so long.
const LASTING: [f64; 2] = [60.0, 300.0];

/// The drift of free inertial navigation, each window from rest and from the attitude that the table has.
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

/// A run as an IMU without the errors of a fitted model would have recorded it.
struct Undone {
    recording: Arc<Recording>,
    angles: Vec<f64>,
    nav_from_table: Dcm<Nav, Table>,
}

impl Undone {
    fn of(run: &Run, fit: &Fit, place: usize) -> Result<Self, NotUndone> {
        let around = fit.linear[place].track().surroundings;
        let recording = Arc::new(compensated(&fit.models[place], around, &run.recording)?);
        let clean = Run { recording, left_out: Vec::new(), ..run.clone() };
        let angles = linearise(&clean, &Model::default(), &[]).track().angles().to_vec();
        Ok(Self { recording: clean.recording, angles, nav_from_table: around.nav_from_table })
    }

    /// The squares of the drift of velocity and attitude over a window.
    fn squares(&self, run: &Run, window: &Range<usize>) -> (f64, f64) {
        let end = navigate_freely(
            &self.recording.slice(window.start, window.end),
            &self.angles[window.start..=window.end],
            self.nav_from_table,
            &run.rig.station,
            None,
        );
        let angles = end.attitude_error;
        let attitude = angles.roll.powi(2) + angles.pitch.powi(2) + angles.yaw.powi(2);
        (end.velocity.xy().norm_squared(), attitude)
    }
}

/// The drifts over these spans of runs, with the errors undone that each of two fits finds.
pub(crate) fn drifts(
    runs: &[Run],
    spans: &[Vec<Range<usize>>],
    fits: [&Fit; 2],
) -> Result<Vec<Drift>, NotUndone> {
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
