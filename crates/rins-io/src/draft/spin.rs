//! The section `[axis]` of a draft, from the evidence in the log.

use super::channels::Channels;
use super::evidence::spin_axis;
use super::page::{Page, text};
use super::sample::Sample;
use super::sections::default_spin;

/// Writes the axis about which the IMU was rotated.
pub(super) fn spin(page: &mut Page, sample: &Sample, channels: &Channels) {
    let table = channels.table.as_ref().map(|table| (table.column, table.is_angle));
    let found = channels.gyro.and_then(|gyro| spin_axis(sample, gyro, table));
    let Some((axis, share)) = found else { return default_spin(page) };
    page.section("axis");
    let share = (share * 1e3).floor() / 10.0;
    let by = if table.is_some() { " during the table motion" } else { "" };
    page.guess("spin", &text(&axis), &format!("{share} % of the rotation is about it{by}"));
}
