//! Invalid scenarios are refused, with the invalid quantity.

use proptest::prelude::*;
use rins_imu::{Axis, ImuNoise, NoiseModel, Quantisation, TriadError};
use rins_motion::{Profile, Segment};
use rins_simulation::{Encoder, Scenario, ScenarioError, TableRecord, Temperature, simulate};
use rins_terms::{Model, TermInstance, catalogue};

use crate::{perfect, realistic};

fn refusal(scenario: &Scenario) -> ScenarioError {
    simulate(scenario).expect_err("the scenario is impossible")
}

#[test]
fn impossible_figures_are_named() {
    let mut cases = Vec::new();
    let mut case = |change: &dyn Fn(&mut Scenario), name: &'static str| {
        let mut scenario = perfect();
        change(&mut scenario);
        cases.push((scenario, name));
    };
    case(&|s| s.station.site.latitude = 2.0, "latitude");
    case(&|s| s.station.site.longitude = f64::NAN, "longitude");
    case(&|s| s.station.site.height = 1e7, "height");
    case(&|s| s.station.gravity = -9.8, "gravity");
    case(&|s| s.interval = 0.0, "interval");
    case(&|s| s.interval = f64::NAN, "interval");
    case(&|s| s.temperature = Some(Temperature::Constant(f64::INFINITY)), "temperature");
    let warm_up = |time_constant| Temperature::WarmUp { start: 20.0, rise: 5.0, time_constant };
    case(&|s| s.temperature = Some(warm_up(0.0)), "time constant of temperature");
    let sinus = |period| Temperature::Sinus { start: 20.0, amplitude: 5.0, period };
    case(&|s| s.temperature = Some(sinus(-60.0)), "period of temperature");
    case(
        &|s| s.imu_error.gyro = TriadError::default().with_bias(Axis::X, f64::NAN),
        "a gyro error",
    );
    case(
        &|s| s.imu_error.accel = TriadError::default().with_scale(Axis::X, f64::INFINITY),
        "an accelerometer error",
    );
    let encoder = |noise, resolution, zero| TableRecord::Angle(Encoder { noise, resolution, zero });
    case(&|s| s.table = encoder(-1.0, None, 0.0), "encoder noise");
    case(&|s| s.table = encoder(0.0, Some(0.0), 0.0), "encoder resolution");
    case(&|s| s.table = encoder(0.0, None, f64::NAN), "encoder zero");
    for (scenario, name) in cases {
        match refusal(&scenario) {
            ScenarioError::Quantity { quantity, .. } => assert_eq!(quantity, name),
            other => panic!("{name}: {other}"),
        }
    }
}

#[test]
fn refusal_tells_figure_and_range() {
    let scenario = Scenario { interval: -0.5, ..perfect() };
    assert_eq!(refusal(&scenario).to_string(), "interval is -0.5; it must be positive");
}

#[test]
fn impossible_effects_are_named() {
    let zero = |value| Model {
        terms: vec![TermInstance::new(&catalogue::ENCODER_ZERO).with_values(&[value])],
    };
    let scenario = Scenario { effects: zero(f64::INFINITY), ..perfect() };
    assert_eq!(
        refusal(&scenario).to_string(),
        "the effect encoder.zero has inf as its angle; it must be a finite number"
    );
    for table in [TableRecord::CommandedRate, TableRecord::Nothing] {
        let scenario = Scenario { effects: zero(1e-3), table, ..perfect() };
        assert_eq!(
            refusal(&scenario).to_string(),
            "the effect encoder.zero needs a measured table angle, which this run does not have"
        );
    }
}

#[test]
fn run_without_a_whole_interval_is_refused() {
    let scenario = Scenario { interval: 1000.0, profile: rest(60.0), ..perfect() };
    let error = ScenarioError::TooShort { duration: 60.0, interval: 1000.0 };
    assert_eq!(refusal(&scenario), error);
}

#[test]
fn run_of_more_than_a_hundred_million_samples_is_refused() {
    let scenario = Scenario { interval: 1e-3, profile: rest(2e5), ..perfect() };
    assert_eq!(refusal(&scenario), ScenarioError::TooLong { n_samples: 2e8 });
    let endless = Scenario { interval: 1e-300, profile: rest(1e300), ..perfect() };
    assert!(matches!(refusal(&endless), ScenarioError::TooLong { .. }));
}

