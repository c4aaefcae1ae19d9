//! Units: products, quotients, powers and roots of known units.

use rins_frames::units::{ARCMIN, ARCSEC, DEG, STANDARD_GRAVITY};

use super::dimension::Dimension;
use super::error::QuantityError;
use crate::suggestion::nearest;

/// A unit: its value in SI units and radians, and its dimension.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// Its value in SI units.
    pub factor: f64,
    /// Its dimension.
    pub dimension: Dimension,
}

const KNOWN: &[(&str, f64, Dimension)] = &[
    ("rad", 1.0, Dimension::ANGLE),
    ("mrad", 1e-3, Dimension::ANGLE),
    ("urad", 1e-6, Dimension::ANGLE),
    ("deg", DEG, Dimension::ANGLE),
    ("arcmin", ARCMIN, Dimension::ANGLE),
    ("arcsec", ARCSEC, Dimension::ANGLE),
    ("gon", 0.9 * DEG, Dimension::ANGLE),
    ("rev", core::f64::consts::TAU, Dimension::ANGLE),
    ("turn", core::f64::consts::TAU, Dimension::ANGLE),
    ("s", 1.0, Dimension::TIME),
    ("ms", 1e-3, Dimension::TIME),
    ("us", 1e-6, Dimension::TIME),
    ("ns", 1e-9, Dimension::TIME),
    ("min", 60.0, Dimension::TIME),
    ("h", 3600.0, Dimension::TIME),
    ("day", 86400.0, Dimension::TIME),
    ("Hz", 1.0, Dimension::FREQUENCY),
    ("kHz", 1e3, Dimension::FREQUENCY),
    ("m", 1.0, Dimension::LENGTH),
    ("mm", 1e-3, Dimension::LENGTH),
    ("um", 1e-6, Dimension::LENGTH),
    ("km", 1e3, Dimension::LENGTH),
    ("nmi", 1852.0, Dimension::LENGTH),
    ("kn", 1852.0 / 3600.0, Dimension::VELOCITY),
    ("g", STANDARD_GRAVITY, Dimension::ACCELERATION),
    ("mg", 1e-3 * STANDARD_GRAVITY, Dimension::ACCELERATION),
    ("ug", 1e-6 * STANDARD_GRAVITY, Dimension::ACCELERATION),
    ("ppm", 1e-6, Dimension::RATIO),
    ("%", 1e-2, Dimension::RATIO),
    ("1", 1.0, Dimension::RATIO),
    ("K", 1.0, Dimension::TEMPERATURE),
    ("degC", 1.0, Dimension::TEMPERATURE),
    ("G", 1e-4, Dimension::MAGNETIC_FIELD),
];

/// Refused spellings with their accepted equivalents: files should be uniform.
const MEANT: &[(&str, &str)] = &[
    ("sec", "s"),
    ("second", "s"),
    ("seconds", "s"),
    ("msec", "ms"),
    ("usec", "us"),
    ("hr", "h"),
    ("hour", "h"),
    ("hours", "h"),
    ("minute", "min"),
    ("degs", "deg"),
    ("degree", "deg"),
    ("degrees", "deg"),
    ("dps", "deg/s"),
    ("dph", "deg/h"),
    ("C", "degC"),
    ("percent", "%"),
    ("mps", "m/s"),
    ("s2", "s^2"),
    ("NM", "nmi"),
    ("kt", "kn"),
    ("kts", "kn"),
    ("knot", "kn"),
    ("knots", "kn"),
];

impl Unit {
    /// The unit in `text`, such as `deg/h/sqrt(Hz)`, `m/s^2` or `ug*s`.
    ///
    /// `*` and `/` are evaluated from left to right; an exponent is an integer or half of one.
    ///
    /// # Errors
    /// [`QuantityError`] if a unit is unknown or the text is not a product of units.
    pub fn parse(text: &str) -> Result<Self, QuantityError> {
        // Micro has two code points, and a degree sign means an angle.
        let plain = text.trim().replace(['µ', 'μ'], "u").replace('²', "^2").replace('³', "^3");
        let plain = plain.replace("°C", "degC").replace('°', "deg");
        let mut parser = Parser { rest: &plain, whole: text };
        let unit = parser.product()?;
        if parser.rest.is_empty() && unit.factor.is_normal() {
            Ok(unit)
        } else {
            Err(parser.malformed())
        }
    }

