//! Time stamps that are the sum of two columns.

use super::date_time::{day, time_of_day};
use super::instant::{Instants, whole};
use super::problem::LogProblem;
use crate::rig::{Coarse, SplitTime};

/// A day with a leap second.
const LONGEST_DAY: i64 = 86_401;

/// The time after the origin \[s\] of a stamp whose first column, called `column`, has the text `first`, and whose second
/// column has the text `second`.
///
/// Both are added as decimal numbers, so that no digit is lost.
///
/// # Errors
/// [`LogProblem`] if the first is not a date or a whole number, or the second not between zero and one unit of the first.
pub(super) fn seconds(
    instants: &mut Instants,
    split: &SplitTime,
    (column, first): (&str, &str),
    second: &str,
) -> Result<f64, LogProblem> {
    let named = |column: &str, text: &str| (column.to_string(), text.chars().take(40).collect());
    let (start, longest) = match split.coarse {
        Coarse::Date => {
            let (column, text) = named(column, first);
            (day(first).ok_or(LogProblem::NotADate { column, text })?, LONGEST_DAY)
        }
        Coarse::Seconds(length) => {
            let (column, text) = named(column, first);
            let problem = LogProblem::NotWhole { column, text };
            let start = whole(first).and_then(|count| count.checked_mul(length));
            (start.ok_or(problem)?, length)
        }
    };
    let (column, text) = named(&split.column, second);
    let of_day =
        time_of_day(second).filter(|_| split.coarse == Coarse::Date && split.per_second == 1);
    // A time of day as a number of seconds, with all its decimals.
    let of_day = of_day.map(|time| format!("{}.{:09}", time / 1_000_000_000, time % 1_000_000_000));
    let second = of_day.as_deref().unwrap_or(second);
    let Ok(number) = second.parse::<f64>() else {
        return Err(LogProblem::NotANumber { column, text });
    };
    if !(0.0..longest as f64).contains(&(number / split.per_second as f64)) {
        return Err(LogProblem::BeyondPart { column, text, longest });
    }
    let time = instants.of_sum(start, second, split.per_second);
    time.filter(|time| time.is_finite()).ok_or(LogProblem::NotFinite { column, text })
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    fn split(coarse: Coarse, per_second: i64) -> SplitTime {
        SplitTime { coarse, column: "b".into(), per_second }
    }

    proptest! {
        /// A nanosecond is kept, whatever the second since 1970.
        #[test]
        fn no_nanosecond_is_lost(start in 0..4_000_000_000_i64, steps in prop::collection::vec(1..2_000_000_000_i64, 2..9)) {
            let unix = split(Coarse::Seconds(1), 1_000_000_000);
            let mut instants = Instants::new(1.0);
            let mut now = start * 1_000_000_000;
            let mut before = None;
            for step in steps {
                now += step;
                let (whole, part) = ((now / 1_000_000_000).to_string(), (now % 1_000_000_000).to_string());
                let time = seconds(&mut instants, &unix, ("a", &whole), &part).unwrap();
                if let Some(before) = before {
                    let found: f64 = time - before;
                    // Near this limit the spacing of doubles is a nanosecond.
                    prop_assert!((found - step as f64 * 1e-9).abs() < 1e-9, "{found} {step}");
                }
                before = Some(time);
            }
        }
    }

    #[test]
    fn weeks_and_days_are_added() {
        let week = split(Coarse::Seconds(604_800), 1_000);
        let mut instants = Instants::new(1.0);
        let end = seconds(&mut instants, &week, ("a", "2209"), "604799990").unwrap();
        let start = seconds(&mut instants, &week, ("a", "2210"), "0").unwrap();
        assert!((start - end - 0.01).abs() < 1e-12);
        let date = split(Coarse::Date, 1);
        let mut instants = Instants::new(1.0);
        let end = seconds(&mut instants, &date, ("a", "31.12.2024"), "23:59:59.995").unwrap();
        let start = seconds(&mut instants, &date, ("a", "01.01.2025"), "0.005").unwrap();
        assert!((start - end - 0.01).abs() < 1e-12);
    }

    #[test]
    fn parts_that_do_not_fit_are_named() {
        let said = |split: &SplitTime, first, second| {
            seconds(&mut Instants::new(1.0), split, ("a", first), second).unwrap_err().to_string()
        };
        let unix = split(Coarse::Seconds(1), 1_000_000_000);
        let rows = [
            (&unix, "1.5", "0", "column \"a\": \"1.5\" is not a whole number"),
            (&unix, "1", "x", "column \"b\": \"x\" is not a number"),
            (
                &unix,
                "1",
                "1e9",
                "column \"b\": \"1e9\" is not from 0 to less than 1 s; check time.unit",
            ),
            (
                &unix,
                "1",
                "-1",
                "column \"b\": \"-1\" is not from 0 to less than 1 s; check time.unit",
            ),
            (
                &split(Coarse::Date, 1),
                "05/07/2021",
                "0",
                "column \"a\": \"05/07/2021\" is not a date such as 2021-07-05 or 05.07.2021",
            ),
        ];
        for (split, first, second, message) in rows {
            assert_eq!(said(split, first, second), message);
        }
    }
}
