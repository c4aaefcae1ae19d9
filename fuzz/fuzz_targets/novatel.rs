//! NovAtel messages; a checksum that is not to be wrong is set right.
#![no_main]

use std::sync::OnceLock;

use rins_io::Rig;

static RIG: OnceLock<Rig> = OnceLock::new();

libfuzzer_sys::fuzz_target!(|data: &[u8]| {
    let Some((right, data)) = data.split_first() else { return };
    let mut bytes = Vec::new();
    for line in data.split_inclusive(|byte| *byte == b'\n') {
        let star = line.iter().rposition(|byte| *byte == b'*').filter(|star| *star > 0);
        match star.filter(|_| right & 1 == 0) {
            Some(star) => {
                bytes.extend(&line[..=star]);
                bytes.extend(format!("{:08x}\n", checksum(&line[1..star])).bytes());
            }
            None => bytes.extend(line),
        }
    }
    rins_fuzz::log(
        &RIG,
        r#"path = "run.csv"
        format = "novatel"
        imu = "HG1700-AG58"
        gaps = "held""#,
        &bytes,
    );
});

fn checksum(bytes: &[u8]) -> u32 {
    bytes.iter().fold(0, |sum, &byte| {
        (0..8).fold(sum ^ u32::from(byte), |sum, _| {
            if sum & 1 == 1 { (sum >> 1) ^ 0xEDB8_8320 } else { sum >> 1 }
        })
    })
}
