//! NovAtel logs in ASCII, known by the names of their messages.

use std::path::Path;

use super::page::{Page, text};
use super::{place, sections};
use crate::error::IoError;
use crate::log::{Lines, RawImu};
use crate::rig::novatel_imu;

/// The lines at the beginning of a log among which a RAWIMU message is looked for.
const BEGINNING: usize = 500;

/// The first RAWIMU message of the log at `path`, if it has one near its beginning.
///
/// # Errors
/// [`IoError`] if the log cannot be read.
pub(super) fn messages(path: &Path) -> Result<Option<RawImu>, IoError> {
    let mut lines = Lines::messages(path)?;
    for _ in 0..BEGINNING {
        // What is not text is told by the reader of columns.
        let Ok(Some((_, line))) = lines.next() else { return Ok(None) };
        if let Some(message) = RawImu::of(line) {
            return Ok(Some(message));
        }
    }
    Ok(None)
}

/// Drafts the rig of a NovAtel log.
pub(super) fn write(page: &mut Page, log: &Path, folder: &Path, messages: RawImu) {
    sections::site(page);
    page.section("log");
    place::path(page, log, folder);
    page.known("format", &text("novatel"));
    match messages.kind.map(|kind| (kind, novatel_imu(kind))) {
        Some((kind, Some(imu))) => {
            page.guess("imu", &text(imu), &format!("its messages state the IMU type {kind}"));
        }
        Some((kind, None)) => page.leave(
            "imu",
            r#""?""#,
            &format!("the IMU, such as \"ISA-100C\"; its messages state the unknown type {kind}"),
        ),
        None => page.leave(
            "imu",
            r#""?""#,
            "the IMU, such as \"ISA-100C\": the unit of its counts depends on it",
        ),
    }
    page.remark("The RAWIMU messages have the time and all readings, along the axes that are marked on the IMU.");
    page.optional("gyro.axes", r#"["x", "y", "z"]"#, "if the axes differ, with signs");
    page.optional("accel.axes", r#"["x", "y", "z"]"#, "likewise");
    sections::attitude(page);
    sections::profile(page);
    sections::imu(page);
    sections::default_spin(page);
}
