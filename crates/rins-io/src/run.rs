//! Runs written down: a recording as CSV, its rig, and the truth that it was simulated from.

use std::fmt::Write as _;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use rins_frames::units::DEG;
use rins_motion::Recording;
use rins_simulation::Scenario;
use serde_json::{Value, json};

use crate::document::{Entry, Node, Value as Written};
use crate::error::IoError;
use crate::parameter::{Parameter, parameters};
use crate::scenario::{ScenarioFile, true_angles};

const TRIADS: [&str; 6] = ["gyro_x", "gyro_y", "gyro_z", "accel_x", "accel_y", "accel_z"];

/// Writes `recording` as CSV, in SI units and radians.
///
/// The columns are `time`, the increments `gyro_x` … `accel_z`, and `table_angle`, `table_rate`
/// and `temperature` where the recording has them. Every number is written with the fewest digits
/// that read back as the same number.
///
/// # Errors
/// What `out` returns.
pub fn write_recording(recording: &Recording, out: &mut dyn Write) -> io::Result<()> {
    let others = [
        ("table_angle", &recording.table_angle),
        ("table_rate", &recording.table_rate),
        ("temperature", &recording.temperature),
    ];
    write!(out, "time,{}", TRIADS.join(","))?;
    for (name, _) in others.iter().filter(|(_, list)| list.is_some()) {
        write!(out, ",{name}")?;
    }
    writeln!(out)?;
    for (sample, (time, increments)) in
        recording.times.iter().zip(&recording.increments).enumerate()
    {
        write!(out, "{time}")?;
        let (angle, velocity) = (increments.angle.components(), increments.velocity.components());
        for number in angle.iter().chain(velocity.iter()) {
            write!(out, ",{number:e}")?;
        }
        for list in others.iter().filter_map(|(_, list)| list.as_ref()) {
            write!(out, ",{:e}", list[sample])?;
        }
        writeln!(out)?;
    }
    Ok(())
}

/// The keys of `[log]` that describe what [`write_recording`] writes, but for `path` and `rate`.
///
/// `angle` is put behind the table angle's column and unit, as in `, noise = "0.3 arcsec"`.
fn column_keys(recording: &Recording, angle: &str) -> String {
    let triad = |names: &[&str], unit: &str| {
        let names: Vec<String> = names.iter().map(|name| format!("{name:?}")).collect();
        format!("{{ columns = [{}], unit = {unit:?} }}", names.join(", "))
    };
    let mut keys = format!(
        "time = {{ column = \"time\", unit = \"s\" }}\ngyro = {}\naccel = {}\n",
        triad(&TRIADS[..3], "rad"),
        triad(&TRIADS[3..], "m/s"),
    );
    let others = [
        ("table_angle", recording.table_angle.is_some(), "rad", angle),
        ("table_rate", recording.table_rate.is_some(), "rad/s", ""),
        ("temperature", recording.temperature.is_some(), "degC", ""),
    ];
    for (name, _, unit, more) in others.into_iter().filter(|(_, there, ..)| *there) {
        // Writing to a string cannot fail.
        let _ = writeln!(keys, "{name} = {{ column = {name:?}, unit = {unit:?}{more} }}");
    }
    keys
}

impl ScenarioFile {
    /// The rig file of a run that was simulated from this scenario: all of the scenario's sections
    /// but `[truth]`, its quantities as they are written there, and a `[log]` that describes what
    /// [`write_recording`] writes.
    pub fn rig_toml(&self, recording: &Recording) -> String {
        let mut text = String::from("# A simulated run: where it was measured, and with what.\n");
        for Entry { key, value, .. } in &self.document.root {
            match (key.as_str(), &value.node) {
                ("truth", _) => {}
                ("log", Node::Table(entries)) => {
                    let source = |key: &str| {
                        entries.iter().find(|entry| entry.key == key).map(|entry| &entry.value)
                    };
                    let rate = source("rate").map_or_else(String::new, inline);
                    let angle = source("table_angle").map_or_else(String::new, figures);
                    let keys = column_keys(recording, &angle);
                    let path = &self.log_name;
                    let _ = write!(text, "\n[log]\npath = {path:?}\nrate = {rate}\n{keys}");
                }
                (key, Node::Table(entries)) => push_table(&mut text, key, entries),
                _ => {}
            }
        }
        text
    }

