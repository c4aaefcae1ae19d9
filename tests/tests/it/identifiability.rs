//! The book's page of what schedules tell apart: made from the shipped schedules, and held against figures from elsewhere.
//!
//! After a change that is meant, `RINS_RENEW=1 cargo test -p rins-tests identifiability` writes the page anew.

use std::fmt::Write as _;

use crate::support::{list, number, result_in};
use serde_json::Value;

/// The schedules of the table's columns.
const SCHEDULES: &str = "i-constant-rate.toml ii-reversal.toml iii-three-rates.toml iv-dwells.toml \
                         v-two-tilts-a.toml+v-two-tilts-b.toml";

const INFINITE: f64 = f64::INFINITY;

/// Two effects, and the separation costs that a linear prototype written apart finds under each schedule; none where
/// it leaves the first to the nuisances, or the schedules differ in what matters.
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

/// A figure of the prototype's is of another arrangement of the same rates and rests: within this factor.
const FACTOR: f64 = 2.1;

/// A sigma that theory sets: a parameter, its usual size, one of its unit in the unit shown, and what the prototype
/// finds with reversal.
struct Limit {
    pair: &'static str,
    size: f64,
    unit: &'static str,
    prototype: f64,
}

const LIMITS: [Limit; 4] = [
    Limit {
        pair: "gyro_g_sensitivity.zx,encoder_eccentricity",
        size: 0.1,
        unit: "deg/h/g",
        prototype: 0.0056,
    },
    Limit {
        pair: "gyro_scale_asymmetry,encoder_eccentricity",
        size: 50.0,
        unit: "ppm",
        prototype: 1.1,
    },
    Limit { pair: "accel_latency,encoder_eccentricity", size: 1e4, unit: "us", prototype: 21.5 },
    Limit { pair: "accel_quadratic.x,encoder_slip", size: 50.0, unit: "ug/g^2", prototype: 25.0 },
];

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
        list(told, "/schedules").iter().map(|schedule| number(schedule, "/rank_loss")).collect()
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
            match &parameter["shown"] {
                shown if shown == "alone" => format!(" {:.2e} |", number(parameter, "/data_sigma")),
                shown if shown == "nothing" => " nothing |".to_string(),
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
    for Limit { pair, size, unit, prototype } in &LIMITS {
        let told = compared(&format!("ii-reversal.toml --separate {pair}"));
        let sigma = size / number(&told, "/schedules/0/separation/each/0/directions/0/seen_sigma");
        assert!((sigma / prototype - 1.0).abs() < 0.1, "{pair}: {sigma}, {prototype}");
        let name = pair.split(',').next().unwrap_or_default();
        let digits = if sigma < 0.1 { 4 } else { 2 };
        let _ = writeln!(page, "| `{name}` | {sigma:.digits$} {unit} | {prototype} {unit} |");
    }
    let path = rins_tests::workspace().join("docs/src/identifiability.md");
    if std::env::var_os("RINS_RENEW").is_some() {
        std::fs::write(&path, &page).unwrap();
    }
    let written = std::fs::read_to_string(&path).unwrap();
    assert!(written == page, "run `RINS_RENEW=1 cargo test -p rins-tests identifiability`");
}

const HEAD: &str = "\
# What a schedule tells apart

