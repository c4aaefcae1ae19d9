//! The content of a log, and its gross errors.

mod inspected;
mod mends;
mod oddities;
mod outcome;
mod page;
mod refusal;
mod result;
mod shows;
mod text;
mod units;
mod verdicts;
mod words;

use rins_inspection::Inspection;

pub(crate) use self::inspected::inspected;
use self::mends::{Mend, mends};
use self::oddities::oddities;
pub(crate) use self::refusal::refuse_mistaken;
pub use self::result::{CheckResult, CorrectionResult, GapResult, StaticMeanResult, VerdictResult};
pub(crate) use self::shows::steady_rates;
use self::verdicts::{Verdict, verdicts};
use crate::log::Log;

/// The content of a log, with a verdict on each possible gross error.
#[derive(Debug)]
pub struct Check<'a> {
    log: &'a Log,
    inspection: Inspection,
    oddities: Vec<String>,
    mends: Vec<Mend>,
    verdicts: Vec<Verdict>,
}

/// Inspects a log against the statements of its rig file.
///
/// ```
/// use rins::Outcome;
/// let folder = tempfile::tempdir()?;
/// let log = rins::demo::log(folder.path())?;
/// let check = rins::check(&log);
/// assert_eq!(check.failure(), None);
/// print!("{check}");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn check(log: &Log) -> Check<'_> {
    let loaded = &log.loaded;
    let inspection = inspected(loaded);
    Check {
        oddities: oddities(&inspection, loaded),
        mends: mends(&inspection, &loaded.rig),
        verdicts: verdicts(&inspection, loaded),
        inspection,
        log,
    }
}
