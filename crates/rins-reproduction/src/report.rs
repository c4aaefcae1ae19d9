//! The page of the book that compares the paper's figures with those of rins, and its charts.

mod accelerometers;
mod attitude;
mod chart;
mod convergence;
mod enhancement;
mod errata;
mod experiment;
mod figures;
mod filter;
mod mechanism;
mod navigation;
mod number;
mod online;
mod overview;
mod ranking;
mod results;
mod roll;
mod rotation;
mod uncertainty;

pub(crate) use results::{Results, Scale};

/// The path of the page, relative to the workspace's root.
pub(crate) const PAGE: &str = "docs/src/reproduction.md";

/// The folder of its charts, relative to the workspace's root.
pub(crate) const FIGURES: &str = "docs/src/figures";

/// A file of the report: its path relative to the workspace's root, and its text.
#[derive(Clone, Debug, PartialEq, Eq)]
pub(crate) struct File {
    /// The path.
    pub(crate) path: String,
    /// The text.
    pub(crate) text: String,
}

/// The page and its charts.
pub(crate) fn files(results: &Results) -> Vec<File> {
    let page = File { path: PAGE.into(), text: page(results) };
    let charts = figures::all(results)
        .into_iter()
        .map(|(name, text)| File { path: format!("{FIGURES}/{name}"), text });
    std::iter::once(page).chain(charts).collect()
}

fn page(results: &Results) -> String {
    [
        overview::section(results),
        filter::section(results),
        navigation::section(results),
        attitude::section(results),
        navigation::velocities(results),
        experiment::section(results),
        online::section(results),
        rotation::section(results),
        mechanism::section(results),
        accelerometers::section(results),
        errata::section(results),
    ]
    .concat()
}
