//! External texts, such as paths, as one line of output.

use std::fmt::Write as _;
use std::path::Path;

/// A text with escaped control characters, so that it neither moves the cursor of a terminal nor begins a new line.
#[must_use]
pub fn one_line(text: &str) -> String {
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

/// A path in one line; bytes that are not UTF-8 are escaped, as in `a\\xff.csv`.
#[must_use]
pub fn shown(path: &Path) -> String {
    let mut line = String::new();
    for chunk in path.as_os_str().as_encoded_bytes().utf8_chunks() {
        line.push_str(&one_line(chunk.valid()));
        for byte in chunk.invalid() {
            // Writing to a string cannot fail.
            let _ = write!(line, "\\x{byte:02x}");
        }
    }
    line
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

    #[cfg(unix)]
    #[test]
    fn bytes_that_are_no_text_are_told_apart() {
        use std::ffi::OsStr;
        use std::os::unix::ffi::OsStrExt;

        let path = |bytes: &[u8]| shown(Path::new(OsStr::from_bytes(bytes)));
        assert_eq!(path(b"a\xff.csv"), "a\\xff.csv");
        assert_eq!(path(b"a\xfe.csv"), "a\\xfe.csv");
        assert_eq!(path("Länge".as_bytes()), "Länge");
    }
}
