//! A mission as text, result and page.

use std::fmt;

use rins_report::Report;

use super::Mission;
use super::page::{mission_report, mission_text};
use super::result::MissionResult;
use crate::basis::BasisResult;
use crate::outcome::Outcome;

impl fmt::Display for Mission {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&mission_text(self))
    }
}

impl Outcome for Mission {
    type Result = MissionResult;

    fn result(&self) -> MissionResult {
        self.into()
    }

    fn basis(&self) -> BasisResult {
        self.basis.clone()
    }

    fn report(&self) -> Option<Report> {
        Some(mission_report(self))
    }
}
