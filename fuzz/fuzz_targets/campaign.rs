//! Any bytes as the results of a campaign.
#![no_main]

use std::path::Path;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let path = Path::new("part.parquet");
    rins_io::fuzzing::put(path, data);
    let Ok(mut runs) = rins_io::PartRuns::open(path) else { return };
    while let Some(Ok(rows)) = runs.next() {
        // A run has a row for each parameter, and one at least.
        let row = &rows[0];
        let heading = runs.heading();
        let values = usize::try_from(row.cell).ok().and_then(|cell| heading.values.get(cell));
        assert!(values.is_some_and(|values| values.len() == heading.keys.len()));
    }
});
