//! Any bytes as PSINS' rows of doubles.
#![no_main]

use std::sync::OnceLock;

use rins_io::Rig;

static RIG: OnceLock<Rig> = OnceLock::new();

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    rins_fuzz::log(
        &RIG,
        r#"path = "run.csv"
        format = "psins-bin"
        gaps = "accumulated""#,
        data,
    );
});
