//! Any bytes as the results of a campaign.
#![no_main]

use std::path::Path;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let path = Path::new("part.parquet");
    rins_io::fuzzing::put(path, data);
    if let Ok(part) = rins_io::read_part(path) {
        for row in &part.rows {
            let values = usize::try_from(row.cell).ok().and_then(|cell| part.heading.values.get(cell));
            assert!(values.is_some_and(|values| values.len() == part.heading.keys.len()));
        }
    }
});
