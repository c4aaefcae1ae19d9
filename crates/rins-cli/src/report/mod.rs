//! The report page: one self-contained HTML file that a person reads and that needs no network.
//!
//! A command describes what it found as a [`Report`] of sections, tables, notes and plots; [`render`] makes the page.
//! Style, scripts and data are all in the file; a content security policy forbids it to load anything else.
//! Tables and text need no script; the curves are drawn by uPlot, whose licence the page carries.
//!
//! Everything given here is taken for text that came from a file: nothing in it can become markup or code.
//! NaN and infinities become gaps of a curve. Curves of more than some thousand samples are thinned for display
//! such that every peak survives, and the plot's caption says so; the full numbers belong in `result.json`.

mod content;
mod drawing;
mod envelope;
mod escape;
mod page;
mod plot;
mod table;

pub(crate) use content::{Cell, Column, Item, Matrix, Report, Section, Table, Tone};
pub(crate) use page::render;
pub(crate) use plot::{Band, Plot, Reference, Scale, Series, Style};
