//! The fields of a line, whose delimiter is determined from the first lines.

use std::borrow::Cow;

use crate::rig::Decimal;

/// The delimiter between two fields.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Delimiter {
    /// A tab.
    Tab,
    /// A semicolon.
    Semicolon,
    /// A comma.
    Comma,
    /// Any number of blanks.
    Blanks,
    /// Another character, stated by a line `sep=`.
    Other(char),
}

impl Delimiter {
    /// The delimiter that divides the first lines into the same number of fields, at least two.
    ///
    /// If several do, the first of tab, semicolon, comma and blanks is used: blanks may
    /// surround a comma, and a comma may be the decimal mark of a number between semicolons.
    pub(super) fn sniff(first: &str, second: Option<&str>, decimal: Decimal) -> Self {
        let all = match decimal {
            Decimal::Point => [Self::Tab, Self::Semicolon, Self::Comma, Self::Blanks],
            // A comma then divides fields in quotation marks only.
            Decimal::Comma => [Self::Tab, Self::Semicolon, Self::Blanks, Self::Comma],
        };
        let fields = |line| all.map(|delimiter| Fields::of(line, delimiter).count());
        let (first, second) = (fields(first), second.map(fields));
        let agree = |&index: &usize| {
            first[index] > 1 && second.is_none_or(|second| second[index] == first[index])
        };
        let several = |&index: &usize| first[index] > 1;
        let chosen = (0..4).find(agree).or_else(|| (0..4).find(several));
        chosen.map_or(Self::Comma, |index| all[index])
    }

    /// The delimiter that a first line such as `sep=;` states, as written by spreadsheets.
    pub(super) fn stated(line: &str) -> Option<Self> {
        let line = line.trim_matches(['"', '\r']);
        let rest = line.get(..4).filter(|start| start.eq_ignore_ascii_case("sep="));
        let mut letters = line[rest?.len()..].chars();
        let delimiter = match letters.next()? {
            '\t' => Self::Tab,
            ';' => Self::Semicolon,
            ',' => Self::Comma,
            ' ' => Self::Blanks,
            other if other.is_alphanumeric() || "+-.\"".contains(other) => return None,
            other => Self::Other(other),
        };
        letters.next().is_none().then_some(delimiter)
    }

    /// The text before the first delimiter and, if there is one, the text after it.
    fn cut(self, text: &str) -> (&str, Option<&str>) {
        match text.split_once(|letter| self.divides(letter)) {
            Some((field, rest)) => (field, Some(rest)),
            None => (text, None),
        }
    }

    fn divides(self, letter: char) -> bool {
        match self {
            Self::Tab => letter == '\t',
            Self::Semicolon => letter == ';',
            Self::Comma => letter == ',',
            Self::Blanks => letter.is_whitespace(),
            Self::Other(other) => letter == other,
        }
    }
}

/// The fields of a line, without the blanks and quotation marks around them; a doubled quotation mark inside
/// stands for one (RFC 4180).
#[derive(Clone, Debug)]
pub(crate) struct Fields<'l> {
    rest: Option<&'l str>,
    delimiter: Delimiter,
    open_quote: bool,
}

impl<'l> Fields<'l> {
    pub(crate) fn of(line: &'l str, delimiter: Delimiter) -> Self {
        Self { rest: Some(line), delimiter, open_quote: false }
    }

    /// Whether a quotation mark was not closed.
    pub(super) fn has_open_quote(&self) -> bool {
        self.open_quote
    }
}

impl<'l> Iterator for Fields<'l> {
    type Item = Cow<'l, str>;

    fn next(&mut self) -> Option<Cow<'l, str>> {
        let rest = self.rest?;
        let blanks = self.delimiter == Delimiter::Blanks;
        if blanks && rest.trim_start().is_empty() {
            self.rest = None;
            return None;
        }
        let start = if self.delimiter == Delimiter::Tab {
            rest.trim_start_matches(' ')
        } else {
            rest.trim_start()
        };
        if let Some(quoted) = start.strip_prefix('"') {
            let end = closing_quote(quoted);
            self.open_quote |= end.is_none();
            let (inside, after) = quoted.split_at(end.unwrap_or(quoted.len()));
            self.rest = self.delimiter.cut(after).1;
            return Some(undoubled(inside));
        }
        let (field, rest) = self.delimiter.cut(if blanks { start } else { rest });
        self.rest = rest;
        Some(Cow::Borrowed(field.trim()))
    }
}

