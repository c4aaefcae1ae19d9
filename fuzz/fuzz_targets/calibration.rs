//! Any text as a calibration file; what is read of one is written and read again as the same.
#![no_main]

use std::path::Path;

use rins_io::Calibration;

libfuzzer_sys::fuzz_target!(|text: &str| {
    let Ok(read) = Calibration::parse(text, Path::new("c.toml")) else { return };
    let again = Calibration::parse(&read.to_toml(), Path::new("c.toml"));
    let again = again.unwrap_or_else(|error| panic!("{error}\n{}", read.to_toml()));
    assert_eq!(again.sigmas.len(), read.sigmas.len());
    let close = |a: f64, b: f64| (a - b).abs() <= 1e-12 * a.abs().max(b.abs());
    for (old, new) in [(read.error.gyro, again.error.gyro), (read.error.accel, again.error.accel)] {
        assert!(old.bias.iter().zip(&new.bias).all(|(a, b)| close(*a, *b)));
        assert!(old.matrix.iter().zip(&new.matrix).all(|(a, b)| close(*a, *b)));
    }
});
