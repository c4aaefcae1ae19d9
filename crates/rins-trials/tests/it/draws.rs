//! Trials as they are drawn.

use rins_trials::{Kind, Length, Level, Schedule, Trial};

/// The squares that a hidden effect adds to a run, made by the generator, are those that the estimator's derivatives foretold.
#[test]
fn effect_is_as_strong_as_it_was_meant() {
    let mut effects = 0;
    for index in [4, 10, 12, 16] {
        let trial = Trial::draw(1, index, Length::Drawn).unwrap();
        assert_eq!(trial.kind, Kind::One, "trial {index}");
        for hidden in &trial.hidden {
            let ratio = hidden.strength / hidden.meant;
            assert!((ratio - 1.0).abs() < 0.02, "trial {index}, {}: {ratio}", hidden.id);
            effects += 1;
        }
    }
    assert_eq!(effects, 4);
}

/// How strong a dead zone is does not go with its width, nor with the square of it.
#[test]
fn a_dead_zone_is_as_strong_as_it_was_meant() {
    let mut zones = 0;
    for (seed, schedule) in (0..6).zip(Schedule::ALL.iter().cycle()) {
        let meant = [("gyro_dead_zone", 6.5)];
        let trial = Trial::hiding(&meant, *schedule, Level::White, seed).unwrap();
        for hidden in &trial.hidden {
            assert!((hidden.strength / 6.5 - 1.0).abs() < 0.02, "{seed}: {}", hidden.strength);
            zones += 1;
        }
    }
    assert!(zones >= 3, "{zones} dead zones");
}

#[test]
fn same_seed_draws_the_same_trial() {
    let [one, same, other] = [(3, 19), (3, 19), (4, 19)]
        .map(|(seed, index)| Trial::draw(seed, index, Length::Drawn).unwrap());
    assert_eq!(one.experiment, same.experiment);
    assert_ne!(one.experiment, other.experiment);
}

#[test]
fn kinds_are_mixed_as_the_page_says() {
    let kinds: Vec<Kind> = (0..400).map(|index| Trial::kind_of(1, index)).collect();
    let share = |kind: Kind| kinds.iter().filter(|other| **other == kind).count() as f64 / 400.0;
    for (kind, expected) in
        [(Kind::Nothing, 0.35), (Kind::One, 0.4), (Kind::Two, 0.1), (Kind::Outside, 0.15)]
    {
        // Three of the standard deviations of a share of 400.
        let bound = 3.0 * (expected * (1.0 - expected) / 400.0_f64).sqrt();
        assert!((share(kind) - expected).abs() < bound, "{kind:?}: {}", share(kind));
    }
}
