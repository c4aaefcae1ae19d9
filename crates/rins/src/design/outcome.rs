//! A designed schedule as text, result, page and files.

use std::fmt;

use rins_report::Report;

use super::Design;
use super::page::report;
use super::result::DesignResult;
use super::words::text;
use crate::basis::BasisResult;
use crate::outcome::Outcome;

impl fmt::Display for Design {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&text(&self.0))
    }
}

impl Outcome for Design {
    type Result = DesignResult;

    fn result(&self) -> DesignResult {
        DesignResult::of(&self.0)
    }

    fn basis(&self) -> BasisResult {
        self.0.basis.clone()
    }

    fn report(&self) -> Option<Report> {
        Some(report(&self.0))
    }

    fn files(&self) -> Vec<(String, Vec<u8>)> {
        let names = super::result::file_names(self.0.scenarios.len());
        names
            .into_iter()
            .zip(self.0.scenarios.iter().map(|text| text.clone().into_bytes()))
            .collect()
    }
}
