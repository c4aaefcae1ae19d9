//! The text of a draft: keys that are known, guessed, or left to the user.

use std::fmt::Write as _;

/// A rig file drafted from a log, with the keys that the user must confirm or fill in.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Draft {
    /// The rig file, with comments.
    pub text: String,
    /// The keys whose values are guesses.
    pub guesses: Vec<Guess>,
    /// The keys that are comments, because their values cannot be determined.
    pub to_fill_in: Vec<ToFillIn>,
}

/// A key whose value is a guess.
#[derive(Clone, Debug, PartialEq)]
pub struct Guess {
    /// The key with its section, as in `log.gyro.unit`.
    pub key: String,
    /// The value, as TOML.
    pub value: String,
    /// The reason for this value.
    pub why: String,
}

/// A key that the user has to fill in.
#[derive(Clone, Debug, PartialEq)]
pub struct ToFillIn {
    /// The key with its section, as in `log.gyro.unit`.
    pub key: String,
    /// The expected value.
    pub expected: String,
}

/// A draft that is being written.
#[derive(Clone, Debug, Default)]
pub(super) struct Page {
    draft: Draft,
    section: &'static str,
}

impl Page {
    /// Opens the section `name`.
    pub(super) fn section(&mut self, name: &'static str) {
        self.section = name;
        let _ = write!(self.draft.text, "\n[{name}]\n");
    }

    /// Opens the section `name` as a comment, which the user uncomments together with its keys.
    pub(super) fn closed_section(&mut self, name: &'static str) {
        self.section = name;
        let _ = writeln!(self.draft.text, "# [{name}]  # to be uncommented with its keys");
    }

    pub(super) fn blank(&mut self) {
        self.draft.text.push('\n');
    }

    pub(super) fn remark(&mut self, text: &str) {
        let _ = writeln!(self.draft.text, "# {}", one_line(text));
    }

    /// A key whose value is known.
    pub(super) fn known(&mut self, key: &str, value: &str) {
        let _ = writeln!(self.draft.text, "{key} = {value}");
    }

    /// A key whose value is a guess.
    pub(super) fn guess(&mut self, key: &str, value: &str, why: &str) {
        let why = one_line(why);
        let _ = writeln!(self.draft.text, "{key} = {value}  # GUESS: {why}; confirm");
        let key = format!("{}.{key}", self.section);
        self.draft.guesses.push(Guess { key, value: value.into(), why });
    }

    /// A key that only the user knows. `form` is a placeholder that the reader refuses, so that the mark cannot be removed
    /// without writing a value.
    pub(super) fn leave(&mut self, key: &str, form: &str, expected: &str) {
        let expected = one_line(expected);
        let _ = writeln!(self.draft.text, "# {key} = {form}  # TO FILL IN: {expected}");
        let key = format!("{}.{key}", self.section);
        self.draft.to_fill_in.push(ToFillIn { key, expected });
    }

    /// A key that the user may add.
    pub(super) fn optional(&mut self, key: &str, form: &str, meaning: &str) {
        let _ = writeln!(self.draft.text, "# {key} = {form}  # optional: {}", one_line(meaning));
    }

    pub(super) fn finish(self) -> Draft {
        self.draft
    }
}

/// A text as a TOML string.
pub(super) fn text(value: &str) -> String {
    toml::Value::from(value).to_string()
}

/// Texts as a TOML list.
pub(super) fn list<'t>(values: impl IntoIterator<Item = &'t str>) -> String {
    let values: Vec<String> = values.into_iter().map(text).collect();
    format!("[{}]", values.join(", "))
}

/// A number with four significant digits.
pub(super) fn short(value: f64) -> String {
    let digits = format!("{value:.3e}");
    let Ok(rounded) = digits.parse::<f64>() else { return digits };
    if rounded == 0.0 || (1e-3..1e6).contains(&rounded.abs()) {
        rounded.to_string()
    } else {
        digits
    }
}

/// A text from the log as one line, without characters that TOML does not allow in a comment.
fn one_line(text: &str) -> String {
    text.chars().map(|letter| if letter.is_control() { ' ' } else { letter }).collect()
}

#[cfg(test)]
mod tests {
    use super::{Page, short, text};

    #[test]
    fn four_digits_are_kept() {
        assert_eq!(short(9.806_65), "9.807");
        assert_eq!(short(0.02), "0.02");
        assert_eq!(short(33108.0), "33110");
        assert_eq!(short(7.292e-5), "7.292e-5");
        assert_eq!(short(f64::NAN), "NaN");
    }

    #[test]
    fn a_page_is_toml_whatever_the_log_says() {
        let mut page = Page::default();
        page.section("log");
        page.guess("path", &text("a\"b\u{7}\n.csv"), "it is called a\u{7}\nb");
        page.remark("x\ry");
        let text = page.finish().text;
        let table: toml::Table = text.parse().unwrap();
        assert_eq!(table["log"]["path"].as_str(), Some("a\"b\u{7}\n.csv"));
    }
}
