//! A recording in short cells, from which means over any span are calculated.

use std::ops::Range;

use nalgebra::Vector3;

use super::options::StaticOptions;
use rins_motion::{Recording, median, whole};

/// The smallest duration of a cell \[s\]; a cell holds whole samples.
const CELL: f64 = 0.1;

/// The shortest span over which the scatter of samples is calculated \[s\] ...
const WINDOW: f64 = 0.5;

/// ... and the smallest number of samples.
const WINDOW_SAMPLES: usize = 8;

/// The largest interval after one lost sample, in mean intervals: this is not a gap.
const ONE_LOST: f64 = 2.5;

/// A shorter interruption \[s\] is not a gap either: an IMU cannot be moved and put back in that time.
const SHORTEST_GAP: f64 = 0.25;

/// Consecutive samples.
#[derive(Clone, Debug)]
pub(super) struct Cell {
    pub(super) span: Range<usize>,
    /// Whether there are no samples during most of it.
    pub(super) gap: bool,
    rate: Vector3<f64>,
    force: Vector3<f64>,
    /// The sums of squares about the means.
    rate_squares: f64,
    force_squares: f64,
}

/// The cells of a recording.
#[derive(Clone, Debug)]
pub(super) struct Cells {
    #[expect(clippy::struct_field_names, reason = "they are the cells, and the rest is of them")]
    pub(super) cells: Vec<Cell>,
    /// The time, and the integrated angle and velocity, before each cell and after the last.
    time: Vec<f64>,
    angle: Vec<Vector3<f64>>,
    velocity: Vec<Vector3<f64>>,
    /// The number of cells over which a scatter is calculated.
    pub(super) window: usize,
    /// The usual interval of a sample \[s\].
    pub(super) interval: f64,
    /// The LSB of each gyro \[rad/s\] and accelerometer \[m/s²\]; zero if it is neither visible nor stated.
    pub(super) gyro_step: Vector3<f64>,
    pub(super) accel_step: Vector3<f64>,
}

impl Cells {
    pub(super) fn of(recording: &Recording, options: &StaticOptions) -> Self {
        let samples = &recording.increments;
        let interval = median(samples.iter().map(|sample| sample.interval)).unwrap_or(CELL);
        let longest = (ONE_LOST * interval).max(interval + SHORTEST_GAP);
        let mut spans: Vec<(Range<usize>, bool)> = Vec::new();
        let (mut start, mut elapsed) = (0, 0.0);
        for (index, sample) in samples.iter().enumerate() {
            let gap = sample.interval > longest;
            if gap && start < index {
                spans.push((start..index, false));
                (start, elapsed) = (index, 0.0);
            }
            elapsed += sample.interval;
            if gap || elapsed >= CELL * (1.0 - 1e-9) {
                spans.push((start..index + 1, gap));
                (start, elapsed) = (index + 1, 0.0);
            }
        }
        if start < samples.len() {
            spans.push((start..samples.len(), false));
        }
        let mut all = Self {
            cells: Vec::with_capacity(spans.len()),
            time: vec![0.0],
            angle: vec![Vector3::zeros()],
            velocity: vec![Vector3::zeros()],
            window: 1,
            interval,
            gyro_step: Vector3::zeros(),
            accel_step: Vector3::zeros(),
        };
        for (span, gap) in spans {
            all.push(recording, span, gap);
        }
        let length = median(all.cells.iter().map(|cell| cell.span.len() as f64)).unwrap_or(1.0);
        let cell = length * interval;
        let needed = (WINDOW / cell).max(WINDOW_SAMPLES as f64 / length);
        all.window = whole((needed * (1.0 - 1e-9)).ceil()).clamp(1, all.cells.len().max(1));
        let step = |stated: Option<f64>, of: &dyn Fn(usize) -> f64| {
            stated.unwrap_or_else(|| least_step((0..samples.len()).map(of)))
        };
        let gyro = |axis: usize| move |k: usize| samples[k].rates().angular_rate.components()[axis];
        let accel =
            |axis: usize| move |k: usize| samples[k].rates().specific_force.components()[axis];
        all.gyro_step = Vector3::from_fn(|axis, _| step(options.gyro.resolution, &gyro(axis)));
        all.accel_step = Vector3::from_fn(|axis, _| step(options.accel.resolution, &accel(axis)));
        all
    }

