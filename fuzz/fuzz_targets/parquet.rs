//! Any bytes as a Parquet file.
#![no_main]

use std::sync::OnceLock;

use rins_io::Rig;

static RIG: OnceLock<Rig> = OnceLock::new();

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    rins_fuzz::log(
        &RIG,
        r#"path = "run.csv"
        format = "parquet"
        time = { column = "t", unit = "ns" }
        gyro = { columns = ["gx", "gy", "gz"], unit = "rad/s" }
        accel = { columns = ["ax", "ay", "az"], unit = "m/s^2" }"#,
        data,
    );
});
