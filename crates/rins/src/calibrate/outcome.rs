//! A calibration as text, result, page and files.

use std::fmt;

use rins_report::Report;

use super::certificate::Certificate;
use super::page::{certificate_report, certificate_text};
use super::result::CalibrateResult;
use super::{Calibration, Kind};
use crate::basis::BasisResult;
use crate::log::with_repairs;
use crate::outcome::Outcome;

impl fmt::Display for Certificate {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&with_repairs(certificate_text(self), &self.repairs()))
    }
}

impl Outcome for Certificate {
    type Result = CalibrateResult;

    fn result(&self) -> CalibrateResult {
        CalibrateResult::of(self)
    }

    fn basis(&self) -> BasisResult {
        self.basis()
    }

    fn report(&self) -> Option<Report> {
        let mut report = certificate_report(self);
        report.summary.extend(self.repairs());
        Some(report)
    }

    fn files(&self) -> Vec<(String, Vec<u8>)> {
        self.calibration_files()
    }

    fn failure(&self) -> Option<String> {
        self.absurd()
    }
}

impl Calibration {
    fn outcome(&self) -> &dyn Outcome<Result = CalibrateResult> {
        match &self.0 {
            Kind::Paper(paper) => &**paper,
            Kind::Certificate(certificate) => &**certificate,
        }
    }
}

impl fmt::Display for Calibration {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        self.outcome().fmt(f)
    }
}

impl Outcome for Calibration {
    type Result = CalibrateResult;

    fn result(&self) -> CalibrateResult {
        self.outcome().result()
    }

    fn basis(&self) -> BasisResult {
        self.outcome().basis()
    }

    fn report(&self) -> Option<Report> {
        self.outcome().report()
    }

    fn files(&self) -> Vec<(String, Vec<u8>)> {
        self.outcome().files()
    }

    fn failure(&self) -> Option<String> {
        self.outcome().failure()
    }
}
