//! The units of readings that a rig file states.

use rins_inspection::{ReadingOf, ReadingUnit};
use rins_io::{LogFormat, LogSpec, Reading, TriadColumns};

/// The stated units, as far as they are common units.
#[derive(Default)]
pub(super) struct SaidUnits {
    pub(super) gyro: Option<ReadingUnit>,
    pub(super) accel: Option<ReadingUnit>,
    pub(super) table: Option<ReadingUnit>,
}

/// The stated units of a log's readings; none for a PSINS text log, whose format defines them.
pub(super) fn said_units(log: &LogSpec) -> SaidUnits {
    let LogFormat::Columns(columns) = &log.format else { return SaidUnits::default() };
    let angle = columns.table_angle.as_ref().map(|angle| Reading::Increment(angle.factor.abs()));
    let rate = columns.table_rate.as_ref().map(|rate| Reading::Rate(rate.factor.abs()));
    SaidUnits {
        gyro: of_triad(&ReadingUnit::GYRO, &columns.gyro),
        accel: of_triad(&ReadingUnit::ACCEL, &columns.accel),
        table: angle
            .and_then(|angle| named(&ReadingUnit::TABLE_ANGLE, angle))
            .or_else(|| rate.and_then(|rate| named(&ReadingUnit::TABLE_RATE, rate))),
    }
}

/// `None` for raw counts: their scale is a possible error of its own.
fn of_triad(units: &[ReadingUnit], triad: &TriadColumns) -> Option<ReadingUnit> {
    let plain = triad.scale.iter().all(|scale| (scale - 1.0).abs() <= 0.0);
    named(units, triad.reading).filter(|_| plain)
}

fn named(units: &[ReadingUnit], reading: Reading) -> Option<ReadingUnit> {
    let (of, factor) = match reading {
        Reading::Rate(factor) => (ReadingOf::Rate, factor),
        Reading::Increment(factor) => (ReadingOf::Increment, factor),
    };
    let is = |unit: &&ReadingUnit| unit.of == of && (unit.factor / factor - 1.0).abs() < 1e-9;
    units.iter().find(is).copied()
}
