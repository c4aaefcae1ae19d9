//! The way a table went, sample by sample.

use rins_motion::cubic;

use crate::edges::edges;
use crate::senses::senses;
use crate::slope::slopes;
use crate::surroundings::Surroundings;
use crate::turns::turns;

/// Over so many samples on either side of an edge a table's rate goes on evenly, if no ramp begins or ends there.
const BESIDE: usize = 4;

/// The table's motion over a run, from which every sample's [`KinematicState`](crate::KinematicState) follows.
#[derive(Clone, Debug, PartialEq)]
pub struct Track {
    /// What surrounds the table.
    pub surroundings: Surroundings,
    /// The end of each sample's interval \[s\].
    pub(crate) times: Vec<f64>,
    /// The length of each sample's interval \[s\].
    pub(crate) intervals: Vec<f64>,
    /// The table angle before the first sample, and at the end of each \[rad\].
    pub(crate) angles: Vec<f64>,
    /// The rate before the first sample, and at the end of each \[rad/s\].
    pub(crate) edges: Vec<f64>,
    /// Before which samples a ramp begins or ends; not told of samples that were taken together.
    corners: Vec<usize>,
    /// The way the table turned last, at the end of each sample.
    pub(crate) senses: Vec<i8>,
    /// The way the rate changed last, over each sample.
    pub(crate) rate_changes: Vec<f32>,
    /// The temperature at the end of each sample \[°C\].
    temperature: Option<Vec<f64>>,
    /// How fast it changes \[K/s\].
    pub(crate) warming_rates: Option<Vec<f64>>,
}

impl Track {
    /// A track through `angles`: that before the first sample, and that at the end of each.
    ///
    /// # Panics
    /// If there is not one angle more than times, and as many intervals and temperatures as times.
    pub fn new(
        surroundings: Surroundings,
        times: Vec<f64>,
        intervals: Vec<f64>,
        angles: Vec<f64>,
        temperature: Option<Vec<f64>>,
    ) -> Self {
        assert_eq!(angles.len(), times.len() + 1, "an angle at the start and one a sample");
        assert_eq!(intervals.len(), times.len(), "an interval a sample");
        let matches = temperature.as_ref().is_none_or(|list| list.len() == times.len());
        assert!(matches, "a temperature a sample");
        let warming_rates = temperature.as_ref().map(|list| slopes(&times, list));
        let mut track = Self {
            surroundings,
            times,
            intervals,
            angles,
            edges: Vec::new(),
            corners: Vec::new(),
            senses: Vec::new(),
            rate_changes: Vec::new(),
            temperature,
            warming_rates,
        };
        let rate = |sample: usize| track.over(sample).0;
        let rates: Vec<f64> = (0..track.len()).map(rate).collect();
        let senses = senses(&track.angles, rate);
        (track.edges, track.corners) = edges(&rates);
        track.senses = senses;
        track.rate_changes = turns(track.len(), |from, to| track.rate_over(from, to).0);
        track
    }

    /// The same with samples taken together: those up to each of `ends`, the sample after the last of them.
    ///
    /// The rate between two pieces is taken over some samples on either side, which have less of the noise of the angles
    /// than single ones; only where a ramp begins or ends near it is it kept.
    ///
    /// # Panics
    /// If an end is not after the one before it, or beyond the track.
    #[must_use]
    pub fn thinned(&self, ends: &[usize]) -> Self {
        let starts = std::iter::once(0).chain(ends.iter().copied());
        let together = |(start, &end): (usize, &usize)| self.intervals[start..end].iter().sum();
        let middle = |(start, &end): (usize, &usize)| usize::midpoint(start, end - 1);
        let mean_change = |(start, &end): (usize, &usize)| {
            self.rate_changes[start..end].iter().sum::<f32>() / (end - start) as f32
        };
        let last = |list: &[f64]| ends.iter().map(|&end| list[end - 1]).collect();
        let edges = self.edges_of(&starts.clone().collect::<Vec<_>>());
        Self {
            surroundings: self.surroundings,
            times: last(&self.times),
            intervals: starts.clone().zip(ends).map(together).collect(),
            angles: starts.clone().map(|edge| self.angles[edge]).collect(),
            edges,
            corners: Vec::new(),
            senses: ends.iter().map(|&end| self.senses[end - 1]).collect(),
            rate_changes: starts.clone().zip(ends).map(mean_change).collect(),
            temperature: self.temperature.as_deref().map(last),
            warming_rates: self
                .warming_rates
                .as_ref()
                .map(|list| starts.zip(ends).map(|piece| list[middle(piece)]).collect()),
        }
    }

