//! The covariance over many steps: symmetric to the last bit, and positive definite.

#[path = "../../examples/soak/case.rs"]
mod case;

use case::Soak;
use rins_calibration::structured::Covariance;

/// A hundred seconds; `cargo run --release --example soak` runs a day.
const STEPS: usize = 20_000;

fn soak<const N: usize>() {
    let mut filter = Soak::<N>::new();
    let before = filter.sigma(9);
    for _ in 0..STEPS {
        filter.step();
        assert_eq!(filter.fault(), None);
    }
    assert!(filter.sigma(9) < 0.01 * before, "the first constant is learnt: {:e}", filter.sigma(9));
}

#[test]
fn twelve_states_keep_a_covariance() {
    soak::<12>();
}

#[test]
fn twenty_four_states_keep_a_covariance() {
    soak::<24>();
}

#[test]
fn forty_states_keep_a_covariance() {
    soak::<40>();
}

#[test]
fn what_is_no_covariance_is_found() {
    let mut filter = Soak::<12>::new();
    filter.step();
    assert_eq!(filter.fault(), None);
    let p = filter.covariance;
    filter.covariance = Covariance::from_fn(0.0, |row, column| {
        if (row, column) == (0, 0) { -p.get(0, 0) } else { p.get(row, column) }
    });
    assert!(filter.fault().is_some_and(|fault| fault.contains("left")));
}
