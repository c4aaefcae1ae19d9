//! Output of simulated runs: the log, its rig file, and the truth.

use std::borrow::Cow;
use std::fmt::Write as _;
use std::fs::File;
use std::io::{self, BufWriter, Write};
use std::path::Path;

use rins_frames::SignedAxes;
use rins_frames::units::DEG;
use rins_motion::Recording;
use rins_terms::Model;
use serde_json::{Value, json};

use crate::document::{Entry, Node};
use crate::error::IoError;
use crate::parameter::{Parameter, parameters};
use crate::rig::Axes;
use crate::scenario::{ScenarioFile, true_angles};
use crate::term;
use crate::write::rig_text::{column_keys, figures, inline, push_table};
use crate::write::{to_own_axes, write_recording};

impl ScenarioFile {
    /// The truth of a simulated run as JSON: the axis frame's true attitude, the IMU's true errors and
    /// the effects, with the ids and units of results, along the sensors' own axes.
    pub fn truth_json(&self) -> String {
        let scenario = &self.scenario;
        let axes = SignedAxes::from(self.spin);
        let angles = true_angles(scenario);
        let error = scenario.imu_error.along(&axes.inverse().matrix());
        let parameters: Vec<Value> = parameters(&error).into_iter().map(parameter_json).collect();
        let effects: Vec<Value> = (0..scenario.effects.terms.len())
            .map(|place| effect_json(&scenario.effects, place, &axes))
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
            "effects": effects,
        });
        format!("{truth:#}\n")
    }

    /// The rig file of a run that was simulated from this scenario: all sections of the scenario
    /// except `[truth]` and `[grid]`, with quantities as written there, and a `[log]` for the output of
    /// [`write_recording`].
    pub fn rig_toml(&self, recording: &Recording) -> String {
        let mut text = String::from("# A simulated run: site, log and IMU.\n");
        for Entry { key, value, .. } in &self.document.root {
            match (key.as_str(), &value.node) {
                ("truth" | "grid", _) => {}
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

    /// Writes the log, rig file and truth of a run that was simulated from this scenario to
    /// `folder`.
    ///
    /// # Errors
    /// [`IoError::File`] on a system error.
    pub fn write_run(&self, recording: &Recording, folder: &Path) -> Result<(), IoError> {
        let write = |name: &str, fill: &dyn Fn(&mut dyn Write) -> io::Result<()>| {
            let path = folder.join(name);
            let file = File::create(&path).map_err(IoError::file("write", &path))?;
            let mut out = BufWriter::new(file);
            fill(&mut out).and_then(|()| out.flush()).map_err(IoError::file("write", &path))
        };
        let mut own = Cow::Borrowed(recording);
        if self.spin != Axes::IDENTITY {
            to_own_axes(own.to_mut(), &self.spin);
        }
        write(&self.log_name, &|out| write_recording(&own, out))?;
        write("rig.toml", &|out| out.write_all(self.rig_toml(recording).as_bytes()))?;
        write("truth.json", &|out| out.write_all(self.truth_json().as_bytes()))
    }
}

fn parameter_json(Parameter { id, value, unit }: Parameter) -> Value {
    json!({ "id": id, "value": value, "unit": unit })
}

fn effect_json(effects: &Model, place: usize, axes: &SignedAxes) -> Value {
    let chosen = &effects.terms[place];
    let settings = chosen.term.own_settings(&chosen.settings, axes);
    let settings: Vec<Value> = chosen
        .term
        .settings
        .iter()
        .zip(&settings)
        .map(|(setting, value)| {
            let (value, unit) = (value / setting.unit.factor, setting.unit.symbol);
            json!({ "name": setting.name, "value": value, "unit": unit })
        })
        .collect();
    let parameters: Vec<Value> =
        term::parameters(effects, place, axes).into_iter().map(parameter_json).collect();
    json!({ "id": chosen.term.id, "settings": settings, "parameters": parameters })
}
