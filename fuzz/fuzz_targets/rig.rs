//! Any text as a rig file.
#![no_main]

use std::path::Path;

libfuzzer_sys::fuzz_target!(|text: &str| {
    let _ = rins_io::Rig::parse(text, Path::new("rig.toml"));
});
