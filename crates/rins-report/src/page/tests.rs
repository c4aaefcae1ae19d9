//! Properties of the page for any content.

use super::*;
use crate::{Band, Cell, Column, Matrix, Reference, Series, Style, Table};

/// Text that tries to leave an element, an attribute, a script and a style.
const HOSTILE: &str = "\"'><script>alert(1)</script><img src=http://evil.test/x onerror=alert(1)>\
                       </style></title>--><!--${x}`\u{2028}\u{2029}\u{202E}&amp;";

fn series(n: i32, y: impl Fn(f64) -> f64) -> Series {
    let x: Vec<f64> = (0..n).map(|row| f64::from(row) * 0.01).collect();
    let y = x.iter().copied().map(y).collect();
    Series { name: "a".into(), x, y, style: Style::Line }
}

fn page_of(items: Vec<Item>) -> String {
    let section = Section { heading: "h".into(), intro: String::new(), items };
    render(&Report { title: "t".into(), sections: vec![section], ..Report::default() })
}

fn hostile_report() -> Report {
    let text = || HOSTILE.to_owned();
    let curve = Series { name: text(), x: vec![0.0, 1.0], y: vec![1.0, 2.0], style: Style::Points };
    let plot = Plot {
        title: text(),
        x_label: text(),
        y_label: text(),
        series: vec![curve],
        bands: vec![Band { name: text(), x: vec![0.0], lower: vec![0.0], upper: vec![1.0] }],
        references: vec![Reference { name: text(), value: 1.0 }],
        caption: text(),
        ..Plot::default()
    };
    let table = Table {
        caption: text(),
        columns: vec![Column::id(HOSTILE), Column::number(HOSTILE)],
        rows: vec![vec![Cell::text(HOSTILE), Cell::badge(Tone::Bad, HOSTILE)]],
    };
    let matrix = Matrix { caption: text(), labels: vec![text()], values: vec![vec![1.0]] };
    let items = vec![
        Item::Text(text()),
        Item::Note(Tone::Warning, text()),
        Item::Table(table),
        Item::Matrix(matrix),
        Item::Plot(plot),
    ];
    let section = Section { heading: text(), intro: text(), items };
    let sections = vec![section.clone(), section.clone(), section];
    Report { title: text(), subtitle: text(), summary: vec![text(), text()], sections }
}

#[test]
fn nothing_from_a_file_becomes_markup_or_code() {
    let tame = |report: &Report| {
        let page = render(report);
        let count = |what: &str| page.matches(what).count();
        (count("<script"), count("</script"), count("<img"), count("</style"), count("<!--"))
    };
    // Two scripts, and one block of data per plot; nothing else.
    assert_eq!(tame(&hostile_report()), (5, 5, 0, 1, 0));
    let page = render(&hostile_report());
    assert!(!page.contains(['\u{2028}', '\u{2029}', '\u{202E}']), "a hidden character got through");
    assert!(!page.contains("\"'>"), "an attribute can be left");
}

#[test]
fn the_page_allows_nothing_to_be_loaded_and_tries_nothing() {
    let page =
        page_of(vec![Item::Plot(Plot { series: vec![series(10, f64::sin)], ..Plot::default() })]);
    let policy = page.find("Content-Security-Policy").expect("a policy");
    let first = page.find("<style").expect("a style");
    assert!(policy < first, "the policy must come before what it governs");
    assert!(page.contains("default-src 'none'"));
    for loader in [" src=", "@import", "url(", "fetch(", "XMLHttpRequest", "import(", "sendBeacon"]
    {
        assert!(!page.contains(loader), "{loader}");
    }
    assert!(page.contains("Copyright (c) 2022 Leon Sorokin"), "uPlot's licence goes with it");
}

#[test]
fn a_page_without_plots_has_no_script() {
    let page = page_of(vec![Item::Text("plain".into())]);
    assert!(!page.contains("<script"));
    assert!(page.contains("<p>plain</p>"));
}

#[test]
fn plots_that_follow_each_other_share_a_grid() {
    let plot = || Item::Plot(Plot { series: vec![series(3, f64::cos)], ..Plot::default() });
    let items = vec![plot(), Item::Text("x".into()), plot(), plot(), plot(), plot()];
    let page = page_of(items);
    assert_eq!(page.matches("<div class=\"plots\">").count(), 1);
    assert_eq!(page.matches("<div class=\"plots many\">").count(), 1);
    assert_eq!(page.matches("<figure").count(), 5);
}

#[test]
fn a_plot_of_nothing_says_so() {
    let page = page_of(vec![Item::Plot(Plot {
        series: vec![series(4, |_| f64::NAN)],
        ..Plot::default()
    })]);
    assert!(page.contains("There is no finite sample to draw."));
    assert!(!page.contains("application/json"));
}

#[test]
fn captions_own_up_to_thinning_and_to_what_is_left_out() {
    let mut long = series(50_000, f64::sin);
    long.x[7] = f64::NAN;
    let plot = Plot { series: vec![long], caption: "Quiet.".into(), ..Plot::default() };
    let page = page_of(vec![Item::Plot(plot)]);
    let want = "<figcaption>Quiet. 49999 samples, drawn as min/max of each pixel. \
                Left out: 1 with no place on the abscissa.</figcaption>";
    assert!(page.contains(want));
}

#[test]
fn forty_long_plots_stay_below_three_megabytes() {
    let noisy = |t: f64| (t * 1234.5).sin() * (1.0 + t) + t.sqrt();
    let plot = Plot {
        series: vec![series(40_000, noisy), series(40_000, |t| noisy(t) * 0.77)],
        ..Plot::default()
    };
    let page = page_of(vec![Item::Plot(plot); 40]);
    assert!(page.len() < 3_000_000, "{} bytes", page.len());
    assert!(page.len() > 1_000_000, "{} bytes: more was left out than need be", page.len());
}

#[test]
fn the_same_report_makes_the_same_bytes() {
    assert_eq!(render(&hostile_report()), render(&hostile_report()));
}
