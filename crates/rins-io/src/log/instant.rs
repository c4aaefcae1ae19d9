//! Time stamps, parsed without the loss of digits that a double cannot represent.

use super::date_time::{nanoseconds, time_of_day};

/// Stamps beyond this \[s\] (48 days) are counted from an integer second near the first: near this limit the spacing of doubles
/// is a nanosecond, and near the seconds since 1970 a quarter of a microsecond.
const LARGEST: f64 = 4194304.0;

/// The decimals of a stamp that are kept when it is counted from an origin.
const DECIMALS: i32 = 12;

/// A parser of time stamps in one unit.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) struct Instants {
    /// Units per second: division by a power of ten rounds once, multiplication by its inverse twice.
    per_second: f64,
    /// The origin of the stamps, in units of 10⁻¹² s; `None` until the first is read.
    origin: Option<i128>,
    /// How the first stamp is written.
    form: Option<Form>,
}

/// How a stamp is written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Form {
    Number,
    DateTime,
    TimeOfDay,
}

impl Instants {
    /// A parser of stamps in units of `unit` seconds.
    pub(super) fn new(unit: f64) -> Self {
        let per_second = unit.recip();
        let whole = per_second.round();
        let is_whole = (per_second - whole).abs() <= 1e-15 * per_second;
        Self { per_second: if is_whole { whole } else { per_second }, origin: None, form: None }
    }

    /// A parser for another file with the same unit and origin, whose stamps may be written otherwise.
    pub(super) fn of_another_file(self) -> Self {
        Self { form: None, ..self }
    }

    /// The stamp's time after the origin \[s\]; `None` if it is neither a number nor, where stamps are in seconds, a time of day or a
    /// date with one, or if it is not written as the first stamp.
    pub(super) fn seconds(&mut self, text: &str) -> Option<f64> {
        if let Ok(stamp) = text.parse() {
            self.is_written_as(Form::Number)?;
            return Some(self.after_origin(stamp, || fixed(text)));
        }
        if self.per_second.to_bits() != 1_f64.to_bits() {
            return None;
        }
        let (nanoseconds, form) = match nanoseconds(text) {
            Some(instant) => (instant, Form::DateTime),
            None => (time_of_day(text)?, Form::TimeOfDay),
        };
        self.is_written_as(form)?;
        let scale = 10_i128.pow(DECIMALS.unsigned_abs() - 9);
        Some(self.after_origin(nanoseconds as f64 * 1e-9, || nanoseconds.checked_mul(scale)))
    }

    /// Refuses a stamp that is not written as the first one.
    fn is_written_as(&mut self, form: Form) -> Option<()> {
        (*self.form.get_or_insert(form) == form).then_some(())
    }

    /// The same for a stamp that is a number.
    pub(super) fn of_number(&mut self, stamp: f64) -> f64 {
        self.after_origin(stamp, || None)
    }

    /// The same for a stamp that is an integer.
    pub(super) fn of_integer(&mut self, stamp: i64) -> f64 {
        self.after_origin(stamp as f64, || {
            i128::from(stamp).checked_mul(10_i128.pow(DECIMALS.unsigned_abs()))
        })
    }

    /// The same for stamps in seconds, of `whole` seconds plus the number in `text`, of which `per_second` are a second.
    pub(super) fn of_sum(&mut self, whole: i64, text: &str, per_second: i64) -> Option<f64> {
        let plain = whole as f64 + text.parse::<f64>().ok()? / per_second as f64;
        let whole = i128::from(whole) * 10_i128.pow(DECIMALS.unsigned_abs());
        let part = || Some(fixed(text)? / i128::from(per_second));
        Some(self.after_origin(plain, || part()?.checked_add(whole)))
    }

