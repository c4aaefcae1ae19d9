//! Logs in the layouts of many programs: a draft has the right columns and units, or leaves them to the user.

use std::fmt::Write as _;

use rins_io::Draft;

use super::layout_table::{LAYOUTS, Layout};
use super::support::{Motion, Row, draft};
use crate::support::folder;

/// Sampling rates \[Hz\], whose intervals are whole milliseconds, and tilts of the axis \[rad\]: about a level axis gravity does not
/// rotate in the body.
const MOTIONS: [Motion; 5] = [
    Motion { rate: 20, tilt: 0.5 },
    Motion { rate: 50, tilt: 0.0 },
    Motion { rate: 50, tilt: 0.5 },
    Motion { rate: 100, tilt: 0.3 },
    Motion { rate: 200, tilt: 0.5 },
];

/// A number that no sensor of the layout shows twice, as noise \[-1, 1\].
fn noise(row: u32, channel: u32) -> f64 {
    let phase = 12.9898 * f64::from(row) + 78.233 * f64::from(channel);
    2.0 * (phase.sin() * 43758.5453).rem_euclid(1.0) - 1.0
}

/// The text of a layout's log.
fn logged(layout: &Layout, motion: &Motion) -> String {
    let mut log = String::from(layout.before);
    for (row, sample) in (1..).zip(motion.rows()) {
        let time = u64::from(row) * 1_000_000 / u64::from(motion.rate);
        let field = |code| match code {
            "t" => (layout.stamp)(time),
            "d" => (layout.second)(time),
            _ => field(layout, code, row, &sample),
        };
        let fields: Vec<String> = layout.codes.split(' ').map(field).collect();
        let _ = writeln!(log, "{}", fields.join(layout.between));
    }
    log
}

/// The text of a field of this kind.
fn field(layout: &Layout, code: &str, row: u32, sample: &Row) -> String {
    let axis = |letter: &str| ["x", "y", "z"].iter().position(|axis| *axis == letter);
    let (kind, rest) = code.split_at(1);
    let number = match (kind, axis(rest)) {
        ("g", Some(axis)) => {
            (sample.rate[axis] + 2e-5 * noise(row, 1 + u32::try_from(axis).unwrap()))
                / layout.gyro.1
        }
        ("a", Some(axis)) => {
            let noise = 2e-3 * noise(row, 5 + u32::try_from(axis).unwrap());
            (sample.force[axis] + noise) / layout.accel.1
        }
        // Without gravity.
        ("l", Some(axis)) => 0.02 * noise(row, 9 + u32::try_from(axis).unwrap()),
        ("m", Some(axis)) => {
            let field = [20.0 * sample.table.cos(), -20.0 * sample.table.sin(), 44.0];
            field[axis] + 0.2 * noise(row, 13 + u32::try_from(axis).unwrap())
        }
        ("q", _) => {
            let half = sample.table / 2.0;
            match rest {
                "w" => half.cos(),
                "z" => half.sin(),
                _ => 0.0,
            }
        }
        ("e", _) if rest == "z" => sample.table.to_degrees(),
        ("e", _) => 0.1 * noise(row, 17),
        ("T", _) => 25.0 + 1e-4 * f64::from(row) + 0.01 * noise(row, 19),
        ("P", _) => 1013.25 + 0.05 * noise(row, 20),
        ("0", _) => 0.0,
        ("n", _) => return row.to_string(),
        ("s", _) => return rest.to_string(),
        _ => panic!("{code}"),
    };
    let decimals = if kind == "q" { 7 } else { layout.decimals };
    let text = format!("{number:.decimals$}");
    if layout.comma { text.replace('.', ",") } else { text }
}

/// A key of the draft's log.
fn key<'t>(table: &'t toml::Table, path: &[&str]) -> Option<&'t toml::Value> {
    let (last, sections) = path.split_last()?;
    let section = sections.iter().try_fold(table, |table, name| table.get(*name)?.as_table())?;
    section.get(*last)
}

/// A text, or those in a list.
fn texts(value: &toml::Value) -> Vec<&str> {
    match value {
        toml::Value::Array(texts) => texts.iter().filter_map(toml::Value::as_str).collect(),
        text => text.as_str().into_iter().collect(),
    }
}

