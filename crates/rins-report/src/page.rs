//! The HTML page of a report.

use maud::{DOCTYPE, Markup, PreEscaped, html};

use super::content::{Item, Report, Section, Tone};
use super::drawing::Drawing;
use super::escape::{LINE, Shown, json_in_script, made};
use super::plot::{Plot, Scale};
use super::table::{class, matrix, table};

const STYLE: &str = include_str!("../assets/report.css");
const SCRIPT: &str = include_str!("../assets/report.js");
const UPLOT: &str = include_str!("../assets/uplot-1.6.32.min.js");
const UPLOT_STYLE: &str = include_str!("../assets/uplot-1.6.32.min.css");
const UPLOT_LICENSE: &str = include_str!("../assets/uplot-LICENSE");

/// The content security policy: nothing is loaded; only the page's own style, script and data are used.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; \
                      img-src data:; base-uri 'none'; form-action 'none'";

/// The maximum number of drawn points of a curve, in steps for pages with increasing numbers of curves.
const POINTS: [usize; 5] = [4000, 2000, 1000, 500, 250];

/// The maximum size of the curves' data \[bytes\], unless it is exceeded with the smallest of [`POINTS`].
const DATA_SIZE: usize = 2_500_000;

/// The number of plots in a row above which they are arranged in two columns on a wide screen.
const FEW_PLOTS: usize = 3;

/// The report as one HTML file.
pub fn render(report: &Report) -> String {
    let figures = figures(report);
    let has_plots = !figures.is_empty();
    let mut figures = figures.into_iter();
    let title = Shown(&report.title);
    let version = env!("CARGO_PKG_VERSION");
    let page = html! {
        (DOCTYPE) (LINE)
        html lang="en" { (LINE)
            head { (LINE)
                meta charset="utf-8"; (LINE)
                meta http-equiv="Content-Security-Policy" content=(POLICY); (LINE)
                meta name="viewport" content="width=device-width, initial-scale=1"; (LINE)
                meta name="color-scheme" content="light dark"; (LINE)
                title { (title) } (LINE)
                link rel="icon" href="data:,"; (LINE)
                style { (LINE) (PreEscaped(UPLOT_STYLE)) (LINE) (PreEscaped(STYLE)) } (LINE)
            } (LINE)
            body { (LINE)
                header { (LINE)
                    h1 { (title) } (LINE)
                    (paragraph(Some("subtitle"), &report.subtitle))
                    (summary(&report.summary))
                    (contents(report))
                    @if has_plots {
                        p class="hint" {
                            "Plots: drag across one to zoom, double-click to see all again; a click on a name in its "
                            "legend hides that curve."
                        } (LINE)
                    }
                } (LINE)
                main { (LINE)
                    @for (place, content) in report.sections.iter().enumerate() {
                        (section(place, content, &mut figures))
                    }
                } (LINE)
                footer {
                    p {
                        "Made by rins " (version)
                        @if has_plots { ", curves drawn by uPlot 1.6.32 (MIT licence)" }
                        ". Self-contained file: no external resources."
                    }
                } (LINE)
                @if has_plots {
                    script { "/*" (LINE) (PreEscaped(UPLOT_LICENSE)) "*/" (LINE) (PreEscaped(UPLOT)) } (LINE)
                    script { (LINE) (PreEscaped(SCRIPT)) } (LINE)
                }
            } (LINE)
        } (LINE)
    };
    page.into_string()
}

fn paragraph(class: Option<&str>, text: &str) -> Markup {
    html! { @if !text.is_empty() { p class=[class] { (Shown(text)) } (LINE) } }
}

fn summary(sentences: &[String]) -> Markup {
    let Some((lead, others)) = sentences.split_first() else { return Markup::default() };
    html! {
        div class="summary" { (LINE)
            p class="lead" { (Shown(lead)) } (LINE)
            @if !others.is_empty() {
                ul { (LINE) @for sentence in others { li { (Shown(sentence)) } (LINE) } } (LINE)
            }
        } (LINE)
    }
}

