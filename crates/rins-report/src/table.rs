//! Tables and matrices as HTML.

use super::content::{Cell, Column, Kind, Matrix, Table, Tone};
use super::escape::{each, html};
use crate::number::{estimate, fixed};

/// A coefficient below this is not worth the reader's eye.
const SLIGHT: f64 = 0.1;

/// More names than this are set small, their coefficients told by shade and on pointing alone.
const MANY: usize = 12;

/// The class by which the style sheet colours a tone.
pub(super) fn class(tone: Tone) -> &'static str {
    match tone {
        Tone::Neutral => "neutral",
        Tone::Good => "good",
        Tone::Warning => "warning",
        Tone::Bad => "bad",
    }
}

/// A table, in a box that scrolls sideways on a narrow screen.
pub(super) fn table(table: &Table) -> String {
    let n_columns = table.rows.iter().map(Vec::len).fold(table.columns.len(), usize::max);
    let unnamed = Column::text("");
    let columns: Vec<&Column> =
        (0..n_columns).map(|place| table.columns.get(place).unwrap_or(&unnamed)).collect();
    let head = each(&columns, |column| {
        let class = kind_class(column.kind, true);
        format!("<th scope=\"col\"{class}>{}</th>", html(&column.heading))
    });
    let widths: Vec<usize> = (0..n_columns).map(|place| sigma_width(table, place)).collect();
    let body = each(&table.rows, |row| {
        let cells = each(columns.iter().enumerate(), |(place, column)| {
            let shown = cell(row.get(place).unwrap_or(&Cell::Empty), widths[place]);
            format!("<td{}>{shown}</td>", kind_class(column.kind, false))
        });
        format!("<tr>{cells}</tr>\n")
    });
    sheet(
        "sheet",
        &table.caption,
        &format!("<thead><tr>{head}</tr></thead>\n<tbody>\n{body}</tbody>"),
    )
}

/// A matrix whose cells are shaded by the size of their coefficient.
pub(super) fn matrix(matrix: &Matrix) -> String {
    let many = matrix.labels.len() > MANY;
    let head = each(&matrix.labels, |label| {
        format!("<th scope=\"col\"><span>{}</span></th>", html(label))
    });
    let body = each(matrix.values.iter().enumerate(), |(row, values)| {
        let label = matrix.labels.get(row).map_or("", String::as_str);
        let cells =
            each(values.iter().enumerate(), |(column, v)| coefficient(*v, row == column, many));
        format!("<tr><th scope=\"row\">{}</th>{cells}</tr>\n", html(label))
    });
    let parts = format!("<thead><tr><td></td>{head}</tr></thead>\n<tbody>\n{body}</tbody>");
    sheet(if many { "sheet matrix many" } else { "sheet matrix" }, &matrix.caption, &parts)
}

fn sheet(class: &str, caption: &str, parts: &str) -> String {
    let caption = html(caption);
    format!(
        "<div class=\"{class}\"><div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"{caption}\">\
         <table>\n<caption>{caption}</caption>\n{parts}\n</table></div></div>\n"
    )
}

fn kind_class(kind: Kind, heading: bool) -> &'static str {
    match kind {
        Kind::Number => " class=\"number\"",
        Kind::Id if !heading => " class=\"id\"",
        Kind::Id | Kind::Text => "",
    }
}

/// The characters of the widest standard deviation of a column, so that its ± signs stand in line.
fn sigma_width(table: &Table, place: usize) -> usize {
    let sigmas = table.rows.iter().filter_map(|row| match row.get(place) {
        Some(Cell::Estimate { value, sigma }) => Some(estimate(*value, *sigma).1.chars().count()),
        _ => None,
    });
    sigmas.max().unwrap_or(0)
}

fn cell(cell: &Cell, sigma_width: usize) -> String {
    match cell {
        Cell::Empty => String::new(),
        Cell::Text(text) => html(text).into_owned(),
        Cell::Number { value, decimals } => fixed(*value, *decimals),
        Cell::Estimate { value, sigma } => {
            let (value, sigma) = estimate(*value, *sigma);
            format!(
                "{value}<span class=\"sign\">±</span>\
                 <span class=\"sigma\" style=\"min-width:{sigma_width}ch\">{sigma}</span>"
            )
        }
        Cell::Bar { value, sigma } => bar(*value, *sigma),
        Cell::Badge(tone, text) => {
            format!("<span class=\"badge {}\">{}</span>", class(*tone), html(text))
        }
    }
}

