//! The held-out part of a run: the end of every segment of constant or of varying rate, or all at the fastest rate, in whole
//! revolutions.

use std::f64::consts::TAU;
use std::ops::Range;

use rins_estimation::{Run, linearise};
use rins_terms::Model;

/// How much of a stretch is held out.
const SHARE: f64 = 0.3;

/// Of a stretch that turns so far one revolution is held out, though it is more \[rad\].
const LEAST_TURNED: f64 = 1.5 * TAU;

/// A rate is constant within this part of itself, or within so much \[rad/s\].
const CONSTANT: (f64, f64) = (0.02, 1e-3);

/// Another rate is slower by this part at least.
const ANOTHER: f64 = 0.2;

/// A table that turns more slowly rests \[rad/s\].
const REST: f64 = 1e-3;

/// A shorter stretch is a ramp \[s\].
const SHORTEST: f64 = 10.0;

/// Where a table rests, so much of the time is taken together \[s\].
const BLOCK: f64 = 10.0;

/// An epoch: its samples, the table's angle in its middle and its rate, and how long it is.
struct Epoch {
    samples: Range<usize>,
    angle: f64,
    rate: f64,
    duration: f64,
}

/// Samples that are held out together, and such as are taken together in judging how certain a gain is.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Held {
    /// The samples of a stretch.
    pub(crate) span: Range<usize>,
    /// Its revolutions, or pieces of a rest, one after the other.
    pub(crate) blocks: Vec<Range<usize>>,
}

/// What is held out of a run: the end of every segment of constant rate, and of every segment of varying rate such as a
/// coast-down. Nothing is held out of segments shorter than [`SHORTEST`].
pub(crate) fn held_out(run: &Run) -> Vec<Held> {
    let epochs = epochs(run);
    with_varying(&epochs, &stretches(&epochs))
        .into_iter()
        .filter_map(|stretch| end_of(&epochs[stretch], SHARE))
        .collect()
}

/// All stretches at the fastest rate of a run that turns at slower ones too, in whole revolutions; nothing of other runs.
pub(crate) fn fastest(run: &Run) -> Vec<Held> {
    let epochs = epochs(run);
    let rate = |stretch: &Range<usize>| {
        let turned = epochs[stretch.end - 1].angle - epochs[stretch.start].angle;
        let duration: f64 = epochs[stretch.clone()].iter().map(|epoch| epoch.duration).sum();
        if duration < SHORTEST { 0.0 } else { (turned / duration).abs() }
    };
    let stretches: Vec<(f64, Range<usize>)> =
        stretches(&epochs).into_iter().map(|stretch| (rate(&stretch), stretch)).collect();
    let fastest = stretches.iter().fold(0.0_f64, |most, (rate, _)| most.max(*rate));
    let is_slower = |rate: f64| rate < (1.0 - ANOTHER) * fastest;
    if !stretches.iter().any(|(rate, _)| *rate > REST && is_slower(*rate)) {
        return Vec::new();
    }
    let fast = stretches.into_iter().filter(|(rate, _)| !is_slower(*rate));
    fast.filter_map(|(_, stretch)| end_of(&epochs[stretch], 1.0)).collect()
}

fn epochs(run: &Run) -> Vec<Epoch> {
    let linear = linearise(run, &Model::default(), &[]);
    let increments = &run.recording.increments;
    let of = |((angle, rate), samples): ((f64, f64), Range<usize>)| Epoch {
        duration: increments[samples.clone()].iter().map(|sample| sample.interval).sum(),
        samples,
        angle,
        rate,
    };
    linear.motion().into_iter().zip(linear.samples()).map(of).collect()
}

/// Stretches of epochs over which the rate is constant.
fn stretches(epochs: &[Epoch]) -> Vec<Range<usize>> {
    let mut stretches = Vec::new();
    let (mut first, mut sum) = (0, 0.0);
    for (place, epoch) in epochs.iter().enumerate() {
        let mean: f64 = if place > first { sum / (place - first) as f64 } else { epoch.rate };
        if (epoch.rate - mean).abs() > CONSTANT.1.max(CONSTANT.0 * mean.abs()) {
            stretches.push(first..place);
            (first, sum) = (place, 0.0);
        }
        sum += epoch.rate;
    }
    stretches.push(first..epochs.len());
    stretches
}

/// The same with successive short segments joined: while the rate varies, none of them is long.
fn with_varying(epochs: &[Epoch], segments: &[Range<usize>]) -> Vec<Range<usize>> {
    let is_short = |segment: &Range<usize>| {
        epochs[segment.clone()].iter().map(|epoch| epoch.duration).sum::<f64>() < SHORTEST
    };
    let joined = segments.chunk_by(|one, other| is_short(one) && is_short(other));
    joined.map(|group| group[0].start..group[group.len() - 1].end).collect()
}

/// The last part of a segment, if it is long enough.
///
/// It is cut at revolutions, in either direction, or, if the table turns less than that, by time.
fn end_of(stretch: &[Epoch], share: f64) -> Option<Held> {
    let duration: f64 = stretch.iter().map(|epoch| epoch.duration).sum();
    if duration < SHORTEST {
        return None;
    }
    let last = stretch.last()?;
    let turned: f64 = stretch.windows(2).map(|pair| (pair[1].angle - pair[0].angle).abs()).sum();
    let by_time = turned / duration < REST || turned < LEAST_TURNED;
    let revolutions = (share * turned / TAU).floor().max(1.0);
    // The duration and the angle from each epoch to the end of the segment.
    let (mut left, mut angle, mut path) = (0.0, last.angle, 0.0);
    let mut blocks: Vec<Range<usize>> = Vec::new();
    let most = if by_time { share * duration / BLOCK } else { revolutions };
    for epoch in stretch.iter().rev() {
        path += (angle - epoch.angle).abs();
        angle = epoch.angle;
        let from_end = if by_time { left / BLOCK } else { path / TAU };
        left += epoch.duration;
        if from_end >= most {
            break;
        }
        #[expect(
            clippy::cast_possible_truncation,
            clippy::cast_sign_loss,
            reason = "a number of revolutions of a run, not negative"
        )]
        let block = from_end as usize;
        match blocks.get_mut(block) {
            Some(block) => block.start = epoch.samples.start,
            None => blocks.push(epoch.samples.clone()),
        }
    }
    blocks.reverse();
    let span = blocks.first()?.start..blocks.last()?.end;
    Some(Held { span, blocks })
}
