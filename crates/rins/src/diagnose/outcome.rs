//! A diagnosis as text, result, page and files.

use std::fmt;

use rins_report::Report;

use super::Diagnosis;
use super::report::diagnosis_report;
use super::result::DiagnoseResult;
use super::text::diagnosis_text;
use crate::basis::BasisResult;
use crate::log::with_repairs;
use crate::outcome::Outcome;

impl fmt::Display for Diagnosis {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&with_repairs(diagnosis_text(&self.found), &self.found.certificate.repairs()))
    }
}

impl Outcome for Diagnosis {
    type Result = DiagnoseResult;

    fn result(&self) -> DiagnoseResult {
        DiagnoseResult::of(&self.found, self.basis.clone())
    }

    fn basis(&self) -> BasisResult {
        self.basis.clone()
    }

    fn report(&self) -> Option<Report> {
        let mut report = diagnosis_report(&self.found);
        report.summary.extend(self.found.certificate.repairs());
        Some(report)
    }

    fn files(&self) -> Vec<(String, Vec<u8>)> {
        self.found.certificate.calibration_files()
    }

    fn failure(&self) -> Option<String> {
        self.found.certificate.absurd()
    }
}