/// A bar from the middle to the value, and a line over its standard deviation.
fn bar(value: f64, sigma: f64) -> String {
    if !(value.is_finite() && sigma.is_finite()) {
        return String::new();
    }
    let place = |part: f64| 50.0 + 50.0 * part.clamp(-1.0, 1.0);
    let (from, to) = (place(value.min(0.0)), place(value.max(0.0)));
    let (least, most) = (place(value - sigma), place(value + sigma));
    format!(
        "<span class=\"bar\"><i style=\"left:{from:.1}%;width:{:.1}%\"></i>\
         <b style=\"left:{least:.1}%;width:{:.1}%\"></b></span>",
        to - from,
        most - least
    )
}

fn coefficient(value: f64, own: bool, many: bool) -> String {
    let shown = fixed((value * 100.0).round() / 100.0, 2);
    let (text, title) =
        if many { (String::new(), format!(" title=\"{shown}\"")) } else { (shown, String::new()) };
    if own {
        return format!("<td class=\"own\">{text}</td>");
    }
    let direction = if value < 0.0 { "down" } else { "up" };
    let slight = if value.abs() >= SLIGHT { "" } else { " slight" };
    let part = if value.is_finite() { value.abs().min(1.0) } else { 0.0 };
    format!("<td class=\"{direction}{slight}\" style=\"--part:{part:.2}\"{title}>{text}</td>")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn rows_of_any_length_make_a_rectangle() {
        let shown = table(&Table {
            caption: "Terms".into(),
            columns: vec![Column::id("id"), Column::number("arcsec")],
            rows: vec![
                vec![],
                vec![Cell::text("a"), Cell::Number { value: -1.5, decimals: 1 }, Cell::Empty],
            ],
        });
        assert_eq!(shown.matches("<th ").count(), 3);
        assert_eq!(shown.matches("<td").count(), 6);
        assert!(shown.contains("<td class=\"number\">−1.5</td>"), "{shown}");
    }

    #[test]
    fn plus_minus_signs_of_a_column_stand_in_line() {
        let estimates = [(1.0, 0.0123), (2.0, 0.5)];
        let shown = table(&Table {
            caption: String::new(),
            columns: vec![Column::number("ppm")],
            rows: estimates.map(|(value, sigma)| vec![Cell::Estimate { value, sigma }]).to_vec(),
        });
        assert_eq!(shown.matches("style=\"min-width:5ch\"").count(), 2, "{shown}");
    }

    #[test]
    fn bars_stay_in_their_cell() {
        assert!(bar(0.5, 0.1).contains("left:50.0%;width:25.0%"), "{}", bar(0.5, 0.1));
        assert!(bar(-7.0, 1.0).contains("left:0.0%;width:50.0%"), "{}", bar(-7.0, 1.0));
        assert!(bar(-7.0, 1.0).contains("left:0.0%;width:0.0%"), "{}", bar(-7.0, 1.0));
        assert_eq!(bar(f64::NAN, 1.0), "");
    }

    #[test]
    fn coefficients_of_a_large_matrix_are_told_on_pointing() {
        let labels: Vec<String> = (0..=MANY).map(|place| format!("p{place}")).collect();
        let values = vec![vec![-0.5; labels.len()]; labels.len()];
        let shown = matrix(&Matrix { caption: String::new(), labels, values });
        assert!(shown.contains("style=\"--part:0.50\" title=\"−0.50\"></td>"), "{shown}");
    }

    #[test]
    fn a_matrix_survives_what_is_no_correlation() {
        let shown = matrix(&Matrix {
            caption: "c".into(),
            labels: vec!["a".into()],
            values: vec![vec![1.0, f64::NAN], vec![-3.0, f64::INFINITY]],
        });
        assert!(shown.contains("class=\"up slight\" style=\"--part:0.00\">–<"), "{shown}");
        assert!(shown.contains("class=\"down\" style=\"--part:1.00\">−3.00<"), "{shown}");
    }
}
