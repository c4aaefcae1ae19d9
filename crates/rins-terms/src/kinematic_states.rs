//! The kinematic states along a track, sample by sample.

use nalgebra::Vector3;

use crate::kinematic_state::{Instant, KinematicState, turned_back};
use crate::track::Track;

impl Track {
    /// What is going on over each sample, in order.
    pub fn moments(&self) -> KinematicStates<'_> {
        KinematicStates {
            track: self,
            sample: 0,
            start: self.start(),
            moment: KinematicState {
                sample: 0,
                interval: 0.0,
                duration: self.duration(),
                mean: Instant::default(),
                end: Instant::default(),
                rate: Vector3::zeros(),
                force: Vector3::zeros(),
                surroundings: self.surroundings,
                track: Some(self),
            },
        }
    }

    /// What is going on from each of these samples on; they are in order.
    ///
    /// The moments are those that [`moments`](Self::moments) comes to there, so that stretches of a long track can be
    /// taken apart.
    pub fn moments_from(
        &self,
        samples: impl IntoIterator<Item = usize>,
    ) -> Vec<KinematicStates<'_>> {
        let mut at = self.moments();
        let from = |sample: usize| {
            at.sample = at.sample.max(sample.min(self.len()));
            at.clone()
        };
        samples.into_iter().map(from).collect()
    }

    /// The moment that ends where the first sample begins: what the run starts from.
    pub fn opening(&self) -> Option<KinematicState<'_>> {
        let first = self.moments().next()?;
        let start =
            Instant { time: 0.0, angle: self.angles[0], rate: first.mean.rate, ..first.end };
        Some(KinematicState { mean: start, end: start, ..first })
    }
}

/// The moments of a [`Track`], in order.
#[derive(Clone, Debug)]
pub struct KinematicStates<'a> {
    track: &'a Track,
    sample: usize,
    /// When the first sample began \[s\].
    start: f64,
    /// The moment of the sample before.
    moment: KinematicState<'a>,
}

impl<'a> KinematicStates<'a> {
    /// The next moment, to be looked at where it is made: to copy it takes as long as to make it.
    pub fn advance(&mut self) -> Option<&KinematicState<'a>> {
        let (track, sample) = (self.track, self.sample);
        let time = *track.times.get(sample)?;
        let (rate, elapsed) = track.over(sample);
        let acceleration = (track.edges[sample + 1] - track.edges[sample]) / elapsed;
        self.sample += 1;
        let interval = track.intervals[sample];
        let temperature_before = track.temperature(sample.saturating_sub(1));
        let temperature = track.temperature(sample);
        // A table that speeds up is behind the middle of its way for most of the time.
        let behind = 0.5 * rate * interval + acceleration * interval * interval / 12.0;
        let mean = Instant {
            time: time - 0.5 * interval - self.start,
            angle: track.angles[sample + 1] - behind,
            rate,
            acceleration,
            sense: 0.5 * (track.sense(sample.saturating_sub(1)) + track.sense(sample)),
            rate_change: f64::from(track.rate_changes[sample]),
            temperature: temperature.zip(temperature_before).map(|(t, before)| t.midpoint(before)),
            warming_rate: track.warming_rates.as_ref().map_or(0.0, |list| list[sample]),
        };
        // The mean of a vector that turns at a constant rate is shorter than the vector.
        let half_turn = 0.5 * rate * interval;
        let shortening = if half_turn.abs() < 1e-4 {
            1.0 - half_turn * half_turn / 6.0
        } else {
            half_turn.sin() / half_turn
        };
        let direction = mean.angle.sin_cos();
        let mean_in_body = |vector: &Vector3<f64>| {
            let v = turned_back(vector, direction);
            Vector3::new(v.x * shortening, v.y * shortening, v.z)
        };
        let moment = &mut self.moment;
        moment.rate = mean_in_body(&track.surroundings.earth_rate) + Vector3::z() * rate;
        moment.force = mean_in_body(&track.surroundings.specific_force);
        moment.sample = sample;
        moment.interval = interval;
        moment.end = Instant {
            time: time - self.start,
            angle: track.angles[sample + 1],
            rate: track.edges[sample + 1],
            sense: track.sense(sample),
            temperature,
            ..mean
        };
        moment.mean = mean;
        Some(moment)
    }
}

impl<'a> Iterator for KinematicStates<'a> {
    type Item = KinematicState<'a>;

    fn next(&mut self) -> Option<Self::Item> {
        self.advance().copied()
    }

    fn size_hint(&self) -> (usize, Option<usize>) {
        let left = self.track.len() - self.sample;
        (left, Some(left))
    }
}

impl ExactSizeIterator for KinematicStates<'_> {}
