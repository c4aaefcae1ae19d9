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

/// The schedules under which sigmas are compared.
const OF_LIMITS: &str = "i-constant-rate.toml ii-reversal.toml iii-three-rates.toml \
                         v-two-tilts-a.toml+v-two-tilts-b.toml";

/// A sigma by the data alone beside the prototype's, where it has one.
struct Limit {
    id: &'static str,
    /// How many of the unit shown one of the parameter's own is.
    scale: f64,
    unit: &'static str,
    prototype: [Option<f64>; 4],
    /// Up to which factor they agree.
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

/// A second of arc in parts per million.
const PPM_OF_ARCSEC: f64 = 4.848;

/// An alike setting: within a tenth.
const SAME: f64 = 1.1;

/// What a run of half the length, or an axis tilted to another side, makes of it: a factor of two at most.
const ALIKE: f64 = 2.15;

/// What differs by more is told below the table.
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

/// Sigmas by the data alone under each schedule, beside the effects of `baseline` and one that does not matter.
fn sigmas(limit: &Limit) -> Vec<f64> {
    let other =
        if limit.id.starts_with("encoder") { "accel_quadratic.x" } else { "encoder_eccentricity" };
    let (term, name) = limit.id.rsplit_once('.').unwrap_or_default();
    // Of what has one parameter alone, of a pair that goes together both.
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

/// A number to two digits.
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

const HEAD: &str = "\
# Observability of rotation schedules

`rins observe` predicts the results of a run before it is made: the Fisher information matrix of all parameters of a model, from
the motion of a scenario and the noise of its `[imu]`. A test generates this page from the schedules in
[scenarios/schedules](https://github.com/rins-rs/rins/tree/main/scenarios/schedules). They take 360 s at 50 Hz, on a spin axis
tilted by 25 deg at latitude 45 deg. The gyros have 0.02 deg/h/√Hz, the accelerometers 30 µg/√Hz and the encoder 1 arcsec.

| schedule | rotation |
| --- | --- |
| i | 10 deg/s |
| ii | forward and back |
| iii | ±5, ±10 and ±20 deg/s |
| iv | eight static intervals |
| v | forward and back at two tilts |

## Method

All parameters are scaled by their prior sigmas. The parameters are then ordered:

1. The most observable parameter is retained first.
2. The parameter that is most observable beside the retained ones follows, as long as the data determine it better than the prior.
3. Each remaining parameter is a combination of the retained ones, either exactly or up to a negligible amount of information.
   *Exactly* means that less than 10⁻¹¹ of its information is independent. The evaluation of the rotation at the middle of a
   sample leaves 10⁻¹².

A retained parameter that is combined with others is reported as the sum only, such as
`gyro.misalignment.xz + 5.73 arcsec/(deg/h) × gyro.bias.x`. A remaining parameter is reported as the sum that the data determine
best. A gauge, a combination of parameters that amounts to a choice of axes, units or origins, is unobservable under every
schedule and is named. A calibration reports the observability of its run in the same terms, with the estimated noise.

## JSON

With `--json`, `schedules` holds for each schedule:

| key | meaning |
| --- | --- |
| `rank`, `null_space_dimension` | of the information matrix of the data alone |
| `observable`, `combination`, `unobservable` | ids of the parameters that are observable, observable only in a combination, unobservable |
| `gauges` | the gauges |
| `parameters` | see below |
| `separation` | `kappa` and `separation_sigma` of a pair of effects, each against the other |

Each of the `parameters` holds:

| key | meaning |
| --- | --- |
| `prior_sigma` | the sigma of the prior |
| `data_sigma` | the sigma by the data alone, of the combination if there is one; null if the data do not bound it |
| `sigma` | the sigma by the data and the prior |
| `identifiable`, `observability` | as in [a calibration](calibration.md#observability) |
| `aliases`, `combination` | the other parameters of the combination, and their coefficients |
| `gauge` | the gauge to which the parameter belongs |

`proposal` holds the recommended next schedule: its `profile`, its `attitude_deg`, and the predicted result.

## Dimension of the null space

`baseline` holds biases, attitude, mounting and the gyro errors along the spin axis. `full` holds all errors of eq. (1) and the
attitude.

| model, unknowns | i | ii | iii | iv | v |
| --- | --- | --- | --- | --- | --- |
";

const INVISIBLE: &str = "
At one rate the null space has three dimensions: each bias forms one combination with an error that is proportional to the rate.
Under every schedule with one tilt, `full` has further unobservable combinations, because the specific force along the spin axis is
constant: biases with misalignments, and scale errors with the tilt. The table gives 1σ by the data alone (deg/h, ppm, arcsec), for
`baseline`, in which the mounting limits the misalignments:

| parameter | i | ii | iii | iv | v |
| --- | --- | --- | --- | --- | --- |
";

const COSTS: &str = "
## Separation of two effects

An effect that is detected by `s` sigma differs from another effect by `s/κ` sigma. `1/κ` is the sine of the angle between the
signatures of the two effects after the parameters of `baseline` are estimated. For effects with several parameters it is the
angle in the worst direction. `rins observe --compare --separate A,B` computes `κ`:

| effects | i | ii | iii | iv | v |
| --- | --- | --- | --- | --- | --- |
";

const FIGURES: &str = "
An independent linear prototype gives the same infinities, and other values within a factor of two, with two exceptions:

- Under (i) it gives no value for the pairs with a delay or with a cube of the rate. There the nuisance parameters, which have no
  prior, absorb the first effect.
- `accel_latency` and `wrong_latitude` have one common signature there under (i). They are separated here, because the initial
  attitude of a run is known to 2 mrad.

For some further pairs the results differ:

| effects | schedule | here | prototype | why |
| --- | --- | --- | --- | --- |
| `encoder_latency`, `clock_drift` | ii | 4.8 | 64 | the ramp from standstill is a second change of rate; without ramps: 70 |
| `gyro_scale_asymmetry`, `gyro_rate_dependent_bias.square_z` | ii | 11 | 41 | the prior of the bias is 0.1 deg/h; with 1000 deg/h: 31 |
| `gyro_scale_asymmetry`, `encoder_latency` | ii | 1.9 | 9 | unexplained; with an unknown bias: 2.6 |
| `accel_lever_arm`, `accel_vibration_rectification` | ii | 1.1 | 2.6 | the latter is proportional to the rate here, to its square there; not tested |
| `dropped_samples`, `encoder_slip` | ii | ∞ | 1.2 | they occur at 300 s, after the last change of rate, where both are one constant |
| `base_tilt_ramp`, `clock_drift` | i | 1.0 | 24 | unexplained; on an axis tilted to the east: 5.0 |

## Uncertainty by the data alone

1σ by the data alone, and in brackets the value of the prototype:

| parameter | unit | i | ii | iii | v |
| --- | --- | --- | --- | --- | --- |
";

const REASONS: &str = "
The values differ for these reasons:

| parameter | schedule | factor | reason |
| --- | --- | --- | --- |
| `gyro_g_sensitivity.xy`, `wrong_latitude` | | 1.4, 2 | the axis is tilted to the south here; tilted to the east they are 0.0035 deg/h/g and 0.34 arcmin, as in the prototype |
| `accel_bias_step.x` | | 1.3 | the step is at 300 s here and at 150 s there: the sigma of a step in white noise is proportional to `√(T / t (T - t))` |
| parameters of each run, such as encoder, wobble, latitude | v | 1.4 | each run holds half of the data |
| `accel_lever_arm` | ii, v | | it is observable by changes of rate alone: with 2.5 deg/s², with 5 deg/s² and at once it is 1.8, 1.4 and 0.72 mm; the acceleration of the prototype's table is unknown |
| `accel_latency` | i | | probably the initial attitude, known to 2 mrad here |
| `accel_vibration_rectification` | | | probably because it is proportional to the rate here, and to its square there |
| `base_tilt_ramp` | v | | probably because one tilt continues through both runs there, and each run has its own here |
| `gyro.scale.z`, `encoder_latency` | iii | | probably because the rates are held for different times |
| `accel_quadratic.x` | v | | unexplained |
";