fn contents(report: &Report) -> Markup {
    if report.sections.len() < 3 {
        return Markup::default();
    }
    html! {
        nav class="contents" aria-label="Sections" {
            ul { (LINE)
                @for (place, section) in report.sections.iter().enumerate() {
                    li { a href={ "#s" (place) } { (Shown(&section.heading)) } } (LINE)
                }
            }
        } (LINE)
    }
}

fn section(place: usize, section: &Section, figures: &mut impl Iterator<Item = Markup>) -> Markup {
    // Consecutive plots share a grid.
    let runs = section.items.chunk_by(|a, b| is_plot(a) && is_plot(b));
    html! {
        section id={ "s" (place) } { (LINE)
            h2 { (Shown(&section.heading)) } (LINE)
            (paragraph(None, &section.intro))
            @for run in runs {
                @match &run[0] {
                    Item::Text(text) => (paragraph(None, text)),
                    Item::Note(tone, text) => (note(*tone, text)),
                    Item::Table(content) => (table(content)),
                    Item::Matrix(content) => (matrix(content)),
                    Item::Plot(_) => {
                        div.plots.many[run.len() > FEW_PLOTS] { (LINE)
                            @for figure in figures.by_ref().take(run.len()) { (figure) }
                        } (LINE)
                    }
                }
            }
        } (LINE)
    }
}

fn is_plot(item: &Item) -> bool {
    matches!(item, Item::Plot(_))
}

fn note(tone: Tone, text: &str) -> Markup {
    let word = match tone {
        Tone::Neutral => "Note.",
        Tone::Good => "Good.",
        Tone::Warning => "Caution.",
        Tone::Bad => "Problem.",
    };
    html! { p.note.(class(tone)) { b { (word) } " " (Shown(text)) } (LINE) }
}

/// All plots of the report, with as many points per curve as the size of the page permits.
fn figures(report: &Report) -> Vec<Markup> {
    let plots: Vec<&Plot> = report
        .sections
        .iter()
        .flat_map(|section| &section.items)
        .filter_map(|item| if let Item::Plot(plot) = item { Some(plot) } else { None })
        .collect();
    let mut made = Vec::new();
    for n_points in POINTS {
        made = plots.iter().map(|plot| figure(plot, n_points)).collect();
        if made.iter().map(|figure: &Markup| figure.0.len()).sum::<usize>() <= DATA_SIZE {
            break;
        }
    }
    made
}

fn figure(plot: &Plot, n_points: usize) -> Markup {
    let drawing = Drawing::new(plot, n_points);
    let title = Shown(&plot.title);
    let scale = if plot.x_scale == Scale::Linear { "linear" } else { "logarithmic" };
    let abscissa = format!("{} {scale}", plot.x_label);
    let label = format!("{}: {}", plot.title, plot.y_label);
    let drawn = drawing.has_samples();
    html! {
        figure.plot data-abscissa=[drawn.then_some(Shown(&abscissa))] data-label=[drawn.then_some(Shown(&label))] {
            div class="head" { h3 { (title) } } (LINE)
            @if drawn {
                p.absent.undrawn { "The curves need JavaScript; text and tables do not." } (LINE)
                script type="application/json" { (made(json_in_script(&drawing.to_json()))) } (LINE)
            } @else {
                p class="absent" { "There is no finite sample to draw." } (LINE)
            }
            (caption(plot, &drawing))
        } (LINE)
    }
}

fn caption(plot: &Plot, drawing: &Drawing<'_>) -> Markup {
    let mut parts = Vec::new();
    if !plot.caption.is_empty() {
        parts.push(plot.caption.clone());
    }
    if let Some(n_samples) = drawing.thinned_from {
        parts.push(format!("{n_samples} samples, drawn as min/max of each pixel."));
    }
    if drawing.n_misplaced > 0 {
        parts.push(format!("Left out: {} with no place on the abscissa.", drawing.n_misplaced));
    }
    if parts.is_empty() {
        return Markup::default();
    }
    html! { figcaption { (Shown(&parts.join(" "))) } (LINE) }
}

#[cfg(test)]
mod tests;
