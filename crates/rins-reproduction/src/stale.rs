//! Comparison of a page in the repository with the present results.

use std::fmt;

/// A place where the stored text and the new one differ by more than a unit in a last digit.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct Difference {
    /// The line of the stored text, from 1.
    pub(crate) line: usize,
    /// The stored text.
    pub(crate) kept: String,
    /// The new text.
    pub(crate) made: String,
}

impl fmt::Display for Difference {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "line {}: kept \"{}\", now \"{}\"", self.line, self.kept, self.made)
    }
}

/// The differences between `kept` and `made`, line by line.
///
/// Numbers may differ by one in the last written digit: the last bits of a sine depend on the machine.
pub(crate) fn differences(kept: &str, made: &str) -> Vec<Difference> {
    let (kept, made): (Vec<&str>, Vec<&str>) = (kept.lines().collect(), made.lines().collect());
    (0..kept.len().max(made.len()))
        .filter_map(|place| {
            let (old, new) = (kept.get(place).copied(), made.get(place).copied());
            let same = matches!((old, new), (Some(old), Some(new)) if is_same(old, new));
            (!same).then(|| Difference {
                line: place + 1,
                kept: old.unwrap_or_default().to_owned(),
                made: new.unwrap_or_default().to_owned(),
            })
        })
        .collect()
}

fn is_same(kept: &str, made: &str) -> bool {
    if kept == made {
        return true;
    }
    let (kept, made) = (tokens(kept), tokens(made));
    kept.len() == made.len() && kept.iter().zip(&made).all(|(one, other)| one.agrees(other))
}

/// A sequence of characters without digits, or a number.
#[derive(Debug, PartialEq)]
enum Token<'t> {
    Text(&'t str),
    Number { value: f64, decimals: usize },
}

impl Token<'_> {
    fn agrees(&self, other: &Self) -> bool {
        match (self, other) {
            (
                Self::Number { value: one, decimals },
                Self::Number { value: another, decimals: same },
            ) if decimals == same => {
                let unit = 0.1_f64.powi(i32::try_from(*decimals).unwrap_or(i32::MAX));
                (one - another).abs() < 1.5 * unit
            }
            _ => self == other,
        }
    }
}

/// The numbers of a line and the text between them; a sign belongs to its number.
fn tokens(line: &str) -> Vec<Token<'_>> {
    let mut tokens = Vec::new();
    let mut rest = line;
    while let Some(start) = rest.find(|c: char| c.is_ascii_digit()) {
        let length = rest[start..]
            .find(|c: char| !(c.is_ascii_digit() || c == '.'))
            .unwrap_or(rest.len() - start);
        // A period after a number belongs to the sentence.
        let number = rest[start..start + length].trim_end_matches('.');
        let before = &rest[..start];
        let unsigned = before.trim_end_matches(['-', '−']);
        let is_negative = before.len() > unsigned.len();
        let size: f64 = number.parse().unwrap_or(f64::NAN);
        tokens.push(Token::Text(unsigned.trim_end_matches('+')));
        tokens.push(Token::Number {
            value: if is_negative { -size } else { size },
            decimals: number.split_once('.').map_or(0, |(_, decimals)| decimals.len()),
        });
        rest = &rest[start + number.len()..];
    }
    tokens.push(Token::Text(rest));
    tokens
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_last_digit_may_differ_and_nothing_else() {
        let agree = |one: &str, other: &str| differences(one, other).is_empty();
        assert!(agree("| 60.286 ± 0.006 |", "| 60.287 ± 0.005 |"));
        assert!(agree("−0.001 m/s", "0.000 m/s"));
        assert!(agree("M12.3 4.5L6.7", "M12.4 4.5L6.7"));
        assert!(!agree("60.286", "60.288"));
        assert!(!agree("60.29", "60.286"));
        assert!(!agree("0.287 arcsec", "0.287 ppm"));
        assert!(!agree("−17.5", "17.5"));
        assert!(!agree("one\ntwo", "one"));
    }

    #[test]
    fn a_difference_names_its_line() {
        let found = differences("same\n1.0\n", "same\n2.0\n");
        assert_eq!(found.len(), 1);
        assert_eq!(found[0].to_string(), "line 2: kept \"1.0\", now \"2.0\"");
    }
}