#[test]
fn table_that_turns_more_than_once_a_sample_is_refused() {
    let turn = Segment { rate: 400.0, duration: 10.0 };
    let profile = Profile::new(&[turn], None).unwrap();
    let error = ScenarioError::TooFast { time: 0.0, rate: 400.0, interval: 0.02 };
    assert_eq!(refusal(&Scenario { profile, ..perfect() }), error);
}

#[test]
fn impossible_noise_is_refused() {
    let noise = ImuNoise { accel: NoiseModel::white(-1.0), ..ImuNoise::default() };
    let error = refusal(&Scenario { noise: Some(noise), ..perfect() });
    assert_eq!(error.to_string(), "the accelerometer noise parameters are invalid");
}

#[test]
fn interval_that_does_not_divide_the_profile_leaves_its_rest_out() {
    let run = simulate(&Scenario { interval: 0.7, profile: rest(2.0), ..perfect() }).unwrap();
    assert_eq!(run.recording.len(), 2);
}

fn rest(duration: f64) -> Profile {
    Profile::new(&[Segment { rate: 0.0, duration }], None).expect("a rest is a profile")
}

/// A plausible number or any bit pattern.
fn any_figure() -> impl Strategy<Value = f64> {
    prop_oneof![-1.0..1.0_f64, prop::num::f64::ANY, Just(0.0)]
}

/// A realistic scenario of two seconds in which the quantity with index `which` is `value`.
fn changed(which: usize, value: f64) -> Option<Scenario> {
    let mut scenario = realistic();
    let mut rates = [0.0, 1.0];
    let mut encoder = Encoder { noise: 1e-6, resolution: Some(1e-6), zero: 0.0 };
    let gyro = &mut scenario.imu_error.gyro;
    let noise = scenario.noise.as_mut()?;
    match which {
        0 => rates[0] = value,
        1 => rates[1] = value,
        2 => scenario.station.site.latitude = value,
        3 => scenario.station.site.longitude = value,
        4 => scenario.station.site.height = value,
        5 => scenario.station.gravity = value,
        6 => *gyro = gyro.with_bias(Axis::X, value),
        7 => *gyro = gyro.with_scale(Axis::Z, value),
        8 => noise.gyro.white_density = value,
        9 => noise.gyro.bias_random_walk = value,
        10 => noise.accel.flicker = Some(value),
        11 => noise.accel.quantisation = Some(Quantisation::Increment(value)),
        12 => encoder.noise = value,
        13 => encoder.resolution = Some(value),
        14 => encoder.zero = value,
        15 => scenario.temperature = Some(Temperature::Constant(value)),
        16 => {
            let rotated =
                TermInstance::new(&catalogue::AXIS_ATTITUDE).with_values(&[value, 0.0, 1e-4]);
            scenario.effects = Model { terms: vec![rotated] };
        }
        17 => {
            scenario.temperature =
                Some(Temperature::WarmUp { start: 20.0, rise: 5.0, time_constant: value });
        }
        // Shorter intervals are allowed, but their many samples would make the test slow.
        _ if value.abs() < 1e-5 && value.is_normal() => return None,
        _ => scenario.interval = value,
    }
    scenario.table = TableRecord::Angle(encoder);
    let segments = rates.map(|rate| Segment { rate, duration: 1.0 });
    scenario.profile = Profile::new(&segments, None).ok()?;
    Some(scenario)
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(1000))]

    #[test]
    fn any_figure_ends_in_a_run_or_a_refusal(which in 0..19_usize, value in any_figure()) {
        let Some(scenario) = changed(which, value) else { return Ok(()) };
        if let Ok(run) = simulate(&scenario) {
            prop_assert_eq!(run.recording.len(), run.truth.table_angle.len());
            prop_assert!(!run.recording.is_empty());
            let nan = |x: &rins_frames::Increments| x.angle.norm().is_nan() || x.velocity.norm().is_nan();
            // Quantities near the largest double may overflow, but nothing else gives NaN.
            prop_assert!(value.abs() > 1e100 || !run.recording.increments.iter().any(nan));
        }
    }
}
