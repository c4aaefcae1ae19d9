//! Dates with times of day, as time stamps.

use jiff::Timestamp;
use jiff::civil::{Date, DateTime, Time};
use jiff::tz::TimeZone;

/// A date with a time of day, such as `2021-07-05T10:00:00.010Z` (ISO 8601), as nanoseconds since 1970; `None` for any other text.
///
/// Also accepted: a blank instead of `T`, a decimal comma, and slashes in a date that begins with the year. A time without an
/// offset from UTC counts as UTC. A date alone has no time.
pub(crate) fn nanoseconds(text: &str) -> Option<i128> {
    let is_digit = |place: usize| text.as_bytes().get(place).is_some_and(u8::is_ascii_digit);
    // What begins with the year, and has a time.
    if !((0..4).all(is_digit) && text.contains(':')) {
        return None;
    }
    let plain = text.replace('/', "-").replace(',', ".");
    let timestamp = plain.parse::<Timestamp>().ok().or_else(|| {
        let local: DateTime = plain.parse().ok()?;
        TimeZone::UTC.to_timestamp(local).ok()
    })?;
    Some(timestamp.as_nanosecond())
}

/// The seconds from 1970 to the start of a day: of a date that begins with the year, with hyphens or slashes, or of one as in
/// `05.07.2021`; `None` for any other text. A date such as `05/07/2021` is ambiguous.
pub(crate) fn day(text: &str) -> Option<i64> {
    let date = match text.split('.').collect::<Vec<_>>()[..] {
        [day, month, year] if year.len() == 4 => {
            Date::new(year.parse().ok()?, month.parse().ok()?, day.parse().ok()?).ok()?
        }
        _ => text.replace('/', "-").parse().ok().filter(|_| !text.contains(':'))?,
    };
    Some(TimeZone::UTC.to_timestamp(date.at(0, 0, 0, 0)).ok()?.as_second())
}

/// The time of day of a text such as `10:00:00.010`, in nanoseconds; `None` for any other text.
pub(crate) fn time_of_day(text: &str) -> Option<i128> {
    let time: Time = text.replace(',', ".").parse().ok().filter(|_| text.contains(':'))?;
    let seconds = 3600 * i128::from(time.hour()) + 60 * i128::from(time.minute());
    let nanoseconds = i128::from(time.subsec_nanosecond());
    Some((seconds + i128::from(time.second())) * 1_000_000_000 + nanoseconds)
}

/// A date with a time and an offset from UTC (RFC 3339) as seconds since 1970; `None` for any other text.
pub fn date_seconds(text: &str) -> Option<f64> {
    let has_offset = text.ends_with(['Z', 'z'])
        || text.rsplit_once(['T', 't', ' ']).is_some_and(|(_, time)| time.contains(['+', '-']));
    nanoseconds(text).filter(|_| has_offset).map(|instant| instant as f64 * 1e-9)
}

/// The date of an instant in seconds since 1970, in UTC; the seconds themselves if it is out of the range of dates.
pub fn date_text(seconds: f64) -> String {
    #[expect(clippy::cast_possible_truncation, reason = "a cast saturates, and dates have a range")]
    let instant = Timestamp::from_second(seconds.round() as i64);
    match instant {
        Ok(instant) => {
            let day = instant.to_zoned(TimeZone::UTC).date();
            day.to_string()
        }
        Err(_) => format!("{seconds} s"),
    }
}

#[cfg(test)]
mod tests {
    use super::{date_seconds, date_text, day, nanoseconds, time_of_day};

    #[test]
    fn days_and_times_of_day_add_up_to_instants() {
        for date in ["2021-07-05", "2021/07/05", "05.07.2021", "5.7.2021"] {
            let start = i128::from(day(date).unwrap()) * 1_000_000_000;
            let time = time_of_day("10:00:00.01").unwrap();
            assert_eq!(Some(start + time), nanoseconds("2021-07-05T10:00:00.010Z"), "{date}");
        }
        assert_eq!(time_of_day("00:00:01,000000001"), Some(1_000_000_001));
    }

    #[test]
    fn ambiguous_days_are_refused() {
        for text in ["05/07/2021", "07-05-2021", "1.2.3", "32.1.2021", "2021-07-05T10:00", "1.5"] {
            assert_eq!(day(text), None, "{text}");
        }
        for text in ["10", "25:00:00", "10.5", "100000", "2021-07-05", "noon"] {
            assert_eq!(time_of_day(text), None, "{text}");
        }
    }

    #[test]
    fn all_ways_to_write_an_instant_say_the_same() {
        let same = [
            "2021-07-05T10:00:00.010Z",
            "2021-07-05T10:00:00.010",
            "2021-07-05 10:00:00.010",
            "2021/07/05 10:00:00.010",
            "2021-07-05 10:00:00,010",
            "2021-07-05T12:00:00.010+02:00",
            "2021-07-05T10:00:00.010000000Z",
        ];
        for text in same {
            assert_eq!(nanoseconds(text), Some(1_625_479_200_010_000_000), "{text}");
        }
        assert_eq!(nanoseconds("1970-01-01T00:00:00.000000001Z"), Some(1));
    }

    #[test]
    fn what_is_no_instant_is_refused() {
        let not = [
            "2021-07-05",
            "10:00:00",
            "05.07.2021 10:00:00",
            "07/05/2021 10:00",
            "2021-13-05T10:00:00",
            "2021:10",
            "",
            "20210705",
            "1625479200.01",
            "2021-07-05T10:00:00Zulu",
        ];
        for text in not {
            assert_eq!(nanoseconds(text), None, "{text}");
        }
    }

    #[test]
    fn dates_have_an_offset() {
        let seconds = date_seconds("2026-11-26T10:00:00+01:00").unwrap();
        assert_eq!(Some(seconds), date_seconds("2026-11-26T09:00:00Z"));
        assert_eq!(date_text(seconds), "2026-11-26");
        for text in ["2026-11-26T10:00:00", "2026-11-26", "today", ""] {
            assert_eq!(date_seconds(text), None, "{text}");
        }
        assert_eq!(date_text(f64::INFINITY), "inf s");
    }
}
