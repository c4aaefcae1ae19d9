//! A comparison as text, result and page.

use std::fmt;

use rins_report::Report;

use super::Comparison;
use super::page::{comparison_report, comparison_text};
use super::result::CompareResult;
use crate::basis::BasisResult;
use crate::outcome::Outcome;

impl fmt::Display for Comparison {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&comparison_text(self))
    }
}

impl Outcome for Comparison {
    type Result = CompareResult;

    fn result(&self) -> CompareResult {
        self.into()
    }

    fn basis(&self) -> BasisResult {
        self.basis.clone()
    }

    fn report(&self) -> Option<Report> {
        Some(comparison_report(self))
    }
}
