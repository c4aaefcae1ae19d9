//! Mistakes that only the numbers betray: the result is given, and says so, and the exit code does.

use serde_json::Value;

use super::DATA;
use super::files::Spoil::{All, Replace};
use super::files::{Folder, Spoil};
use crate::support::{object, rins_in, texts};

const RIG: &str = "rig.toml";

/// A case: what it is, what is done to the rig, and what the suspicion says.
const SUSPECTED: &[(&str, Spoil, &str)] = &[
    (
        "increments taken for rates",
        Replace(RIG, "unit = \"m/s\"", "unit = \"m/s^2\""),
        "readings in m/s were declared as m/s^2",
    ),
    (
        "m/s taken for g",
        Replace(RIG, "unit = \"m/s\"", "unit = \"m/s\", scale = 9.80665"),
        "readings in m/s^2 were declared as g",
    ),
    (
        "g taken for m/s",
        Replace(RIG, "unit = \"m/s\"", "unit = \"m/s\", scale = 0.10197162"),
        "readings in g were declared as m/s^2",
    ),
    (
        "an accelerometer that reads double",
        Replace(RIG, "unit = \"m/s\"", "unit = \"m/s\", scale = 2"),
        "check units, scale and axes",
    ),
    (
        "angle increments taken for rates",
        Replace(RIG, "unit = \"rad\"", "unit = \"rad/s\""),
        "readings in rad were declared as rad/s",
    ),
    (
        "radians taken for degrees",
        Replace(RIG, "unit = \"rad\"", "unit = \"deg\""),
        "readings in rad were declared as deg",
    ),
    (
        "a table in degrees",
        Replace(RIG, "\"table_angle\", unit = \"rad\"", "\"table_angle\", unit = \"deg\""),
        "readings of the table's angle in rad were declared as deg",
    ),
    (
        "a gyro triad upside down",
        Replace(RIG, "unit = \"rad\"", "unit = \"rad\", axes = [\"x\", \"-y\", \"-z\"]"),
        "the direction of rotation of the table is opposite to that of the gyro",
    ),
    (
        "exchanged gyros",
        Replace(RIG, "unit = \"rad\"", "unit = \"rad\", axes = [\"z\", \"x\", \"y\"]"),
        "the axes are exchanged",
    ),
    (
        "two at once",
        All(&[
            Replace(RIG, "unit = \"m/s\"", "unit = \"m/s^2\""),
            Replace(RIG, "unit = \"rad\"", "unit = \"rad\", axes = [\"x\", \"-y\", \"-z\"]"),
        ]),
        "the direction of rotation of the table is opposite to that of the gyro",
    ),
];

#[test]
fn suspected_mistake_comes_with_the_result() {
    for (name, spoil, says) in SUSPECTED {
        let folder = Folder::new();
        folder.spoil(spoil);
        let finished = rins_in(folder.path(), "check rig.toml --json -o out");
        assert_eq!(finished.code, Some(DATA), "{name}: {}", finished.err);
        assert_eq!(finished.err.lines().count(), 1, "{name}: {}", finished.err);
        assert!(finished.err.starts_with("rins: rig.toml: "), "{name}: {}", finished.err);
        let printed = object(&finished);
        let suspicions = texts(&printed, "/suspicions");
        assert!(suspicions.iter().any(|text| text.contains(says)), "{name}: {suspicions:?}");
        let written = std::fs::read_to_string(folder.path().join("out/result.json")).unwrap();
        assert_eq!(serde_json::from_str::<Value>(&written).unwrap(), printed, "{name}");
    }
}
