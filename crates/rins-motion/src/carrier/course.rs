//! The course of a carrier: heading and speed over time.

use core::f64::consts::{PI, TAU};

/// A leg of a voyage: a heading and a speed for some time.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Leg {
    /// The heading, clockwise from north \[rad\].
    pub heading: f64,
    /// The speed ahead \[m/s\].
    pub speed: f64,
    /// The duration, with the turn and the change of speed at its beginning \[s\].
    pub duration: f64,
    /// The rate of the turn to its heading \[rad/s\]; without it the heading must be that of the leg before.
    pub turn_rate: Option<f64>,
    /// The acceleration to its speed \[m/s²\]; without it the speed must be that of the leg before.
    pub acceleration: Option<f64>,
}

/// Headings closer than this are the same \[rad\]: a hundredth of an arc second.
const SAME_HEADING: f64 = 5e-8;

/// The largest number of pieces of a course.
const MOST_PIECES: usize = 1_000_000;

/// The reason why a carrier cannot move so.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CarrierError {
    /// A number of a leg is not finite, or not positive where it must be.
    #[error(
        "leg {leg}: heading {heading} rad, speed {speed} m/s, {duration} s; expected finite numbers, and a positive duration, turn rate \
         and acceleration"
    )]
    Leg {
        /// The leg, from 1.
        leg: usize,
        /// Its heading \[rad\].
        heading: f64,
        /// Its speed \[m/s\].
        speed: f64,
        /// Its duration \[s\].
        duration: f64,
    },
    /// The heading jumps.
    #[error("leg {leg}: the heading jumps by {jump_deg:.4} deg; state a turn rate")]
    HeadingJumps {
        /// The leg, from 1.
        leg: usize,
        /// The change of heading \[deg\].
        jump_deg: f64,
    },
    /// The speed jumps.
    #[error("leg {leg}: the speed jumps by {jump} m/s; state an acceleration")]
    SpeedJumps {
        /// The leg, from 1.
        leg: usize,
        /// The change of speed \[m/s\].
        jump: f64,
    },
    /// A turn or a change of speed takes longer than the leg.
    #[error(
        "leg {leg}: its turn or its change of speed takes {needed:.1} s, and the leg {duration} s"
    )]
    TooShort {
        /// The leg, from 1.
        leg: usize,
        /// The time that it takes \[s\].
        needed: f64,
        /// The duration of the leg \[s\].
        duration: f64,
    },
    /// The legs are too short for the voyage.
    #[error(
        "the legs would be repeated {repeats:.0} times; at most {MOST_PIECES} legs are possible"
    )]
    TooMany {
        /// How often the legs would be repeated.
        repeats: f64,
    },
    /// A number of an oscillation is not finite, or its period not positive.
    #[error(
        "an oscillation of {amplitude} with a period of {period} s; expected finite numbers and a positive period"
    )]
    Sway {
        /// The amplitude \[rad or m\].
        amplitude: f64,
        /// The period \[s\].
        period: f64,
    },
}

/// Heading and speed that change linearly.
#[derive(Clone, Copy, Debug, PartialEq)]
struct Piece {
    start: f64,
    heading: f64,
    turn: f64,
    speed: f64,
    acceleration: f64,
}

/// The whole course.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Course {
    pieces: Vec<Piece>,
}

impl Course {
    pub(super) fn at_rest() -> Self {
        let still = Piece { start: 0.0, heading: 0.0, turn: 0.0, speed: 0.0, acceleration: 0.0 };
        Self { pieces: vec![still] }
    }

    /// The course through at least one leg, repeated for `duration` \[s\].
    pub(super) fn new(legs: &[Leg], duration: f64) -> Result<Self, CarrierError> {
        for (place, leg) in legs.iter().enumerate() {
            leg.check(place + 1)?;
        }
        let cycle: f64 = legs.iter().map(|leg| leg.duration).sum();
        let repeats = (duration / cycle).ceil();
        if repeats * legs.len() as f64 > MOST_PIECES as f64 {
            return Err(CarrierError::TooMany { repeats });
        }
        let mut pieces: Vec<Piece> = Vec::new();
        let (mut heading, mut speed, mut start) = (legs[0].heading, legs[0].speed, 0.0);
        for (place, leg) in legs.iter().enumerate().cycle() {
            if start >= duration && start > 0.0 {
                break;
            }
            leg.pieces(place + 1, (start, &mut heading, &mut speed), &mut pieces)?;
            start += leg.duration;
        }
        Ok(Self { pieces })
    }

    /// The heading \[rad\] and its rate, the speed \[m/s\] and its rate.
    pub(super) fn at(&self, time: f64) -> [f64; 4] {
        let piece = &self.pieces[self.place(time)];
        let elapsed = time - piece.start;
        [
            piece.heading + piece.turn * elapsed,
            piece.turn,
            piece.speed + piece.acceleration * elapsed,
            piece.acceleration,
        ]
    }

    pub(super) fn next_corner(&self, time: f64) -> f64 {
        self.pieces.get(self.place(time) + 1).map_or(f64::INFINITY, |piece| piece.start)
    }

    fn place(&self, time: f64) -> usize {
        self.pieces.partition_point(|piece| piece.start <= time).saturating_sub(1)
    }
}

impl Leg {
    fn check(&self, leg: usize) -> Result<(), CarrierError> {
        let Self { heading, speed, duration, turn_rate, acceleration } = *self;
        let optional = [turn_rate, acceleration].into_iter().flatten();
        let are_positive = optional.chain([duration]).all(|value| value.is_finite() && value > 0.0);
        if are_positive && heading.is_finite() && speed.is_finite() {
            Ok(())
        } else {
            Err(CarrierError::Leg { leg, heading, speed, duration })
        }
    }

    /// Adds its pieces, from the heading and speed before.
    fn pieces(
        &self,
        leg: usize,
        (start, heading, speed): (f64, &mut f64, &mut f64),
        pieces: &mut Vec<Piece>,
    ) -> Result<(), CarrierError> {
        let turn = shorter_way(self.heading - *heading);
        let gain = self.speed - *speed;
        let turning = match self.turn_rate {
            _ if turn.abs() < SAME_HEADING => 0.0,
            Some(rate) => turn.abs() / rate,
            None => return Err(CarrierError::HeadingJumps { leg, jump_deg: turn.to_degrees() }),
        };
        let gaining = match self.acceleration {
            _ if gain == 0.0 => 0.0,
            Some(acceleration) => gain.abs() / acceleration,
            None => return Err(CarrierError::SpeedJumps { leg, jump: gain }),
        };
        let needed = f64::max(turning, gaining);
        if needed > self.duration {
            return Err(CarrierError::TooShort { leg, needed, duration: self.duration });
        }
        let mut corners = [0.0, turning, gaining];
        corners.sort_by(f64::total_cmp);
        for (place, &corner) in corners.iter().enumerate() {
            if corners.get(place + 1) == Some(&corner) {
                continue;
            }
            let part = |lasts: f64| if lasts > 0.0 { (corner / lasts).min(1.0) } else { 1.0 };
            pieces.push(Piece {
                start: start + corner,
                heading: *heading + turn * part(turning),
                turn: if corner < turning { turn / turning } else { 0.0 },
                speed: *speed + gain * part(gaining),
                acceleration: if corner < gaining { gain / gaining } else { 0.0 },
            });
        }
        *heading += turn;
        *speed = self.speed;
        Ok(())
    }
}

/// The angle between -π and π of a change of heading.
fn shorter_way(change: f64) -> f64 {
    (change + PI).rem_euclid(TAU) - PI
}
