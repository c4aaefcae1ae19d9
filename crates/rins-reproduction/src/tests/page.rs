//! The page: complete, and in agreement with the code.

use std::fs;
use std::path::Path;
use std::sync::OnceLock;

use crate::report::{FIGURES, File, PAGE, Results, Scale, files};
use crate::stale::differences;

/// A scale so small that only results which do not depend on the runs can be compared.
const SMALL: Scale =
    Scale { runs: 2, honesty_runs: 3, honesty_duration: 4.0, emulated: 2, followed: 2 };

fn small() -> &'static [File] {
    static FILES: OnceLock<Vec<File>> = OnceLock::new();
    FILES.get_or_init(|| files(&Results::compute(SMALL, || ()).expect("it runs")))
}

fn kept(path: &str) -> String {
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).ancestors().nth(2).expect("the workspace");
    fs::read_to_string(root.join(path)).unwrap_or_else(|error| panic!("{path}: {error}"))
}

/// The lines from a heading to the next one of its level or of a higher one.
fn section<'t>(page: &'t str, heading: &str) -> &'t str {
    let start = page.find(heading).unwrap_or_else(|| panic!("no {heading:?}"));
    let depth = heading.find(' ').expect("a heading has a level");
    let rest = &page[start + heading.len()..];
    let ends = (1..=depth).filter_map(|depth| rest.find(&format!("\n{} ", "#".repeat(depth))));
    &page[start..start + heading.len() + ends.min().unwrap_or(rest.len())]
}

#[test]
fn every_table_figure_and_equation_is_at_a_glance() {
    let head = section(&small()[0].text, "## At a glance");
    let tables = ["Tables 1, 2", "Table 3", "Table 4", "Table 5", "Table 6"];
    let figures = ["Figure 1", "Figure 2", "Figure 3", "Figure 4", "Figure 5", "Figures 6 to 8"];
    for item in tables.iter().chain(&figures) {
        assert!(head.contains(item), "{item}");
    }
    // The rows of equations are contiguous.
    let first_and_last = |cell: &str| -> Vec<u32> {
        let numbers = cell.split(|c: char| !c.is_ascii_digit()).filter(|part| !part.is_empty());
        numbers.map(|number| number.parse().unwrap()).collect()
    };
    let cells =
        head.lines().filter(|line| line.starts_with("| (")).map(|line| line.split('|').nth(1));
    let mut next = 1;
    for cell in cells.flatten().filter(|cell| !cell.contains("(A.")) {
        let numbers = first_and_last(cell);
        assert_eq!(numbers[0], next, "{cell}");
        next = numbers[numbers.len() - 1] + 1;
    }
    assert_eq!(next, 22, "eq. (21) is the last");
    assert!(["(A.1) to (A.4)", "(A.5)", "(A.6)", "(A.7)"].iter().all(|cell| head.contains(cell)));
}

#[test]
fn what_does_not_depend_on_the_runs_is_as_kept() {
    let page = kept(PAGE);
    for heading in [
        "## Table 4's attitudes",
        "### What stays after compensation",
        "### Table 5: the uncertainty of the estimates",
        "### What the compensation changed",
        "## Static and rotating",
        "## Equations (6), (8), (9)",
        "## Accelerometer errors and whole turns",
        "## Equations misprinted",
    ] {
        let (old, new) = (section(&page, heading), section(&small()[0].text, heading));
        let found = differences(old, new);
        assert!(found.is_empty(), "make the page again with `cargo xtask reproduce`: {found:?}");
    }
}

#[test]
fn figures_are_there_and_the_page_shows_them() {
    for File { path, text } in &small()[1..] {
        let name = path.strip_prefix(FIGURES).unwrap();
        assert!(small()[0].text.contains(&format!("(figures{name})")), "{path}");
        assert!(text.starts_with("<svg") && text.ends_with("</svg>\n"), "{path}");
        assert!(!text.contains("NaN") && !text.contains("inf"), "{path}");
        assert!(kept(path).len() > 5000, "{path}");
    }
    for name in ["mechanism.svg", "static-and-rotating.svg"] {
        let made = small().iter().find(|file| file.path.ends_with(name)).unwrap();
        assert_eq!(differences(&kept(&made.path), &made.text), []);
    }
}