    /// The time after the origin of a stamp whose double is `plain`, and whose value to 10⁻¹² is `fixed`.
    fn after_origin(&mut self, plain: f64, fixed: impl Fn() -> Option<i128>) -> f64 {
        if !plain.is_finite() {
            return plain;
        }
        let origin = *self.origin.get_or_insert_with(|| match fixed() {
            Some(stamp) if (plain / self.per_second).abs() > LARGEST => {
                let second = self.per_second.round() * 10_f64.powi(DECIMALS);
                // A second has at most 10²¹ of these units.
                #[expect(clippy::cast_possible_truncation, reason = "a whole number below 2⁷⁰")]
                let second = second as i128;
                stamp.div_euclid(second) * second
            }
            _ => 0,
        });
        if origin == 0 {
            return plain / self.per_second;
        }
        let scale = 10_f64.powi(DECIMALS);
        match fixed() {
            Some(stamp) => (stamp - origin) as f64 / (scale * self.per_second),
            None => (plain - origin as f64 / scale) / self.per_second,
        }
    }

    /// The origin \[s\].
    pub(super) fn origin(&self) -> f64 {
        self.origin.unwrap_or(0) as f64 / (10_f64.powi(DECIMALS) * self.per_second)
    }
}

/// The whole number in `text`.
pub(super) fn whole(text: &str) -> Option<i64> {
    let one = 10_i128.pow(DECIMALS.unsigned_abs());
    let number = fixed(text).filter(|number| text.parse::<f64>().is_ok() && number % one == 0)?;
    i64::try_from(number / one).ok()
}

/// A decimal number in units of 10⁻¹²; `None` if it is too large for that.
fn fixed(text: &str) -> Option<i128> {
    let (mantissa, exponent) = match text.split_once(['e', 'E']) {
        Some((mantissa, exponent)) => (mantissa, exponent.parse::<i32>().ok()?),
        None => (text, 0),
    };
    let (whole, decimals) = mantissa.split_once('.').unwrap_or((mantissa, ""));
    let negative = whole.starts_with('-');
    let whole = whole.trim_start_matches(['-', '+']);
    let digits: String = whole.chars().chain(decimals.chars()).take(34).collect();
    let decimals = i32::try_from(digits.len()).ok()? - i32::try_from(whole.len()).ok()?;
    let shift = exponent.checked_add(DECIMALS)?.checked_sub(decimals)?;
    let number: i128 = if digits.is_empty() { 0 } else { digits.parse().ok()? };
    let power = 10_i128.checked_pow(shift.unsigned_abs())?;
    let scaled = if shift < 0 { number / power } else { number.checked_mul(power)? };
    // A quarter of the range leaves room for differences.
    (scaled < i128::MAX / 4).then_some(if negative { -scaled } else { scaled })
}

#[cfg(test)]
mod tests {
    use super::Instants;
    use proptest::prelude::*;
    use rins_testing::assert_close;

    #[test]
    fn a_nanosecond_since_1970_is_not_lost() {
        let mut instants = Instants::new(1e-9);
        let first = instants.seconds("1700000000123456789").unwrap();
        let second = instants.seconds("1700000000123456790").unwrap();
        assert!((second - first - 1e-9).abs() < 1e-16);
        assert_close!(instants.origin(), 1.7e9, 1e-9);
    }

    #[test]
    fn an_exponent_is_as_good_as_digits() {
        let mut digits = Instants::new(1.0);
        let mut exponent = Instants::new(1.0);
        for (a, b) in [
            ("1700000000.123456", "1.700000000123456000e+09"),
            ("1700000000.133457", "1.700000000133457000E9"),
        ] {
            assert_eq!(digits.seconds(a), exponent.seconds(b));
        }
        assert!((digits.seconds("1700000001.5").unwrap() - 1.5).abs() < 1e-15);
    }

    proptest! {
        #[test]
        fn small_times_are_read_as_they_are(time in -4e6..4e6_f64) {
            prop_assert_eq!(Instants::new(1.0).seconds(&time.to_string()), Some(time));
        }

        #[test]
        fn any_text_is_read_or_refused(text in "[-+0-9.eE]{0,30}") {
            let mut instants = Instants::new(1e-3);
            let _ = instants.seconds("9e15");
            let _ = instants.seconds(&text);
        }
    }
}
