//! The book's page on effects that schedules distinguish: generated from the shipped schedules, and compared with independent
//! figures.
//!
//! After an intended change, `RINS_RENEW=1 cargo test -p rins-tests identifiability` writes the page again.

mod page;

use self::page::{COSTS, FIGURES, HEAD, INVISIBLE, REASONS};
use std::fmt::Write as _;

use crate::support::{list, number, result_in};
use serde_json::Value;

/// The schedules of the table's columns.
const SCHEDULES: &str = "i-constant-rate.toml ii-reversal.toml iii-three-rates.toml iv-dwells.toml \
                         v-two-tilts-a.toml+v-two-tilts-b.toml";

const INFINITE: f64 = f64::INFINITY;

/// Two effects, and the separations of an independent linear prototype under each schedule; none if
/// the prototype treats the first as a nuisance parameter, or the schedules differ in a relevant way.
struct Row {
    pair: &'static str,
    prototype: [Option<f64>; 5],
}

const fn row(pair: &'static str, prototype: [Option<f64>; 5]) -> Row {
    Row { pair, prototype }
}

const ROWS: [Row; 12] = [
    row(
        "gyro_g_sensitivity,encoder_eccentricity",
        [Some(113.0), Some(1.0), Some(1.0), Some(1.3), Some(1.0)],
    ),
    row(
        "gyro_g2_sensitivity,encoder_harmonic",
        [Some(94.0), Some(1.0), Some(1.0), Some(1.2), Some(1.0)],
    ),
    row(
        "gyro_g2_sensitivity,table_wobble",
        [Some(60.0), Some(1.0), Some(1.0), Some(1.1), Some(1.0)],
    ),
    row(
        "gyro_bias_ramp.z,gyro_scale_ramp",
        [Some(INFINITE), Some(1.0), Some(1.3), Some(1.2), Some(1.2)],
    ),
    row(
        "base_tilt_ramp,cable_torque_tilt",
        [Some(INFINITE), Some(1.0), Some(1.0), Some(1.1), Some(1.0)],
    ),
    row(
        "gyro_g_sensitivity.zx,gyro_magnetic",
        [Some(INFINITE), Some(INFINITE), Some(INFINITE), Some(INFINITE), Some(2.0)],
    ),
    row(
        "gyro_g_sensitivity.zx,gyro.misalignment",
        [Some(INFINITE), Some(INFINITE), Some(INFINITE), Some(INFINITE), Some(1.6)],
    ),
    row("encoder_latency,gyro_lag", [None, Some(18.0), Some(29.0), Some(87.0), Some(35.0)]),
    row("encoder_latency,encoder_backlash", [None, Some(3.3), Some(1.8), Some(2.0), Some(3.2)]),
    row(
        "gyro_scale_nonlinearity.k3_z,gyro_scale_nonlinearity.k2_z",
        [None, Some(24.0), Some(11.0), Some(16.0), Some(24.0)],
    ),
    row("accel_quadratic.x,accel_asymmetry", [Some(4.6), Some(4.6), Some(4.6), Some(3.6), None]),
    row("accel_latency,wrong_latitude", [None, Some(1.0), Some(1.0), Some(1.0), Some(1.0)]),
];

/// The factor for the prototype's figures, which are for another arrangement of the same rates and static intervals.
const FACTOR: f64 = 2.1;

/// The schedules under which sigmas are compared.
const OF_LIMITS: &str = "i-constant-rate.toml ii-reversal.toml iii-three-rates.toml \
                         v-two-tilts-a.toml+v-two-tilts-b.toml";

/// A sigma from the data alone, with that of the prototype, if it has one.
struct Limit {
    id: &'static str,
    /// The number of displayed units in one unit of the parameter.
    scale: f64,
    unit: &'static str,
    prototype: [Option<f64>; 4],
    /// The factor within which they agree.
    within: f64,
}

