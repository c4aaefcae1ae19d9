//! Any bytes as a CSV log.
#![no_main]

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    if let Some((choice, bytes)) = data.split_first() {
        rins_fuzz::csv(*choice, bytes);
    }
});
