//! Tables for a terminal and for a report page.

use rins_report::{Cell, Column, Table};

/// Columns as wide as their widest cell: the first and the last aligned left, the others right.
pub(crate) fn aligned(rows: &[Vec<String>]) -> String {
    let columns = rows.iter().map(Vec::len).max().unwrap_or_default();
    let widths: Vec<usize> = (0..columns)
        .map(|column| {
            rows.iter().filter_map(|row| row.get(column)).map(|cell| cell.chars().count()).max()
        })
        .map(Option::unwrap_or_default)
        .collect();
    let mut text = String::new();
    for row in rows {
        text.push_str("  ");
        for (column, cell) in row.iter().enumerate() {
            let pad = " ".repeat(widths[column] - cell.chars().count());
            // The first column contains names and the last one prose: both are aligned left.
            if column == 0 || column + 1 == columns {
                text.push_str(cell);
                text.push_str(if column + 1 == row.len() { "" } else { &pad });
            } else {
                text.push_str(&pad);
                text.push_str(cell);
            }
            text.push_str(if column + 1 == row.len() { "\n" } else { "  " });
        }
    }
    text
}

/// The same with a caption.
pub(crate) fn captioned(caption: &str, rows: &[Vec<String>]) -> Table {
    Table { caption: caption.into(), ..report_table(rows) }
}

/// The same rows as a table of a report page: the first row is the head, the first and the last column are text.
pub(crate) fn report_table(rows: &[Vec<String>]) -> Table {
    let mut rows = rows.iter();
    let head = rows.next().cloned().unwrap_or_default();
    let last = head.len().saturating_sub(1);
    let columns = head.into_iter().enumerate().map(|(place, name)| {
        if place == 0 || place == last { Column::text(name) } else { Column::number(name) }
    });
    Table {
        caption: String::new(),
        columns: columns.collect(),
        rows: rows.map(|row| row.iter().map(Cell::text).collect()).collect(),
    }
}
