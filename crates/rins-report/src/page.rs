//! The page around what a report says.

use super::content::{Item, Report, Section, Tone};
use super::drawing::Drawing;
use super::escape::{each, html, json_in_script};
use super::plot::{Plot, Scale};
use super::table::{class, matrix, table};

const STYLE: &str = include_str!("../assets/report.css");
const SCRIPT: &str = include_str!("../assets/report.js");
const UPLOT: &str = include_str!("../assets/uplot-1.6.32.min.js");
const UPLOT_STYLE: &str = include_str!("../assets/uplot-1.6.32.min.css");
const UPLOT_LICENSE: &str = include_str!("../assets/uplot-LICENSE");

/// Nothing is loaded; the page's own style, script and data suffice.
const POLICY: &str = "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; \
                      img-src data:; base-uri 'none'; form-action 'none'";

/// The points drawn of a curve at most, and what it comes down to where a page has very many curves.
const POINTS: [usize; 5] = [4000, 2000, 1000, 500, 250];

/// The curves' data at most \[bytes\], unless the least of [`POINTS`] exceeds it.
const DATA_SIZE: usize = 2_500_000;

/// More plots in a row than this are set in two columns on a wide screen.
const FEW_PLOTS: usize = 3;

/// The report as one HTML file.
pub fn render(report: &Report) -> String {
    let mut figures = figures(report).into_iter();
    let sections = each(report.sections.iter().enumerate(), |(place, content)| {
        section(place, content, &mut figures)
    });
    let title = html(&report.title);
    let contents = contents(report);
    let summary = summary(&report.summary);
    let subtitle = paragraph("subtitle", &report.subtitle);
    let has_plots = sections.contains("<figure");
    let hint = if has_plots {
        "<p class=\"hint\">Plots: drag across one to zoom, double-click to see all again; \
         a click on a name in its legend hides that curve.</p>\n"
    } else {
        ""
    };
    let scripts = if has_plots {
        format!("<script>/*\n{UPLOT_LICENSE}*/\n{UPLOT}</script>\n<script>\n{SCRIPT}</script>\n")
    } else {
        String::new()
    };
    let maker = if has_plots { ", curves drawn by uPlot 1.6.32 (MIT licence)" } else { "" };
    let version = env!("CARGO_PKG_VERSION");
    format!(
        "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n\
         <meta http-equiv=\"Content-Security-Policy\" content=\"{POLICY}\">\n\
         <meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n\
         <meta name=\"color-scheme\" content=\"light dark\">\n<title>{title}</title>\n\
         <link rel=\"icon\" href=\"data:,\">\n\
         <style>\n{UPLOT_STYLE}\n{STYLE}</style>\n</head>\n<body>\n\
         <header>\n<h1>{title}</h1>\n{subtitle}{summary}{contents}{hint}</header>\n\
         <main>\n{sections}</main>\n\
         <footer><p>Made by rins {version}{maker}. This file is complete: it loads nothing.</p></footer>\n\
         {scripts}</body>\n</html>\n"
    )
}

fn paragraph(class: &str, text: &str) -> String {
    match (text.is_empty(), class) {
        (true, _) => String::new(),
        (false, "") => format!("<p>{}</p>\n", html(text)),
        (false, class) => format!("<p class=\"{class}\">{}</p>\n", html(text)),
    }
}

fn summary(sentences: &[String]) -> String {
    let Some((lead, others)) = sentences.split_first() else {
        return String::new();
    };
    let others = each(others, |sentence| format!("<li>{}</li>\n", html(sentence)));
    let list = if others.is_empty() { String::new() } else { format!("<ul>\n{others}</ul>\n") };
    format!("<div class=\"summary\">\n<p class=\"lead\">{}</p>\n{list}</div>\n", html(lead))
}

