//! Line charts as SVG: panels side by side, with axes, units and a legend, legible in light and dark mode.

use std::fmt::Write;

const PANEL_WIDTH: f64 = 270.0;
const PANEL_HEIGHT: f64 = 200.0;
const LEFT: f64 = 62.0;
const RIGHT: f64 = 14.0;
const TOP: f64 = 34.0;
const BOTTOM: f64 = 44.0;
const LEGEND: f64 = 22.0;

const STYLE: &str = "
svg { background: #ffffff; font: 12px sans-serif; }
text { fill: #24292f; }
.frame { fill: none; stroke: #57606a; }
.grid { stroke: #d8dee4; }
.line { fill: none; stroke-width: 1.6; }
.thin { fill: none; stroke-width: 0.7; opacity: 0.6; }
.dash { fill: none; stroke-width: 1.6; stroke-dasharray: 6 4; }
.s0 { stroke: #0969da; color: #0969da; }
.s1 { stroke: #bc4c00; color: #bc4c00; }
.s2 { stroke: #1a7f37; color: #1a7f37; }
.s3 { stroke: #24292f; color: #24292f; }
.dot { fill: currentColor; stroke: none; opacity: 0.55; }
.cross { stroke-width: 2.2; fill: none; }
@media (prefers-color-scheme: dark) {
svg { background: #161b22; }
text { fill: #e6edf3; }
.frame { stroke: #8d96a0; }
.grid { stroke: #30363d; }
.s0 { stroke: #58a6ff; color: #58a6ff; }
.s1 { stroke: #ff9b50; color: #ff9b50; }
.s2 { stroke: #56d364; color: #56d364; }
.s3 { stroke: #e6edf3; color: #e6edf3; }
}
";

/// The style of a series.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Mark {
    Line,
    Thin,
    Dash,
    Dots,
    Cross,
}

/// A series of points.
#[derive(Clone, Debug)]
pub(super) struct Series {
    /// Its name in the legend; a series without a name is not in the legend.
    pub(super) label: Option<&'static str>,
    pub(super) mark: Mark,
    /// The index of its color, from 0 to 3.
    pub(super) colour: usize,
    pub(super) points: Vec<(f64, f64)>,
}

/// The mapping of values to positions along an axis.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Scale {
    Linear,
    Logarithmic,
}

#[derive(Clone, Debug)]
pub(super) struct Axis {
    /// The quantity with its unit.
    pub(super) label: String,
    pub(super) scale: Scale,
    pub(super) from: f64,
    pub(super) to: f64,
}

impl Axis {
    pub(super) fn new(label: &str, scale: Scale, (from, to): (f64, f64)) -> Self {
        Self { label: label.into(), scale, from, to }
    }

    /// The position of `value`, from 0 at the start to 1 at the end.
    fn place(&self, value: f64) -> f64 {
        match self.scale {
            Scale::Linear => (value - self.from) / (self.to - self.from),
            Scale::Logarithmic => (value / self.from).ln() / (self.to / self.from).ln(),
        }
    }

    /// The values of the tick marks, with their labels.
    fn ticks(&self) -> Vec<(f64, String)> {
        match self.scale {
            Scale::Linear => {
                let step = round_step((self.to - self.from) / 5.0);
                let decimals = decimals_of(step);
                let first = (self.from / step - 1e-9).ceil();
                std::iter::successors(Some(first), |count| Some(count + 1.0))
                    .map(|count| count * step)
                    .take_while(|value| *value <= self.to + 1e-9 * step)
                    .map(|value| (value, super::number::fixed(value, decimals)))
                    .collect()
            }
            Scale::Logarithmic => {
                let first = (self.from.log10() - 1e-9).ceil();
                std::iter::successors(Some(first), |exponent| Some(exponent + 1.0))
                    .map(|exponent| (10_f64.powf(exponent), exponent))
                    .take_while(|(value, _)| *value <= self.to * (1.0 + 1e-9))
                    .map(|(value, exponent)| {
                        (value, super::number::fixed(value, decimals_of(10_f64.powf(exponent))))
                    })
                    .collect()
            }
        }
    }
}

/// The next of 1, 2, 5, 10, … that is not below `step`.
fn round_step(step: f64) -> f64 {
    let power = 10_f64.powf(step.log10().floor());
    let rounds = [1.0, 2.0, 5.0, 10.0].map(|factor| factor * power);
    rounds.into_iter().find(|round| *round >= step * (1.0 - 1e-9)).unwrap_or(10.0 * power)
}

fn decimals_of(step: f64) -> usize {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a small count that is not negative"
    )]
    let decimals = (-(step * (1.0 + 1e-9)).log10().floor()).max(0.0) as usize;
    decimals
}

#[derive(Clone, Debug)]
pub(super) struct Panel {
    pub(super) title: &'static str,
    pub(super) x: Axis,
    pub(super) y: Axis,
    pub(super) series: Vec<Series>,
}

/// The panels in a row, as an SVG file; `description` is the text for screen readers.
pub(super) fn svg(description: &str, panels: &[Panel]) -> String {
    let width = LEFT.mul_add(panels.len() as f64, (PANEL_WIDTH + RIGHT) * panels.len() as f64);
    let height = TOP + PANEL_HEIGHT + BOTTOM + LEGEND;
    let mut out = String::new();
    // Writing to a string cannot fail.
    let _ = writeln!(
        out,
        "<svg xmlns=\"http://www.w3.org/2000/svg\" viewBox=\"0 0 {width:.0} {height:.0}\" \
         width=\"{width:.0}\" height=\"{height:.0}\" role=\"img\">\n<title>{description}</title>\n\
         <style>{STYLE}</style>",
    );
    for (place, panel) in panels.iter().enumerate() {
        let left = (LEFT + PANEL_WIDTH + RIGHT) * place as f64 + LEFT;
        draw(&mut out, panel, left);
    }
    legend(&mut out, panels, TOP + PANEL_HEIGHT + BOTTOM + 8.0);
    out + "</svg>\n"
}

fn draw(out: &mut String, panel: &Panel, left: f64) {
    let Panel { title, x, y, series } = panel;
    let bottom = TOP + PANEL_HEIGHT;
    let across = |value: f64| left + PANEL_WIDTH * x.place(value);
    let up = |value: f64| bottom - PANEL_HEIGHT * y.place(value);
    let middle = left + 0.5 * PANEL_WIDTH;
    let _ = writeln!(
        out,
        "<text x=\"{middle:.0}\" y=\"{:.0}\" text-anchor=\"middle\" font-weight=\"bold\">{title}</text>",
        TOP - 12.0,
    );
    for (value, name) in x.ticks() {
        let at = across(value);
        let _ = writeln!(
            out,
            "<path class=\"grid\" d=\"M{at:.1} {TOP}V{bottom}\"/>\
             <text x=\"{at:.1}\" y=\"{:.0}\" text-anchor=\"middle\">{name}</text>",
            bottom + 16.0,
        );
    }
    for (value, name) in y.ticks() {
        let at = up(value);
        let _ = writeln!(
            out,
            "<path class=\"grid\" d=\"M{left} {at:.1}H{:.0}\"/>\
             <text x=\"{:.0}\" y=\"{:.1}\" text-anchor=\"end\">{name}</text>",
            left + PANEL_WIDTH,
            left - 6.0,
            at + 4.0,
        );
    }
    let _ = writeln!(
        out,
        "<text x=\"{middle:.0}\" y=\"{:.0}\" text-anchor=\"middle\">{}</text>\n\
         <text transform=\"translate({:.0} {:.0}) rotate(-90)\" text-anchor=\"middle\">{}</text>",
        bottom + 34.0,
        x.label,
        left - 48.0,
        TOP + 0.5 * PANEL_HEIGHT,
        y.label,
    );
    let _ = writeln!(
        out,
        "<clipPath id=\"c{left:.0}\"><rect x=\"{left:.0}\" y=\"{TOP}\" width=\"{PANEL_WIDTH}\" \
         height=\"{PANEL_HEIGHT}\"/></clipPath>\n<g clip-path=\"url(#c{left:.0})\">",
    );
    let (crosses, lines): (Vec<&Series>, Vec<&Series>) =
        series.iter().partition(|series| series.mark == Mark::Cross);
    let places = |series: &Series| -> Vec<(f64, f64)> {
        series.points.iter().map(|&(at, value)| (across(at), up(value))).collect()
    };
    for series in lines {
        push_marks(out, series, places(series).into_iter());
    }
    out.push_str("</g>\n");
    // A cross on the frame is drawn completely.
    for series in crosses {
        push_marks(out, series, places(series).into_iter());
    }
    let _ = writeln!(
        out,
        "<rect class=\"frame\" x=\"{left}\" y=\"{TOP}\" width=\"{PANEL_WIDTH}\" height=\"{PANEL_HEIGHT}\"/>",
    );
}

fn push_marks(out: &mut String, series: &Series, places: impl Iterator<Item = (f64, f64)>) {
    let colour = series.colour;
    let class = match series.mark {
        Mark::Line => "line",
        Mark::Thin => "thin",
        Mark::Dash => "dash",
        Mark::Dots => {
            for (x, y) in places {
                let _ = writeln!(
                    out,
                    "<circle class=\"dot s{colour}\" cx=\"{x:.1}\" cy=\"{y:.1}\" r=\"2.5\"/>"
                );
            }
            return;
        }
        Mark::Cross => {
            for (x, y) in places {
                let _ = writeln!(
                    out,
                    "<path class=\"cross s{colour}\" d=\"M{:.1} {y:.1}h12m-6 -6v12\"/>",
                    x - 6.0
                );
            }
            return;
        }
    };
    let _ = write!(out, "<path class=\"{class} s{colour}\" d=\"");
    for (index, (x, y)) in places.enumerate() {
        let _ = write!(out, "{}{x:.1} {y:.1}", if index == 0 { 'M' } else { 'L' });
    }
    let _ = writeln!(out, "\"/>");
}

/// One entry for each name of the panels' series.
fn legend(out: &mut String, panels: &[Panel], top: f64) {
    let mut names: Vec<&Series> = Vec::new();
    for series in panels.iter().flat_map(|panel| &panel.series) {
        if series.label.is_some() && !names.iter().any(|named| named.label == series.label) {
            names.push(series);
        }
    }
    let mut left = LEFT;
    for series in names {
        let sample = match series.mark {
            Mark::Dots | Mark::Cross => vec![(left + 12.0, top)],
            _ => vec![(left, top), (left + 24.0, top)],
        };
        push_marks(out, series, sample.into_iter());
        let label = series.label.unwrap_or_default();
        let _ =
            writeln!(out, "<text x=\"{:.0}\" y=\"{:.0}\">{label}</text>", left + 30.0, top + 4.0);
        left += 48.0 + 6.6 * label.chars().count() as f64;
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn ticks_are_round_and_inside() {
        let ticks = |scale, from, to| {
            let axis = Axis::new("", scale, (from, to));
            axis.ticks().into_iter().map(|(_, name)| name).collect::<Vec<_>>().join(" ")
        };
        assert_eq!(ticks(Scale::Linear, 0.0, 360.0), "0 100 200 300");
        assert_eq!(ticks(Scale::Linear, -0.2, 0.21), "−0.2 −0.1 0.0 0.1 0.2");
        assert_eq!(
            ticks(Scale::Logarithmic, 0.01, 100.0),
            "0.01 0.10 1 10 100".replace("0.10", "0.1")
        );
    }

    #[test]
    fn points_lie_where_the_axes_say_and_are_cut_off_outside() {
        let panel = Panel {
            title: "a",
            x: Axis::new("t [s]", Scale::Linear, (0.0, 10.0)),
            y: Axis::new("v [m/s]", Scale::Linear, (0.0, 1.0)),
            series: vec![Series {
                label: Some("one"),
                mark: Mark::Line,
                colour: 0,
                points: vec![(0.0, 0.0), (10.0, 1.0)],
            }],
        };
        let text = svg("test", &[panel]);
        let path =
            format!("M{LEFT:.1} {:.1}L{:.1} {TOP:.1}", TOP + PANEL_HEIGHT, LEFT + PANEL_WIDTH);
        assert!(text.contains(&path), "{path} in {text}");
        assert!(text.contains(">t [s]<") && text.contains(">one<"), "{text}");
        assert!(text.contains("<g clip-path=\"url(#c62)\">"), "{text}");
    }
}