/// Whether a draft leaves a question open, or what of it is wrong.
fn judged(layout: &Layout, draft: &Draft) -> Result<bool, String> {
    let table: toml::Table = draft.text.parse().unwrap();
    let codes: Vec<&str> = layout.codes.split(' ').collect();
    let names = layout.names();
    let place = |value: &toml::Value| -> Option<usize> {
        let name = value.as_str()?;
        let named = names.iter().position(|known| known == name);
        named.or_else(|| name.parse::<usize>().ok()?.checked_sub(1))
    };
    let mut open = false;
    for (sensor, letter, (unit, _)) in [("gyro", "g", layout.gyro), ("accel", "a", layout.accel)] {
        match key(&table, &["log", sensor, "columns"]) {
            None => open = true,
            Some(found) => {
                let found: Vec<_> = found.as_array().unwrap().iter().map(place).collect();
                let expected = ["x", "y", "z"]
                    .map(|axis| codes.iter().position(|code| *code == format!("{letter}{axis}")));
                if found != expected {
                    return Err(format!("{sensor}.columns are {found:?}, not {expected:?}"));
                }
            }
        }
        match key(&table, &["log", sensor, "unit"]).and_then(toml::Value::as_str) {
            None => open = true,
            Some(found) if found != unit => {
                return Err(format!("{sensor}.unit is {found}, not {unit}"));
            }
            Some(_) => {}
        }
    }
    let time = |name: &str| key(&table, &["log", "time", name]);
    let columns = match (time("column"), time("columns")) {
        (Some(column), None) => vec![place(column)],
        (None, Some(columns)) => columns.as_array().unwrap().iter().map(place).collect(),
        _ => Vec::new(),
    };
    let units = time("unit").map(texts);
    let known = |place: &Option<usize>| place.is_some_and(|place| layout.times().contains(&place));
    if !columns.iter().all(known) {
        return Err(format!("time is in {columns:?}"));
    }
    open |= columns.is_empty();
    match units {
        None => open = true,
        Some(units) if !layout.time_units.contains(&units.join(" ").as_str()) => {
            return Err(format!("time.unit is {units:?}, not one of {:?}", layout.time_units));
        }
        Some(_) => {}
    }
    for other in ["table_angle", "table_rate"] {
        if key(&table, &["log", other]).is_some() {
            return Err(format!("there is no {other}"));
        }
    }
    let temperature = key(&table, &["log", "temperature", "column"]);
    if temperature.is_some_and(|found| place(found).is_none_or(|place| codes[place] != "T")) {
        return Err(format!("temperature is in {temperature:?}"));
    }
    if layout.comma != (key(&table, &["log", "decimal"]).is_some()) {
        return Err("decimal is wrong".into());
    }
    Ok(open)
}

#[test]
fn no_layout_is_drafted_wrongly() {
    let (mut right, mut asking, mut wrong) = (0, Vec::new(), Vec::new());
    for (layout, motion) in
        LAYOUTS.iter().flat_map(|layout| MOTIONS.iter().map(move |m| (layout, m)))
    {
        let name = format!("{} at {} Hz, tilt {}", layout.name, motion.rate, motion.tilt);
        let folder = folder(&[(layout.file, logged(layout, motion).as_bytes())]);
        let draft = draft(folder.path(), layout.file);
        match judged(layout, &draft) {
            Ok(false) => right += 1,
            Ok(true) => {
                let open: Vec<_> = draft.to_fill_in.iter().map(|open| open.key.as_str()).collect();
                let open = open.iter().filter(|key| key.starts_with("log.")).copied();
                asking.push(format!("{name}: {}", open.collect::<Vec<_>>().join(", ")));
            }
            Err(fault) => wrong.push(format!("{name}: {fault}\n{}", draft.text)),
        }
    }
    println!("{right} right, {} asking:\n{}", asking.len(), asking.join("\n"));
    let count = LAYOUTS.len() * MOTIONS.len();
    assert!(wrong.is_empty(), "{} of {count} wrong:\n{}", wrong.len(), wrong.join("\n"));
    // Most logs need no question; fewer would say that the draft asks too much.
    assert!(right * 5 >= count * 3, "only {right} right; asking:\n{}", asking.join("\n"));
}
