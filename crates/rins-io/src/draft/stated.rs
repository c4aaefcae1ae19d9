//! The unit in a column's name: in brackets, or as its ending.

use crate::quantity::{Dimension, Unit};

/// A unit in a column's name.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Stated {
    /// The unit in the spelling of a rig file.
    pub(super) text: String,
    pub(super) unit: Unit,
    /// Whether it is only the ending of the name, as in `gyro_x_dps`, and not in brackets.
    pub(super) by_ending: bool,
}

/// Spellings of units in headers, with the spelling of a rig file.
const SPELLINGS: &[(&str, &str)] = &[
    ("sec", "s"),
    ("secs", "s"),
    ("second", "s"),
    ("seconds", "s"),
    ("msec", "ms"),
    ("millisecond", "ms"),
    ("milliseconds", "ms"),
    ("usec", "us"),
    ("microsecond", "us"),
    ("microseconds", "us"),
    ("nsec", "ns"),
    ("nanosecond", "ns"),
    ("nanoseconds", "ns"),
    ("hr", "h"),
    ("hour", "h"),
    ("hours", "h"),
    ("degree", "deg"),
    ("degrees", "deg"),
    ("degs", "deg"),
    ("radian", "rad"),
    ("radians", "rad"),
    ("dps", "deg/s"),
    ("dph", "deg/h"),
    ("s2", "s^2"),
    ("mps2", "m/s^2"),
    ("G", "g"),
    ("mG", "mg"),
    ("C", "degC"),
    ("celsius", "degC"),
    ("Celsius", "degC"),
    ("kelvin", "K"),
    ("Kelvin", "K"),
];

/// Endings of names in lower case, with their units.
const ENDINGS: &[(&[&str], &str)] = &[
    (&["m", "s", "2"], "m/s^2"),
    (&["deg", "per", "s"], "deg/s"),
    (&["rad", "per", "s"], "rad/s"),
    (&["deg", "s"], "deg/s"),
    (&["rad", "s"], "rad/s"),
    (&["deg", "h"], "deg/h"),
    (&["deg", "hr"], "deg/h"),
    (&["m", "s2"], "m/s^2"),
    (&["m", "s"], "m/s"),
    (&["dps"], "deg/s"),
    (&["degps"], "deg/s"),
    (&["dph"], "deg/h"),
    (&["radps"], "rad/s"),
    (&["rads"], "rad/s"),
    (&["mps2"], "m/s^2"),
    (&["ms2"], "m/s^2"),
    (&["mss"], "m/s^2"),
    (&["g"], "g"),
    (&["mg"], "mg"),
    (&["ug"], "ug"),
    (&["deg"], "deg"),
    (&["rad"], "rad"),
    (&["arcsec"], "arcsec"),
    (&["s"], "s"),
    (&["sec"], "s"),
    (&["ms"], "ms"),
    (&["us"], "us"),
    (&["ns"], "ns"),
    (&["msec"], "ms"),
    (&["usec"], "us"),
    (&["nsec"], "ns"),
    (&["nsecs"], "ns"),
    (&["nanosec"], "ns"),
    (&["nanosecs"], "ns"),
    (&["degc"], "degC"),
    (&["celsius"], "degC"),
    (&["c"], "degC"),
    (&["k"], "K"),
];

/// The unit in the last brackets of a name, and the name without them.
pub(super) fn in_brackets(name: &str) -> Option<(Stated, String)> {
    let end = name.rfind([')', ']', '}'])?;
    let open = match name.as_bytes()[end] {
        b')' => '(',
        b']' => '[',
        _ => '{',
    };
    let start = name[..end].rfind(open)?;
    let text = spelt(&name[start + 1..end])?;
    let unit = Unit::parse(&text).ok().filter(|unit| unit.dimension != Dimension::RATIO)?;
    let rest = format!("{} {}", &name[..start], &name[end + 1..]);
    Some((Stated { text, unit, by_ending: false }, rest))
}

/// The unit of the last words of a name, and the number of these words.
pub(super) fn by_ending(words: &[String]) -> Option<(Stated, usize)> {
    let ends = |ending: &[&str]| {
        words.len() > ending.len()
            && words[words.len() - ending.len()..]
                .iter()
                .map(String::as_str)
                .eq(ending.iter().copied())
    };
    let (ending, text) = ENDINGS.iter().find(|(ending, _)| ends(ending))?;
    let unit = Unit::parse(text).ok()?;
    Some((Stated { text: (*text).into(), unit, by_ending: true }, ending.len()))
}

/// A unit of a header in the spelling of a rig file.
fn spelt(text: &str) -> Option<String> {
    let plain = text.trim().replace(['µ', 'μ'], "u").replace('²', "^2").replace('³', "^3");
    let plain = plain.replace("°C", "degC").replace("deg C", "degC").replace('°', "deg");
    if plain.chars().count() > 24 {
        return None;
    }
    let mut spelt = String::new();
    let mut word = String::new();
    for letter in plain.chars().chain(['\n']) {
        if letter.is_alphanumeric() || letter == '%' {
            word.push(letter);
            continue;
        }
        let known = SPELLINGS.iter().find(|(spelling, _)| *spelling == word);
        spelt.push_str(known.map_or(word.as_str(), |(_, unit)| unit));
        word.clear();
        if !letter.is_whitespace() {
            spelt.push(letter);
        }
    }
    Some(if spelt == "m/s/s" { "m/s^2".into() } else { spelt })
}

#[cfg(test)]
mod tests {
    use super::{by_ending, in_brackets};

    #[test]
    fn units_in_brackets_are_spelt_as_in_a_rig_file() {
        let cases = [
            ("Gyroscope X (deg/s)", "deg/s", "Gyroscope X"),
            ("gx [rad/s]", "rad/s", "gx"),
            ("GYRO_X(dps)", "deg/s", "GYRO_X"),
            ("wz (°/s)", "deg/s", "wz"),
            ("Acc X [m/s²]", "m/s^2", "Acc X"),
            ("Acc X [m/s2]", "m/s^2", "Acc X"),
            ("Acc X [m/s/s]", "m/s^2", "Acc X"),
            ("Accelerometer X (G)", "g", "Accelerometer X"),
            ("Time (sec)", "s", "Time"),
            ("Timestamp (microseconds)", "us", "Timestamp"),
            ("Temperature {°C}", "degC", "Temperature"),
            ("rate (degrees / second)", "deg/s", "rate"),
        ];
        for (name, unit, rest) in cases {
            let (stated, name) = in_brackets(name).unwrap();
            assert_eq!((stated.text.as_str(), name.trim()), (unit, rest));
        }
    }

    #[test]
    fn brackets_without_a_unit_state_none() {
        for name in ["acc (x)", "Magnetometer X (uT)", "gyro[0]", "x)(", "gain (1)", "é)", "(é"] {
            assert_eq!(in_brackets(name), None, "{name}");
        }
    }

    #[test]
    fn endings_state_units_but_not_whole_names() {
        let stated = |name: &str| {
            let words: Vec<String> = name.split('_').map(String::from).collect();
            by_ending(&words).map(|(stated, words)| (stated.text, words))
        };
        assert_eq!(stated("gyro_x_deg_s"), Some(("deg/s".into(), 2)));
        assert_eq!(stated("time_ms"), Some(("ms".into(), 1)));
        assert_eq!(stated("acc_x_m_s_2"), Some(("m/s^2".into(), 3)));
        assert_eq!(stated("s"), None);
        assert_eq!(stated("gyro_x"), None);
    }
}
