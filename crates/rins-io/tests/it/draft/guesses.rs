//! Units and columns without a statement, determined from the magnitude of the numbers.

use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, STANDARD_GRAVITY};
use rins_io::read;
use rins_testing::{assert_close, filled};

use super::support::{Motion, SITE, draft};
use crate::support::folder;

/// A unit: its spelling in a rig file, its value in SI units, and whether it is an increment.
type Spelt = (&'static str, f64, bool);

const GYROS: [Spelt; 6] = [
    ("rad/s", 1.0, false),
    ("deg/s", DEG, false),
    ("deg/h", DEG_PER_HOUR, false),
    ("rad", 1.0, true),
    ("deg", DEG, true),
    ("arcsec", ARCSEC, true),
];
const ACCELS: [Spelt; 6] = [
    ("m/s^2", 1.0, false),
    ("g", STANDARD_GRAVITY, false),
    ("mg", 1e-3 * STANDARD_GRAVITY, false),
    ("ug", 1e-6 * STANDARD_GRAVITY, false),
    ("m/s", 1.0, true),
    ("ug*s", 1e-6 * STANDARD_GRAVITY, true),
];
const TABLES: [(&str, f64); 4] =
    [("rad", 1.0), ("deg", DEG), ("arcsec", ARCSEC), ("rev", std::f64::consts::TAU)];
const TIMES: [(&str, f64); 4] = [("s", 1.0), ("ms", 1e-3), ("us", 1e-6), ("ns", 1e-9)];

/// A log of `motion` in these units; `names` is its header.
fn log(motion: &Motion, names: &str, gyro: Spelt, accel: Spelt, others: (f64, f64)) -> String {
    let mut log = String::from(names);
    for row in motion.rows() {
        let over = |spelt: Spelt| if spelt.2 { f64::from(motion.rate) * spelt.1 } else { spelt.1 };
        let (w, f) = (row.rate / over(gyro), row.force / over(accel));
        let (time, table) = (row.time / others.0, row.table / others.1);
        log.push_str(&format!(
            "{time},{:e},{:e},{:e},{},{},{},{table:.9}\n",
            w.x, w.y, w.z, f.x, f.y, f.z
        ));
    }
    log
}

/// All pairs of units of gyros and accelerometers, each with some unit of table and time.
#[test]
fn units_are_those_in_which_gravity_and_the_table_come_out_right() {
    let motion = Motion { rate: 40, ..Motion::default() };
    for (index, gyro) in GYROS.into_iter().enumerate() {
        for (other, accel) in ACCELS.into_iter().enumerate() {
            let (table, time) = (TABLES[(index + other) % 4], TIMES[(index + 2 * other) % 4]);
            let names = "t,gx,gy,gz,ax,ay,az,table\n";
            let log = log(&motion, names, gyro, accel, (time.1, table.1));
            let folder = folder(&[("run.csv", log.as_bytes())]);
            let draft = draft(folder.path(), "run.csv");
            let expected = [
                ("log.time.unit", time.0),
                ("log.gyro.unit", gyro.0),
                ("log.accel.unit", accel.0),
                ("log.table_angle.unit", table.0),
            ];
            for (key, unit) in expected {
                let guess = draft.guesses.iter().find(|guess| guess.key == key);
                let value = guess.map(|guess| guess.value.as_str());
                assert_eq!(value, Some(format!("{unit:?}").as_str()), "{key}\n{}", draft.text);
            }
            let spin = draft.guesses.iter().find(|guess| guess.key == "axis.spin");
            assert_eq!(spin.map(|guess| guess.value.as_str()), Some("\"z\""));

            let rig = folder.path().join("rig.toml");
            std::fs::write(&rig, filled(&draft.text, &SITE)).unwrap();
            let loaded = read(&rig).unwrap();
            let rows: Vec<_> = motion.rows().collect();
            for at in [0, 1200, 2800] {
                let rates = loaded.recording.increments[at].rates();
                let force = rates.specific_force.components() - rows[at].force;
                let rate = rates.angular_rate.components() - rows[at].rate;
                assert_close!(force.norm(), 0.0, 1e-6);
                assert_close!(rate.norm(), 0.0, 1e-9);
                let angles = loaded.recording.table_angle.as_ref().unwrap();
                assert_close!(angles[at], rows[at].table, 1e-7);
            }
        }
    }
}

/// With gravity along the axis, only the table or, at rest, the Earth rate determines the gyros' unit.
#[test]
fn gyros_are_measured_by_the_table_or_by_the_earth() {
    let level = Motion { tilt: 0.0, ..Motion::default() };
    for gyro in GYROS {
        let accel = ACCELS[0];
        let names = "t,gx,gy,gz,ax,ay,az,table (deg)\n";
        let with_table = log(&level, names, gyro, accel, (1.0, DEG));
        let at_rest: Vec<&str> = with_table.lines().take(1000).collect();
        let without = at_rest.join("\n").replacen("table (deg)", "other", 1);
        for (text, why) in
            [(with_table.as_str(), "equals that of the table"), (&without, "Earth's rate")]
        {
            let folder = folder(&[("run.csv", text.as_bytes())]);
            let draft = draft(folder.path(), "run.csv");
            let guess = draft.guesses.iter().find(|guess| guess.key == "log.gyro.unit").unwrap();
            assert_eq!(guess.value, format!("{:?}", gyro.0));
            assert!(guess.why.contains(why), "{}", guess.why);
        }
    }
}

/// The jumps of a wrapped angle determine its unit, whatever the gyros indicate.
#[test]
fn the_jump_of_a_wrapped_angle_is_a_turn() {
    for (unit, factor) in [("rad", 1.0), ("deg", DEG), ("rev", std::f64::consts::TAU)] {
        let turn = std::f64::consts::TAU / factor;
        let mut log = String::from("t,encoder\n");
        for row in 0..1500 {
            let angle = (f64::from(row) * 0.02 / factor).rem_euclid(turn);
            log.push_str(&format!("{},{angle}\n", f64::from(row) * 0.02));
        }
        let folder = folder(&[("run.csv", log.as_bytes())]);
        let draft = draft(folder.path(), "run.csv");
        let guess = draft.guesses.iter().find(|guess| guess.key == "log.table_angle.unit");
        assert_eq!(guess.map(|guess| guess.value.clone()), Some(format!("{unit:?}")));
    }
}

#[test]
fn columns_without_names_are_told_by_gravity() {
    let motion = Motion::default();
    let log = log(&motion, "", GYROS[1], ACCELS[1], (1.0, 1.0));
    let swapped: String = log
        .lines()
        .map(|line| {
            let field: Vec<&str> = line.split(',').collect();
            let order = [field[4], field[5], field[6], field[0], field[1], field[2], field[3]];
            order.join(" ") + "\n"
        })
        .collect();
    let cases = [
        (log.as_str(), ["\"1\"", r#"["2", "3", "4"]"#, r#"["5", "6", "7"]"#]),
        (&swapped, ["\"4\"", r#"["5", "6", "7"]"#, r#"["1", "2", "3"]"#]),
    ];
    for (text, columns) in cases {
        let folder = folder(&[("run.txt", text.as_bytes())]);
        let draft = draft(folder.path(), "run.txt");
        for (key, value) in
            ["log.time.column", "log.gyro.columns", "log.accel.columns"].into_iter().zip(columns)
        {
            let guess = draft.guesses.iter().find(|guess| guess.key == key).unwrap();
            assert_eq!(guess.value, value, "{key}");
        }
        assert!(draft.text.contains("gyro.unit = \"deg/s\"  # GUESS"));
    }
}

#[test]
fn a_header_that_gravity_contradicts_is_doubted() {
    let names = "t,gx (deg/s),gy (deg/s),gz (deg/s),ax (g),ay (g),az (g),table (rad)\n";
    let log = log(&Motion::default(), names, GYROS[0], ACCELS[0], (1.0, 1.0));
    let folder = folder(&[("run.csv", log.as_bytes())]);
    let draft = draft(folder.path(), "run.csv");
    let why = |key: &str| draft.guesses.iter().find(|guess| guess.key == key).unwrap().why.clone();
    assert_eq!(why("log.accel.unit"), "stated in the header, but gravity is then 96.08 m/s^2");
    assert_eq!(
        why("log.gyro.unit"),
        "stated in the header, but their rotation is then 0.01746 times that of the table"
    );
}

#[test]
fn the_axis_that_turns_is_found_with_its_sign() {
    let motion = Motion::default();
    let mut log = String::from("t,gx,gy,gz,ax,ay,az,table\n");
    for row in motion.rows() {
        // The sensor is mounted on its side: its x points down along the axis.
        let (w, f) = (row.rate, row.force);
        log.push_str(&format!(
            "{},{:e},{:e},{:e},{},{},{},{}\n",
            row.time, -w.z, w.y, w.x, -f.z, f.y, f.x, row.table
        ));
    }
    let folder = folder(&[("run.csv", log.as_bytes())]);
    let draft = draft(folder.path(), "run.csv");
    assert!(draft.text.contains("spin = \"-x\"  # GUESS"), "{}", draft.text);
    assert!(draft.text.contains("gyro.unit = \"rad/s\"  # GUESS"), "{}", draft.text);
}
