//! A result as a page: one self-contained HTML file that a person reads and that needs no network.
//!
//! A program describes what it found as a [`Report`] of sections, tables, notes and plots; [`render`] makes the page.
//! Style, scripts and data are all in the file; a content security policy forbids it to load anything else.
//! Tables and text need no script; the curves are drawn by uPlot, whose licence the page carries.
//!
//! Everything given here is taken for text that came from a file: nothing in it can become markup or code.
//! NaN and infinities become gaps of a curve. Curves of more than some thousand samples are thinned for display
//! such that every peak survives, and the plot's caption says so; the full numbers belong in `result.json`.
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
