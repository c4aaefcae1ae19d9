//! Escaping of text from files for the page and for a script's data.

use std::borrow::Cow;

use maud::{Escaper, Markup, PreEscaped, Render};

/// Text for an element or a quoted attribute of the page: markup in it is displayed as text.
///
/// Control characters and those that reverse the direction of writing become U+FFFD, because a file could
/// make one number look like another with them.
pub(super) struct Shown<'a>(pub(super) &'a str);

impl Render for Shown<'_> {
    fn render_to(&self, buffer: &mut String) {
        use std::fmt::Write as _;
        // Writing to a string cannot fail.
        let _ = Escaper::new(buffer).write_str(&visible(self.0));
    }
}

/// A line end, so that a page can be compared line by line.
pub(super) const LINE: PreEscaped<&str> = PreEscaped("\n");

/// Markup that this crate has generated, unchanged.
pub(super) fn made(text: String) -> Markup {
    PreEscaped(text)
}

fn visible(text: &str) -> Cow<'_, str> {
    if !text.contains(is_hidden) {
        return Cow::Borrowed(text);
    }
    Cow::Owned(text.chars().map(|c| if is_hidden(c) { '\u{FFFD}' } else { c }).collect())
}

fn is_hidden(c: char) -> bool {
    match c {
        '\t' | '\n' => false,
        '\u{2028}' | '\u{2029}' => true,
        c => c.is_control() || reverses(c),
    }
}

/// Whether the character changes the direction of writing.
fn reverses(c: char) -> bool {
    matches!(c, '\u{202A}'..='\u{202E}' | '\u{2066}'..='\u{2069}')
}

/// JSON text for a `script` element: the same value, without `<`, `>`, `&`, U+2028 and U+2029.
///
/// In JSON these characters occur only in strings, where `\u` can encode any character.
/// Those that reverse the direction of writing become U+FFFD, as in [`Shown`].
pub(super) fn json_in_script(json: &str) -> String {
    let mut escaped = String::with_capacity(json.len());
    for c in json.chars() {
        match c {
            '<' => escaped.push_str("\\u003c"),
            '>' => escaped.push_str("\\u003e"),
            '&' => escaped.push_str("\\u0026"),
            '\u{2028}' => escaped.push_str("\\u2028"),
            '\u{2029}' => escaped.push_str("\\u2029"),
            _ if reverses(c) => escaped.push('\u{FFFD}'),
            _ => escaped.push(c),
        }
    }
    escaped
}

#[cfg(test)]
mod tests {
    use super::*;

    fn html(text: &str) -> String {
        Shown(text).render().into_string()
    }

    #[test]
    fn markup_becomes_text() {
        assert_eq!(
            html("<img src=x onerror='a(\"&\")'>"),
            "&lt;img src=x onerror='a(&quot;&amp;&quot;)'&gt;"
        );
        assert!(matches!(visible("±3σ of gyro.bias.x [deg/h]"), Cow::Borrowed(_)));
    }

    #[test]
    fn numbers_cannot_be_reversed_or_hidden() {
        assert_eq!(html("1\u{202E}23\u{0}\u{1b}[8m"), "1\u{FFFD}23\u{FFFD}\u{FFFD}[8m");
        assert_eq!(html("a\nb\tc"), "a\nb\tc");
    }

    #[test]
    fn json_keeps_its_value_and_cannot_end_its_script() {
        let hostile = "</script><!--<script>&\u{2028}\u{2029}\\\"";
        let json = serde_json::to_string(hostile).unwrap();
        let escaped = json_in_script(&json);
        assert!(!escaped.contains(['<', '>', '&', '\u{2028}', '\u{2029}']), "{escaped}");
        assert_eq!(serde_json::from_str::<String>(&escaped).unwrap(), hostile);
    }
}
