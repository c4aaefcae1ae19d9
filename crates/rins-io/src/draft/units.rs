//! Units that no header states, determined from the magnitude of the numbers.

use std::f64::consts::TAU;

use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, STANDARD_GRAVITY};

use super::evidence::{least_rate, steady, turning_of_gravity, turning_of_table, wrap};
use super::page::short;
use super::sample::Sample;

/// The Earth rate, which a gyro triad at rest measures \[rad/s\].
const EARTH_RATE: f64 = 15.041 * DEG_PER_HOUR;

/// A unit, and its value in SI units.
type Candidate = (&'static str, f64);

const FORCES: [Candidate; 4] = [
    ("m/s^2", 1.0),
    ("g", STANDARD_GRAVITY),
    ("mg", 1e-3 * STANDARD_GRAVITY),
    ("ug", 1e-6 * STANDARD_GRAVITY),
];
const VELOCITIES: [Candidate; 2] = [("m/s", 1.0), ("ug*s", 1e-6 * STANDARD_GRAVITY)];
const RATES: [Candidate; 3] = [("rad/s", 1.0), ("deg/s", DEG), ("deg/h", DEG_PER_HOUR)];
const ANGLES: [Candidate; 3] = [("rad", 1.0), ("deg", DEG), ("arcsec", ARCSEC)];
const TABLE_ANGLES: [Candidate; 4] = [("rad", 1.0), ("deg", DEG), ("arcsec", ARCSEC), ("rev", TAU)];

/// A unit that was determined, with the reason.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct UnitFound {
    pub(super) text: &'static str,
    pub(super) why: String,
}

/// The unit of the accelerometers' numbers, from the magnitude of gravity.
///
/// # Errors
/// A description of what the numbers indicate instead.
pub(super) fn accel_unit(
    sample: &Sample,
    accel: [usize; 3],
    interval: Option<f64>,
    increment: bool,
) -> Result<UnitFound, String> {
    let Some(seen) = steady(sample, accel) else {
        return Err("no row with a steady magnitude to compare with gravity".into());
    };
    let candidates = candidates(&FORCES, &VELOCITIES, interval, increment);
    // Small sensors can have biases of a tenth of gravity.
    let tolerances = tolerances(sample, accel, &[1.03, 1.15]);
    match unique(&candidates, STANDARD_GRAVITY * interval.unwrap_or(1.0) / seen.norm, tolerances) {
        Some(text) => {
            let norm = short(seen.norm);
            Ok(UnitFound { text, why: format!("their steady magnitude, {norm}, is then gravity") })
        }
        None => Err(format!(
            "the steady magnitude is {}, where gravity is 9.81 m/s^2",
            short(seen.norm)
        )),
    }
}

/// The findings that are used to determine the gyros' unit.
#[derive(Clone, Copy, Debug)]
pub(super) struct Surroundings<'s> {
    pub(super) sample: &'s Sample,
    pub(super) interval: Option<f64>,
    pub(super) accel: Option<[usize; 3]>,
    /// The table's column, the value of its unit in SI units, and whether it is an angle.
    pub(super) table: Option<(usize, f64, bool)>,
}

impl Surroundings<'_> {
    /// The rotation of the body per row and per unit of the gyros' numbers \[rad\], from the table motion.
    pub(super) fn by_table(&self, gyro: [usize; 3]) -> Option<f64> {
        let (column, factor, is_angle) = self.table?;
        let ratio = turning_of_table(self.sample, gyro, column, is_angle)?;
        if is_angle { Some(ratio * factor) } else { Some(ratio * factor * self.interval?) }
    }

    /// The same from the rotation of gravity.
    pub(super) fn by_gravity(&self, gyro: [usize; 3]) -> Option<f64> {
        turning_of_gravity(self.sample, gyro, self.accel?)
    }

    /// The unit of the gyros' numbers: from the table motion, from the rotation of gravity, or from the
    /// Earth rate.
    ///
    /// # Errors
    /// A description of what the numbers indicate instead.
    pub(super) fn gyro_unit(&self, gyro: [usize; 3], increment: bool) -> Result<UnitFound, String> {
        // Motion between rows shows a unit only if the time between them is known.
        if self.interval.is_none() {
            return Err("it depends on the rate, which is not known".into());
        }
        let candidates = candidates(&RATES, &ANGLES, self.interval, increment);
        let found = |text, why: &str| Ok(UnitFound { text, why: why.into() });
        let mut seen = Vec::new();
        if let Some(turn) = self.by_table(gyro) {
            if let Some(text) = unique(&candidates, turn, &[1.03]) {
                return found(text, "the rotation of the gyros then equals that of the table");
            }
            seen.push(self.one_count("the table's motion", turn));
        }
        if let Some(turn) = self.by_gravity(gyro).map(f64::abs) {
            if let Some(text) =
                unique(&candidates, turn, tolerances(self.sample, gyro, &[1.05, 1.6]))
            {
                return found(
                    text,
                    "the rotation of gravity in the accelerometers then equals that of the gyros",
                );
            }
            seen.push(self.one_count("the rotation of gravity", turn));
        }
        if let (Some(rate), Some(interval)) = (least_rate(self.sample, gyro), self.interval) {
            let near = tolerances(self.sample, gyro, &[1.05, 1.3]);
            if let Some(text) = unique(&candidates, EARTH_RATE * interval / rate, near) {
                let seen = short(rate);
                let why = format!("the quietest rows, {seen}, then show the Earth's rate");
                return Ok(UnitFound { text, why });
            }
            seen.push(format!("the quietest rows read {}", short(rate)));
        }
        Err(if seen.is_empty() { "the data do not show it".into() } else { seen.join("; ") })
    }

    fn one_count(&self, by: &str, turn: f64) -> String {
        match self.interval {
            Some(interval) => format!("by {by}, 1 is about {} deg/s", short(turn / interval / DEG)),
            None => format!(
                "by {by}, 1 is about {} deg/s if the rate is 100 Hz",
                short(turn * 100.0 / DEG)
            ),
        }
    }
}

