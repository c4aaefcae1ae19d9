//! How late the table's angle is, and how its count and the z gyro's compare.

use nalgebra::{Matrix4, Vector4};

use crate::recording::Recording;

/// The table's rate must change by this much \[rad/s\], rms, for a lag to show.
const LEAST_CHANGE: f64 = 1e-3;

/// A time stamp may mean the start, the middle or the end of a sample, and of the one before.
const MOST_SAMPLES_LATE: f64 = 2.0;

/// The angle of the z gyro against that of the table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TableLag {
    /// By how much the table's angle is late \[s\].
    pub latency: f64,
    /// Its 1σ by the scatter of the angles, as if that were white \[s\].
    pub sigma: f64,
    /// The gyro's turn over the table's: the gyro's scale, and how fast their clocks go.
    pub ratio: f64,
}

impl TableLag {
    /// `None` without an angle that was read, or if the table turns at one rate only.
    ///
    /// The gyro's angle is `ratio · (θ + latency · ω) + bias · t + start`, by least squares.
    pub(super) fn of(recording: &Recording) -> Option<Self> {
        let table = recording.table_angle.as_deref()?;
        let samples = &recording.increments;
        if samples.len() < 100 {
            return None;
        }
        let mut angle = 0.0;
        let mut rows = Vec::with_capacity(samples.len());
        for index in 1..samples.len() - 1 {
            angle += samples[index].angle.components().z;
            let over = recording.times[index + 1] - recording.times[index - 1];
            let rate = (table[index + 1] - table[index - 1]) / over;
            let time = recording.times[index] - recording.times[0];
            rows.push((Vector4::new(table[index] - table[0], rate, time, 1.0), angle));
        }
        let count = rows.len() as f64;
        let mean = rows.iter().map(|(row, _)| row.y).sum::<f64>() / count;
        let change = rows.iter().map(|(row, _)| (row.y - mean).powi(2)).sum::<f64>() / count;
        if change.sqrt() < LEAST_CHANGE {
            return None;
        }
        // Columns of one size, so that the normal equations are no worse than they must be.
        let mut size = Vector4::zeros();
        for (row, _) in &rows {
            size += row.component_mul(row);
        }
        let size = size.map(|square: f64| (square / count).sqrt().max(f64::MIN_POSITIVE));
        let (mut normal, mut right) = (Matrix4::zeros(), Vector4::zeros());
        for (row, angle) in &rows {
            let row = row.component_div(&size);
            normal += row * row.transpose();
            right += row * *angle;
        }
        let inverse = normal.try_inverse()?;
        let found = inverse * right;
        let off = |(row, angle): &(Vector4<f64>, f64)| angle - row.component_div(&size).dot(&found);
        let scatter = rows.iter().map(|row| off(row).powi(2)).sum::<f64>() / count;
        let ratio = found.x / size.x;
        let latency = found.y / size.y / ratio;
        let sigma = (scatter * inverse[(1, 1)]).sqrt() / size.y / ratio.abs();
        (latency.is_finite() && sigma.is_finite()).then_some(Self { latency, sigma, ratio })
    }

    /// The latency, if it is a matter of which instant of a sample a time stamp means, samples being `interval` long \[s\]: it
    /// is told by itself, and no sign of a table that moved otherwise.
    pub(super) fn by_convention(&self, interval: f64) -> Option<f64> {
        (self.latency.abs() <= MOST_SAMPLES_LATE * interval).then_some(self.latency)
    }
}
