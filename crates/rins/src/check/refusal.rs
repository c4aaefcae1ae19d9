//! Refusal of runs with gross errors, whose results would be meaningless.

use rins_io::{Loaded, shown};

use super::inspected::inspected;
use super::mends::{mends, mends_in_words};
use super::words::suspicion_in_words;

/// Refuses a run whose units, signs or axes are wrong.
pub(crate) fn refuse_mistaken(loaded: &Loaded) -> anyhow::Result<()> {
    anyhow::ensure!(
        loaded.rig.log.is_complete(),
        "{}: the log does not have three gyros and three accelerometers",
        shown(&loaded.rig.path)
    );
    let inspection = inspected(loaded);
    let mut mistaken: Vec<String> = inspection.suspicions.iter().map(suspicion_in_words).collect();
    mistaken.extend(mends_in_words(&mends(&inspection, &loaded.rig)));
    anyhow::ensure!(
        mistaken.is_empty(),
        "{}: {}",
        shown(&loaded.rig.path),
        mistaken.join("; and ")
    );
    Ok(())
}
