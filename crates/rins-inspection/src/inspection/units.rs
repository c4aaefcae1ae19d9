//! The possible units of readings, and the effect of confusing two of them.

use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, MICRO_G, STANDARD_GRAVITY};

use super::timing::Timing;

/// The largest relative difference of a ratio from the factor of an error: an uncalibrated sensor may have a scale error of
/// ten percent and more, a wrong unit at least a factor of seven.
const FACTOR_WITHIN: f64 = 0.2;

/// The same for a factor that is itself within [`FACTOR_WITHIN`] of one.
const NARROW_FACTOR_WITHIN: f64 = 0.005;

/// A factor this close to one is more probably that of the sensor than that of an error.
const NEAREST_FACTOR: f64 = 0.05;

/// The largest difference of equal factors.
const SAME_FACTOR: f64 = 1e-6;

/// A possible unit of the readings of a triad or of the table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ReadingUnit {
    /// Its symbol.
    pub symbol: &'static str,
    /// Its value in SI units.
    pub factor: f64,
    /// The quantity that it measures.
    pub of: ReadingOf,
}

/// The quantity that is measured in a unit.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ReadingOf {
    /// A mean rate over an interval: angular rate or specific force.
    Rate,
    /// An increment over an interval, or an angle.
    Increment,
}

impl ReadingUnit {
    /// The units of gyros.
    pub const GYRO: [Self; 6] = [
        Self::rate("rad/s", 1.0),
        Self::rate("deg/s", DEG),
        Self::rate("deg/h", DEG_PER_HOUR),
        Self::increment("rad", 1.0),
        Self::increment("deg", DEG),
        Self::increment("arcsec", ARCSEC),
    ];

    /// The units of accelerometers.
    pub const ACCEL: [Self; 6] = [
        Self::rate("m/s^2", 1.0),
        Self::rate("g", STANDARD_GRAVITY),
        Self::rate("mg", 1e3 * MICRO_G),
        Self::rate("ug", MICRO_G),
        Self::increment("m/s", 1.0),
        Self::increment("ug*s", MICRO_G),
    ];

    /// The units of a table angle.
    pub const TABLE_ANGLE: [Self; 4] = [
        Self::increment("rad", 1.0),
        Self::increment("deg", DEG),
        Self::increment("arcsec", ARCSEC),
        Self::increment("gon", 0.9 * DEG),
    ];

    /// The units of a table rate.
    pub const TABLE_RATE: [Self; 3] =
        [Self::rate("rad/s", 1.0), Self::rate("deg/s", DEG), Self::rate("deg/h", DEG_PER_HOUR)];

    const fn rate(symbol: &'static str, factor: f64) -> Self {
        Self { symbol, factor, of: ReadingOf::Rate }
    }

    const fn increment(symbol: &'static str, factor: f64) -> Self {
        Self { symbol, factor, of: ReadingOf::Increment }
    }

    /// The contribution of one unit over an interval, in SI units.
    fn over(&self, interval: f64) -> f64 {
        match self.of {
            ReadingOf::Rate => self.factor * interval,
            ReadingOf::Increment => self.factor,
        }
    }
}

/// An error, and the factor by which it increases the readings.
pub(super) struct Mistake {
    pub(super) factor: f64,
    pub(super) cause: String,
}

/// The errors in which a unit of `all` was declared as `said`; all pairs of units if that is unknown.
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

/// Whether a ratio is close to one or, if not, the errors that explain it.
///
/// Of the factors close to the ratio the nearest is used; a factor that an uncalibrated sensor may have too must fit closely.
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