    /// The number of samples.
    pub fn len(&self) -> usize {
        self.times.len()
    }

    /// Whether there is no sample.
    pub fn is_empty(&self) -> bool {
        self.times.is_empty()
    }

    /// When each sample ends \[s\].
    pub fn times(&self) -> &[f64] {
        &self.times
    }

    /// The table angle before the first sample, and at the end of each \[rad\].
    pub fn angles(&self) -> &[f64] {
        &self.angles
    }

    /// When the first sample began \[s\].
    pub fn start(&self) -> f64 {
        self.times
            .first()
            .zip(self.intervals.first())
            .map_or(0.0, |(time, interval)| time - interval)
    }

    /// How long the run is \[s\].
    pub fn duration(&self) -> f64 {
        self.times.last().map_or(0.0, |time| time - self.start())
    }

    /// When the sample before began to end \[s\]: times may have gaps.
    fn time_before(&self, sample: usize) -> f64 {
        if sample == 0 { self.start() } else { self.times[sample - 1] }
    }

    /// The mean rate over the time up to the end of a sample \[rad/s\], or that of the last one, and that time \[s\].
    pub(crate) fn over(&self, sample: usize) -> (f64, f64) {
        let sample = sample.min(self.len() - 1);
        self.rate_over(sample, sample + 1)
    }

    /// The table angle at a time since the start of the first sample \[rad\] and its rate \[rad/s\], searched from a sample
    /// near it; before the start and after the end of the track the rate is constant.
    pub(crate) fn at(&self, time: f64, near: usize) -> (f64, f64) {
        let time = self.start() + time;
        let mut sample = near.min(self.len() - 1);
        while sample > 0 && self.times[sample - 1] >= time {
            sample -= 1;
        }
        while sample + 1 < self.len() && self.times[sample] < time {
            sample += 1;
        }
        let [from, to] = [sample, sample + 1].map(|edge| (self.angles[edge], self.edges[edge]));
        let (rate, duration) = self.over(sample);
        let start = self.time_before(sample);
        let part = (time - start) / duration;
        if part < 0.0 {
            return (from.0 + (time - start) * from.1, from.1);
        }
        if part > 1.0 {
            return (to.0 + (time - self.times[sample]) * to.1, to.1);
        }
        let [first, second, third] = cubic(rate * duration, from.1 * duration, to.1 * duration);
        let turned = part * (part * (part * third + second) + first);
        let slope = part * (part * 3.0 * third + 2.0 * second) + first;
        (from.0 + turned, slope / duration)
    }

    /// The mean rate from one edge to another \[rad/s\], and the time between them \[s\].
    fn rate_over(&self, from: usize, to: usize) -> (f64, f64) {
        let elapsed = self.times[to - 1] - self.time_before(from);
        ((self.angles[to] - self.angles[from]) / elapsed, elapsed)
    }

    /// The rates at the edges of pieces \[rad/s\].
    fn edges_of(&self, pieces: &[usize]) -> Vec<f64> {
        let mut rates: Vec<f64> = pieces.iter().map(|&edge| self.edges[edge]).collect();
        for (around, rate) in pieces.windows(3).zip(&mut rates[1..]) {
            let edge = around[1];
            let start = around[0].max(edge.saturating_sub(BESIDE));
            let end = around[2].min(edge + BESIDE);
            let from = self.corners.partition_point(|corner| *corner < start);
            if self.corners.get(from).is_none_or(|corner| *corner > end) {
                *rate = self.rate_between(start, edge, end);
            }
        }
        rates
    }

    /// The rate at an edge, if it goes on evenly from one edge before it to one behind it \[rad/s\].
    fn rate_between(&self, start: usize, edge: usize, end: usize) -> f64 {
        let ((before, long_before), (after, long_after)) =
            (self.rate_over(start, edge), self.rate_over(edge, end));
        (before * long_after + after * long_before) / (long_before + long_after)
    }

    pub(crate) fn sense(&self, sample: usize) -> f64 {
        f64::from(self.senses[sample])
    }

    pub(crate) fn temperature(&self, sample: usize) -> Option<f64> {
        self.temperature.as_ref().map(|list| list[sample])
    }
}