fn undoubled(inside: &str) -> Cow<'_, str> {
    if inside.contains('"') {
        Cow::Owned(inside.replace("\"\"", "\""))
    } else {
        Cow::Borrowed(inside)
    }
}

/// The position of the quotation mark that closes a field; a doubled one stands for itself.
fn closing_quote(quoted: &str) -> Option<usize> {
    let mut from = 0;
    while let Some(place) = quoted[from..].find('"').map(|place| from + place) {
        if !quoted[place + 1..].starts_with('"') {
            return Some(place);
        }
        from = place + 2;
    }
    None
}

#[cfg(test)]
mod tests {
    use super::{Decimal, Delimiter, Fields};
    use proptest::prelude::*;

    #[test]
    fn delimiters_are_found() {
        let cases = [
            ("t,gx,gy", "0.1,2,3", Delimiter::Comma),
            ("t, gx, gy", "0.1, 2, 3", Delimiter::Comma),
            ("t;gx", "0,1;2,5", Delimiter::Semicolon),
            ("Time (s)\tGyro X (deg/s)", "0.1\t2", Delimiter::Tab),
            ("Time (s),Gyro X (deg/s)", "0.1,2", Delimiter::Comma),
            ("  t  gx", "0.1 2", Delimiter::Blanks),
            ("0.1   2.5", "0.2 2.5", Delimiter::Blanks),
            ("\"t, s\";\"x\"", "1;2", Delimiter::Semicolon),
        ];
        for (first, second, delimiter) in cases {
            assert_eq!(Delimiter::sniff(first, Some(second), Decimal::Point), delimiter, "{first}");
        }
    }

    #[test]
    fn a_decimal_comma_divides_no_fields() {
        let cases = [
            ("0,1 2,5 3,5", "0,2 2,5 3,5", Delimiter::Blanks),
            ("0,1\t2,5", "0,2\t2,5", Delimiter::Tab),
            ("t,gx", "\"0,1\",\"2,5\"", Delimiter::Comma),
        ];
        for (first, second, delimiter) in cases {
            let found = Delimiter::sniff(first, Some(second), Decimal::Comma);
            assert_eq!(found, delimiter, "{first}");
        }
    }

    #[test]
    fn quotation_marks_and_blanks_are_taken_off() {
        let fields = |line, delimiter| Fields::of(line, delimiter).collect::<Vec<_>>();
        assert_eq!(fields(r#" "a, b" ,c , "" "#, Delimiter::Comma), ["a, b", "c", ""]);
        assert_eq!(fields(r#""gyro ""x""","a""#, Delimiter::Comma), ["gyro \"x\"", "a"]);
        assert_eq!(fields("1,,3,", Delimiter::Comma), ["1", "", "3", ""]);
        assert_eq!(fields(" 1 2\t 3  ", Delimiter::Blanks), ["1", "2", "3"]);
        assert_eq!(fields("a\t\tb", Delimiter::Tab), ["a", "", "b"]);
        // A blank character of three bytes.
        assert_eq!(fields("\"a\"\u{3000}b", Delimiter::Blanks), ["a", "b"]);
    }

    proptest! {
        #[test]
        fn fields_joined_by_a_comma_come_apart_again(
            given in prop::collection::vec("[a-z0-9.+-]{0,6}", 1..9)
        ) {
            let line = given.join(",");
            let fields: Vec<_> = Fields::of(&line, Delimiter::Comma).collect();
            prop_assert_eq!(fields, given);
        }

        #[test]
        fn any_line_comes_to_an_end(line in "\\PC{0,60}|[\",; \t\u{3000}a]{0,40}") {
            for delimiter in
                [Delimiter::Tab, Delimiter::Semicolon, Delimiter::Comma, Delimiter::Blanks]
            {
                prop_assert!(Fields::of(&line, delimiter).count() <= line.len() + 1);
            }
        }
    }
}
