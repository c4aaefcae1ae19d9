//! MATLAB files made of elements.
#![no_main]

use std::sync::OnceLock;

use rins_fuzz::elements::File;
use rins_io::Rig;

static RIG: OnceLock<Rig> = OnceLock::new();

libfuzzer_sys::fuzz_target!(|file: File| {
    rins_fuzz::log(
        &RIG,
        r#"path = "run.csv"
        format = "mat"
        time = { column = "t", unit = "s" }
        gyro = { columns = ["imu(:,1)", "imu(:,2)", "s.gyro(:,1)"], unit = "rad" }
        accel = { columns = ["accel", "imu(:,3)", "s.accel"], unit = "m/s" }
        gaps = "accumulated""#,
        &file.bytes(),
    );
});
