//! What a record says of the program.

use rins_terms::{Term, catalogue};

use crate::answer::Named;
use crate::draw::Kind;
use crate::hide::Hidden;
use crate::journal::Record;
use crate::laboratory::Level;

/// A rival beside which so many sigmas are left is separable.
const SEPARABLE: f64 = 5.0;

/// A parameter is shown if its bound is at most this part of its usual size.
const SHOWN: f64 = 0.3;

/// Of a normal number 95 % lie so many sigmas about its mean.
const CENTRAL: f64 = 1.959964;

impl Record {
    /// Whether it gave an answer at all.
    pub(crate) fn answered(&self) -> bool {
        self.answer.failure.is_none()
    }

    /// Whether it said that something is not as the model has it.
    pub(crate) fn detected(&self) -> bool {
        !self.answer.causes.is_empty() || !self.answer.unexplained.is_empty()
    }

    /// What it named that is neither hidden nor an imperfection of the table.
    pub(crate) fn false_names(&self) -> impl Iterator<Item = &Named> {
        let there = |id: &str| {
            self.hidden.iter().any(|one| one.id == id) || self.present.iter().any(|one| one == id)
        };
        self.answer.causes.iter().filter(move |cause| !cause.set().any(there))
    }

    /// What it named that may be this effect.
    pub(crate) fn set_with(&self, id: &str) -> Option<&Named> {
        self.answer.causes.iter().find(|cause| cause.may_be(id))
    }

    /// The one effect that was hidden.
    pub(crate) fn one(&self) -> Option<&Hidden> {
        (self.kind == Kind::One).then(|| self.hidden.first()).flatten()
    }

    /// The cause that it put first, the table's imperfections apart.
    pub(crate) fn first(&self) -> Option<&Named> {
        self.answer.causes.iter().find(|cause| !self.present.contains(&cause.effect))
    }

    /// Whether each amplitude that the run shows has the truth in its 95 % interval; nothing if the first name is
    /// wrong.
    pub(crate) fn covered(&self) -> Vec<bool> {
        let (Some(hidden), Some(named)) = (self.one(), self.first()) else { return Vec::new() };
        if hidden.id != named.effect {
            return Vec::new();
        }
        let Some(term) = catalogue::term(&hidden.id) else { return Vec::new() };
        term.parameters
            .iter()
            .enumerate()
            .filter(|(place, _)| hidden.bounds[*place] < SHOWN * hidden.usual[*place])
            .filter_map(|(place, parameter)| {
                let found = named.parameters.iter().find(|(name, ..)| name == parameter.name)?;
                Some((found.1 - hidden.parameters[place]).abs() < CENTRAL * found.2)
            })
            .collect()
    }
}

impl Hidden {
    /// Whether the schedule tells it from every rival.
    pub(crate) fn is_separable(&self) -> bool {
        self.strength >= SEPARABLE && self.confusable.iter().all(|(_, left)| *left >= SEPARABLE)
    }
}

/// Effects that act alike; what is named within a class is nearly right.
static CLASSES: [(&str, &[&Term]); 11] = [
    (
        "gyro: time and temperature",
        &[
            &catalogue::GYRO_BIAS_STEP,
            &catalogue::GYRO_BIAS_RAMP,
            &catalogue::GYRO_WARMUP,
            &catalogue::GYRO_THERMAL_BIAS,
            &catalogue::GYRO_THERMAL_POLYNOMIAL,
            &catalogue::GYRO_THERMAL_LAG,
            &catalogue::GYRO_SHUPE,
        ],
    ),
    (
        "gyro: rate",
        &[
            &catalogue::GYRO_RATE_DEPENDENT_BIAS,
            &catalogue::GYRO_SCALE_ASYMMETRY,
            &catalogue::GYRO_SCALE_NONLINEARITY,
            &catalogue::GYRO_HYSTERESIS,
            &catalogue::GYRO_THERMAL_SCALE,
            &catalogue::GYRO_SCALE_RAMP,
        ],
    ),
    (
        "gyro: once per revolution",
        &[
            &catalogue::GYRO_G_SENSITIVITY,
            &catalogue::GYRO_G2_SENSITIVITY,
            &catalogue::GYRO_MAGNETIC,
            &catalogue::GYRO_DEAD_ZONE,
            &catalogue::THERMAL_ONE_PER_TURN,
        ],
    ),
    (
        "accelerometer: time and temperature",
        &[
            &catalogue::ACCEL_BIAS_STEP,
            &catalogue::ACCEL_BIAS_RAMP,
            &catalogue::ACCEL_WARMUP,
            &catalogue::ACCEL_THERMAL_BIAS,
            &catalogue::ACCEL_THERMAL_POLYNOMIAL,
            &catalogue::ACCEL_THERMAL_LAG,
        ],
    ),
    (
        "accelerometer: specific force",
        &[
            &catalogue::ACCEL_QUADRATIC,
            &catalogue::ACCEL_CUBIC,
            &catalogue::ACCEL_ASYMMETRY,
            &catalogue::ACCEL_CROSS_COUPLING,
        ],
    ),
    (
        "accelerometer: rate",
        &[
            &catalogue::ACCEL_LEVER_ARM,
            &catalogue::ACCEL_SIZE_EFFECT,
            &catalogue::ACCEL_VIBRATION_RECTIFICATION,
        ],
    ),
    (
        "latencies",
        &[
            &catalogue::GYRO_LAG,
            &catalogue::ACCEL_LATENCY,
            &catalogue::ENCODER_LATENCY,
            &catalogue::CLOCK_DRIFT,
            &catalogue::DROPPED_SAMPLES,
        ],
    ),
    (
        "encoder",
        &[
            &catalogue::ENCODER_ECCENTRICITY,
            &catalogue::ENCODER_HARMONIC,
            &catalogue::ENCODER_BACKLASH,
            &catalogue::ENCODER_SLIP,
        ],
    ),
    (
        "axis and base",
        &[
            &catalogue::TABLE_WOBBLE,
            &catalogue::CABLE_TORQUE_TILT,
            &catalogue::BASE_TILT_RAMP,
            &catalogue::BASE_TILT_STEP,
        ],
    ),
    ("spectral lines", &[&catalogue::BASE_SWAY, &catalogue::INTERFERENCE_LINE]),
    ("site", &[&catalogue::BASE_ROTATION, &catalogue::WRONG_LATITUDE, &catalogue::WRONG_GRAVITY]),
];

