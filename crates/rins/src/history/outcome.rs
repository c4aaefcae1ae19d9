//! A history as text, result and page.

use std::fmt;

use rins_report::Report;

use super::RunHistory;
use super::page::history_report;
use super::result::HistoryResult;
use super::text::history_text;
use crate::basis::BasisResult;
use crate::outcome::Outcome;

impl fmt::Display for RunHistory {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&history_text(self))
    }
}

impl Outcome for RunHistory {
    type Result = HistoryResult;

    fn result(&self) -> HistoryResult {
        self.into()
    }

    fn basis(&self) -> BasisResult {
        self.basis.clone()
    }

    fn report(&self) -> Option<Report> {
        Some(history_report(self))
    }
}
