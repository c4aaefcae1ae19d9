//! The meaning of a column's name: sensor, axis, unit.

use super::stated::{Stated, by_ending, in_brackets};
use crate::quantity::Dimension;

/// The content of a column.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Role {
    Time,
    /// A GNSS week.
    Week,
    /// A sample counter.
    Counter,
    Gyro,
    Accel,
    TableAngle,
    TableRate,
    Temperature,
    /// An angle of an attitude, the result of a navigation solution.
    Attitude,
}

/// The meaning of a column's name.
#[derive(Clone, Debug, Default, PartialEq)]
pub(super) struct Label {
    pub(super) role: Option<Role>,
    /// Whether the name is unambiguous.
    pub(super) sure: bool,
    /// Whether the name indicates increments.
    pub(super) increment: bool,
    /// The axis, from zero.
    pub(super) axis: Option<usize>,
    /// The name without axis and unit, which the three columns of a triad have in common.
    pub(super) stem: String,
    pub(super) unit: Option<Stated>,
}

const TEMPERATURE: &[&str] = &["temp", "temps", "temperature", "temperatures", "tmp"];
const TABLE: &[&str] =
    &["table", "turntable", "ratetable", "encoder", "enc", "resolver", "spindle", "rotor", "stage"];
const RATE: &[&str] = &["rate", "speed", "velocity", "vel", "omega"];
const ANGLE: &[&str] = &["angle", "theta", "azimuth", "zeta"];
/// Words of angles that are the result of a navigation solution.
const ATTITUDE: &[&str] = &["roll", "pitch", "yaw", "heading", "course", "euler"];
const TIME: &[&str] = &[
    "time",
    "timestamp",
    "stamp",
    "t",
    "tow",
    "itow",
    "sow",
    "sec",
    "secs",
    "msec",
    "usec",
    "nsec",
    "nsecs",
    "nanosec",
    "nanosecs",
    "seconds",
    "millis",
    "micros",
    "epoch",
    "clock",
];
const WEEK: &[&str] = &["week", "weeks", "gpsweek", "wn"];
const COUNTER: &[&str] = &[
    "sample", "samples", "counter", "count", "index", "idx", "packet", "packets", "seq",
    "sequence", "frame", "n", "nr", "no",
];
const GYRO: &[&str] = &[
    "gyro",
    "gyros",
    "gyroscope",
    "gyroscopes",
    "gyr",
    "dtheta",
    "dang",
    "dth",
    "omega",
    "wib",
    "angvel",
];
const ACCEL: &[&str] = &[
    "accel",
    "accels",
    "accelerometer",
    "accelerometers",
    "accelerations",
    "acc",
    "acceleration",
    "dvel",
    "dv",
    "deltav",
];
/// Letters and words that mean a gyro or an accelerometer by convention only.
const WEAK_GYRO: &[&str] = &["g", "w", "wb", "om", "rate"];
const WEAK_ACCEL: &[&str] = &["a", "f", "sf", "fb"];
/// Words of the axes x, y and z, and of the rotations about them.
const AXES: [&[&str]; 3] = [&["roll", "front", "forward"], &["pitch", "left"], &["yaw", "up"]];
const INCREMENT: &[&str] =
    &["dtheta", "dang", "dth", "dvel", "dv", "deltav", "inc", "delta", "increment", "d"];
/// Words of triads that are not inertial sensors.
const OTHERS: &[&str] = &[
    "mag",
    "magn",
    "magnetometer",
    "magnetic",
    "quat",
    "quaternion",
    "q",
    "pos",
    "position",
    "gnss",
    "gps",
    "euler",
    "bias",
    "gravity",
];

impl Label {
    /// The meaning of `name`.
    pub(super) fn of(name: &str) -> Self {
        let (bracketed, bare) = match in_brackets(name) {
            Some((stated, bare)) => (Some(stated), bare),
            None => (None, name.to_string()),
        };
        let mut words = words(&bare);
        let attitude = words.iter().any(|word| ATTITUDE.contains(&word.as_str()));
        let mut axis = take_axis(&mut words);
        let mut unit = bracketed;
        if unit.is_none()
            && let Some((stated, count)) = by_ending(&words)
        {
            words.truncate(words.len() - count);
            unit = Some(stated);
        }
        axis = axis.or_else(|| take_axis(&mut words));
        let stem = words.join(" ");
        let label = Self { axis, stem, unit, ..Self::default() };
        label.judged(&words, attitude)
    }

