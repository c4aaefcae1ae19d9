//! What is known of a log of columns before its draft is written.

use std::path::Path;

use super::label::Label;
use super::layout::Layout;
use super::pace::Pace;
use super::sample::Sample;

/// What is known of a log of columns.
#[derive(Clone, Copy, Debug)]
pub(super) struct Findings<'f> {
    pub(super) log: &'f Path,
    /// The folder of the rig file.
    pub(super) folder: &'f Path,
    pub(super) sample: &'f Sample,
    /// What the name of each column says.
    pub(super) labels: &'f [Label],
    pub(super) pace: Option<&'f Pace>,
    pub(super) layout: &'f Layout,
}

impl Findings<'_> {
    /// The interval from row to row \[s\], if it is known.
    pub(super) fn interval(&self) -> Option<f64> {
        self.pace.and_then(Pace::interval)
    }
}
