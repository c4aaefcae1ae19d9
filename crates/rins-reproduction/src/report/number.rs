//! Numbers and tables in the format of the page.

use std::fmt::Write;

/// A number with this number of decimals and a minus sign (U+2212); zero has no sign.
pub(super) fn fixed(number: f64, decimals: usize) -> String {
    let text = format!("{number:.decimals$}");
    match text.strip_prefix('-') {
        Some(size) if size.bytes().all(|byte| matches!(byte, b'0' | b'.')) => size.into(),
        Some(size) => format!("−{size}"),
        None => text,
    }
}

/// The same with a plus sign for positive numbers.
pub(super) fn signed(number: f64, decimals: usize) -> String {
    let text = fixed(number, decimals);
    if number > 0.0 && text.bytes().any(|byte| (b'1'..=b'9').contains(&byte)) {
        format!("+{text}")
    } else {
        text
    }
}

/// A number with this number of significant digits, however large.
pub(super) fn significant(number: f64, digits: i32) -> String {
    if number == 0.0 || !number.is_finite() {
        return fixed(number, 0);
    }
    #[expect(clippy::cast_possible_truncation, reason = "the exponent of a double")]
    let exponent = number.abs().log10().floor() as i32;
    let decimals = usize::try_from(digits - 1 - exponent).unwrap_or(0);
    fixed(number, decimals)
}

/// A number with its unit, without a line break between them.
pub(super) fn with_unit(number: &str, unit: &str) -> String {
    format!("{number}\u{a0}{unit}")
}

/// `mean ± deviation` with this number of decimals.
pub(super) fn spread(sample: &crate::statistics::Sample, decimals: usize) -> String {
    [fixed(sample.mean, decimals), fixed(sample.deviation, decimals)].join("\u{a0}±\u{a0}")
}

/// Numbers with this number of decimals, in brackets.
pub(super) fn tuple(numbers: &[f64], decimals: usize) -> String {
    let numbers: Vec<String> = numbers.iter().map(|number| fixed(*number, decimals)).collect();
    format!("({})", numbers.join(", "))
}

/// A table in Markdown; a column whose title ends with `>` is aligned right.
#[derive(Debug)]
pub(super) struct Table {
    text: String,
    columns: usize,
}

impl Table {
    pub(super) fn new(titles: &[&str]) -> Self {
        let shown: Vec<&str> = titles.iter().map(|title| title.trim_end_matches('>')).collect();
        let rules: Vec<&str> =
            titles.iter().map(|title| if title.ends_with('>') { "--:" } else { "---" }).collect();
        let text = format!("| {} |\n| {} |\n", shown.join(" | "), rules.join(" | "));
        Self { text, columns: titles.len() }
    }

    /// Adds a row.
    ///
    /// # Panics
    /// If its number of cells differs from the number of titles of the table.
    pub(super) fn row<S: AsRef<str>>(&mut self, cells: &[S]) {
        assert_eq!(cells.len(), self.columns, "a row of {:?}", cells[0].as_ref());
        let cells: Vec<&str> = cells.iter().map(AsRef::as_ref).collect();
        // Writing to a string cannot fail.
        let _ = writeln!(self.text, "| {} |", cells.join(" | "));
    }

    pub(super) fn finish(self) -> String {
        self.text + "\n"
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_their_digits_and_signs() {
        assert_eq!(fixed(-1.25, 1), "−1.2");
        assert_eq!(fixed(-0.001, 2), "0.00");
        assert_eq!(signed(0.5, 2), "+0.50");
        assert_eq!(signed(1e-9, 2), "0.00");
        assert_eq!(significant(-1234.5, 2), "−1234");
        assert_eq!(significant(0.012345, 3), "0.0123");
        assert_eq!(tuple(&[1.0, -2.0], 1), "(1.0, −2.0)");
    }

    #[test]
    fn tables_are_markdown() {
        let mut table = Table::new(&["a", "b>"]);
        table.row(&["x", "1"]);
        assert_eq!(table.finish(), "| a | b |\n| --- | --: |\n| x | 1 |\n\n");
    }
}