    fn judged(self, words: &[String], attitude: bool) -> Self {
        let has = |list: &[&str]| words.iter().any(|word| list.contains(&word.as_str()));
        let dimension = self.unit.as_ref().map(|stated| stated.unit.dimension);
        let role = |role, sure| Some((role, sure));
        let found = if has(TEMPERATURE) || dimension == Some(Dimension::TEMPERATURE) {
            role(Role::Temperature, true)
        } else if let Some(found) = self.axis.and_then(|_| triad(words, dimension)) {
            Some(found)
        } else if attitude {
            role(Role::Attitude, true)
        } else if self.axis.is_some() {
            None
        } else if has(TABLE) {
            let rate = has(RATE) || dimension == Some(Dimension::ANGULAR_RATE);
            role(if rate { Role::TableRate } else { Role::TableAngle }, true)
        } else if has(WEEK) && !has(TIME) && !has(&["of"]) {
            role(Role::Week, true)
        } else if has(TIME) || dimension == Some(Dimension::TIME) {
            role(Role::Time, true)
        } else if has(COUNTER) {
            role(Role::Counter, true)
        } else if has(ANGLE) {
            role(Role::TableAngle, false)
        } else {
            None
        };
        let increment = has(INCREMENT);
        match found {
            Some((role, sure)) => Self { role: Some(role), sure, increment, ..self },
            None => self,
        }
    }
}

/// The triad of a column with an axis, and whether that is certain.
fn triad(words: &[String], dimension: Option<Dimension>) -> Option<(Role, bool)> {
    let has = |list: &[&str]| words.iter().any(|word| list.contains(&word.as_str()));
    if has(OTHERS) || has(TABLE) {
        return None;
    }
    let turning = has(&["angular", "ang", "rotation", "rotational"]) && has(RATE);
    let change = has(&["delta", "inc", "increment"]);
    let angle = change && has(&["angle", "theta", "ang"]);
    let velocity = change && has(&["velocity", "vel", "v"]);
    if has(GYRO) || turning || angle {
        return Some((Role::Gyro, true));
    }
    let in_g = has(&["g"]) && has(&["f", "force"]);
    if has(ACCEL) || in_g || velocity || (has(&["specific"]) && has(&["force"])) {
        return Some((Role::Accel, true));
    }
    match dimension {
        Some(Dimension::ANGULAR_RATE) => Some((Role::Gyro, has(WEAK_GYRO))),
        Some(Dimension::ACCELERATION) => Some((Role::Accel, has(WEAK_ACCEL))),
        _ if has(WEAK_GYRO) => Some((Role::Gyro, false)),
        _ if has(WEAK_ACCEL) => Some((Role::Accel, false)),
        _ => None,
    }
}

/// The words of a name in lower case: `GyroX`, `gyro_x` and `Gyro X` are the same two words.
fn words(name: &str) -> Vec<String> {
    let mut words = vec![String::new()];
    let mut before = ' ';
    let mut letters = name.chars().peekable();
    while let Some(letter) = letters.next() {
        // After an acronym, the last capital begins a word: `GPSWeek`, but `DTheta`.
        let is_acronym = before.is_uppercase()
            && words.last().is_some_and(|word| word.chars().count() > 1)
            && letters.peek().is_some_and(|next| next.is_lowercase());
        if !letter.is_alphanumeric()
            || (letter.is_uppercase() && (before.is_lowercase() || is_acronym))
        {
            words.push(String::new());
        }
        if letter.is_alphanumeric()
            && let Some(word) = words.last_mut()
        {
            word.extend(letter.to_lowercase());
        }
        before = letter;
    }
    words.retain(|word| !word.is_empty());
    words
}

