//! Texts of others, such as paths, within a line of ours.

use std::path::Path;

/// A text in which nothing moves the cursor of a terminal or begins a line: control characters are escaped.
pub(crate) fn one_line(text: &str) -> String {
    let mut line = String::with_capacity(text.len());
    for letter in text.chars() {
        if letter.is_control() {
            line.extend(letter.escape_default());
        } else {
            line.push(letter);
        }
    }
    line
}

/// A path as it is shown.
pub(crate) fn shown(path: &Path) -> String {
    one_line(&path.display().to_string())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn nothing_in_a_path_moves_the_cursor() {
        let path = Path::new("\u{1b}[31mred\nrins: ok\u{9b}2J.csv");
        assert_eq!(shown(path), "\\u{1b}[31mred\\nrins: ok\\u{9b}2J.csv");
        assert_eq!(one_line("Länge 5 µg ± 2"), "Länge 5 µg ± 2");
    }
}
