//! The tolerances of an IMU: `[tolerance.gyro]` and `[tolerance.accel]`.

use rins_imu::{ImuError, TriadError};

use crate::error::IoError;
use crate::parameter::{self, ACCEL, GYRO, LeftOut, TriadKeys};
use crate::section::Section;

/// The keys of the section.
const TRIADS: [&str; 2] = ["gyro", "accel"];

/// Reads the section, whose numbers are the largest permitted magnitudes; zero where none is stated.
pub(super) fn read(root: &Section<'_>) -> Result<Option<ImuError>, IoError> {
    let Some(section) = root.section("tolerance", &TRIADS)? else { return Ok(None) };
    let triad = |keys: &TriadKeys, name: &str| -> Result<TriadError, IoError> {
        let Some(own) = section.section(name, &parameter::KEYS)? else {
            return Ok(TriadError::default());
        };
        let triad = parameter::read(&own, keys, LeftOut::Zero)?;
        let limit = "limits of magnitude, which are not negative";
        let matrix = &triad.matrix;
        let is_misaligned = (0..9).any(|place| place % 4 != 0 && matrix[place] < 0.0);
        match () {
            () if triad.bias.min() < 0.0 => Err(own.not_allowed("bias", limit)),
            () if matrix.diagonal().min() < 0.0 => Err(own.not_allowed("scale", limit)),
            () if is_misaligned => Err(own.not_allowed("misalignment", limit)),
            () => Ok(triad),
        }
    };
    Ok(Some(ImuError { gyro: triad(&GYRO, "gyro")?, accel: triad(&ACCEL, "accel")? }))
}
