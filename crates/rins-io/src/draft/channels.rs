//! The keys of the gyros and accelerometers in a draft, and the source of their units.

use std::path::{Path, PathBuf};

use rins_frames::units::STANDARD_GRAVITY;

use super::clock_keys;
use super::evidence::steady;
use super::findings::Findings;
use super::label::{Label, Role};
use super::layout::{Picked, sensor_by_file_name};
use super::page::{Page, list, short, text};
use super::place::between;
use super::sample::Sample;
use super::stated::Stated;
use super::table_keys::Table;
use super::units::{Surroundings, UnitFound, accel_unit};
use crate::quantity::{Dimension, Unit};

/// The unit of a triad's numbers.
#[derive(Clone, Debug, PartialEq)]
pub(super) enum Measured {
    /// The header states it.
    Stated(String),
    /// A guess, with its reason.
    Guess(String, String),
    /// Unknown; the text describes what the numbers indicate.
    Unknown(String),
}

impl Measured {
    fn text(&self) -> Option<&str> {
        match self {
            Self::Stated(text) | Self::Guess(text, _) => Some(text),
            Self::Unknown(_) => None,
        }
    }

    fn unit(&self) -> Option<Unit> {
        Unit::parse(self.text()?).ok()
    }

    fn of(found: Result<UnitFound, String>) -> Self {
        match found {
            Ok(UnitFound { text, why }) => Self::Guess(text.into(), why),
            Err(seen) => Self::Unknown(seen),
        }
    }
}

/// The columns of the gyros and accelerometers, with their units.
#[derive(Clone, Debug)]
pub(super) struct Channels {
    pub(super) gyro: Option<[usize; 3]>,
    pub(super) accel: Option<[usize; 3]>,
    gyro_unit: Measured,
    accel_unit: Measured,
    /// Whether gravity rotates opposite to the gyros' indication.
    contrary: bool,
    pub(super) table: Option<Table>,
}

impl Channels {
    pub(super) fn find(findings: Findings<'_>) -> Self {
        let Findings { sample, labels, layout, .. } = findings;
        let interval = findings.interval();
        let accel = layout.accel.as_ref().map(|picked| picked.column);
        let gyro = layout.gyro.as_ref().map(|picked| picked.column);
        let accel_unit = match &layout.accel {
            Some(picked) => accel_measured(sample, labels, picked, interval),
            None => Measured::Unknown(String::new()),
        };
        let stated = Table::stated(labels, layout);
        let surroundings = Surroundings { sample, interval, accel, table: stated };
        let gyro_unit = match &layout.gyro {
            Some(picked) => gyro_measured(labels, picked, &surroundings),
            None => Measured::Unknown(String::new()),
        };
        let turn =
            gyro_unit.unit().and_then(|unit| per_row(unit, Dimension::ANGULAR_RATE, interval));
        let table = Table::find(findings, gyro.zip(turn));
        let contrary =
            gyro.is_some_and(|gyro| surroundings.by_gravity(gyro).is_some_and(|k| k < 0.0));
        Self { gyro, accel, gyro_unit, accel_unit, contrary, table }
    }

    /// Whether the log has the columns and axes of a KF-GINS increments file.
    pub(super) fn looks_like_kf_gins(&self, sample: &Sample) -> bool {
        let down = |accel| steady(sample, accel).is_some_and(|s| s.mean.z < -0.7 * s.norm);
        sample.names.is_none()
            && sample.count == 7
            && self.gyro == Some([1, 2, 3])
            && self.accel == Some([4, 5, 6])
            && self.accel_unit.text() == Some("m/s")
            && self.accel.is_some_and(down)
    }

