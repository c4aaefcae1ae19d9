//! The assignment of columns, by their names or, if they have none, by their numbers.

use std::path::Path;

use super::evidence::{steady, turning_of_gravity};
use super::label::{Label, Role};
use super::pace::Pace;
use super::sample::{Run, Sample};
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
        let one = |role| one(sample, labels, role, pace);
        let mut layout = Self {
            gyro: three(sample, labels, Role::Gyro, pace),
            accel: three(sample, labels, Role::Accel, pace),
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
        let mut triads = triads(sample, labels, pace);
        for triad in &mut triads {
            along_axes(triad, labels);
        }
        let interval = pace.and_then(Pace::interval);
        let picked =
            |column, why: &str| Some(Picked { column, guess: Some(why.into()), increment: false });
        let is_accel = |triad: &[usize; 3]| accel_unit(sample, *triad, interval, false).is_ok();
        match triads[..] {
            [triad] => match sensor_by_file_name(path) {
                Some(Role::Gyro) => self.gyro = picked(triad, "by the name of the file"),
                Some(_) => self.accel = picked(triad, "by the name of the file"),
                None if is_accel(&triad) => {
                    self.accel = picked(triad, "their magnitude is that of gravity");
                }
                None => self.unknown = Some(triad),
            },
            [first, second] => {
                let (gyro, accel) = match (is_accel(&first), is_accel(&second)) {
                    (false, true) => (first, second),
                    (true, false) => (second, first),
                    // Gyros come first in most logs, and have more relative noise at rest.
                    _ if steady(sample, first).is_none() && steady(sample, second).is_some() => {
                        (first, second)
                    }
                    _ => return,
                };
                self.accel = picked(accel, "their magnitude is constant like that of gravity");
                self.gyro = picked(gyro, "the other three columns besides the accelerometers");
            }
            _ => {
                let mut accels = triads.iter().filter(|triad| is_accel(triad));
                let (Some(&accel), None) = (accels.next(), accels.next()) else { return };
                self.accel = picked(accel, "only their magnitude is constant like that of gravity");
                let turns = |triad: &&[usize; 3]| {
                    **triad != accel && turning_of_gravity(sample, **triad, accel).is_some()
                };
                let mut gyros = triads.iter().filter(turns);
                if let (Some(&gyro), None) = (gyros.next(), gyros.next()) {
                    self.gyro = picked(gyro, "gravity in the accelerometers rotates with them");
                }
            }
        }
    }
}

/// The triads among columns without meaningful names: three adjacent ones, of which one at least varies, and which are not a part
/// of an orientation.
fn triads(sample: &Sample, labels: &[Label], pace: Option<&Pace>) -> Vec<[usize; 3]> {
    let orientations = orientations(sample);
    let is_free = |column: usize| {
        labels[column].role.is_none()
            && !pace.is_some_and(|pace| pace.has(column))
            && sample.is_numeric(column)
            && !orientations.contains(&column)
    };
    let (varying, constant): (Vec<usize>, Vec<usize>) = (0..sample.count)
        .filter(|column| is_free(*column))
        .partition(|column| sample.varies(*column));
    // Covariances are constant. A coarse accelerometer at rest may be too, and then its triad is not complete without it.
    if let Some(triads) = whole_triads(&varying) {
        return triads;
    }
    let mut all = [varying.clone(), constant].concat();
    all.sort_unstable();
    let adjacent = all.chunk_by(|before, after| before + 1 == *after);
    let triads = adjacent.flat_map(|columns| columns.as_chunks::<3>().0.to_vec());
    triads.filter(|triad| triad.iter().any(|column| varying.contains(column))).collect()
}

/// Puts the columns of a triad in the order of their axes, if their names state three.
fn along_axes(triad: &mut [usize; 3], labels: &[Label]) {
    let mut ordered = *triad;
    ordered.sort_by_key(|column| labels[*column].axis);
    if ordered.map(|column| labels[column].axis) == [Some(0), Some(1), Some(2)] {
        *triad = ordered;
    }
}

