//! Any text as a scenario file.
#![no_main]

use std::path::Path;

libfuzzer_sys::fuzz_target!(|text: &str| {
    let _ = rins_io::ScenarioFile::parse(text, Path::new("scenario.toml"));
});
