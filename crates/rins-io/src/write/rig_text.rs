//! Text of rig files: copied sections, and the description of a new log.

use std::fmt::Write as _;

use rins_motion::Recording;

use super::signals::COLUMNS;
use crate::document::{Entry, Node, Value as Written};

/// The keys of `[log]` for the output of [`write_recording`](super::write_recording), except `path` and `rate`.
///
/// `angle` is appended to the table angle's column and unit, as in `, noise = "0.3 arcsec"`.
pub(crate) fn column_keys(recording: &Recording, angle: &str) -> String {
    let triad = |names: &[&str], unit: &str| {
        let names: Vec<String> = names.iter().map(|name| format!("{name:?}")).collect();
        format!("{{ columns = [{}], unit = {unit:?} }}", names.join(", "))
    };
    let mut keys = format!(
        "time = {{ column = \"time\", unit = \"s\" }}\ngyro = {}\naccel = {}\n",
        triad(&COLUMNS[..3], "rad"),
        triad(&COLUMNS[3..], "m/s"),
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

/// The same for a MATLAB file written by rins.
pub(crate) fn matrix_keys(recording: &Recording, angle: &str) -> String {
    let mut keys = column_keys(recording, angle);
    for name in ["gyro", "accel"] {
        for (axis, column) in ["x", "y", "z"].iter().zip(1..) {
            keys = keys.replace(&format!("\"{name}_{axis}\""), &format!("\"{name}(:,{column})\""));
        }
    }
    keys
}

/// The keys of a table angle other than column, unit and sense.
pub(crate) fn figures(angle: &Written) -> String {
    let Node::Table(entries) = &angle.node else { return String::new() };
    let mut figures = String::new();
    let kept = |entry: &&Entry| !["column", "unit", "sense"].contains(&entry.key.as_str());
    for Entry { key, value, .. } in entries.iter().filter(kept) {
        let _ = write!(figures, ", {key} = {}", inline(value));
    }
    figures
}

pub(crate) fn push_table(text: &mut String, header: &str, entries: &[Entry]) {
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
pub(crate) fn inline(value: &Written) -> String {
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
