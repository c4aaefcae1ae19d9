//! An alignment as text, result and page.

use std::fmt;

use rins_io::shown;
use rins_report::{Item, Report, Section};

use super::Alignment;
use super::result::AlignResult;
use super::text::{rows, sentences};
use crate::basis::BasisResult;
use crate::log::{site_assumption, statics_in_words, with_repairs};
use crate::outcome::Outcome;
use crate::table::{aligned, report_table};

impl Alignment<'_> {
    fn title(&self) -> String {
        format!("Alignment of {}", self.log.name)
    }

    fn summary(&self) -> Vec<String> {
        let mut sentences = sentences(&self.found, &self.log.loaded);
        sentences.extend(statics_in_words(&self.statics, &self.log.loaded.rig));
        sentences
    }
}

impl fmt::Display for Alignment<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        writeln!(f, "{}", self.title())?;
        for sentence in self.summary() {
            writeln!(f, "  {sentence}")?;
        }
        let table = aligned(&rows(&self.found, &self.log.loaded));
        f.write_str(&with_repairs(format!("\n{table}"), &self.log.repairs()))
    }
}

impl Outcome for Alignment<'_> {
    type Result = AlignResult;

    fn result(&self) -> AlignResult {
        AlignResult::of(self)
    }

    fn basis(&self) -> BasisResult {
        BasisResult::of_log(self.log).assuming(site_assumption(&self.log.loaded.rig))
    }

    fn report(&self) -> Option<Report> {
        let mut summary = self.summary();
        summary.extend(self.log.repairs());
        Some(Report {
            title: self.title(),
            subtitle: format!("rins align: {}", shown(&self.log.loaded.rig.log.path)),
            summary,
            sections: vec![Section {
                heading: "What was found".into(),
                intro: String::new(),
                items: vec![Item::Table(report_table(&rows(&self.found, &self.log.loaded)))],
            }],
        })
    }
}
