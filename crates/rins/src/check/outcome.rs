//! A check as text, result and page.

use std::fmt;

use rins_io::shown;
use rins_report::{Report, Tone};

use super::Check;
use super::mends::mends_in_words;
use super::page::page;
use super::result::CheckResult;
use super::text::{judged, rests, rows};
use crate::basis::BasisResult;
use crate::log::{site_assumption, statics_in_words};
use crate::outcome::Outcome;
use crate::table::aligned;

impl Check<'_> {
    pub(super) fn title(&self) -> String {
        format!("Check of {}", self.log.name)
    }

    /// The items whose verdicts have this tone.
    fn of_tone(&self, tone: Tone) -> Vec<&str> {
        let of = self.verdicts.iter().filter(|verdict| verdict.tone == tone);
        of.map(|verdict| verdict.item).collect()
    }

    fn conclusion(&self) -> String {
        let (odd, bad) = (self.of_tone(Tone::Warning), self.of_tone(Tone::Bad));
        match (&odd[..], &bad[..]) {
            ([], []) if self.oddities.is_empty() => "no anomaly found".to_owned(),
            ([], []) => "no verdict is odd or bad; see the remarks above".to_owned(),
            (odd, []) => format!("odd: {}", odd.join(", ")),
            ([], bad) => format!("bad: {}", bad.join(", ")),
            (odd, bad) => format!("bad: {}; odd: {}", bad.join(", "), odd.join(", ")),
        }
    }
}

impl fmt::Display for Check<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (inspection, loaded) = (&self.inspection, &self.log.loaded);
        write!(f, "{}\n\n{}", self.title(), aligned(&rows(inspection, loaded)))?;
        if inspection.rests.len() > 1 {
            writeln!(f, "\n  static intervals\n{}", aligned(&rests(inspection, loaded)))?;
        }
        writeln!(f, "\n{}", aligned(&judged(&self.verdicts)[1..]))?;
        for line in statics_in_words(&inspection.static_intervals, &loaded.rig) {
            writeln!(f, "  {line}")?;
        }
        for oddity in &self.oddities {
            writeln!(f, "  ! {oddity}")?;
        }
        if let Some(mend) = mends_in_words(&self.mends) {
            writeln!(f, "  > {mend}")?;
        }
        writeln!(f, "  {}", self.conclusion())
    }
}

impl Outcome for Check<'_> {
    type Result = CheckResult;

    fn result(&self) -> CheckResult {
        CheckResult::of(self)
    }

    fn basis(&self) -> BasisResult {
        BasisResult::of_log(self.log).assuming(site_assumption(&self.log.loaded.rig))
    }

    fn report(&self) -> Option<Report> {
        Some(page(self))
    }

    fn failure(&self) -> Option<String> {
        let (suspected, bad) = (self.inspection.suspicions.len(), self.of_tone(Tone::Bad));
        let why = match bad.len() {
            _ if suspected > 0 => format!("{suspected} suspected mistake(s), see above"),
            0 => return None,
            _ => format!("bad: {}", bad.join(", ")),
        };
        Some(format!("{}: {why}", shown(&self.log.loaded.rig.path)))
    }
}
