//! The noise as text, result and page.

use std::fmt;

use rins_io::shown;
use rins_report::Report;

use super::Allan;
use super::page::{allan_report, allan_text};
use super::result::AllanResult;
use crate::basis::BasisResult;
use crate::log::with_repairs;
use crate::outcome::Outcome;

impl Allan<'_> {
    fn title(&self) -> String {
        format!("Noise of {}", self.log.name)
    }
}

impl fmt::Display for Allan<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let text = allan_text(&self.rest, &self.title());
        f.write_str(&with_repairs(text, &self.log.repairs()))
    }
}

impl Outcome for Allan<'_> {
    type Result = AllanResult;

    fn result(&self) -> AllanResult {
        AllanResult::of(&self.rest, self.log)
    }

    fn basis(&self) -> BasisResult {
        BasisResult::of_log(self.log)
    }

    fn report(&self) -> Option<Report> {
        let mut report =
            allan_report(&self.rest, self.title(), &shown(&self.log.loaded.rig.log.path));
        report.summary.extend(self.log.repairs());
        Some(report)
    }
}
