//! Drafts for PSINS text logs, whose header states almost everything that a rig needs.

use std::io::Read;
use std::path::Path;

use rins_frames::units::{ARCSEC, DEG};

use super::page::{Page, short};
use super::{place, sections};
use crate::error::IoError;
use crate::log::{Lines, PsinsHeader, psins_header};
use crate::source;

/// The length of the beginning that is searched for comments that name the format \[bytes\].
const BEGINNING: u64 = 4096;

/// The header of the log at `path`, if it is a PSINS log: if its comments say so, or if it begins with three rows of six
/// numbers that are a plausible header.
///
/// # Errors
/// [`IoError`] if it cannot be read, or if its comments mention PSINS but its header is implausible.
pub(super) fn header(path: &Path) -> Result<Option<PsinsHeader>, IoError> {
    let says_so = says_so(path)?;
    match psins_header(&mut Lines::open(path)?) {
        Ok(header) => Ok(Some(header)),
        Err(error) if says_so => Err(error),
        Err(_) => Ok(None),
    }
}

/// Whether a comment near the beginning of the log mentions PSINS.
fn says_so(path: &Path) -> Result<bool, IoError> {
    let failed = || IoError::file("read", path);
    let mut beginning = Vec::new();
    let file = source::open(path).map_err(failed())?;
    file.take(BEGINNING).read_to_end(&mut beginning).map_err(failed())?;
    let text = String::from_utf8_lossy(&beginning);
    Ok(text.lines().any(|line| line.starts_with('%') && line.contains("PSINS")))
}

/// Drafts the rig file of a PSINS log.
pub(super) fn write(page: &mut Page, log: &Path, folder: &Path, header: &PsinsHeader) {
    let PsinsHeader { site, attitude, angle_scale, velocity_scale, .. } = header;
    page.section("log");
    place::path(page, log, folder);
    page.known("format", "\"psins\"");
    page.remark("This is a PSINS text log. rins reads from its header:");
    page.remark(&format!(
        "  place: latitude {} deg, longitude {} deg, height {} m",
        decimals(site.latitude / DEG),
        decimals(site.longitude / DEG),
        decimals(site.height)
    ));
    page.remark(&format!(
        "  rate: {} Hz, that is one row per {} ms; there is no time column, so gaps are not visible",
        short(1.0 / header.interval),
        short(header.interval * 1e3)
    ));
    page.remark(&format!(
        "  increments: of {} arcsec and {} ug*s (x axes), with g = {} m/s^2",
        short(angle_scale.x / ARCSEC),
        short(velocity_scale.x / header.gravity * 1e6),
        decimals(header.gravity)
    ));
    page.remark("  axes: x right, y forward, z up");
    page.optional("gyro.axes", r#"["x", "y", "z"]"#, "if the axes differ, with signs");
    page.optional("accel.axes", r#"["x", "y", "z"]"#, "likewise");
    page.blank();
    page.remark(
        "The place of the header is used unless [site] states another: latitude, longitude, height.",
    );
    page.remark(&format!(
        "Its attitude (pitch {}, roll {}, yaw {} deg) has no uncertainty and is not used.",
        decimals(attitude.pitch / DEG),
        decimals(attitude.roll / DEG),
        decimals(attitude.yaw / DEG)
    ));
    sections::attitude(page);
    page.blank();
    page.remark(
        "A PSINS log has no table angle. If the IMU was rotated, the commanded motion is needed.",
    );
    sections::profile(page);
    sections::imu(page);
    sections::default_spin(page);
}

/// A number of a header, without rounding errors of the unit conversion.
fn decimals(value: f64) -> String {
    let rounded = (value * 1e9).round() / 1e9;
    // Adding zero makes a negative zero positive.
    (rounded + 0.0).to_string()
}
