//! Markup: text that came from a file made harmless in it, and in a script's data.

use std::borrow::Cow;

/// The text as HTML shows it, in an element or in a quoted attribute.
///
/// Control characters and those that reverse the direction of writing are shown as U+FFFD, since a file could
/// make one number look like another with them.
pub(super) fn html(text: &str) -> Cow<'_, str> {
    if !text.contains(|c| replacement(c).is_some()) {
        return Cow::Borrowed(text);
    }
    let mut escaped = String::with_capacity(text.len() + 16);
    for c in text.chars() {
        match replacement(c) {
            Some(shown) => escaped.push_str(shown),
            None => escaped.push(c),
        }
    }
    Cow::Owned(escaped)
}

fn replacement(c: char) -> Option<&'static str> {
    match c {
        '&' => Some("&amp;"),
        '<' => Some("&lt;"),
        '>' => Some("&gt;"),
        '"' => Some("&quot;"),
        '\'' => Some("&#39;"),
        '\t' | '\n' => None,
        '\u{2028}' | '\u{2029}' => Some("\u{FFFD}"),
        hidden if hidden.is_control() || reverses(hidden) => Some("\u{FFFD}"),
        _ => None,
    }
}

/// Whether the character changes the direction of writing.
fn reverses(c: char) -> bool {
    matches!(c, '\u{202A}'..='\u{202E}' | '\u{2066}'..='\u{2069}')
}

/// A JSON text that can stand in a `script` element: the same value, with no `<`, `>`, `&`, U+2028 or U+2029 in it.
///
/// In JSON those characters occur within strings only, where `\u` may stand for any character.
/// Those that reverse the direction of writing become U+FFFD, as in [`html`].
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

/// What each item becomes, one after the other.
pub(super) fn each<T>(
    items: impl IntoIterator<Item = T>,
    shown: impl FnMut(T) -> String,
) -> String {
    items.into_iter().map(shown).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn markup_becomes_text() {
        assert_eq!(
            html("<img src=x onerror='a(\"&\")'>"),
            "&lt;img src=x onerror=&#39;a(&quot;&amp;&quot;)&#39;&gt;"
        );
        assert!(matches!(html("±3σ of gyro.bias.x [deg/h]"), Cow::Borrowed(_)));
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
