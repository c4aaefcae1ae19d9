//! The paper's calibration as text, result, page and files.

use std::fmt::{self, Write as _};
use std::path::Path;

use rins_calibration::MEASUREMENTS;
use rins_io::{ModelFile, shown};
use rins_report::Report;

use super::PaperCalibration;
use super::page::{calibration_report, calibration_text};
use super::result::result;
use crate::basis::BasisResult;
use crate::calibrate::compensation_guide::{budget_section, compensation_section};
use crate::calibrate::departure::ABSURD_NIS;
use crate::calibrate::result::CalibrateResult;
use crate::log::with_repairs;
use crate::outcome::Outcome;

impl PaperCalibration {
    fn title(&self) -> String {
        format!("Calibration of {}", self.log.name)
    }

    fn subtitle(&self) -> String {
        let (span, loaded) = (&self.calibration.span, &self.log.loaded);
        format!(
            "rins calibrate, model paper12: {} samples from {:.2} s to {:.2} s of {}",
            span.len(),
            loaded.recording.times[span.start],
            loaded.recording.times[span.end - 1],
            loaded.rig.log.path.file_name().map_or_else(String::new, |name| shown(Path::new(name))),
        )
    }
}

impl fmt::Display for PaperCalibration {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut text = calibration_text(&self.calibration, &self.title());
        for remark in &self.remarks {
            writeln!(text, "  {remark}")?;
        }
        f.write_str(&with_repairs(text, &self.log.repairs()))
    }
}

impl Outcome for PaperCalibration {
    type Result = CalibrateResult;

    fn result(&self) -> CalibrateResult {
        result(self)
    }

    fn basis(&self) -> BasisResult {
        self.basis.clone()
    }

    fn report(&self) -> Option<Report> {
        let mut report = calibration_report(&self.calibration, &self.title(), &self.subtitle());
        report.sections.push(compensation_section(&self.model));
        report.sections.push(budget_section("Error budget", &self.ids(), &self.budget));
        report.summary.extend(self.remarks.iter().cloned());
        report.summary.extend(self.log.repairs());
        Some(report)
    }

    fn files(&self) -> Vec<(String, Vec<u8>)> {
        let model = ModelFile::of(self.model.clone())
            .with_axes(self.log.loaded.rig.spin)
            .with_provenance(self.basis.provenance());
        vec![
            ("calibration.toml".into(), self.file().to_toml().into_bytes()),
            ("model.toml".into(), model.to_toml().into_bytes()),
        ]
    }

    /// Why estimates mean nothing, if the innovations are beyond what any sensor error explains.
    fn failure(&self) -> Option<String> {
        let nis = self.calibration.consistency.nis_mean;
        (nis > ABSURD_NIS).then(|| {
        format!(
            "the innovations are {:.0} times larger than the rig's figures allow: units, axes, signs, attitude or table \
             profile are wrong, and so are the estimates",
            (nis / MEASUREMENTS as f64).sqrt()
        )
    })
    }
}
