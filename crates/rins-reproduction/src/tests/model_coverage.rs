//! A dozen runs with random truth: the coverage of the estimator's intervals.

use crate::model_coverage::{Colour, Schedule, coverage};

#[test]
fn intervals_hold_the_truth() {
    for (schedule, colour, runs) in [
        (Schedule::SeveralRates, Colour::WHITE, 12),
        (Schedule::ConstantRate, Colour::WHITE, 12),
        (Schedule::Reversal, Colour::STRONG, 6),
    ] {
        let figures = coverage(schedule, &colour, runs, || ()).unwrap();
        let faults = figures.faults();
        assert!(faults.is_empty(), "{} {}: {faults:?}", schedule.name(), colour.name());
    }
}

/// The same statistics detect an estimator that assumes white noise in the presence of flicker noise.
#[test]
fn flicker_taken_for_white_noise_is_seen() {
    let colour = Colour { knowledge: rins_estimation::NoiseKnowledge::Given, ..Colour::STRONG };
    let figures = coverage(Schedule::Reversal, &colour, 6, || ()).unwrap();
    assert!(figures.nees > 100.0 && !figures.faults().is_empty(), "NEES {}", figures.nees);
}
