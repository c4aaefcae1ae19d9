//! The table angle of each sample, from its readings or from the commanded rate.

use rins_motion::{Recording, cubic};

/// The table angle before the first sample of a recording and after each sample \[rad\]: the reading, corrected for its
/// `latency` \[s\] with the rotation measured by the gyro, or the integral of the commanded rate from zero.
pub fn table_angles(recording: &Recording, latency: f64) -> Option<Vec<f64>> {
    if let Some(read) = &recording.table_angle {
        let mut angles = vec![0.0];
        if latency == 0.0 {
            angles.extend(read);
        } else {
            let turned = Turned::of(recording);
            let now = turned.angles[1..].iter().zip(&recording.times);
            let since = |(angle, (now, time)): (&f64, (&f64, &f64))| {
                angle + now - turned.at(time - latency)
            };
            angles.extend(read.iter().zip(now).map(since));
        }
        // There is no reading before the first sample; the gyro measures the rotation since then.
        if let (Some(first), Some(sample)) = (angles.get(1), recording.increments.first()) {
            angles[0] = first - sample.angle.components().z;
        }
        return Some(angles);
    }
    let rate = recording.table_rate.as_ref()?;
    let mut angle = 0.0;
    let turns = rate.iter().zip(&recording.increments).map(|(rate, sample)| {
        angle += rate * sample.interval;
        angle
    });
    Some(std::iter::once(0.0).chain(turns).collect())
}

/// The angle of rotation of the z gyro at any time, with linear interpolation of its rate between the samples.
struct Turned {
    /// The start of the first sample and the end of each \[s\].
    times: Vec<f64>,
    /// The angle of rotation at these times \[rad\].
    angles: Vec<f64>,
    /// The rates at these times \[rad/s\].
    rates: Vec<f64>,
}

impl Turned {
    fn of(recording: &Recording) -> Self {
        let samples = &recording.increments;
        let begin = recording.times.first().zip(samples.first());
        let begin = begin.map_or(0.0, |(end, sample)| end - sample.interval);
        let times: Vec<f64> =
            std::iter::once(begin).chain(recording.times.iter().copied()).collect();
        let mut angles = vec![0.0];
        let mut angle = 0.0;
        angles.extend(samples.iter().map(|sample| {
            angle += sample.angle.components().z;
            angle
        }));
        let own: Vec<f64> =
            samples.iter().map(|one| one.angle.components().z / one.interval).collect();
        let last = own.len().saturating_sub(1);
        let rate = |edge: usize| {
            let [before, after] = [edge.saturating_sub(1), edge.min(last)];
            own.get(before)
                .zip(own.get(after))
                .map_or(0.0, |(before, after)| 0.5 * (before + after))
        };
        let rates = (0..times.len()).map(rate).collect();
        Self { times, angles, rates }
    }

    /// The angle at a time, extrapolated with a constant rate before the start and after the end.
    fn at(&self, time: f64) -> f64 {
        let edges = self.times.len();
        let after = self.times.partition_point(|edge| *edge <= time);
        if after == 0 || after == edges {
            let nearest = after.saturating_sub(1);
            return self.angles[nearest] + (time - self.times[nearest]) * self.rates[nearest];
        }
        let before = after - 1;
        let duration = self.times[after] - self.times[before];
        let part = (time - self.times[before]) / duration;
        let turned = self.angles[after] - self.angles[before];
        let [from, to] = [before, after].map(|edge| self.rates[edge] * duration);
        let [first, second, third] = cubic(turned, from, to);
        self.angles[before] + part * (part * (part * third + second) + first)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rins_frames::units::{ARCSEC, DEG};
    use rins_frames::{InFrame, Increments};

    const INTERVAL: f64 = 0.02;

    /// A table that is static, accelerates with 20 deg/s² from the end of a sample on, and rotates at 15 deg/s.
    fn angle(time: f64) -> f64 {
        let ramping = (time - 1.0).clamp(0.0, 0.75);
        let on = (time - 1.75).max(0.0);
        (10.0 * ramping * ramping + 15.0 * on) * DEG
    }

    /// Angles with a positive or negative latency are corrected, during the acceleration too.
    #[test]
    fn what_is_late_is_brought_forward() {
        let times: Vec<f64> = (1..=150).map(|sample| f64::from(sample) * INTERVAL).collect();
        let turn = |time: &f64| Increments {
            angle: InFrame::new(0.0, 0.0, angle(*time) - angle(time - INTERVAL)),
            velocity: InFrame::zeros(),
            interval: INTERVAL,
        };
        for (latency, within) in
            [(0.02, 1e-6), (-0.02, 1e-6), (0.1, 1e-6), (0.007, 2.0), (-0.013, 2.0)]
        {
            let recording = Recording {
                increments: times.iter().map(turn).collect(),
                table_angle: Some(times.iter().map(|time| angle(time - latency)).collect()),
                times: times.clone(),
                ..Recording::default()
            };
            let angles = table_angles(&recording, latency).unwrap();
            assert_eq!(angles.len(), times.len() + 1);
            for (found, time) in angles[1..].iter().zip(&times) {
                let off = (found - angle(*time)).abs() / ARCSEC;
                // The acceleration may begin at any time within a sample: this is the uncertainty of the interpolation.
                assert!(off < within, "{off} arcsec at {time} s of {latency} s");
            }
        }
    }
}
