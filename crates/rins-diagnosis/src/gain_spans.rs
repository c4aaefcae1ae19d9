//! Which part of a run is held out: the last of every stretch of constant rate, or all at the fastest rate, in whole
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

/// What is held out of a run: nothing of stretches of less than one and a half revolutions.
pub(crate) fn held_out(run: &Run) -> Vec<Held> {
    let epochs = epochs(run);
    stretches(&epochs).into_iter().filter_map(|stretch| end_of(&epochs[stretch], SHARE)).collect()
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

/// The last part of a stretch, if it is long enough.
fn end_of(stretch: &[Epoch], share: f64) -> Option<Held> {
    let duration: f64 = stretch.iter().map(|epoch| epoch.duration).sum();
    if duration < SHORTEST {
        return None;
    }
    let (first, last) = (stretch.first()?, stretch.last()?);
    let turned = (last.angle - first.angle).abs();
    let rests = turned / duration < REST;
    let least = if turned > LEAST_TURNED { 1.0 } else { 0.0 };
    let revolutions = (share * turned / TAU).floor().max(least);
    if !rests && revolutions < 1.0 {
        return None;
    }
    // How far each epoch is from the stretch's end, in blocks.
    let mut left = 0.0;
    let mut blocks: Vec<Range<usize>> = Vec::new();
    let most = if rests { share * duration / BLOCK } else { revolutions };
    for epoch in stretch.iter().rev() {
        let from_end = if rests { left / BLOCK } else { (last.angle - epoch.angle).abs() / TAU };
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
