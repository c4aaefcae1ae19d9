//! The commanded motion of a single-axis table: a list of rates and durations.

/// A constant rate for a certain time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Segment {
    /// The rate about the spin axis \[rad/s\].
    pub rate: f64,
    /// The duration \[s\], including the ramp from the previous rate.
    pub duration: f64,
}

/// The largest plausible rate of a table \[rad/s\]: 16 revolutions in 10 ms.
///
/// The time for calculations with a profile is proportional to its revolutions.
const FASTEST_RATE: f64 = 1e4;

/// The reason why a list of segments is not a valid profile.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum ProfileError {
    /// There is no segment.
    #[error("a table profile needs at least one segment")]
    Empty,
    /// A rate is not finite, or not plausible for a table.
    #[error(
        "segment {index} has a rate of {rate} rad/s; it must be finite and at most {FASTEST_RATE} rad/s"
    )]
    Rate {
        /// The number of the segment, from 1.
        index: usize,
        /// Its rate.
        rate: f64,
    },
    /// A duration is not positive.
    #[error("segment {index} lasts {duration} s; it must be positive")]
    Duration {
        /// The number of the segment, from 1.
        index: usize,
        /// Its duration.
        duration: f64,
    },
    /// The acceleration is not positive.
    #[error("a table acceleration of {acceleration} rad/s² is not positive")]
    Acceleration {
        /// The acceleration.
        acceleration: f64,
    },
    /// The ramp takes longer than the segment.
    #[error("segment {index} lasts {duration} s, less than the {ramp} s that its ramp takes")]
    RampTooLong {
        /// The number of the segment, from 1.
        index: usize,
        /// Its duration.
        duration: f64,
        /// The duration of the ramp.
        ramp: f64,
    },
}

/// The commanded motion of the table: angle and rate as functions of time.
///
/// Each segment whose rate differs from the previous one begins with a ramp of constant acceleration; before the first
/// segment the table is at rest at angle zero. Without an acceleration the rate changes instantly.
///
/// ```
/// use rins_motion::{Profile, Segment};
/// let turn = Segment { rate: 0.2, duration: 30.0 };
/// let profile = Profile::new(&[turn], Some(0.1))?;
/// assert_eq!(profile.rate(1.0), 0.1); // half way up the ramp
/// assert!((profile.angle(30.0) - (0.2 * 30.0 - 0.2)).abs() < 1e-14); // the ramp costs 0.2 rad
/// # Ok::<(), rins_motion::ProfileError>(())
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Profile {
    pieces: Vec<Piece>,
    duration: f64,
}

/// An interval of constant acceleration.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Piece {
    pub(crate) start: f64,
    pub(crate) angle: f64,
    pub(crate) rate: f64,
    pub(crate) acceleration: f64,
}

impl Piece {
    pub(crate) fn angle_at(&self, time: f64) -> f64 {
        let elapsed = time - self.start;
        self.angle + elapsed * (self.rate + 0.5 * self.acceleration * elapsed)
    }

    pub(crate) fn rate_at(&self, time: f64) -> f64 {
        self.rate + self.acceleration * (time - self.start)
    }
}

impl Profile {
    /// The profile of these segments, with an acceleration of `acceleration` \[rad/s²\] between their rates.
    ///
    /// # Errors
    /// [`ProfileError`] if there is no segment, a value is not finite or not positive where it must be, or a ramp is longer
    /// than its segment.
    pub fn new(segments: &[Segment], acceleration: Option<f64>) -> Result<Self, ProfileError> {
        if segments.is_empty() {
            return Err(ProfileError::Empty);
        }
        if let Some(acceleration) = acceleration.filter(|a| !(a.is_finite() && *a > 0.0)) {
            return Err(ProfileError::Acceleration { acceleration });
        }
        let mut pieces = Vec::with_capacity(2 * segments.len());
        let mut next = Piece { start: 0.0, angle: 0.0, rate: 0.0, acceleration: 0.0 };
        let mut end = 0.0;
        for (place, &Segment { rate, duration }) in segments.iter().enumerate() {
            let index = place + 1;
            if !(rate.is_finite() && rate.abs() <= FASTEST_RATE) {
                return Err(ProfileError::Rate { index, rate });
            }
            if !(duration.is_finite() && duration > 0.0) {
                return Err(ProfileError::Duration { index, duration });
            }
            end += duration;
            let change = rate - next.rate;
            let ramp = acceleration.map_or(0.0, |acceleration| change.abs() / acceleration);
            if ramp > duration {
                return Err(ProfileError::RampTooLong { index, duration, ramp });
            }
            if ramp > 0.0 {
                pieces.push(Piece { acceleration: change / ramp, ..next });
                next.angle += 0.5 * (next.rate + rate) * ramp;
                next.start += ramp;
            }
            next.rate = rate;
            pieces.push(next);
            next.angle = next.angle_at(end);
            next.start = end;
        }
        Ok(Self { pieces, duration: end })
    }