    pub(super) fn write(&self, page: &mut Page, findings: Findings<'_>) {
        let Findings { sample, layout, pace, .. } = findings;
        if let Some(unknown) = layout.unknown {
            let names = list(unknown.map(|column| sample.name(column)).iter().map(String::as_str));
            page.remark(&format!(
                "Columns {names} are gyros or accelerometers; the data do not show which."
            ));
            page.remark(
                "The others may be in another file; gyro.path or accel.path is then its name.",
            );
        }
        let gyro = Triad { key: "gyro", role: Role::Gyro, picked: layout.gyro.as_ref() };
        gyro.write(page, findings, &self.gyro_unit);
        let accel = Triad { key: "accel", role: Role::Accel, picked: layout.accel.as_ref() };
        accel.write(page, findings, &self.accel_unit);
        if let Some(seen) = self.accel.and_then(|accel| steady(sample, accel)) {
            let axis = seen.mean.iamax();
            if seen.mean[axis] < -0.9 * seen.norm {
                let name = ["x", "y", "z"][axis];
                page.remark(&format!(
                    "Static, accel {name} reads minus gravity: it points down, or the log gives gravity, not"
                ));
                page.remark("specific force; then accel.axes = [\"-x\", \"-y\", \"-z\"].");
            }
        }
        if self.contrary {
            page.remark(
                "Gravity and gyros rotate in opposite directions: axes of one triad are \
                         exchanged or reversed.",
            );
        }
        page.optional(
            "gyro.axes",
            r#"["x", "y", "z"]"#,
            "the sensor axis along each body axis, with signs",
        );
        page.optional("accel.axes", r#"["x", "y", "z"]"#, "likewise");
        let increments =
            [(&self.gyro_unit, Dimension::ANGLE), (&self.accel_unit, Dimension::VELOCITY)];
        if increments.iter().any(|(unit, kind)| unit.unit().is_some_and(|u| u.dimension == *kind)) {
            clock_keys::gaps(page, pace);
        }
    }
}

/// The increment per row of one count, in SI units.
fn per_row(unit: Unit, rate: Dimension, interval: Option<f64>) -> Option<f64> {
    if unit.dimension == rate { Some(unit.factor * interval?) } else { Some(unit.factor) }
}

/// The unit that the names of all three columns state, if it has one of these dimensions.
fn stated(labels: &[Label], triad: [usize; 3], kinds: [Dimension; 2]) -> Option<&Stated> {
    let [x, y, z] = triad.map(|column| labels[column].unit.as_ref());
    let agreed = x.filter(|_| x == y && y == z)?;
    kinds.contains(&agreed.unit.dimension).then_some(agreed)
}

fn as_stated(stated: &Stated, doubt: Option<String>) -> Measured {
    let text = stated.text.clone();
    match doubt {
        Some(doubt) => Measured::Guess(text, format!("stated in the header, but {doubt}")),
        None if stated.by_ending => {
            Measured::Guess(text, "by the ending of the columns' names".into())
        }
        None => Measured::Stated(text),
    }
}

fn accel_measured(
    sample: &Sample,
    labels: &[Label],
    picked: &Picked<[usize; 3]>,
    interval: Option<f64>,
) -> Measured {
    let kinds = [Dimension::ACCELERATION, Dimension::VELOCITY];
    let Some(stated) = stated(labels, picked.column, kinds) else {
        return Measured::of(accel_unit(sample, picked.column, interval, picked.increment));
    };
    let gain = per_row(stated.unit, kinds[0], interval).unwrap_or(stated.unit.factor);
    let gravity =
        steady(sample, picked.column).map(|seen| seen.norm * gain / interval.unwrap_or(1.0));
    let doubt = gravity.filter(|gravity| (gravity / STANDARD_GRAVITY).ln().abs() > 1.2_f64.ln());
    as_stated(stated, doubt.map(|gravity| format!("gravity is then {} m/s^2", short(gravity))))
}

fn gyro_measured(
    labels: &[Label],
    picked: &Picked<[usize; 3]>,
    surroundings: &Surroundings<'_>,
) -> Measured {
    let kinds = [Dimension::ANGULAR_RATE, Dimension::ANGLE];
    let Some(stated) = stated(labels, picked.column, kinds) else {
        return Measured::of(surroundings.gyro_unit(picked.column, picked.increment));
    };
    let gain = per_row(stated.unit, kinds[0], surroundings.interval);
    // A name such as gyro_rad may mean rad/s.
    let turn = surroundings.by_table(picked.column).or(surroundings.by_gravity(picked.column));
    let is_other = |(turn, gain): (f64, f64)| (gain / turn.abs()).ln().abs() > 1.6_f64.ln();
    if stated.by_ending && turn.zip(gain).is_some_and(is_other) {
        return Measured::of(surroundings.gyro_unit(picked.column, picked.increment));
    }
    if stated.by_ending && stated.unit.dimension == kinds[1] && turn.is_none() && !picked.increment
    {
        let unit = &stated.text;
        return Measured::Unknown(format!("the names end in {unit}, which may mean {unit}/s"));
    }
    let ratio = surroundings.by_table(picked.column).zip(gain).map(|(turn, gain)| gain / turn);
    let doubt = ratio.filter(|ratio| ratio.ln().abs() > 1.1_f64.ln());
    as_stated(
        stated,
        doubt.map(|ratio| {
            format!("their rotation is then {} times that of the table", short(ratio))
        }),
    )
}

/// The keys of a triad.
struct Triad<'l> {
    key: &'static str,
    role: Role,
    picked: Option<&'l Picked<[usize; 3]>>,
}

