//! Units that readings may be in, and what taking one for another does to them.

use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, MICRO_G, STANDARD_GRAVITY};

use super::timing::Timing;

/// How far a ratio may be from a suspected factor: a sensor as it comes from the factory may be off
/// by ten percent and more, a wrong unit by seven times at least.
const FACTOR_WITHIN: f64 = 0.2;

/// The same of a factor that is itself within [`FACTOR_WITHIN`] of one.
const NARROW_FACTOR_WITHIN: f64 = 0.005;

/// A factor this near to one is more likely the sensor's than a mistake's.
const NEAREST_FACTOR: f64 = 0.05;

/// Factors that differ by no more than this are one.
const SAME_FACTOR: f64 = 1e-6;

/// A unit that the readings of a triad or of the table may be in.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReadingUnit {
    /// How it is written.
    pub symbol: &'static str,
    /// What it is in SI units.
    pub factor: f64,
    /// What is read in it.
    pub of: ReadingOf,
}

/// What is read in a unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReadingOf {
    /// A mean rate over an interval: angular rate or specific force.
    Rate,
    /// An increment over an interval, or an angle.
    Increment,
}

impl ReadingUnit {
    /// What gyros are read in.
    pub const GYRO: [Self; 6] = [
        Self::rate("rad/s", 1.0),
        Self::rate("deg/s", DEG),
        Self::rate("deg/h", DEG_PER_HOUR),
        Self::increment("rad", 1.0),
        Self::increment("deg", DEG),
        Self::increment("arcsec", ARCSEC),
    ];

    /// What accelerometers are read in.
    pub const ACCEL: [Self; 6] = [
        Self::rate("m/s^2", 1.0),
        Self::rate("g", STANDARD_GRAVITY),
        Self::rate("mg", 1e3 * MICRO_G),
        Self::rate("ug", MICRO_G),
        Self::increment("m/s", 1.0),
        Self::increment("ug*s", MICRO_G),
    ];

    /// What a table's angle is read in.
    pub const TABLE_ANGLE: [Self; 4] = [
        Self::increment("rad", 1.0),
        Self::increment("deg", DEG),
        Self::increment("arcsec", ARCSEC),
        Self::increment("gon", 0.9 * DEG),
    ];

    /// What a table's rate is read in.
    pub const TABLE_RATE: [Self; 3] =
        [Self::rate("rad/s", 1.0), Self::rate("deg/s", DEG), Self::rate("deg/h", DEG_PER_HOUR)];

    const fn rate(symbol: &'static str, factor: f64) -> Self {
        Self { symbol, factor, of: ReadingOf::Rate }
    }

    const fn increment(symbol: &'static str, factor: f64) -> Self {
        Self { symbol, factor, of: ReadingOf::Increment }
    }

    /// What one of it adds over an interval, in SI units.
    fn over(&self, interval: f64) -> f64 {
        match self.of {
            ReadingOf::Rate => self.factor * interval,
            ReadingOf::Increment => self.factor,
        }
    }
}

/// A mistake, and the factor by which what is read is then too large.
pub(super) struct Mistake {
    pub(super) factor: f64,
    pub(super) cause: String,
}

/// The units of `all` that were meant, each taken for what was said; for any of them where that is
/// not known.
pub(super) fn mistakes(
    all: &[ReadingUnit],
    said: Option<ReadingUnit>,
    timing: &Timing,
    what: &str,
) -> Vec<Mistake> {
    let each = said.as_ref().map_or(all, std::slice::from_ref);
    let pairs = each.iter().flat_map(|said| all.iter().map(move |meant| (said, meant)));
    pairs
        .filter(|(said, meant)| said != meant)
        .map(|(said, meant)| Mistake {
            factor: said.over(timing.interval) / meant.over(timing.interval),
            cause: format!("{what} in {} were declared as {}", meant.symbol, said.symbol),
        })
        .collect()
}

/// Whether a ratio is near one or, if not, the mistakes that make it what it is.
///
/// Of the factors near the ratio the nearest counts; one that a sensor as it comes from the factory
/// may have as well must fit closely.
pub(super) fn explained(ratio: f64, mistakes: &[Mistake]) -> Result<(), Option<String>> {
    let off = |factor: f64| (ratio / factor - 1.0).abs();
    let within = |mistake: &&Mistake| {
        let near = (mistake.factor - 1.0).abs();
        if near < NEAREST_FACTOR {
            return false;
        }
        off(mistake.factor)
            < if near < FACTOR_WITHIN { NARROW_FACTOR_WITHIN } else { FACTOR_WITHIN }
    };
    let nearest = mistakes
        .iter()
        .filter(within)
        .map(|mistake| mistake.factor)
        .min_by(|a, b| off(*a).total_cmp(&off(*b)))
        .filter(|factor| off(*factor) < off(1.0));
    let Some(nearest) = nearest else {
        return if off(1.0) < FACTOR_WITHIN { Ok(()) } else { Err(None) };
    };
    let same =
        mistakes.iter().filter(|mistake| (mistake.factor / nearest - 1.0).abs() < SAME_FACTOR);
    let causes: Vec<&str> = same.map(|mistake| mistake.cause.as_str()).collect();
    Err(Some(causes.join(", or ")))
}
