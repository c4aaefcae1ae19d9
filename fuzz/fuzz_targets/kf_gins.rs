//! Any bytes as KF-GINS' text.
#![no_main]

use std::sync::OnceLock;

use rins_io::Rig;

static RIG: OnceLock<Rig> = OnceLock::new();

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    rins_fuzz::log(
        &RIG,
        r#"path = "run.csv"
        format = "kf-gins"
        gaps = "held""#,
        data,
    );
});
