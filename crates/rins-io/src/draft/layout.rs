//! The assignment of columns, by their names or, if they have none, by their numbers.

use std::path::Path;

use super::evidence::steady;
use super::label::{Label, Role};
use super::pace::Pace;
use super::sample::Sample;
use super::units::accel_unit;

/// The assignment of columns.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Layout {
    pub(super) gyro: Option<Picked<[usize; 3]>>,
    pub(super) accel: Option<Picked<[usize; 3]>>,
    pub(super) table_angle: Option<Picked<usize>>,
    pub(super) table_rate: Option<Picked<usize>>,
    pub(super) temperature: Option<Picked<usize>>,
    /// A triad that is either gyros or accelerometers.
    pub(super) unknown: Option<[usize; 3]>,
}

/// A column, or three, and the reason for the selection.
#[derive(Clone, Debug, PartialEq)]
pub(super) struct Picked<T> {
    pub(super) column: T,
    /// The reason, if the names alone are not sufficient.
    pub(super) guess: Option<String>,
    /// Whether the names indicate increments.
    pub(super) increment: bool,
}

impl Layout {
    /// Finds the columns of the log at `path`.
    pub(super) fn find(
        path: &Path,
        sample: &Sample,
        labels: &[Label],
        pace: Option<&Pace>,
    ) -> Self {
        let time = pace.map(|pace| pace.column);
        let one = |role| one(sample, labels, role, time);
        let mut layout = Self {
            gyro: three(sample, labels, Role::Gyro),
            accel: three(sample, labels, Role::Accel),
            table_angle: one(Role::TableAngle),
            table_rate: one(Role::TableRate),
            temperature: one(Role::Temperature),
            unknown: None,
        };
        if layout.gyro.is_none() && layout.accel.is_none() && sample.kinds.is_empty() {
            layout.by_numbers(path, sample, labels, pace);
        }
        layout
    }

    /// Finds gyros and accelerometers among columns without meaningful names.
    fn by_numbers(&mut self, path: &Path, sample: &Sample, labels: &[Label], pace: Option<&Pace>) {
        let time = pace.map(|pace| pace.column);
        let is_free = |column: &usize| {
            labels[*column].role.is_none() && Some(*column) != time && sample.is_numeric(*column)
        };
        let free: Vec<usize> = (0..sample.count).filter(is_free).collect();
        let (triads, _) = free.as_chunks::<3>();
        let interval = pace.and_then(Pace::interval);
        let picked =
            |column, why: &str| Some(Picked { column, guess: Some(why.into()), increment: false });
        match triads {
            [triad] => match sensor_by_file_name(path) {
                Some(Role::Gyro) => self.gyro = picked(*triad, "by the name of the file"),
                Some(_) => self.accel = picked(*triad, "by the name of the file"),
                None if accel_unit(sample, *triad, interval, false).is_ok() => {
                    self.accel = picked(*triad, "their magnitude is that of gravity");
                }
                None => self.unknown = Some(*triad),
            },
            [first, second, ..] => {
                let is_accel =
                    |triad: &[usize; 3]| accel_unit(sample, *triad, interval, false).is_ok();
                let (gyro, accel) = match (is_accel(first), is_accel(second)) {
                    (false, true) => (first, second),
                    (true, false) => (second, first),
                    // Gyros come first in most logs, and have more relative noise at rest.
                    _ if steady(sample, *first).is_none() && steady(sample, *second).is_some() => {
                        (first, second)
                    }
                    _ => return,
                };
                self.accel = picked(*accel, "their magnitude is constant like that of gravity");
                self.gyro = picked(*gyro, "the other three columns besides the accelerometers");
            }
            [] => {}
        }
    }
}

/// The sensor that the name of a file contains.
pub(super) fn sensor_by_file_name(path: &Path) -> Option<Role> {
    let name = path.file_stem()?.to_str()?.to_lowercase();
    match (name.contains("gyr"), name.contains("acc")) {
        (true, false) => Some(Role::Gyro),
        (false, true) => Some(Role::Accel),
        _ => None,
    }
}

/// The first complete triad of a role; unambiguous names take precedence.
fn three(sample: &Sample, labels: &[Label], role: Role) -> Option<Picked<[usize; 3]>> {
    let is_part = |column: &usize| {
        let label = &labels[*column];
        label.role == Some(role) && label.axis.is_some() && sample.is_numeric(*column)
    };
    let columns: Vec<usize> = (0..sample.count).filter(is_part).collect();
    let mut found: Vec<(bool, [usize; 3])> = Vec::new();
    for &first in columns.iter().filter(|column| labels[**column].axis == Some(0)) {
        let of_axis = |axis| {
            let belongs = |column: &&usize| {
                labels[**column].axis == Some(axis) && labels[**column].stem == labels[first].stem
            };
            // If names repeat, each axis is the nearest column after the x axis.
            let mut after = columns.iter().filter(|column| **column >= first);
            after.find(belongs).or_else(|| columns.iter().find(belongs)).copied()
        };
        if let (Some(y), Some(z)) = (of_axis(1), of_axis(2)) {
            found.push((labels[first].sure, [first, y, z]));
        }
    }
    let (sure, column) = *found.iter().find(|(sure, _)| *sure).or(found.first())?;
    let others: Vec<String> = found
        .iter()
        .filter(|(_, triad)| *triad != column)
        .map(|(_, triad)| triad.map(|column| sample.name(column)).join(", "))
        .collect();
    let guess = match (others.is_empty(), sure) {
        (true, true) => None,
        (true, false) => Some("by their names".to_string()),
        (false, _) => Some(format!("the first of several; there are also {}", others.join("; "))),
    };
    Some(Picked { column, guess, increment: labels[column[0]].increment })
}

/// The first column of a role.
fn one(
    sample: &Sample,
    labels: &[Label],
    role: Role,
    time: Option<usize>,
) -> Option<Picked<usize>> {
    let is_one = |column: &usize| {
        labels[*column].role == Some(role) && sample.is_numeric(*column) && Some(*column) != time
    };
    let found: Vec<usize> = (0..sample.count).filter(is_one).collect();
    let sure = found.iter().find(|column| labels[**column].sure);
    let column = *sure.or(found.first())?;
    let others: Vec<String> =
        found.iter().filter(|other| **other != column).map(|other| sample.name(*other)).collect();
    let guess = match (others.is_empty(), labels[column].sure) {
        (true, true) => None,
        (true, false) => Some("by its name".to_string()),
        (false, _) => Some(format!("the first of several; there is also {}", others.join(", "))),
    };
    Some(Picked { column, guess, increment: false })
}
