//! Any text as a quantity of every kind.
#![no_main]

use rins_io::quantity::kinds;

libfuzzer_sys::fuzz_target!(|text: &str| {
    for kind in [kinds::GYRO_BIAS, kinds::GYRO_NOISE, kinds::SAMPLE_RATE, kinds::RATIO] {
        if let Ok(value) = kind.parse(text) {
            assert!(value.is_finite());
        }
    }
});
