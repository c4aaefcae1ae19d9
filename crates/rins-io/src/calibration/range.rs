//! The range covered by the runs of a calibration: `[range]`.

use std::fmt::Write as _;

use rins_frames::units::DEG;

use crate::error::IoError;
use crate::quantity::kinds;
use crate::section::Section;

/// The range covered by the runs from which a calibration was made, as minimum and maximum.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct CalibratedRange {
    /// The temperature \[°C\].
    pub temperature: Option<[f64; 2]>,
    /// The rate about the spin axis, positive about the sensor's own axis \[rad/s\].
    pub rate: Option<[f64; 2]>,
}

/// Reads `[range]`, which may be left out.
pub(super) fn read(root: &Section<'_>) -> Result<CalibratedRange, IoError> {
    let Some(section) = root.section("range", &["temperature", "rate"])? else {
        return Ok(CalibratedRange::default());
    };
    Ok(CalibratedRange {
        temperature: section.celsius_range("temperature")?,
        rate: section.quantity_range("rate", &kinds::TABLE_RATE)?,
    })
}

/// The section, as it is written; nothing if nothing is known.
pub(super) fn written(range: &CalibratedRange) -> String {
    let mut text = String::new();
    if *range == CalibratedRange::default() {
        return text;
    }
    text.push_str(
        "\n# Range of the runs of the calibration; rate is about the spin axis.\n[range]\n",
    );
    // Writing to a string cannot fail.
    if let Some([low, high]) = range.temperature {
        let _ = writeln!(text, "temperature = [\"{low} degC\", \"{high} degC\"]");
    }
    if let Some([low, high]) = range.rate.map(|range| range.map(|rate| rate / DEG)) {
        let _ = writeln!(text, "rate = [\"{low} deg/s\", \"{high} deg/s\"]");
    }
    text
}
