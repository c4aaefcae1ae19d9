//! Any bytes as a MATLAB level 5 file.
#![no_main]

use std::sync::OnceLock;

use rins_io::Rig;

static RIG: OnceLock<Rig> = OnceLock::new();

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    rins_fuzz::log(
        &RIG,
        r#"path = "run.csv"
        format = "mat"
        time = { column = "imu(:,7)", unit = "s" }
        gyro = { columns = ["imu(:,1)", "imu(:,2)", "imu(:,3)"], unit = "rad" }
        accel = { columns = ["imu(:,4)", "imu(:,5)", "imu(:,6)"], unit = "m/s" }
        gaps = "accumulated""#,
        data,
    );
});
