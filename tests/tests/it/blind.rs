//! A blind trial of each kind: short runs of a generator that is independent of the analysis.
//!
//! More trials, each with its expected result, are the frozen trials: `cargo xtask blind --frozen`.

use rins_tests::rins;
use rins_trials::{Analyser, Answer, Level, Schedule, Trial, try_out};

fn asked(trial: &Trial) -> Answer {
    let answer = try_out(trial, &Analyser::new(rins().get_program(), 2)).expect("rins starts");
    assert_eq!(answer.failure, None);
    answer
}

#[test]
fn nothing_is_named_where_nothing_is_hidden() {
    let trial = Trial::hiding(&[], Schedule::Reversal, Level::Flicker, 2).unwrap();
    let answer = asked(&trial);
    assert_eq!(answer.verdict, "adequate", "{answer:?}");
    assert!(answer.causes.is_empty() && answer.unexplained.is_empty(), "{answer:?}");
}

#[test]
fn hidden_effect_is_in_the_set() {
    let effects = [("accel_lever_arm", 20.0)];
    let trial = Trial::hiding(&effects, Schedule::ThreeRates, Level::White, 11).unwrap();
    assert_eq!(trial.hidden.len(), 1, "the schedule shows it");
    let answer = asked(&trial);
    let [first] = &answer.causes[..] else { panic!("{answer:?}") };
    assert!(first.may_be("accel_lever_arm"), "{answer:?}");
}

#[test]
fn what_no_effect_explains_is_not_taken_for_adequate() {
    let trial = Trial::outside(30.0, Schedule::ThreeRates, Level::White, 31).unwrap();
    let answer = asked(&trial);
    assert!(!answer.unexplained.is_empty(), "{:?}: {answer:?}", trial.outside);
}