    fn push(&mut self, recording: &Recording, span: Range<usize>, gap: bool) {
        let samples = &recording.increments[span.clone()];
        let last = self.cells.len();
        let (mut time, mut angle, mut velocity) =
            (self.time[last], self.angle[last], self.velocity[last]);
        for sample in samples {
            time += sample.interval;
            angle += sample.angle.components();
            velocity += sample.velocity.components();
        }
        let duration = time - self.time[last];
        let rate = (angle - self.angle[last]) / duration;
        let force = (velocity - self.velocity[last]) / duration;
        let (mut rate_squares, mut force_squares) = (0.0, 0.0);
        for sample in samples {
            let rates = sample.rates();
            rate_squares += (rates.angular_rate.components() - rate).norm_squared();
            force_squares += (rates.specific_force.components() - force).norm_squared();
        }
        self.time.push(time);
        self.angle.push(angle);
        self.velocity.push(velocity);
        self.cells.push(Cell { span, gap, rate, force, rate_squares, force_squares });
    }

    pub(super) fn len(&self) -> usize {
        self.cells.len()
    }

    /// The duration of these cells \[s\].
    pub(super) fn duration(&self, cells: &Range<usize>) -> f64 {
        self.time[cells.end] - self.time[cells.start]
    }

    /// The mean rate over these cells.
    pub(super) fn rate(&self, cells: &Range<usize>) -> Vector3<f64> {
        (self.angle[cells.end] - self.angle[cells.start]) / self.duration(cells)
    }

    /// The mean specific force over these cells.
    pub(super) fn force(&self, cells: &Range<usize>) -> Vector3<f64> {
        (self.velocity[cells.end] - self.velocity[cells.start]) / self.duration(cells)
    }

    /// The direction of the mean specific force.
    pub(super) fn up(&self, cells: &Range<usize>) -> Vector3<f64> {
        self.force(cells).try_normalize(0.0).unwrap_or_default()
    }

    /// The samples of these cells.
    pub(super) fn samples(&self, cells: &Range<usize>) -> Range<usize> {
        self.cells[cells.start].span.start..self.cells[cells.end - 1].span.end
    }

    /// The root mean square deviation of the samples from the mean over these cells, of gyros and accelerometers.
    pub(super) fn scatter(&self, cells: &Range<usize>) -> [f64; 2] {
        let cells = &self.cells[cells.clone()];
        let count: f64 = cells.iter().map(|cell| cell.span.len() as f64).sum();
        let mean = |of: fn(&Cell) -> Vector3<f64>| -> Vector3<f64> {
            cells.iter().map(|cell| of(cell) * cell.span.len() as f64).sum::<Vector3<f64>>() / count
        };
        let (rate, force) = (mean(|cell| cell.rate), mean(|cell| cell.force));
        let (mut rates, mut forces) = (0.0, 0.0);
        for cell in cells {
            let samples = cell.span.len() as f64;
            rates += cell.rate_squares + samples * (cell.rate - rate).norm_squared();
            forces += cell.force_squares + samples * (cell.force - force).norm_squared();
        }
        [(rates / count).sqrt(), (forces / count).sqrt()]
    }

    /// The largest changes of angle and velocity within these cells, if a static IMU measures `rate` and `force`.
    pub(super) fn excursion(
        &self,
        cells: &Range<usize>,
        rate: Vector3<f64>,
        force: Vector3<f64>,
    ) -> [f64; 2] {
        let mut most = [0.0_f64; 2];
        for end in cells.start + 1..=cells.end {
            let lasting = self.time[end] - self.time[cells.start];
            let angle = self.angle[end] - self.angle[cells.start] - rate * lasting;
            let velocity = self.velocity[end] - self.velocity[cells.start] - force * lasting;
            most = [most[0].max(angle.norm()), most[1].max(velocity.norm())];
        }
        most
    }
}

/// The smallest difference between successive readings: the LSB of a coarse sensor, and much less than the noise of a fine
/// one.
fn least_step(readings: impl Iterator<Item = f64>) -> f64 {
    /// The fraction of smaller differences, one in this number, which may be due to rounding errors instead of the LSB.
    const PART: usize = 20;
    /// Enough to determine the difference.
    const ENOUGH: usize = 100_000;
    let readings: Vec<f64> = readings.take(ENOUGH).collect();
    let largest = readings.iter().fold(0.0_f64, |most, reading| most.max(reading.abs()));
    let mut steps: Vec<f64> = readings
        .windows(2)
        .map(|pair| (pair[1] - pair[0]).abs())
        .filter(|step| *step > 1e-10 * largest)
        .collect();
    // Readings that change only a few times show a change of the input, not an LSB.
    if steps.len() < PART {
        return 0.0;
    }
    let place = steps.len() / PART;
    *steps.select_nth_unstable_by(place, f64::total_cmp).1
}
