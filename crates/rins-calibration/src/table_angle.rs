//! The table angle of each sample, from what was read of it or commanded.

use rins_motion::{Recording, cubic};

/// The table angle before the first sample of a recording and after each \[rad\]: as read, brought
/// forward by its `latency` \[s\], over which it turned as the gyro says, or the commanded rate integrated from zero.
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
        // Nothing was read before the first sample; the gyro says how far the table came since.
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

/// How far the z gyro turned by any time, its rate changing evenly from sample to sample.
struct Turned {
    /// The start of the first sample and the end of each \[s\].
    times: Vec<f64>,
    /// How far it turned by then \[rad\].
    angles: Vec<f64>,
    /// Its rate then \[rad/s\].
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

    /// By a time, before the start or after the end on at the rate there.
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

    /// A table that rests, ramps up at 20 deg/s² from a sample's end on, and turns at 15 deg/s.
    fn angle(time: f64) -> f64 {
        let ramping = (time - 1.0).clamp(0.0, 0.75);
        let on = (time - 1.75).max(0.0);
        (10.0 * ramping * ramping + 15.0 * on) * DEG
    }

    /// Angles that were read too late, or too early, are those of the time again, over the ramp too.
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
                // A ramp may begin anywhere in a sample: what is between two is known but to this.
                assert!(off < within, "{off} arcsec at {time} s of {latency} s");
            }
        }
    }
}