/// The names of all classes.
pub(crate) fn classes() -> impl Iterator<Item = &'static str> {
    CLASSES.iter().map(|(name, _)| *name)
}

/// The class of an effect.
pub(crate) fn class(id: &str) -> &'static str {
    CLASSES
        .iter()
        .find(|(_, terms)| terms.iter().any(|term| term.id == id))
        .map_or("other", |(name, _)| *name)
}

/// Whether a level is one of those that the targets are about.
pub(crate) fn is_plain(record: &Record) -> bool {
    matches!(record.level, Level::White | Level::Flicker)
}

/// Records of one hidden effect, on plain levels.
pub(crate) fn ones<'a>(records: &[&'a Record]) -> Vec<(&'a Record, &'a Hidden)> {
    let plain = records.iter().copied().filter(|record| is_plain(record));
    plain.filter_map(|record| Some((record, record.one()?))).collect()
}

pub(crate) fn in_set((record, hidden): &(&Record, &Hidden)) -> bool {
    record.set_with(&hidden.id).is_some()
}

pub(crate) fn meant(low: f64, high: f64) -> impl Fn(&&(&Record, &Hidden)) -> bool {
    move |(_, hidden)| (low..=high).contains(&hidden.meant)
}

#[cfg(test)]
mod tests {
    use serde_json::{Value, json};

    use super::*;
    use crate::catalogue::is_hideable;

    /// A record of 5 mm and -3 mm of lever arm, bounds 1 mm, and of a table with an eccentric encoder.
    fn record(causes: &Value) -> Record {
        let lever = json!({
            "id": "accel_lever_arm", "meant": 8.0, "strength": 8.0, "dof": 2, "settings": [],
            "parameters": [5e-3, -3e-3], "bounds": [1e-3, 1e-3], "usual": [0.3, 0.3],
            "confusable": [["accel_size_effect", 1.2], ["accel_quadratic", 6.0]],
        });
        let answer = json!({
            "verdict": "named", "causes": causes, "unexplained": [], "gain": null, "seconds": 1.0,
            "failure": null,
        });
        let record = json!({
            "seed": 1, "index": 2, "timed": false, "kind": "one", "schedule": "three_rates",
            "level": "white", "interval": 0.02, "duration": 360.0, "hidden": [lever], "outside": null,
            "present": ["encoder_eccentricity"], "answer": answer,
        });
        serde_json::from_value(record).expect("it is a record")
    }

    fn named(effect: &str, others: &[&str], parameters: &Value) -> Value {
        json!({
            "effect": effect, "cannot_tell_from": others, "ln_p": -20.0, "parameters": parameters,
            "settings": {},
        })
    }

    #[test]
    fn name_is_false_if_nothing_of_its_set_is_there() {
        let set = named("accel_size_effect", &["accel_lever_arm"], &json!([]));
        let table = named("encoder_eccentricity", &[], &json!([]));
        let wrong = named("gyro_lag", &["accel_latency"], &json!([]));
        let record = record(&json!([table, set, wrong]));
        let names: Vec<&str> = record.false_names().map(|cause| cause.effect.as_str()).collect();
        assert_eq!(names, ["gyro_lag"]);
        // The table's own imperfection comes first and does not count.
        assert_eq!(record.first().map(|cause| cause.effect.as_str()), Some("accel_size_effect"));
        assert!(record.set_with("accel_lever_arm").is_some_and(|set| set.set().count() == 2));
        assert!(record.set_with("base_sway").is_none());
        assert!(record.detected());
    }

    #[test]
    fn interval_covers_within_two_sigmas_of_the_truth() {
        let lever = |x: f64, y: f64| {
            named("accel_lever_arm", &[], &json!([["r_x", x, 1e-3], ["r_y", y, 1e-3]]))
        };
        assert_eq!(record(&json!([lever(6.9e-3, -5.1e-3)])).covered(), [true, false]);
        // Only where the first name is right.
        assert!(record(&json!([named("gyro_lag", &[], &json!([]))])).covered().is_empty());
        assert!(record(&json!([])).covered().is_empty());
    }

    #[test]
    fn schedule_separates_what_leaves_five_sigmas() {
        let mut hidden = record(&json!([])).hidden.remove(0);
        assert!(!hidden.is_separable());
        hidden.confusable.remove(0);
        assert!(hidden.is_separable());
        hidden.strength = 4.0;
        assert!(!hidden.is_separable());
    }

    #[test]
    fn every_effect_has_one_class() {
        for term in catalogue::CATALOGUE.iter().filter(|term| is_hideable(term)) {
            let times =
                CLASSES.iter().filter(|(_, own)| own.iter().any(|one| one.is(term))).count();
            assert_eq!(times, 1, "{}", term.id);
        }
    }
}
