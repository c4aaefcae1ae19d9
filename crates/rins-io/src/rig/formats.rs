//! Log formats with fixed columns, units and axes.

use super::axes::Axes;
use super::log_spec::{ColumnSpec, Reading, Stamp, Table, TimeColumn, TimeUnit, TriadColumns};
use super::novatel;
use super::readings::{ACCEL, GYRO, refuse_own, scale_of, unit};
use crate::error::IoError;
use crate::section::{Section, quoted};
use std::path::Path;

/// A format with fixed columns.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(super) enum Fixed {
    /// KF-GINS increments as text: time, angles and velocities; front, right, down.
    KfGins,
    /// PSINS increments as doubles: angles, velocities, time; right, front, up.
    PsinsBinary,
    /// Rates of the EuRoC data set as text, which Kalibr also reads: time in ns, rates, forces.
    Euroc,
    /// NovAtel RAWIMU messages: counts.
    NovAtel,
}

impl Fixed {
    /// The name in a rig file.
    fn name(self) -> &'static str {
        match self {
            Self::KfGins => "kf-gins",
            Self::PsinsBinary => "psins-bin",
            Self::Euroc => "euroc",
            Self::NovAtel => "novatel",
        }
    }

    fn table(self) -> Table {
        match self {
            Self::KfGins => Table::Numbers,
            Self::Euroc => Table::Text,
            Self::PsinsBinary => Table::Doubles(7),
            Self::NovAtel => Table::NovAtel,
        }
    }

    /// From the axes of the log to right, front, up.
    pub(super) fn axes(self) -> Axes {
        match self {
            Self::KfGins => Axes::FRONT_RIGHT_DOWN,
            Self::PsinsBinary | Self::Euroc | Self::NovAtel => Axes::IDENTITY,
        }
    }

    /// The columns of the log at `path`.
    pub(super) fn columns(
        self,
        log: &Section<'_>,
        triads: [Option<&Section<'_>>; 2],
        path: &Path,
    ) -> Result<ColumnSpec, IoError> {
        let name = self.name();
        refuse_own(log, &["time"], &format!("the time column of a {name} log is fixed"))?;
        let own: &[&str] = match self {
            Self::NovAtel if !log.has("imu") => &["path", "columns", "offset", "time"],
            _ => &["path", "columns", "unit", "scale", "offset", "time"],
        };
        for triad in triads.into_iter().flatten() {
            refuse_own(triad, own, &format!("a {name} log's columns are fixed"))?;
        }
        let (gyro, accel) = match self {
            Self::KfGins | Self::PsinsBinary => (Reading::Increment(1.0), Reading::Increment(1.0)),
            Self::Euroc => (Reading::Rate(1.0), Reading::Rate(1.0)),
            Self::NovAtel => counts(log, triads)?,
        };
        let (time, gyros, accels, seconds) = match self {
            Self::KfGins => ("1", ["2", "3", "4"], ["5", "6", "7"], 1.0),
            Self::PsinsBinary => ("7", ["1", "2", "3"], ["4", "5", "6"], 1.0),
            Self::Euroc => ("1", ["2", "3", "4"], ["5", "6", "7"], 1e-9),
            Self::NovAtel => {
                let gyros = ["gyro_x", "gyro_y", "gyro_z"];
                ("time", gyros, ["accel_x", "accel_y", "accel_z"], 1.0)
            }
        };
        let triad = |columns: [&str; 3], reading, section| -> Result<TriadColumns, IoError> {
            let scale = match section {
                Some(section) => scale_of(section)?,
                None => [1.0; 3],
            };
            Ok(TriadColumns {
                rows: None,
                path: path.into(),
                columns: columns.map(|name| Some(name.into())),
                reading,
                offset: [0.0; 3],
                scale,
            })
        };
        let unit = TimeUnit::Seconds(seconds);
        let time = Some(TimeColumn { column: time.into(), unit, split: None, stamp: Stamp::End });
        let [gyro_section, accel_section] = triads;
        let gyro = triad(gyros, gyro, gyro_section)?;
        let accel = triad(accels, accel, accel_section)?;
        Ok(ColumnSpec::of(self.table(), time, gyro, accel))
    }
}

/// The scale of a NovAtel log's counts: that of a known IMU, or that in the rig file.
fn counts(
    log: &Section<'_>,
    triads: [Option<&Section<'_>>; 2],
) -> Result<(Reading, Reading), IoError> {
    let expected = || format!("one of {}", quoted(novatel::IMUS));
    if let Some(imu) = log.text("imu", &expected())? {
        return novatel::counts(imu).ok_or_else(|| log.not_allowed("imu", &expected()));
    }
    let mut readings = [Reading::Increment(1.0); 2];
    for ((reading, section), known) in readings.iter_mut().zip(triads).zip([&GYRO, &ACCEL]) {
        let stated = section.filter(|section| section.has("unit") && section.has("scale"));
        let Some(section) = stated else {
            let expected =
                format!("the IMU's model, {}; or unit and scale of gyro and accel", expected());
            return Err(log.missing("imu", expected));
        };
        let unit = unit(section, &[known.rate, known.increment], known)?;
        *reading = if unit.dimension == known.rate {
            Reading::Rate(unit.factor)
        } else {
            Reading::Increment(unit.factor)
        };
    }
    let [gyro, accel] = readings;
    Ok((gyro, accel))
}
