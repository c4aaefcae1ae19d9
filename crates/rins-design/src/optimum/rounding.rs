//! A runnable profile from the shares of motions.

use rins_motion::Segment;

use super::motion::Motion;
use crate::limits::{Limits, transit};

/// The shortest time for a motion, apart from its ramp \[s\].
const SHORTEST: f64 = 4.0;

/// The share in a run below which a motion is left out.
const LEAST_SHARE: f64 = 1e-7;

/// The resolution of durations \[s\].
const RESOLUTION: f64 = 0.1;

/// What becomes of a motion whose share is shorter than it needs.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Short {
    /// It is left out.
    LeftOut,
    /// It gets the time that it needs.
    Extended,
}

/// The segments of a run of this duration \[s\] with these shares of motions; `None` if not even one of them fits.
///
/// Static intervals come first, in the order of their table angles, then the rotations, the fastest first and forward before back. The
/// rotations from one static interval to the next are part of the time of the rotations. If they do not fit, the motion with the least
/// share is left out.
pub(super) fn segments(
    shares: &[(Motion, f64)],
    duration: f64,
    limits: &Limits,
    short: Short,
) -> Option<Vec<Segment>> {
    let whole: f64 = shares.iter().map(|(_, share)| share).sum();
    if duration < SHORTEST {
        return None;
    }
    let mut kept: Vec<(Motion, f64)> =
        shares.iter().copied().filter(|(_, share)| *share > LEAST_SHARE * whole).collect();
    if short == Short::Extended {
        // With a ramp from the opposite rate, and what rotations between static intervals take.
        let needed = 2.0 * (SHORTEST + 2.0 * limits.rate / limits.acceleration) / duration * whole;
        for (_, share) in &mut kept {
            *share = share.max(needed);
        }
    }
    while !kept.is_empty() {
        if let Some(segments) = with_all(&kept, duration, limits) {
            return Some(segments);
        }
        let least = (0..kept.len()).min_by(|&a, &b| kept[a].1.total_cmp(&kept[b].1))?;
        kept.remove(least);
    }
    None
}

/// The same with all motions; `None` if one of them has too little time.
fn with_all(kept: &[(Motion, f64)], duration: f64, limits: &Limits) -> Option<Vec<Segment>> {
    let whole: f64 = kept.iter().map(|(_, share)| share).sum();
    let (mut dwells, mut rotations) = (Vec::new(), Vec::new());
    for &(motion, share) in kept {
        let time = share / whole * duration;
        match motion {
            Motion::Dwell(angle) => dwells.push((angle, time)),
            Motion::Rotation(rate) => rotations.push((rate, time)),
        }
    }
    dwells.sort_by(|a, b| a.0.total_cmp(&b.0));
    rotations.sort_by(|a, b| b.0.abs().total_cmp(&a.0.abs()).then(b.0.total_cmp(&a.0)));
    let mut segments = Vec::new();
    let (mut angle, mut moving) = (0.0, 0.0);
    for &(next, time) in &dwells {
        let between = transit(next - angle, limits);
        moving += between.iter().map(|segment| segment.duration).sum::<f64>();
        segments.extend(between);
        segments.push(Segment { rate: 0.0, duration: time });
        angle = next;
    }
    take(&mut rotations, &mut segments, moving)?;
    segments.extend(rotations.iter().map(|&(rate, duration)| Segment { rate, duration }));
    let mut before = 0.0;
    for place in 0..segments.len() {
        let Segment { rate, duration } = segments[place];
        let ramp = (rate - before).abs() / limits.acceleration;
        let least =
            if is_transit(&segments, place) { ramp * (1.0 - 1e-9) } else { ramp + SHORTEST };
        if duration < least {
            return None;
        }
        before = rate;
    }
    Some(rounded(segments, duration))
}

/// Takes the time of the rotations between static intervals from the rotations as far as they have it, and the rest from all static
/// intervals.
fn take(rotations: &mut [(f64, f64)], segments: &mut [Segment], moving: f64) -> Option<()> {
    let mut left = moving;
    if let Some(first) = rotations.first_mut() {
        // At least half of the fastest rotation remains.
        let part = left.min(0.5 * first.1);
        first.1 -= part;
        left -= part;
    }
    let at_rest: f64 =
        segments.iter().filter(|segment| segment.rate == 0.0).map(|one| one.duration).sum();
    if left > 0.5 * at_rest {
        return None;
    }
    for segment in segments.iter_mut().filter(|segment| segment.rate == 0.0) {
        segment.duration *= 1.0 - left / at_rest;
    }
    Some(())
}

/// Whether a segment is a rotation from one static interval to the next.
fn is_transit(segments: &[Segment], place: usize) -> bool {
    segments[place].rate != 0.0 && segments.get(place + 1).is_some_and(|next| next.rate == 0.0)
}

/// Durations to the resolution, except those of rotations between static intervals; the longest has what remains of the whole.
fn rounded(mut segments: Vec<Segment>, duration: f64) -> Vec<Segment> {
    for place in 0..segments.len() {
        if !is_transit(&segments, place) {
            segments[place].duration =
                (segments[place].duration / RESOLUTION).round().max(1.0) * RESOLUTION;
        }
    }
    let all: f64 = segments.iter().map(|segment| segment.duration).sum();
    let longest = segments.iter_mut().max_by(|a, b| a.duration.total_cmp(&b.duration));
    if let Some(longest) = longest {
        longest.duration += duration - all;
    }
    segments
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use rins_motion::Profile;
    use rins_testing::assert_close;

    use super::*;

    const LIMITS: Limits = Limits { rate: 0.2, acceleration: 0.1, duration: 300.0, directions: 1 };

    #[test]
    fn profile_lasts_as_long_and_stands_at_the_angles() {
        let shares = [
            (Motion::Rotation(0.2), 0.3),
            (Motion::Rotation(-0.2), 0.3),
            (Motion::Dwell(TAU / 4.0), 0.2),
            (Motion::Dwell(TAU / 2.0), 0.195),
            (Motion::Dwell(0.0), 0.005),
        ];
        let segments = segments(&shares, 300.0, &LIMITS, Short::LeftOut).unwrap();
        let profile = Profile::new(&segments, Some(LIMITS.acceleration)).unwrap();
        assert_close!(profile.duration(), 300.0, 1e-9);
        // The shortest static interval does not fit.
        let rates: Vec<f64> = segments.iter().map(|segment| segment.rate).collect();
        assert_eq!(rates, [0.2, 0.0, 0.2, 0.0, 0.2, -0.2]);
        let first = segments[0].duration + segments[1].duration;
        assert_close!(profile.angle(first - 1.0), TAU / 4.0, 1e-9);
        let second = first + segments[2].duration + segments[3].duration;
        assert_close!(profile.angle(second - 1.0), TAU / 2.0, 1e-9);
        assert_close!(segments[5].duration, 90.0 / 0.995, 0.1);
        assert!(super::segments(&shares[..1], 3.0, &LIMITS, Short::LeftOut).is_none());
        let extended = super::segments(&shares, 300.0, &LIMITS, Short::Extended).unwrap();
        assert!(extended[0].rate == 0.0 && extended[0].duration > SHORTEST);
    }
}