    /// Writes the log, rig file and truth of a run that was simulated from this scenario into
    /// `folder`.
    ///
    /// # Errors
    /// [`IoError::File`] if the system refuses.
    pub fn write_run(&self, recording: &Recording, folder: &Path) -> Result<(), IoError> {
        let write = |name: &str, fill: &dyn Fn(&mut dyn Write) -> io::Result<()>| {
            let path = folder.join(name);
            let file = File::create(&path).map_err(IoError::file("write", &path))?;
            let mut out = BufWriter::new(file);
            fill(&mut out).and_then(|()| out.flush()).map_err(IoError::file("write", &path))
        };
        write(&self.log_name, &|out| write_recording(recording, out))?;
        write("rig.toml", &|out| out.write_all(self.rig_toml(recording).as_bytes()))?;
        write("truth.json", &|out| out.write_all(truth_json(&self.scenario).as_bytes()))
    }
}

/// What a table angle's keys say besides column and unit.
fn figures(angle: &Written) -> String {
    let Node::Table(entries) = &angle.node else { return String::new() };
    let mut figures = String::new();
    for Entry { key, value, .. } in entries.iter().filter(|e| e.key != "column" && e.key != "unit")
    {
        let _ = write!(figures, ", {key} = {}", inline(value));
    }
    figures
}

fn push_table(text: &mut String, header: &str, entries: &[Entry]) {
    let is_table = |entry: &&Entry| matches!(entry.value.node, Node::Table(_));
    if !entries.iter().all(|entry| is_table(&entry)) {
        let _ = writeln!(text, "\n[{header}]");
    }
    for Entry { key, value, .. } in entries.iter().filter(|entry| !is_table(entry)) {
        let _ = writeln!(text, "{key} = {}", inline(value));
    }
    for Entry { key, value, .. } in entries.iter().filter(is_table) {
        if let Node::Table(entries) = &value.node {
            push_table(text, &format!("{header}.{key}"), entries);
        }
    }
}

/// A value as TOML, on one line unless it is a list of tables.
fn inline(value: &Written) -> String {
    match &value.node {
        Node::List(items) if items.iter().any(|item| matches!(item.node, Node::Table(_))) => {
            let items: Vec<String> =
                items.iter().map(|item| format!("    {},\n", inline(item))).collect();
            format!("[\n{}]", items.concat())
        }
        Node::List(items) => {
            format!("[{}]", items.iter().map(inline).collect::<Vec<_>>().join(", "))
        }
        Node::Table(entries) => {
            let keys = entries.iter().map(|e| format!("{} = {}", e.key, inline(&e.value)));
            format!("{{ {} }}", keys.collect::<Vec<_>>().join(", "))
        }
        _ => value.source.clone(),
    }
}

/// What a simulated run was made from, as JSON: the axis frame's true attitude, and the IMU's
/// true errors by the ids and in the units that results have them.
pub fn truth_json(scenario: &Scenario) -> String {
    let angles = true_angles(scenario);
    let parameters: Vec<Value> = parameters(&scenario.imu_error)
        .into_iter()
        .map(|Parameter { id, value, unit }| json!({ "id": id, "value": value, "unit": unit }))
        .collect();
    let truth = json!({
        "schema": 1,
        "seed": scenario.seed.seed,
        "attitude_deg": {
            "roll": angles.roll / DEG,
            "pitch": angles.pitch / DEG,
            "yaw": angles.yaw / DEG,
        },
        "parameters": parameters,
        "effects": [],
    });
    format!("{truth:#}\n")
}
