//! Any text as a model file; what is read of one is written and read again as the same.
#![no_main]

use std::path::Path;

use rins_io::ModelFile;

libfuzzer_sys::fuzz_target!(|text: &str| {
    let Ok(read) = ModelFile::parse(text, Path::new("model.toml")) else { return };
    let written = read.to_toml();
    let again = ModelFile::parse(&written, Path::new("model.toml"));
    let again = again.unwrap_or_else(|error| panic!("{error}\n{written}"));
    let what = |file: &ModelFile| -> Vec<_> {
        file.model.terms.iter().map(|term| (term.term.id, term.settings.len())).collect()
    };
    assert_eq!(what(&again), what(&read));
});
