//! Numbers as text for readers.

/// The text of a number that is not finite.
const NONE: &str = "–";

/// A number with `digits` significant digits, and with a power of ten if it is very small or large.
pub fn figure(value: f64, digits: usize) -> String {
    if !value.is_finite() {
        return unusual(value);
    }
    if value == 0.0 {
        return "0".to_owned();
    }
    // Rounded first: 9.996 with three digits is 10.0.
    let last = digits.saturating_sub(1);
    let scientific = format!("{value:.last$e}");
    let power = power_of(&scientific);
    if !(-3..5).contains(&power) {
        return scientific;
    }
    let decimals = last.saturating_add_signed(-power as isize);
    format!("{value:.decimals$}")
}

/// The number with this number of decimals and a minus sign (U+2212), or with a power of ten if it would be rounded to zero.
pub fn fixed(value: f64, decimals: usize) -> String {
    if !value.is_finite() {
        return unusual(value);
    }
    let plain = format!("{value:.decimals$}");
    if value != 0.0 && is_zero(&plain) {
        return signed(&format!("{value:.1e}"));
    }
    signed(&plain)
}

/// The number with this number of decimals; one that is rounded to zero has no sign.
pub fn decimal(value: f64, decimals: usize) -> String {
    let plain = format!("{value:.decimals$}");
    if is_zero(&plain) { plain.trim_start_matches('-').to_owned() } else { plain }
}

/// A value and its standard deviation, both rounded to the second digit of the standard deviation, with a minus sign (U+2212).
///
/// Without a valid standard deviation the value has six digits.
pub fn estimate(value: f64, sigma: f64) -> (String, String) {
    if !value.is_finite() {
        return (unusual(value), unusual_or(sigma, |sigma| format!("{sigma:.1e}")));
    }
    if !sigma.is_finite() || sigma <= 0.0 {
        let shown = if sigma == 0.0 { "0".to_owned() } else { unusual(sigma) };
        return (signed(&figure(value, 6)), shown);
    }
    // Rounded first: the second digit of 0.0996 is that of 0.10.
    let power = power_of(&format!("{sigma:.1e}"));
    if power < -6 && value != 0.0 {
        let digits = (power_of(&format!("{value:e}")) - power + 1).max(0);
        let digits = usize::try_from(digits).unwrap_or_default().min(17);
        return (signed(&format!("{value:.digits$e}")), signed(&format!("{sigma:.1e}")));
    }
    if power < -6 {
        return ("0".to_owned(), signed(&format!("{sigma:.1e}")));
    }
    let decimals = usize::try_from(1 - power).unwrap_or_default();
    (signed(&format!("{value:.decimals$}")), format!("{sigma:.decimals$}"))
}

/// The power of ten of a number written like `1.2e-3`.
fn power_of(scientific: &str) -> i32 {
    scientific.split_once('e').and_then(|(_, power)| power.parse().ok()).unwrap_or_default()
}

fn unusual(value: f64) -> String {
    match value {
        f64::INFINITY => "∞".to_owned(),
        f64::NEG_INFINITY => "−∞".to_owned(),
        _ => NONE.to_owned(),
    }
}

fn unusual_or(value: f64, usual: impl Fn(f64) -> String) -> String {
    if value.is_finite() { signed(&usual(value)) } else { unusual(value) }
}

fn signed(number: &str) -> String {
    if is_zero(number) { number.replace('-', "") } else { number.replace('-', "−") }
}

fn is_zero(number: &str) -> bool {
    number.bytes().all(|b| matches!(b, b'-' | b'.' | b'0'))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn estimates_stop_at_the_second_digit_of_their_sigma() {
        let cases = [
            (59.98123, 0.00612, "59.9812", "0.0061"),
            (-107.743, 0.0996, "−107.74", "0.10"),
            (-107.743, 0.0994, "−107.743", "0.099"),
            (301.39, 0.034, "301.390", "0.034"),
            (12345.6, 123.0, "12346", "123"),
            (3.0, 9.96, "3", "10"),
            (1.23456e-9, 1.2e-11, "1.235e−9", "1.2e−11"),
            (0.0, 1.2e-11, "0", "1.2e−11"),
            (-0.001, 0.5, "0.00", "0.50"),
            (1.5e12, f64::NAN, "1.50000e12", "–"),
            (2.5, 0.0, "2.50000", "0"),
            (2.123456789, f64::NAN, "2.12346", "–"),
            (f64::NAN, 0.5, "–", "5.0e−1"),
            (1.0, f64::INFINITY, "1.00000", "∞"),
        ];
        for (value, sigma, shown, shown_sigma) in cases {
            let want = (shown.to_owned(), shown_sigma.to_owned());
            assert_eq!(estimate(value, sigma), want, "{value} ± {sigma}");
        }
    }

    #[test]
    fn figures_keep_their_digits() {
        let cases = [
            (5.7296, 3, "5.73"),
            (9.9996, 4, "10.00"),
            (-0.012345, 3, "-0.0123"),
            (123456.0, 3, "1.23e5"),
            (12345.6, 3, "12346"),
            (0.00049996, 4, "5.000e-4"),
            (0.0, 4, "0"),
            (f64::INFINITY, 3, "∞"),
        ];
        for (value, digits, shown) in cases {
            assert_eq!(figure(value, digits), shown, "{value} to {digits} digits");
        }
    }

    #[test]
    fn fixed_decimals_never_make_zero_of_a_number() {
        let cases = [
            (2.9704, 2, "2.97"),
            (-17.431, 1, "−17.4"),
            (0.0004, 2, "4.0e−4"),
            (-0.0, 2, "0.00"),
            (0.0, 3, "0.000"),
            (f64::NEG_INFINITY, 1, "−∞"),
            (f64::NAN, 1, "–"),
        ];
        for (value, decimals, shown) in cases {
            assert_eq!(fixed(value, decimals), shown, "{value} to {decimals} decimals");
        }
    }
}
