//! Any text as a scenario file with a grid.
#![no_main]

use std::path::Path;

libfuzzer_sys::fuzz_target!(|text: &str| {
    if let Ok(grid) = rins_io::ScenarioGrid::parse(text, Path::new("scenario.toml")) {
        assert!(!grid.cells.is_empty());
        assert!(grid.cells.iter().all(|cell| cell.values.len() == grid.keys.len()));
    }
});