/// The unit of the table angle, from the jumps at which it wraps around, or from gyros whose unit is known:
/// `turn` is the rotation of the body per row and per unit of their numbers \[rad\].
pub(super) fn angle_unit(
    sample: &Sample,
    column: usize,
    gyro: Option<([usize; 3], f64)>,
) -> Option<UnitFound> {
    if let Some(jump) = wrap(sample, column)
        && let Some(text) = unique(&TABLE_ANGLES, TAU / jump, &[1.1])
    {
        let why = format!("it jumps by {}, which is then one revolution", short(jump));
        return Some(UnitFound { text, why });
    }
    let (gyro, turn) = gyro?;
    let ratio = turning_of_table(sample, gyro, column, true)?;
    let text = unique(&TABLE_ANGLES, turn / ratio, &[1.1])?;
    Some(UnitFound { text, why: "the rotation of the table then equals that of the gyros".into() })
}

/// The unit of the table rate, from gyros as in [`angle_unit`].
pub(super) fn rate_unit(
    sample: &Sample,
    column: usize,
    gyro: Option<([usize; 3], f64)>,
    interval: Option<f64>,
) -> Option<UnitFound> {
    let (gyro, turn) = gyro?;
    let ratio = turning_of_table(sample, gyro, column, false)?;
    let text = unique(&RATES, turn / interval? / ratio, &[1.1])?;
    Some(UnitFound { text, why: "the rotation of the table then equals that of the gyros".into() })
}

/// The units of rates and increments, each with its increment per row in SI units.
fn candidates(
    rates: &[Candidate],
    increments: &[Candidate],
    interval: Option<f64>,
    only_increments: bool,
) -> Vec<Candidate> {
    match interval {
        // Without the interval, rates and increments cannot be distinguished; gravity is then integrated over 1 s.
        None if only_increments => Vec::new(),
        None => rates.to_vec(),
        Some(interval) => {
            let over = |&(text, factor): &Candidate| (text, factor * interval);
            let rates = rates.iter().filter(|_| !only_increments).map(over);
            rates.chain(increments.iter().copied()).collect()
        }
    }
}

/// The tolerances for a triad. Counts can have any scale, of which many are near one of the units: only the closest is applied.
fn tolerances<'t>(sample: &Sample, triad: [usize; 3], all: &'t [f64]) -> &'t [f64] {
    if sample.is_whole(triad) { &all[..all.len().min(1)] } else { all }
}

/// The only candidate whose factor is within a tolerance of `factor`; the tolerances are applied in
/// order until a candidate is found.
fn unique(candidates: &[Candidate], factor: f64, tolerances: &[f64]) -> Option<&'static str> {
    for tolerance in tolerances {
        let is_near = |candidate: &&Candidate| (factor / candidate.1).ln().abs() < tolerance.ln();
        let mut near = candidates.iter().filter(is_near);
        match (near.next(), near.next()) {
            (Some((text, _)), None) => return Some(text),
            (Some(_), Some(_)) => return None,
            (None, _) => {}
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::{ANGLES, FORCES, RATES, VELOCITIES, candidates, unique};
    use rins_frames::units::{DEG, STANDARD_GRAVITY};

    #[test]
    fn an_ambiguous_unit_is_not_chosen() {
        // At 10 Hz, 0.98 is gravity in g minus 2 %, or in m/s over an interval.
        let at = |interval| candidates(&FORCES, &VELOCITIES, Some(interval), false);
        let unit = |interval: f64, norm: f64| {
            unique(&at(interval), STANDARD_GRAVITY * interval / norm, &[1.03, 1.15])
        };
        assert_eq!(unit(0.1, 0.981), None);
        assert_eq!(unit(0.1, 9.9), Some("m/s^2"));
        assert_eq!(unit(0.02, 1.02), Some("g"));
        assert_eq!(unit(0.02, 0.196), Some("m/s"));
        assert_eq!(unit(0.02, 0.5), None);
    }

    #[test]
    fn rates_and_increments_are_told_apart_where_they_can_be() {
        let at = |interval| candidates(&RATES, &ANGLES, Some(interval), false);
        // At 50 Hz a degree per interval is 0.87 rad/s: the closer tolerance decides.
        assert_eq!(unique(&at(0.02), DEG, &[1.05, 1.6]), Some("deg"));
        assert_eq!(unique(&at(0.02), 0.02 / 1.07, &[1.05, 1.6]), None);
        assert_eq!(unique(&at(0.0025), 0.6 * 0.0025 * DEG, &[1.05]), None);
        assert_eq!(unique(&at(0.0025), 0.7 * 0.0025 * DEG, &[1.05, 1.6]), Some("deg/s"));
    }
}