`rins observe` reckons, before a run, what it would tell: the Fisher information of all parameters of a model, from the
motion of a scenario and the noise of its `[imu]`. This page is made by a test from the schedules in
[scenarios/schedules](https://github.com/rins-rs/rins/tree/main/scenarios/schedules): 360 s at 50 Hz on an axis
tilted by 25 deg at latitude 45 deg, gyros of 0.02 deg/h/√Hz, accelerometers of 30 µg/√Hz and an encoder of 1 arcsec:
(i) 10 deg/s; (ii) forward and back; (iii) ±5, ±10 and ±20 deg/s; (iv) eight rests; (v) forward and back at two tilts.

Everything is seen in units of what is known beforehand. The best seen parameter is kept first, then what is best
seen beside it, as long as the data tell more of it than was known. What is then left over is a part of what was kept,
exactly or but for something too faint to count. Exactly means that less than 10⁻¹¹ of its information is its
own; that a sample's turn is taken at its middle leaves 10⁻¹². Of a parameter that is kept and has others in it, only the
sum is told, such as `gyro.misalignment.xz + 5.73 arcsec/(deg/h) × gyro.bias.x`; of one that is left over, the sum in which
it is told best. Where parameters make up a choice of axes, units or origins, a gauge, no schedule tells that, and
it is named. A calibration says the same of its run in the same words, from the noise that it found.

With `--json`, `schedules` holds for each `rank`, `rank_loss`, the ids that are told `alone`, `in_combination` and
`not_shown`, `gauges`, and its `parameters`: `prior_sigma`, `data_sigma` (of the sum, if one is told; null if the data
alone tell nothing), `sigma` with both, `identifiable`, `shown` (`alone`, `combination`, `part` of another's, `nothing`), its
`aliases`, the `combination` with coefficients, and its `gauge`; `separation` has `kappa` and `told_sigma` of a pair each way; `proposal` the
schedule to run next, its `profile`, `attitude_deg` and what it is predicted to reach.

## How many combinations are exactly invisible

`baseline` holds biases, attitude, mounting and the gyro errors tied to the spin axis, `full` all of eq. (1) and the
attitude.

| model, unknowns | i | ii | iii | iv | v |
| --- | --- | --- | --- | --- | --- |
";

const INVISIBLE: &str = "
At one rate three are lost: each bias is one number with an error that multiplies the rate. What `full` loses
besides under every schedule of one tilt is what a force along the axis that does not change leaves open: biases against
misalignments, scale errors against the tilt. 1σ by the data alone (deg/h, ppm, arcsec; `baseline`, in which the mounting
limits the misalignments):

| parameter | i | ii | iii | iv | v |
| --- | --- | --- | --- | --- | --- |
";

const COSTS: &str = "
## What it costs to tell two effects apart

An effect that is seen by `s` sigma is told from another by `s/κ`, where `1/κ` is the sine of the angle between
their signatures, the parameters of `baseline` estimated along. Of effects with several parameters it is the angle in the
worst direction. `rins observe --compare --separate A,B` finds it:

| effects | i | ii | iii | iv | v |
| --- | --- | --- | --- | --- | --- |
";

const FIGURES: &str = "
A linear prototype written apart has costs within a factor of two of these and the same infinities, wherever it gives a
figure: under (i) it leaves the first effect of the pairs with a delay or a cube of the rate to the nuisances, of which
nothing is known beforehand there. `accel_latency` and `wrong_latitude`, one signature there under (i), are told apart
here since the first attitude of a run is known to 2 mrad. Further pairs of its list come out otherwise:

| effects | schedule | here | prototype | likely why |
| --- | --- | --- | --- | --- |
| `encoder_latency`, `clock_drift` | ii | 4.8 | 64 | the ramp from rest is a second change of rate |
| `gyro_scale_asymmetry`, `gyro_rate_dependent_bias.square_z` | ii | 11 | 41 | the bias is known beforehand to 0.1 deg/h |
| `gyro_scale_asymmetry`, `encoder_latency` | ii | 1.9 | 9 | the same |
| `accel_lever_arm`, `accel_vibration_rectification` | ii | 1.1 | 2.6 | the latter goes with the rate here, with its square there |
| `dropped_samples`, `encoder_slip` | ii | ∞ | 1.2 | they happen at 300 s, after the last change of rate |
| `base_tilt_ramp`, `clock_drift` | i | 1.5 | 24 | not found |

## What is seen at all

1σ with reversal (ii), beside the prototype's:

| parameter | here | prototype |
| --- | --- | --- |
";