/// Removes the axis from a name's words: a separate word, or a letter at an end of a sensor's name.
fn take_axis(words: &mut Vec<String>) -> Option<usize> {
    let axis = |word: &str| ["x", "y", "z"].iter().position(|axis| *axis == word);
    if let Some(place) = words.iter().rposition(|word| axis(word).is_some()) {
        return axis(&words.remove(place));
    }
    // The directions of a vehicle, right-handed: front, left, up.
    let direction = |word: &str| AXES.iter().position(|directions| directions.contains(&word));
    if let Some(place) = words.iter().rposition(|word| direction(word).is_some()) {
        return direction(&words.remove(place));
    }
    let sensor = |word: &str, lists: &[&[&str]]| lists.iter().any(|list| list.contains(&word));
    for word in words.iter_mut().rev() {
        let Some((place, last)) = word.char_indices().next_back() else { continue };
        if let Some(axis) = axis(last.encode_utf8(&mut [0; 4]))
            && sensor(&word[..place], &[GYRO, ACCEL, WEAK_GYRO, WEAK_ACCEL, OTHERS])
        {
            word.truncate(place);
            return Some(axis);
        }
        if let Some(axis) = word.get(..1).and_then(axis)
            && sensor(&word[1..], &[GYRO, ACCEL])
        {
            word.remove(0);
            return Some(axis);
        }
    }
    None
}

#[cfg(test)]
mod tests {
    use super::{Label, Role};
    use proptest::prelude::*;

    #[test]
    fn names_of_many_loggers_are_understood() {
        let triads = [
            ("Gyroscope X (deg/s)", Role::Gyro, 0, Some("deg/s")),
            ("gyr_y", Role::Gyro, 1, None),
            ("gz", Role::Gyro, 2, None),
            ("GyroZ", Role::Gyro, 2, None),
            ("wy [rad/s]", Role::Gyro, 1, Some("rad/s")),
            ("GYRO_X_dps", Role::Gyro, 0, Some("deg/s")),
            ("angular_velocity.x", Role::Gyro, 0, None),
            ("xgyro", Role::Gyro, 0, None),
            ("Z (deg/h)", Role::Gyro, 2, Some("deg/h")),
            ("dtheta_x", Role::Gyro, 0, None),
            ("delta angle y", Role::Gyro, 1, None),
            ("Accelerometer Z (g)", Role::Accel, 2, Some("g")),
            ("ax", Role::Accel, 0, None),
            ("acc_x_mps2", Role::Accel, 0, Some("m/s^2")),
            ("linear_acceleration.y", Role::Accel, 1, None),
            ("specific force z", Role::Accel, 2, None),
            ("fx", Role::Accel, 0, None),
            ("gFy", Role::Accel, 1, None),
            ("acc_front", Role::Accel, 0, None),
            ("Yaw rate (deg/s)", Role::Gyro, 2, Some("deg/s")),
            ("dvz", Role::Accel, 2, None),
        ];
        for (name, role, axis, unit) in triads {
            let label = Label::of(name);
            let text = label.unit.as_ref().map(|stated| stated.text.as_str());
            assert_eq!((label.role, label.axis, text), (Some(role), Some(axis), unit), "{name}");
        }
        let others = [
            ("Time (s)", Role::Time),
            ("t", Role::Time),
            ("time_us", Role::Time),
            ("SampleTime", Role::Time),
            ("n_samples", Role::Counter),
            ("PacketCounter", Role::Counter),
            ("table", Role::TableAngle),
            ("Encoder (deg)", Role::TableAngle),
            ("table_rate", Role::TableRate),
            ("turntable (deg/s)", Role::TableRate),
            ("angle", Role::TableAngle),
            ("temp", Role::Temperature),
            ("table_temperature", Role::Temperature),
            ("IMU (degC)", Role::Temperature),
            ("GPSWeek", Role::Week),
            ("SecondsOfWeek", Role::Time),
            ("roll angle", Role::Attitude),
            ("Yaw (deg)", Role::Attitude),
        ];
        for (name, role) in others {
            assert_eq!(Label::of(name).role, Some(role), "{name}");
        }
    }

    #[test]
    fn other_sensors_are_left_alone() {
        for name in
            ["Magnetometer X (uT)", "mx", "qx", "mag_z", "Barometer (hPa)", "vx", "pos_x", "x"]
        {
            assert_eq!(Label::of(name).role, None, "{name}");
        }
    }

    #[test]
    fn a_triad_shares_a_stem_whatever_its_axis() {
        for names in [["gx", "gy", "gz"], ["Acc X (g)", "Acc Y (g)", "Acc Z (g)"]] {
            let stems = names.map(|name| Label::of(name).stem);
            assert!(stems[0] == stems[1] && stems[1] == stems[2], "{stems:?}");
        }
    }

    proptest! {
        #[test]
        fn any_name_is_read(name in "\\PC{0,30}|[xyzXYZ()\\[\\]_a-gé/ ]{0,20}") {
            let _ = Label::of(&name);
        }
    }
}
