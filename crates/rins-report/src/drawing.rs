//! A plot prepared for the page's script: curves with the same abscissa are grouped, thinned and rounded to visible digits.

use serde::Serialize;

use super::envelope::rows_to_draw;
use super::plot::{Plot, Scale, Style};

/// The number of colors in the style sheet; further curves repeat them.
const N_COLOURS: usize = 8;

/// The data for the script, and the omissions for the caption.
#[derive(Debug, Serialize)]
pub(super) struct Drawing<'a> {
    x_label: &'a str,
    y_label: &'a str,
    log_x: bool,
    log_y: bool,
    references: Vec<Line<'a>>,
    groups: Vec<Group<'a>>,
    /// The number of samples of the longest curve, if not all of them are drawn.
    #[serde(skip)]
    pub(super) thinned_from: Option<usize>,
    /// The number of samples that are omitted because their abscissa is not on the axis.
    #[serde(skip)]
    pub(super) n_misplaced: usize,
}

#[derive(Debug, Serialize)]
struct Line<'a> {
    name: &'a str,
    value: f64,
}

/// Curves with a common abscissa. A NaN is written as `null`.
#[derive(Debug, Serialize)]
struct Group<'a> {
    entries: Vec<Entry<'a>>,
    x: Vec<f64>,
    y: Vec<Vec<f64>>,
}

/// An entry of the legend: one column of its group, or two for a band.
#[derive(Debug, Serialize)]
struct Entry<'a> {
    name: &'a str,
    style: &'static str,
    colour: usize,
}

/// A group before thinning.
struct Given<'a> {
    x: &'a [f64],
    entries: Vec<Entry<'a>>,
    y: Vec<&'a [f64]>,
}

impl<'a> Drawing<'a> {
    /// The plot with at most about `n_points` drawn points of each curve.
    pub(super) fn new(plot: &'a Plot, n_points: usize) -> Self {
        let mut drawing = Self {
            x_label: &plot.x_label,
            y_label: &plot.y_label,
            log_x: plot.x_scale == Scale::Logarithmic,
            log_y: plot.y_scale == Scale::Logarithmic,
            references: Vec::new(),
            groups: Vec::new(),
            thinned_from: None,
            n_misplaced: 0,
        };
        let lines = plot.references.iter().filter(|line| line.value.is_finite());
        drawing.references = lines.map(|r| Line { name: &r.name, value: r.value }).collect();
        for given in groups(plot) {
            drawing.add(given, n_points);
        }
        drawing
    }

    /// Whether there is any sample to draw.
    pub(super) fn has_samples(&self) -> bool {
        self.groups.iter().flat_map(|group| &group.y).flatten().any(|y| y.is_finite())
    }

    /// The data as JSON.
    pub(super) fn to_json(&self) -> String {
        serde_json::to_string(self).expect("numbers and strings in structs always serialise")
    }

    fn add(&mut self, given: Given<'a>, n_points: usize) {
        let placed = |x: &f64| x.is_finite() && (!self.log_x || *x > 0.0);
        let mut rows: Vec<usize> =
            (0..given.x.len()).filter(|row| placed(&given.x[*row])).collect();
        self.n_misplaced = self.n_misplaced.max(given.x.len() - rows.len());
        rows.sort_by(|a, b| given.x[*a].total_cmp(&given.x[*b]));
        let x: Vec<f64> = rows.iter().map(|row| given.x[*row]).collect();
        let shown = |y: f64| y.is_finite() && (!self.log_y || y > 0.0);
        let gapped = |y: f64| if shown(y) { y } else { f64::NAN };
        let y: Vec<Vec<f64>> =
            given.y.iter().map(|y| rows.iter().map(|row| gapped(y[*row])).collect()).collect();

        let columns: Vec<&[f64]> = y.iter().map(Vec::as_slice).collect();
        let n_buckets = (n_points / (2 * columns.len())).max(n_points / 4).max(1);
        let position = if self.log_x { f64::ln } else { |x| x };
        let drawn = rows_to_draw(&x, &columns, n_buckets, position);
        if drawn.len() < x.len() {
            self.thinned_from = self.thinned_from.max(Some(x.len()));
        }
        let range = range_of(&y);
        self.groups.push(Group {
            entries: given.entries,
            x: rounded_abscissa(&drawn.iter().map(|row| x[*row]).collect::<Vec<_>>(), self.log_x),
            y: y.iter()
                .map(|y| drawn.iter().map(|row| rounded_ordinate(y[*row], range)).collect())
                .collect(),
        });
    }
}

/// Bands and curves grouped by their abscissae; bands first, so that they are behind the curves.
fn groups(plot: &Plot) -> Vec<Given<'_>> {
    let mut groups = Vec::new();
    for band in &plot.bands {
        let entry = Entry { name: &band.name, style: "band", colour: 0 };
        join(&mut groups, &band.x, &[&band.lower, &band.upper], entry);
    }
    for (place, series) in plot.series.iter().enumerate() {
        let style = match series.style {
            Style::Line => "line",
            Style::Dashed => "dashed",
            Style::Points => "points",
            Style::Steps => "steps",
        };
        let entry = Entry { name: &series.name, style, colour: place % N_COLOURS };
        join(&mut groups, &series.x, &[&series.y], entry);
    }
    groups
}

fn join<'a>(groups: &mut Vec<Given<'a>>, x: &'a [f64], y: &[&'a [f64]], entry: Entry<'a>) {
    let length = y.iter().map(|y| y.len()).fold(x.len(), usize::min);
    let x = &x[..length];
    let y = y.iter().map(|y| &y[..length]);
    match groups.iter_mut().find(|group| group.x == x) {
        Some(group) => {
            group.entries.push(entry);
            group.y.extend(y);
        }
        None => groups.push(Given { x, entries: vec![entry], y: y.collect() }),
    }
}

fn range_of(columns: &[Vec<f64>]) -> f64 {
    let finite = columns.iter().flatten().filter(|y| y.is_finite());
    let (least, greatest) = finite
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(least, most), y| (least.min(*y), most.max(*y)));
    (greatest - least).max(0.0)
}

/// An ordinate rounded to six digits, or to a hundred-thousandth of the plot's range if that is finer.
fn rounded_ordinate(y: f64, range: f64) -> f64 {
    let short = to_digits(y, 6);
    let visible = 1e-5 * range;
    if visible > 0.0 && (short - y).abs() > visible { to_step(y, visible) } else { short }
}

/// Abscissae rounded to a ten-millionth of their range (to seven digits on a logarithmic axis); their order is preserved.
fn rounded_abscissa(x: &[f64], logarithmic: bool) -> Vec<f64> {
    let range = x.last().zip(x.first()).map_or(0.0, |(last, first)| last - first);
    let step = 1e-7 * range;
    let round = |x: &f64| match step > 0.0 && step.is_finite() {
        _ if logarithmic => to_digits(*x, 7),
        true => to_step(*x, step),
        false => *x,
    };
    x.iter().map(round).collect()
}

/// The number rounded to this number of significant digits, so that its text is short.
fn to_digits(value: f64, digits: usize) -> f64 {
    format!("{value:.*e}", digits - 1).parse().unwrap_or(value)
}

/// The number rounded to the decimals of `step`.
fn to_step(value: f64, step: f64) -> f64 {
    let decimals = (-step.log10()).ceil().clamp(0.0, 300.0);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a whole number between 0 and 300"
    )]
    let decimals = decimals as usize;
    format!("{value:.decimals$}").parse().unwrap_or(value)
}

#[cfg(test)]
mod tests;