const fn limit(
    id: &'static str,
    (scale, unit): (f64, &'static str),
    prototype: [Option<f64>; 4],
    within: f64,
) -> Limit {
    Limit { id, scale, unit, prototype, within }
}

/// One arcsecond in parts per million.
const PPM_OF_ARCSEC: f64 = 4.848;

/// An equal setting: within a tenth.
const SAME: f64 = 1.1;

/// The effect of a run of half the length, or of an axis tilted to another side: at most a factor of two.
const ALIKE: f64 = 2.15;

/// Larger differences are explained below the table.
const APART: f64 = 8.0;

const LIMITS: [Limit; 17] = [
    limit(
        "gyro_g_sensitivity.zx",
        (1.0, "deg/h/g"),
        [Some(0.0057), Some(0.0056), Some(0.0057), Some(0.0078)],
        1.2,
    ),
    limit(
        "gyro_g_sensitivity.xy",
        (1.0, "deg/h/g"),
        [Some(0.0035), Some(0.0035), Some(0.0035), Some(0.005)],
        ALIKE,
    ),
    limit("gyro.scale.z", (1.0, "ppm"), [None, Some(0.031), Some(0.024), Some(0.032)], 1.4),
    limit(
        "gyro.misalignment.xz",
        (PPM_OF_ARCSEC, "ppm"),
        [None, Some(5.3), Some(5.3), Some(7.2)],
        SAME,
    ),
    limit("gyro_scale_asymmetry.z", (1.0, "ppm"), [None, Some(1.1), Some(0.052), Some(0.83)], 1.3),
    limit("encoder_latency.delay", (1e3, "us"), [None, Some(1.2), Some(0.57), Some(0.85)], ALIKE),
    limit(
        "accel_latency.delay",
        (1e3, "us"),
        [Some(1340.0), Some(21.5), Some(16.5), Some(30.0)],
        APART,
    ),
    limit(
        "encoder_eccentricity.cos",
        (1.0, "arcsec"),
        [Some(0.014), Some(0.014), Some(0.014), Some(0.014)],
        ALIKE,
    ),
    limit(
        "table_wobble.cos",
        (1.0, "arcsec"),
        [Some(0.006), Some(0.006), Some(0.005), Some(0.006)],
        ALIKE,
    ),
    limit(
        "base_tilt_ramp.x",
        (0.1, "arcsec in 360 s"),
        [Some(1.25), Some(1.25), Some(1.25), Some(0.42)],
        APART,
    ),
    limit(
        "accel_quadratic.x",
        (1.0, "ug/g^2"),
        [Some(25.0), Some(25.0), Some(25.0), Some(26.0)],
        ALIKE,
    ),
    limit("accel.scale.x", (1.0, "ppm"), [Some(7.5), Some(7.5), Some(7.5), Some(10.0)], SAME),
    limit(
        "accel.misalignment.xy",
        (PPM_OF_ARCSEC, "ppm"),
        [Some(7.5), Some(7.5), Some(7.5), Some(10.0)],
        SAME,
    ),
    limit("accel_bias_step.x", (1.0, "ug"), [Some(3.2), Some(3.2), Some(3.2), None], ALIKE),
    limit(
        "wrong_latitude.latitude",
        (1.0, "arcmin"),
        [Some(0.34), Some(0.34), Some(0.34), Some(0.33)],
        APART,
    ),
    limit("accel_lever_arm.r_x", (1.0, "mm"), [None, Some(6.7), Some(0.32), Some(4.8)], APART),
    limit(
        "accel_vibration_rectification.x",
        (1.0, "ug"),
        [None, Some(21.0), Some(1.0), Some(15.0)],
        APART,
    ),
];

/// The sigmas from the data alone under each schedule, with the effects of `baseline` and an irrelevant one.
fn sigmas(limit: &Limit) -> Vec<f64> {
    let other =
        if limit.id.starts_with("encoder") { "accel_quadratic.x" } else { "encoder_eccentricity" };
    let (term, name) = limit.id.rsplit_once('.').unwrap_or_default();
    // One parameter of a single effect, both of a pair that belongs together.
    let asked = if name == "cos" || term == "base_tilt_ramp" { term } else { limit.id };
    let told = compared(&format!("{OF_LIMITS} --separate {asked},{other}"));
    let sigma = |schedule: &Value| {
        let parameters = list(schedule, "/parameters");
        let parameter = parameters.iter().find(|parameter| parameter["id"] == limit.id);
        let parameter = parameter.unwrap_or_else(|| panic!("{}", limit.id));
        parameter["data_sigma"].as_f64().map_or(INFINITE, |sigma| sigma * limit.scale)
    };
    list(&told, "/schedules").iter().map(sigma).collect()
}

/// A number with two digits.
fn two_digits(value: f64) -> String {
    let decimals = match value {
        value if value < 0.01 => 4,
        value if value < 0.1 => 3,
        value if value < 1.0 => 2,
        value if value < 10.0 => 1,
        _ => 0,
    };
    format!("{value:.decimals$}")
}

fn compared(arguments: &str) -> Value {
    let folder = rins_tests::workspace().join("scenarios/schedules");
    result_in(&folder, &format!("observe --compare {arguments}"))
}

fn costs(pair: &str) -> Vec<f64> {
    let told = compared(&format!("{SCHEDULES} --separate {pair}"));
    let cost = |schedule: &Value| {
        schedule.pointer("/separation/each/0/kappa").and_then(Value::as_f64).unwrap_or(INFINITE)
    };
    list(&told, "/schedules").iter().map(cost).collect()
}

fn shown(cost: f64) -> String {
    match cost {
        cost if cost.is_infinite() => "∞".into(),
        cost if cost < 10.0 => format!("{cost:.1}"),
        cost => format!("{cost:.0}"),
    }
}

#[test]
fn identifiability_page_is_what_the_schedules_tell() {
    let mut page = String::from(HEAD);
    let baseline = compared(&format!("{SCHEDULES} --model baseline"));
    let full = compared(SCHEDULES);
    let losses = |told: &Value| -> Vec<f64> {
        list(told, "/schedules")
            .iter()
            .map(|schedule| number(schedule, "/null_space_dimension"))
            .collect()
    };
    let cells =
        |losses: &[f64]| losses.iter().fold(String::new(), |row, loss| row + &format!(" {loss} |"));
    assert_eq!(losses(&baseline)[..4], [3.0, 0.0, 0.0, 0.0]);
    let _ = writeln!(page, "| `baseline`, 14 |{}", cells(&losses(&baseline)));
    let _ = writeln!(page, "| `full`, 27 |{}", cells(&losses(&full)));
    page.push_str(INVISIBLE);
    for id in ["gyro.bias.x", "gyro.bias.z", "gyro.scale.z", "gyro.misalignment.xz"] {
        let each = list(&baseline, "/schedules").iter().map(|schedule| {
            let parameters = list(schedule, "/parameters");
            let parameter = parameters.iter().find(|parameter| parameter["id"] == id);
            let parameter = parameter.unwrap_or_else(|| panic!("{id}"));
            match parameter["observability"].as_str() {
                Some("observable") => format!(" {:.2e} |", number(parameter, "/data_sigma")),
                Some("prior_dominated") => " nothing |".to_string(),
                _ => format!(" with `{}` |", parameter["aliases"][0].as_str().unwrap_or("?")),
            }
        });
        let _ = writeln!(page, "| `{id}` |{}", each.collect::<String>());
    }
    page.push_str(COSTS);
    for Row { pair, prototype } in &ROWS {
        let found = costs(pair);
        for (found, expected) in found.iter().zip(prototype) {
            let Some(expected) = expected else { continue };
            let agrees = if expected.is_infinite() {
                found.is_infinite()
            } else {
                (1.0 / FACTOR..FACTOR).contains(&(found / expected))
            };
            assert!(agrees, "{pair}: {found}, and the prototype has {expected}");
        }
        let cells =
            found.iter().fold(String::new(), |row, cost| row + &format!(" {} |", shown(*cost)));
        let names = pair.replace(',', "` and `");
        let _ = writeln!(page, "| `{names}` |{cells}");
    }
    page.push_str(FIGURES);
    for limit in &LIMITS {
        let mut cells = String::new();
        for (found, prototype) in sigmas(limit).into_iter().zip(limit.prototype) {
            let Some(expected) = prototype else {
                cells.push_str(" |");
                continue;
            };
            let ratio = found / expected;
            let agrees = (1.0 / limit.within..limit.within).contains(&ratio);
            assert!(agrees, "{}: {found}, and the prototype has {expected}", limit.id);
            let _ = write!(cells, " {} ({expected}) |", two_digits(found));
        }
        let _ = writeln!(page, "| `{}` | {} |{cells}", limit.id, limit.unit);
    }
    page.push_str(REASONS);
    let path = rins_tests::workspace().join("docs/src/identifiability.md");
    if std::env::var_os("RINS_RENEW").is_some() {
        std::fs::write(&path, &page).unwrap();
    }
    let written = std::fs::read_to_string(&path).unwrap();
    assert!(written == page, "run `RINS_RENEW=1 cargo test -p rins-tests identifiability`");
}
