//! A few of the blind trials, frozen: short runs of a generator that shares nothing with the analyser.

use rins_tests::rins;
use rins_trials::{Analyser, Answer, Length, Level, Schedule, Trial, try_out};

fn asked(trial: &Trial) -> Answer {
    let answer = try_out(trial, &Analyser::new(rins().get_program(), 2)).expect("rins starts");
    assert_eq!(answer.failure, None);
    answer
}

#[test]
fn nothing_is_named_where_nothing_is_hidden() {
    for (seed, schedule, level) in [
        (1, Schedule::Constant, Level::White),
        (2, Schedule::Reversal, Level::Flicker),
        (3, Schedule::ThreeRates, Level::White),
    ] {
        let answer = asked(&Trial::hiding(&[], schedule, level, seed).unwrap());
        assert_eq!(answer.verdict, "adequate", "{schedule:?}: {answer:?}");
        assert!(answer.causes.is_empty() && answer.unexplained.is_empty(), "{answer:?}");
    }
}

#[test]
fn hidden_effect_is_in_the_set() {
    for (seed, id, schedule, level) in [
        (11, "accel_lever_arm", Schedule::ThreeRates, Level::White),
        (12, "encoder_latency", Schedule::ThreeRates, Level::Flicker),
        (13, "gyro_scale_asymmetry", Schedule::ThreeRates, Level::White),
        (14, "accel_bias_step", Schedule::Constant, Level::White),
        (15, "base_tilt_ramp", Schedule::Constant, Level::White),
        (16, "encoder_eccentricity", Schedule::Reversal, Level::Flicker),
        (17, "table_wobble", Schedule::Reversal, Level::White),
    ] {
        let trial = Trial::hiding(&[(id, 20.0)], schedule, level, seed).unwrap();
        assert_eq!(trial.hidden.len(), 1, "the schedule shows {id}");
        let answer = asked(&trial);
        let first = answer.causes.first().unwrap_or_else(|| panic!("{id} is not seen: {answer:?}"));
        assert!(first.may_be(id), "{id}: {answer:?}");
    }
}

/// The one cause that is named in a trial of a campaign may be what is hidden in it.
fn assert_named(seed: u64, index: u64, id: &str) {
    let trial = Trial::draw(seed, index, Length::Drawn).unwrap();
    assert_eq!(trial.hidden[0].id, id);
    let answer = asked(&trial);
    let [cause] = &answer.causes[..] else { panic!("{answer:?}") };
    assert!(cause.may_be(id), "{answer:?}");
}

/// At the edges of a zone derivatives jump: its estimate has no place to rest, only places that are as good.
#[test]
fn zone_whose_edges_the_estimate_goes_about_is_named() {
    assert_named(24, 36, "gyro_dead_zone");
}

/// At one rate nothing but the table's cogging shows how late an encoder is: what it leaves is a line, of no sensor.
#[test]
fn cogging_that_comes_late_is_no_line() {
    assert_named(16, 0, "encoder_latency");
}

/// A latency of four microseconds is little of what latencies are, but as much as backlash that would do the same.
#[test]
fn what_is_small_of_its_kind_stays_in_the_set() {
    assert_named(17, 373, "encoder_latency");
}

/// Of an event between two of the times that are tried, a warm-up shows more at first.
#[test]
fn step_is_looked_for_at_its_time_before_a_warm_up_is_believed() {
    assert_named(17, 345, "accel_bias_step");
}

/// Heat that lags far behind, with a warm-up, can be every effect of a table that turns but twice in the run.
#[test]
fn slow_heat_does_not_stand_for_an_imperfect_table() {
    let trial = Trial::draw(17, 179, Length::Drawn).unwrap();
    assert_eq!(trial.hidden[0].id, "cable_torque_tilt");
    let answer = asked(&trial);
    for id in ["cable_torque_tilt", "table_wobble", "encoder_eccentricity"] {
        assert!(answer.causes.iter().any(|cause| cause.may_be(id)), "{id}: {answer:?}");
    }
    assert_eq!(answer.causes.len(), 3, "{answer:?}");
    assert!(answer.unexplained.is_empty(), "{answer:?}");
}

/// What is outside the catalogue in a trial of a campaign, on this channel, is told as unexplained there.
fn assert_unexplained(seed: u64, index: u64, name: &str, channel: &str) {
    let trial = Trial::draw(seed, index, Length::Drawn).unwrap();
    let outside = trial.outside.as_ref().expect("there is something outside the catalogue");
    assert_eq!((outside.name.as_str(), outside.channel.as_str()), (name, channel));
    let answer = asked(&trial);
    assert!(answer.unexplained.iter().any(|one| one.starts_with(channel)), "{answer:?}");
}

/// On a table that turns back a bump in the turn is neither an effect of gravity nor a line on top, though both follow it.
#[test]
fn bump_on_a_table_that_turns_back_is_not_explained() {
    assert_unexplained(24, 278, "pulse once per revolution", "gyro.z");
}

/// What is left of a sawtooth beside a line passes for flicker, multiple by multiple, or for a walk of the bias with steps in it.
#[test]
fn sawtooths_are_not_explained() {
    assert_unexplained(24, 638, "sawtooth", "gyro.y");
    assert_unexplained(24, 262, "sawtooth", "accel.z");
}

/// Means over epochs may show outliers, and not enough to be believed: samples do.
#[test]
fn heavy_tails_are_told_though_epochs_hardly_show_them() {
    assert_unexplained(25, 171, "heavy tails", "gyro.x");
}

#[test]
fn two_hidden_effects_are_both_in_sets() {
    let effects = [("gyro_bias_step", 20.0), ("encoder_harmonic", 20.0)];
    let trial = Trial::hiding(&effects, Schedule::ThreeRates, Level::White, 21).unwrap();
    let answer = asked(&trial);
    for (id, _) in effects {
        assert!(answer.causes.iter().any(|cause| cause.may_be(id)), "{id}: {answer:?}");
    }
}

#[test]
fn what_no_effect_explains_is_not_taken_for_adequate() {
    let trial = Trial::outside(30.0, Schedule::ThreeRates, Level::White, 31).unwrap();
    let answer = asked(&trial);
    assert!(!answer.unexplained.is_empty(), "{:?}: {answer:?}", trial.outside);
}
