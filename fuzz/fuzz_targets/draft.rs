//! A rig file drafted from any bytes: it is one, but for what is left to fill in.
#![no_main]

use std::path::Path;

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let path = Path::new("run.csv");
    rins_io::fuzzing::put(path, data);
    let _ = rins_io::peek(path);
    if let Ok(draft) = rins_io::draft_rig(path, Path::new("")) {
        // What is wrong with a draft is never its syntax.
        if let Err(error) = rins_io::Rig::parse(&draft.text, Path::new("rig.toml")) {
            let said = error.to_string();
            assert!(!said.contains("duplicate key"), "{said}\n{}", draft.text);
        }
    }
});