impl Triad<'_> {
    fn write(&self, page: &mut Page, findings: Findings<'_>, unit: &Measured) {
        let sample = findings.sample;
        let key = |name: &str| format!("{}.{name}", self.key);
        let units = match self.role {
            Role::Gyro => r#""deg/s", "rad/s", "deg/h"; or increments "deg", "rad", "arcsec""#,
            _ => r#""m/s^2", "g", "mg"; or increments "m/s", "ug*s""#,
        };
        let Some(picked) = self.picked else {
            return self.write_absent(page, findings, units);
        };
        let names =
            list(picked.column.map(|column| sample.name(column)).iter().map(String::as_str));
        match &picked.guess {
            None => page.known(&key("columns"), &names),
            Some(why) => page.guess(&key("columns"), &names, why),
        }
        match unit {
            Measured::Stated(unit) => page.known(&key("unit"), &text(unit)),
            Measured::Guess(unit, why) => page.guess(&key("unit"), &text(unit), why),
            Measured::Unknown(seen) => {
                page.remark(&format!("The unit of the {} is not stated; {seen}.", self.sensors()));
                page.leave(&key("unit"), r#""?""#, units);
                if sample.is_whole(picked.column) {
                    page.remark(
                        "Whole numbers: raw counts? A reading is (number - offset) * scale units.",
                    );
                    page.leave(
                        &key("scale"),
                        r#""?""#,
                        "a number, or one for each column, if raw counts",
                    );
                    page.optional(&key("offset"), "[0, 0, 0]", "the counts at zero");
                }
            }
        }
    }
}

/// The only columns of x, y and z whose names state no sensor.
fn shared_axes(findings: Findings<'_>) -> Option<[usize; 3]> {
    let of = |axis: usize| {
        let mut found = (0..findings.sample.count).filter(|&column| {
            let label = &findings.labels[column];
            label.role.is_none() && label.axis == Some(axis) && findings.sample.is_numeric(column)
        });
        found.next().filter(|_| found.next().is_none())
    };
    Some([of(0)?, of(1)?, of(2)?])
}

impl Triad<'_> {
    fn sensors(&self) -> &'static str {
        if self.role == Role::Gyro { "gyros" } else { "accelerometers" }
    }

    /// Writes the key of the triad's rows, if the log has rows of several kinds.
    fn write_rows(&self, page: &mut Page, sample: &Sample) {
        let Some((column, kinds)) = sample.kinds.first() else { return };
        let name = text(&sample.name(*column));
        let all = kinds.iter().map(|kind| text(kind)).collect::<Vec<_>>().join(", ");
        page.remark(&format!("Rows of several kinds: column {name} has {all}."));
        let part = if self.role == Role::Gyro { "gyr" } else { "acc" };
        let mut of_name = kinds.iter().filter(|kind| kind.to_lowercase().contains(part));
        let key = format!("{}.where", self.key);
        match (of_name.next(), of_name.next()) {
            (Some(kind), None) => {
                let value = format!("{{ column = {name}, value = {} }}", text(kind));
                page.guess(&key, &value, "by its name");
            }
            _ => page.optional(
                &key,
                &format!("{{ column = {name}, value = \"?\" }}"),
                "the rows that are read, if each sensor has its own",
            ),
        }
    }

    /// Writes the keys of a triad that is not in this log.
    fn write_absent(&self, page: &mut Page, findings: Findings<'_>, units: &str) {
        let Findings { log, folder, sample, .. } = findings;
        let key = |name: &str| format!("{}.{name}", self.key);
        let elsewhere = sensor_by_file_name(log).is_some_and(|role| role != self.role);
        let beside = beside(log, self.role).filter(|_| elsewhere);
        let beside = beside.and_then(|file| between(folder, &file).to_str().map(text));
        match &beside {
            Some(file) => page.guess(&key("path"), file, "the file beside this log"),
            None if elsewhere => page.leave(&key("path"), r#""?""#, "the file that holds them"),
            None => {}
        }
        if beside.is_none() {
            self.write_rows(page, sample);
        }
        if beside.is_some() && sample.names.is_none() && sample.count == 4 {
            page.guess(&key("columns"), r#"["2", "3", "4"]"#, "as in this log");
        } else {
            let named = shared_axes(findings).filter(|_| !sample.kinds.is_empty());
            match named {
                Some(columns) => {
                    let names = columns.map(|column| sample.name(column));
                    let why = "by their names, which all rows share";
                    page.guess(&key("columns"), &list(names.iter().map(String::as_str)), why);
                }
                None => {
                    page.leave(&key("columns"), r#"["?", "?", "?"]"#, "the columns of x, y and z");
                }
            }
        }
        page.leave(&key("unit"), r#""?""#, units);
    }
}

/// The only file beside `log` with the same extension and a name after the other sensor.
fn beside(log: &Path, role: Role) -> Option<PathBuf> {
    let folder = log.parent().filter(|folder| !folder.as_os_str().is_empty());
    let entries = std::fs::read_dir(folder.unwrap_or(Path::new("."))).ok()?;
    let mut found = entries.flatten().map(|entry| entry.path()).filter(|path| {
        path.extension() == log.extension() && sensor_by_file_name(path) == Some(role)
    });
    match (found.next(), found.next()) {
        (Some(only), None) => Some(only),
        _ => None,
    }
}
