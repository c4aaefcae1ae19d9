//! The page of the book that lists the keys of a rig file has those that the reader knows, and no others.

use std::collections::BTreeSet;
use std::path::Path;

use rins_io::Rig;

/// What precedes an unknown key in each section of the page, after a valid rig.
const PLACES: &[(&str, &str)] = &[
    ("[site]", "LOG\n[site]\nlatitude = \"45 deg\"\nKEY"),
    ("[log]", "[log]\npath = \"run.csv\"\nKEY"),
    ("log.time", "[log]\npath = \"run.csv\"\n[log.time]\ncolumn = \"t\"\nunit = \"s\"\nKEY"),
    ("log.gyro", "[log]\npath = \"run.csv\"\nrate = \"1 Hz\"\n[log.gyro]\nKEY"),
    ("log.accel", "[log]\npath = \"run.csv\"\nrate = \"1 Hz\"\n[log.accel]\nKEY"),
    ("log.gyro.where", "SITE LOG\n[log.gyro.where]\nKEY"),
    ("log.table_angle", "SITE LOG\n[log.table_angle]\nKEY"),
    ("log.table_rate", "SITE LOG\n[log.table_rate]\nKEY"),
    ("log.temperature", "SITE LOG\n[log.temperature]\nKEY"),
    ("[attitude]", "SITE LOG\n[attitude]\nKEY"),
    ("[axis]", "SITE LOG\n[axis]\nKEY"),
    ("[table]", "SITE LOG\n[table]\nKEY"),
    ("table.profile", "SITE LOG\n[[table.profile]]\nKEY"),
    ("[imu]", "SITE LOG\n[imu]\nKEY"),
    ("[imu.gyro]", "SITE LOG\n[imu.gyro]\nKEY"),
    ("[run]", "SITE LOG\n[run]\nKEY"),
    ("[lab]", "SITE LOG\n[lab]\nKEY"),
    ("[tolerance]", "SITE LOG\n[tolerance]\nKEY"),
    ("[tolerance.gyro]", "SITE LOG\n[tolerance.gyro]\nKEY"),
];

const SITE: &str = "[site]\nlatitude = \"45 deg\"\n";

const LOG: &str = r#"
[log]
path = "run.csv"
rate = "1 Hz"
[log.accel]
columns = ["a", "b", "c"]
unit = "g"
[log.gyro]
columns = ["d", "e", "f"]
unit = "deg/s"
"#;

/// The keys that the reader expects where it finds an unknown one.
fn known(place: &str) -> BTreeSet<String> {
    let text = place.replace("SITE", SITE).replace("LOG", LOG).replace("KEY", "unheard_of = 1");
    let error = Rig::parse(&text, Path::new("rig.toml")).unwrap_err().to_string();
    let (_, keys) = error
        .split_once("unheard_of: unknown key, expected one of ")
        .unwrap_or_else(|| panic!("{place}: {error}"));
    keys.split(", ").map(str::to_owned).collect()
}

/// The keys in the table of each section of the page.
fn listed(page: &str) -> Vec<(String, BTreeSet<String>)> {
    let mut sections: Vec<(String, BTreeSet<String>)> = Vec::new();
    for line in page.lines() {
        if let Some(heading) = line.strip_prefix('#') {
            let name = heading.trim_start_matches('#').trim().trim_matches('`');
            sections.push((name.into(), BTreeSet::new()));
        } else if let Some(cells) = line.strip_prefix("| `") {
            let keys = cells.split(" | ").next().unwrap().trim_end_matches('`');
            let (_, of_section) = sections.last_mut().unwrap();
            of_section.extend(keys.split("`, `").map(str::to_owned));
        }
    }
    sections
}

#[test]
fn the_page_of_the_rig_file_lists_every_key() {
    let page = concat!(env!("CARGO_MANIFEST_DIR"), "/../../docs/src/rig-file.md");
    let sections = listed(&std::fs::read_to_string(page).unwrap());
    let of_page: BTreeSet<&str> = sections[1..].iter().map(|(name, _)| name.as_str()).collect();
    assert_eq!(of_page, PLACES.iter().map(|(name, _)| *name).collect());
    for (name, place) in PLACES {
        let (_, keys) = sections.iter().find(|(section, _)| section == name).unwrap();
        assert_eq!(*keys, known(place), "{name}");
    }
    // Every section of a rig file is on the page.
    let sections = known("KEY");
    let named = |section: &String| of_page.contains(format!("[{section}]").as_str());
    assert!(sections.iter().all(named), "{sections:?}");
}