    fn times(self, other: Self) -> Option<Self> {
        let dimension = self.dimension.times(other.dimension)?;
        Some(Self { factor: self.factor * other.factor, dimension })
    }

    fn over(self, other: Self) -> Option<Self> {
        let dimension = self.dimension.times(other.dimension.power(-2)?)?;
        Some(Self { factor: self.factor / other.factor, dimension })
    }

    fn power(self, halves: i32) -> Option<Self> {
        let dimension = self.dimension.power(halves)?;
        let whole = self.factor.powi(halves / 2);
        let factor = match halves % 2 {
            0 => whole,
            1 => whole * self.factor.sqrt(),
            _ => whole / self.factor.sqrt(),
        };
        Some(Self { factor, dimension })
    }
}

struct Parser<'t> {
    rest: &'t str,
    whole: &'t str,
}

impl Parser<'_> {
    fn product(&mut self) -> Result<Unit, QuantityError> {
        let mut unit = self.power()?;
        loop {
            self.rest = self.rest.trim_start();
            unit = if self.take("*") || self.take("·") {
                unit.times(self.power()?).ok_or_else(|| self.malformed())?
            } else if self.take("/") {
                unit.over(self.power()?).ok_or_else(|| self.malformed())?
            } else {
                return Ok(unit);
            };
        }
    }

    fn power(&mut self) -> Result<Unit, QuantityError> {
        let unit = self.atom()?;
        if !self.take("^") {
            return Ok(unit);
        }
        let end = self
            .rest
            .find(|c: char| !(c.is_ascii_digit() || c == '.' || c == '-'))
            .unwrap_or(self.rest.len());
        let (exponent, rest) = self.rest.split_at(end);
        let halves = exponent.parse::<f64>().map_or(f64::NAN, |exponent| 2.0 * exponent);
        // A finite number outside the range of `i32` saturates, and is then refused because of its size.
        #[expect(clippy::cast_possible_truncation, reason = "a whole number, or refused")]
        let halves = if halves.fract() == 0.0 { Some(halves as i32) } else { None };
        self.rest = rest;
        halves.and_then(|halves| unit.power(halves)).ok_or_else(|| self.malformed())
    }

    fn atom(&mut self) -> Result<Unit, QuantityError> {
        self.rest = self.rest.trim_start();
        let root = self.take("sqrt(") || self.take("√(");
        if root || self.take("(") {
            let inner = self.product()?;
            if !self.take(")") {
                return Err(self.malformed());
            }
            return if root { inner.power(1).ok_or_else(|| self.malformed()) } else { Ok(inner) };
        }
        if self.take("√") {
            return self.atom()?.power(1).ok_or_else(|| self.malformed());
        }
        let end = self
            .rest
            .find(|c: char| !(c.is_alphanumeric() || c == '%' || c == '_'))
            .unwrap_or(self.rest.len());
        let (name, rest) = self.rest.split_at(end);
        if name.is_empty() {
            return Err(self.malformed());
        }
        self.rest = rest;
        match KNOWN.iter().find(|(known, ..)| *known == name) {
            Some(&(_, factor, dimension)) => Ok(Unit { factor, dimension }),
            None => Err(QuantityError::UnknownUnit {
                text: self.whole.into(),
                unit: name.into(),
                suggestion: suggestion(name),
            }),
        }
    }

    fn take(&mut self, prefix: &str) -> bool {
        match self.rest.strip_prefix(prefix) {
            Some(rest) => {
                self.rest = rest;
                true
            }
            None => false,
        }
    }

    fn malformed(&self) -> QuantityError {
        QuantityError::Malformed { text: self.whole.into() }
    }
}

fn suggestion(name: &str) -> Option<&'static str> {
    let meant = MEANT.iter().find(|(spelling, _)| *spelling == name).map(|(_, unit)| *unit);
    meant.or_else(|| nearest(name, KNOWN.iter().map(|(known, ..)| *known)))
}