/// The triads of adjacent columns; `None` if there are others beside them.
fn whole_triads(columns: &[usize]) -> Option<Vec<[usize; 3]>> {
    let adjacent = columns.chunk_by(|before, after| before + 1 == *after);
    let triads: Vec<_> = adjacent.map(<[usize]>::as_chunks::<3>).collect();
    let is_whole = triads.iter().all(|(_, rest)| rest.is_empty());
    is_whole.then(|| triads.iter().flat_map(|(triads, _)| triads.to_vec()).collect())
}

/// The columns of orientations. The zeros of a covariance may complete a quaternion too: the first four columns are taken.
fn orientations(sample: &Sample) -> Vec<usize> {
    let mut columns: Vec<usize> = Vec::new();
    for first in 0..sample.count.saturating_sub(3) {
        if !columns.contains(&first) && is_orientation(sample, first) {
            columns.extend(first..first + 4);
        }
    }
    columns
}

/// Whether the four columns from `first` on are a unit quaternion: the sum of their squares is 1 in every row, to within the last
/// decimal of their numbers.
///
/// Accelerometers in g beside a column of zeros have a sum near 1 only, because of noise.
fn is_orientation(sample: &Sample, first: usize) -> bool {
    let columns = first..first + 4;
    if !columns.clone().all(|column| sample.is_numeric(column)) {
        return false;
    }
    let rows = |run: &Run| -> Vec<[f64; 4]> {
        (0..run[first].len()).map(|row| [0, 1, 2, 3].map(|part| run[first + part][row])).collect()
    };
    let rows: Vec<[f64; 4]> = sample.runs.iter().flat_map(rows).collect();
    // With one decimal, many rows have such a sum; single precision has seven digits.
    let last = last_decimal(rows.as_flattened());
    let last = if last < 0.1 { last.max(1e-6) } else { 1e-6 };
    rows.iter().all(|row| {
        let squares: f64 = row.iter().map(|part| part * part).sum();
        let sum: f64 = row.iter().map(|part| part.abs()).sum();
        // Each part is rounded to half of its last decimal.
        (squares - 1.0).abs() <= sum * last
    })
}

/// The largest power of ten, at most 1, of which all numbers are multiples.
fn last_decimal(numbers: &[f64]) -> f64 {
    let are_multiples = |unit: &f64| {
        numbers.iter().all(|number| {
            let count = number / unit;
            (count - count.round()).abs() < 1e-4
        })
    };
    (0..9).map(|digits| 10_f64.powi(-digits)).find(are_multiples).unwrap_or_default()
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
fn three(
    sample: &Sample,
    labels: &[Label],
    role: Role,
    pace: Option<&Pace>,
) -> Option<Picked<[usize; 3]>> {
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
    let named = found.iter().find(|(sure, _)| *sure).or(found.first())?;
    // Of several accelerometers, some may be without gravity.
    let interval = pace.and_then(Pace::interval);
    let is_gravity =
        |(_, triad): &&(bool, [usize; 3])| accel_unit(sample, *triad, interval, false).is_ok();
    let mut with_gravity = found.iter().filter(is_gravity).filter(|_| role == Role::Accel);
    let only = with_gravity.next().filter(|_| with_gravity.next().is_none() && found.len() > 1);
    let (sure, column) = *only.unwrap_or(named);
    let others: Vec<String> = found
        .iter()
        .filter(|(_, triad)| *triad != column)
        .map(|(_, triad)| triad.map(|column| sample.name(column)).join(", "))
        .collect();
    let guess = match (others.is_empty(), sure) {
        (true, true) => None,
        (true, false) => Some("by their names".to_string()),
        (false, _) => {
            let why = if only.is_some() {
                "their magnitude is that of gravity"
            } else {
                "the first of several"
            };
            Some(format!("{why}; there are also {}", others.join("; ")))
        }
    };
    Some(Picked { column, guess, increment: labels[column[0]].increment })
}

/// The first column of a role.
fn one(
    sample: &Sample,
    labels: &[Label],
    role: Role,
    pace: Option<&Pace>,
) -> Option<Picked<usize>> {
    let has_attitude = labels.iter().any(|label| label.role == Some(Role::Attitude));
    let is_one = |column: &usize| {
        labels[*column].role == Some(role)
            // Beside other angles of an attitude, an azimuth is one too.
            && (labels[*column].sure || role != Role::TableAngle || !has_attitude)
            && sample.is_numeric(*column)
            && !pace.is_some_and(|pace| pace.has(*column))
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
