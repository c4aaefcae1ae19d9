//! Report pages: a result as one self-contained HTML file, which needs no network.
//!
//! A program describes its results as a [`Report`] of sections, tables, notes and plots; [`render`] generates the page.
//! Style, scripts and data are in the file; a content security policy prevents it from loading anything else.
//! Tables and text need no script; the curves are drawn by uPlot, whose license is in the page.
//!
//! All content is treated as untrusted text: nothing in it can become markup or code.
//! NaN and infinities become gaps of a curve. Curves of more than a few thousand samples are thinned for display
//! such that every peak is preserved, and the plot's caption states it; the full numbers are in `result.json`.
//!
//! ```
//! use rins_report::{Cell, Column, Item, Report, Section, Table, render};
//! let table = Table {
//!     caption: "Biases".into(),
//!     columns: vec![Column::text("sensor"), Column::number("bias [deg/h]")],
//!     rows: vec![vec![Cell::text("gyro x"), Cell::Estimate { value: 0.021, sigma: 0.004 }]],
//! };
//! let section = Section { heading: "Sensors".into(), items: vec![Item::Table(table)], ..Section::default() };
//! let report = Report { title: "A run".into(), sections: vec![section], ..Report::default() };
//! assert!(render(&report).contains("gyro x"));
//! ```

mod content;
mod drawing;
mod envelope;
mod escape;
pub mod number;
mod page;
mod plot;
mod table;

pub use content::{Cell, Column, Item, Kind, Matrix, Report, Section, Table, Tone};
pub use page::render;
pub use plot::{Band, Plot, Reference, Scale, Series, Style};

#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;
