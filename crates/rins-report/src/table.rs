//! Tables and matrices as HTML.

use maud::{Markup, html};

use super::content::{Cell, Column, Kind, Matrix, Table, Tone};
use super::escape::{LINE, Shown};
use crate::number::{estimate, fixed};

/// The magnitude below which a coefficient is not emphasized.
const SLIGHT: f64 = 0.1;

/// The number of names above which they are set small, and coefficients are given by shade and tooltip only.
const MANY: usize = 12;

/// The class of a tone in the style sheet.
pub(super) fn class(tone: Tone) -> &'static str {
    match tone {
        Tone::Neutral => "neutral",
        Tone::Good => "good",
        Tone::Warning => "warning",
        Tone::Bad => "bad",
    }
}

/// A table, in a box that scrolls horizontally on a narrow screen.
pub(super) fn table(table: &Table) -> Markup {
    let n_columns = table.rows.iter().map(Vec::len).fold(table.columns.len(), usize::max);
    let unnamed = Column::text("");
    let columns: Vec<&Column> =
        (0..n_columns).map(|place| table.columns.get(place).unwrap_or(&unnamed)).collect();
    let widths: Vec<usize> = (0..n_columns).map(|place| sigma_width(table, place)).collect();
    let parts = html! {
        thead {
            tr {
                @for column in &columns {
                    th scope="col" class=[kind_class(column.kind, true)] { (Shown(&column.heading)) }
                }
            }
        } (LINE)
        tbody { (LINE)
            @for row in &table.rows {
                tr {
                    @for (place, column) in columns.iter().enumerate() {
                        td class=[kind_class(column.kind, false)] {
                            (cell(row.get(place).unwrap_or(&Cell::Empty), widths[place]))
                        }
                    }
                } (LINE)
            }
        }
    };
    sheet("sheet", &table.caption, &parts)
}

/// A matrix whose cells are shaded by the magnitude of their coefficient.
pub(super) fn matrix(matrix: &Matrix) -> Markup {
    let many = matrix.labels.len() > MANY;
    let parts = html! {
        thead {
            tr {
                td {}
                @for label in &matrix.labels { th scope="col" { span { (Shown(label)) } } }
            }
        } (LINE)
        tbody { (LINE)
            @for (row, values) in matrix.values.iter().enumerate() {
                tr {
                    th scope="row" { (Shown(matrix.labels.get(row).map_or("", String::as_str))) }
                    @for (column, value) in values.iter().enumerate() {
                        (coefficient(*value, row == column, many))
                    }
                } (LINE)
            }
        }
    };
    sheet(if many { "sheet matrix many" } else { "sheet matrix" }, &matrix.caption, &parts)
}

fn sheet(class: &str, caption: &str, parts: &Markup) -> Markup {
    let caption = Shown(caption);
    html! {
        div class=(class) {
            div class="scroll" tabindex="0" role="region" aria-label=(caption) {
                table { (LINE) caption { (caption) } (LINE) (parts) (LINE) }
            }
        } (LINE)
    }
}

fn kind_class(kind: Kind, heading: bool) -> Option<&'static str> {
    match kind {
        Kind::Number => Some("number"),
        Kind::Id if !heading => Some("id"),
        Kind::Id | Kind::Text => None,
    }
}

/// The number of characters of the widest standard deviation of a column, for the alignment of its ± signs.
fn sigma_width(table: &Table, place: usize) -> usize {
    let sigmas = table.rows.iter().filter_map(|row| match row.get(place) {
        Some(Cell::Estimate { value, sigma }) => Some(estimate(*value, *sigma).1.chars().count()),
        _ => None,
    });
    sigmas.max().unwrap_or(0)
}

fn cell(cell: &Cell, sigma_width: usize) -> Markup {
    match cell {
        Cell::Empty => Markup::default(),
        Cell::Text(text) => html! { (Shown(text)) },
        Cell::Number { value, decimals } => html! { (fixed(*value, *decimals)) },
        Cell::Estimate { value, sigma } => {
            let (value, sigma) = estimate(*value, *sigma);
            html! {
                (value) span class="sign" { "±" }
                span class="sigma" style={ "min-width:" (sigma_width) "ch" } { (sigma) }
            }
        }
        Cell::Bar { value, sigma } => bar(*value, *sigma),
        Cell::Badge(tone, text) => html! { span.badge.(class(*tone)) { (Shown(text)) } },
    }
}

/// A bar from the center to the value, and a line over its standard deviation.
fn bar(value: f64, sigma: f64) -> Markup {
    if !(value.is_finite() && sigma.is_finite()) {
        return Markup::default();
    }
    let place = |part: f64| 50.0 + 50.0 * part.clamp(-1.0, 1.0);
    let span = |from: f64, to: f64| format!("left:{from:.1}%;width:{:.1}%", to - from);
    html! {
        span class="bar" {
            i style=(span(place(value.min(0.0)), place(value.max(0.0)))) {}
            b style=(span(place(value - sigma), place(value + sigma))) {}
        }
    }
}

fn coefficient(value: f64, own: bool, many: bool) -> Markup {
    let shown = fixed((value * 100.0).round() / 100.0, 2);
    let (text, title) = if many { ("", Some(&shown)) } else { (shown.as_str(), None) };
    if own {
        return html! { td class="own" { (text) } };
    }
    let direction = if value < 0.0 { "down" } else { "up" };
    // NaN is not a strong correlation either.
    let is_slight = value.is_nan() || value.abs() < SLIGHT;
    let part = if value.is_finite() { value.abs().min(1.0) } else { 0.0 };
    html! {
        td.(direction).slight[is_slight] style={ "--part:" (format!("{part:.2}")) } title=[title] {
            (text)
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table(content: &Table) -> String {
        super::table(content).into_string()
    }

    fn matrix(content: &Matrix) -> String {
        super::matrix(content).into_string()
    }

    fn bar(value: f64, sigma: f64) -> String {
        super::bar(value, sigma).into_string()
    }

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
