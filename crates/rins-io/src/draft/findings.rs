//! The findings on a log with columns, before its draft is written.

use std::path::Path;

use super::label::Label;
use super::layout::Layout;
use super::pace::Pace;
use super::sample::Sample;

/// The findings on a log with columns.
#[derive(Clone, Copy, Debug)]
pub(super) struct Findings<'f> {
    pub(super) log: &'f Path,
    /// The folder of the rig file.
    pub(super) folder: &'f Path,
    pub(super) sample: &'f Sample,
    /// The meaning of each column's name.
    pub(super) labels: &'f [Label],
    pub(super) pace: Option<&'f Pace>,
    pub(super) layout: &'f Layout,
}

impl Findings<'_> {
    /// The interval between rows \[s\], if it is known.
    pub(super) fn interval(&self) -> Option<f64> {
        self.pace.and_then(Pace::interval)
    }
}