    /// The duration of the profile \[s\].
    pub fn duration(&self) -> f64 {
        self.duration
    }

    /// The table angle at `time` \[rad\], not wrapped.
    pub fn angle(&self, time: f64) -> f64 {
        self.piece_at(time).angle_at(time)
    }

    /// The table rate at `time` \[rad/s\].
    pub fn rate(&self, time: f64) -> f64 {
        self.piece_at(time).rate_at(time)
    }

    /// The intervals of constant acceleration that intersect `from..to`, each with its intersection.
    pub(crate) fn pieces_within(
        &self,
        from: f64,
        to: f64,
    ) -> impl Iterator<Item = (&Piece, f64, f64)> {
        let first = self.index_at(from);
        self.pieces[first..].iter().enumerate().map_while(move |(offset, piece)| {
            let begin = if offset == 0 { from } else { piece.start };
            let next = self.pieces.get(first + offset + 1).map_or(f64::INFINITY, |p| p.start);
            (begin < to).then(|| (piece, begin, next.min(to)))
        })
    }

    fn piece_at(&self, time: f64) -> &Piece {
        &self.pieces[self.index_at(time)]
    }

    fn index_at(&self, time: f64) -> usize {
        self.pieces.partition_point(|piece| piece.start <= time).saturating_sub(1)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;
    use rins_testing::assert_close;

    fn any_segments() -> impl Strategy<Value = Vec<Segment>> {
        let segment = (-1.0..1.0_f64, 25.0..60.0_f64);
        prop::collection::vec(segment.prop_map(|(rate, duration)| Segment { rate, duration }), 1..6)
    }

    proptest! {
        #[test]
        fn angle_is_the_integral_of_rate(segments in any_segments(), part in 0.0..1.0_f64) {
            let profile = Profile::new(&segments, Some(0.1)).unwrap();
            let end = part * profile.duration();
            let n = 40_000;
            let step = end / f64::from(n);
            let sum: f64 = (0..n).map(|k| profile.rate((f64::from(k) + 0.5) * step)).sum();
            // A midpoint is exact except in the steps in which a ramp begins or ends.
            let corners = 2.0 * segments.len() as f64;
            let bound = corners * 0.1 * step * step / 8.0 + 1e-9;
            prop_assert!((sum * step - profile.angle(end)).abs() < bound);
        }

        #[test]
        fn each_segment_ends_at_its_rate(segments in any_segments()) {
            let profile = Profile::new(&segments, Some(0.1)).unwrap();
            let mut end = 0.0;
            for segment in &segments {
                end += segment.duration;
                prop_assert!((profile.rate(end - 1e-9) - segment.rate).abs() < 1e-9);
            }
        }

        #[test]
        fn acceleration_is_never_exceeded(segments in any_segments(), part in 0.0..1.0_f64) {
            let profile = Profile::new(&segments, Some(0.1)).unwrap();
            let time = part * (profile.duration() - 0.1);
            let change = profile.rate(time + 0.1) - profile.rate(time);
            prop_assert!(change.abs() <= 0.1 * 0.1 + 1e-12);
        }
    }

    #[test]
    fn rate_jumps_where_no_acceleration_is_given() {
        let segments =
            [Segment { rate: 1.0, duration: 2.0 }, Segment { rate: -1.0, duration: 2.0 }];
        let profile = Profile::new(&segments, None).unwrap();
        assert_close!(profile.angle(2.0), 2.0, 1e-15);
        assert_close!(profile.angle(4.0), 0.0 + 1e-300, 1e-15);
        assert_close!(profile.rate(0.0), 1.0, 1e-15);
        assert_close!(profile.rate(2.0), -1.0, 1e-15);
    }

    #[test]
    fn impossible_profiles_are_refused_with_their_figures() {
        let segment = |rate, duration| Segment { rate, duration };
        let cases = [
            (vec![], None, ProfileError::Empty),
            (vec![segment(1.0, 0.0)], None, ProfileError::Duration { index: 1, duration: 0.0 }),
            (
                vec![segment(0.0, 1.0), segment(f64::INFINITY, 1.0)],
                None,
                ProfileError::Rate { index: 2, rate: f64::INFINITY },
            ),
            (vec![segment(-1e300, 1.0)], None, ProfileError::Rate { index: 1, rate: -1e300 }),
            (
                vec![segment(1.0, 1.0)],
                Some(-2.0),
                ProfileError::Acceleration { acceleration: -2.0 },
            ),
            (
                vec![segment(1.0, 4.0)],
                Some(0.125),
                ProfileError::RampTooLong { index: 1, duration: 4.0, ramp: 8.0 },
            ),
        ];
        for (segments, acceleration, error) in cases {
            assert_eq!(Profile::new(&segments, acceleration), Err(error));
        }
    }
}
