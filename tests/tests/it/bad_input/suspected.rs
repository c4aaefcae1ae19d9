//! Errors that only the data show: the result is printed and states the suspicion, and the exit code reports it.

use rins_testing::{Fault, assert_rows, is, says};
use serde_json::Value;

use super::DATA;
use super::files::Spoil::{All, Replace};
use super::files::{Folder, Spoil};
use crate::support::{object, rins_in, texts};

const RIG: &str = "rig.toml";

/// A case: its name, the fault of the rig, and the text of the suspicion.
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

/// The faults in the report of a gross error: in the exit code, in one line, and in the printed and written result.
fn suspected(spoil: &Spoil, suspicion: &str) -> Fault {
    let folder = Folder::new();
    folder.spoil(spoil);
    let finished = rins_in(folder.path(), "check rig.toml --json -o out");
    let said = finished.err.as_str();
    is(&(finished.code, said.lines().count()), &(Some(DATA), 1))
        .map_err(|off| off + ": " + said)?;
    says(said, "rins: rig.toml: ")?;
    let printed = object(&finished);
    says(&texts(&printed, "/suspicions").join("\n"), suspicion)?;
    let written = std::fs::read_to_string(folder.path().join("out/result.json"));
    is(&serde_json::from_str::<Value>(&written.unwrap()).unwrap(), &printed)
}

#[test]
fn suspected_mistake_comes_with_the_result() {
    assert_rows(
        SUSPECTED.iter().map(|(name, spoil, suspicion)| (name, suspected(spoil, suspicion))),
    );
}