fn contents(report: &Report) -> String {
    if report.sections.len() < 3 {
        return String::new();
    }
    let links = each(report.sections.iter().enumerate(), |(place, section)| {
        format!("<li><a href=\"#s{place}\">{}</a></li>\n", html(&section.heading))
    });
    format!("<nav class=\"contents\" aria-label=\"Sections\"><ul>\n{links}</ul></nav>\n")
}

fn section(place: usize, section: &Section, figures: &mut impl Iterator<Item = String>) -> String {
    // Plots that follow each other share a grid.
    let runs = section.items.chunk_by(|a, b| is_plot(a) && is_plot(b));
    let body = each(runs, |run| match &run[0] {
        Item::Text(text) => paragraph("", text),
        Item::Note(tone, text) => note(*tone, text),
        Item::Table(content) => table(content),
        Item::Matrix(content) => matrix(content),
        Item::Plot(_) => {
            let many = if run.len() > FEW_PLOTS { " many" } else { "" };
            let plots: String = figures.by_ref().take(run.len()).collect();
            format!("<div class=\"plots{many}\">\n{plots}</div>\n")
        }
    });
    let heading = html(&section.heading);
    let intro = paragraph("", &section.intro);
    format!("<section id=\"s{place}\">\n<h2>{heading}</h2>\n{intro}{body}</section>\n")
}

fn is_plot(item: &Item) -> bool {
    matches!(item, Item::Plot(_))
}

fn note(tone: Tone, text: &str) -> String {
    let word = match tone {
        Tone::Neutral => "Note.",
        Tone::Good => "Good.",
        Tone::Warning => "Caution.",
        Tone::Bad => "Problem.",
    };
    format!("<p class=\"note {}\"><b>{word}</b> {}</p>\n", class(tone), html(text))
}

/// Every plot of the report, each curve with as many points as the page has room for.
fn figures(report: &Report) -> Vec<String> {
    let plots: Vec<&Plot> = report
        .sections
        .iter()
        .flat_map(|section| &section.items)
        .filter_map(|item| if let Item::Plot(plot) = item { Some(plot) } else { None })
        .collect();
    let mut made = Vec::new();
    for n_points in POINTS {
        made = plots.iter().map(|plot| figure(plot, n_points)).collect();
        if made.iter().map(String::len).sum::<usize>() <= DATA_SIZE {
            break;
        }
    }
    made
}

fn figure(plot: &Plot, n_points: usize) -> String {
    let drawing = Drawing::new(plot, n_points);
    let title = html(&plot.title);
    let caption = caption(plot, &drawing);
    let head = format!("<div class=\"head\"><h3>{title}</h3></div>");
    if !drawing.has_samples() {
        return format!(
            "<figure class=\"plot\">{head}\n<p class=\"absent\">There is no finite sample to draw.</p>\n\
             {caption}</figure>\n"
        );
    }
    let label = html(&plot.y_label);
    let scale = if plot.x_scale == Scale::Linear { "linear" } else { "logarithmic" };
    let abscissa = format!("{} {scale}", html(&plot.x_label));
    let data = json_in_script(&drawing.to_json());
    format!(
        "<figure class=\"plot\" data-abscissa=\"{abscissa}\" data-label=\"{title}: {label}\">{head}\n\
         <p class=\"absent undrawn\">The curves need JavaScript; text and tables do not.</p>\n\
         <script type=\"application/json\">{data}</script>\n{caption}</figure>\n"
    )
}

fn caption(plot: &Plot, drawing: &Drawing<'_>) -> String {
    let mut parts = Vec::new();
    if !plot.caption.is_empty() {
        parts.push(html(&plot.caption).into_owned());
    }
    if let Some(n_samples) = drawing.thinned_from {
        parts.push(format!("{n_samples} samples, drawn as min/max of each pixel."));
    }
    if drawing.n_misplaced > 0 {
        parts.push(format!("Left out: {} with no place on the abscissa.", drawing.n_misplaced));
    }
    if parts.is_empty() {
        return String::new();
    }
    format!("<figcaption>{}</figcaption>\n", parts.join(" "))
}

#[cfg(test)]
mod tests;
