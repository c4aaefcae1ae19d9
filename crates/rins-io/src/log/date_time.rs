//! Dates with times of day, as time stamps.

use jiff::Timestamp;
use jiff::civil::DateTime;
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

#[cfg(test)]
mod tests {
    use super::nanoseconds;

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
}
