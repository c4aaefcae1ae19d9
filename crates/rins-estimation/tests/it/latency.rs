//! Latencies of several samples.

use rins_estimation::{NoiseKnowledge, NoiseParameters, fit};
use rins_imu::ImuError;
use rins_terms::{Model, Role, Term, TermInstance, catalogue};

use crate::support::{fibre, profile, run, scenario, tilted, white};

/// Four samples of 40 ms.
const LATE: f64 = 0.16;

/// An angle that is late is one with gyros and accelerometers that are early: the likelihood is that of the same pairs of
/// readings. Accelerometers show the rotation of gravity on a tilted axis.
#[test]
fn late_angle_is_as_likely_as_early_sensors() {
    let turns = profile(&[(0.0, 10.0), (20.0, 30.0), (-40.0, 40.0), (0.0, 10.0)]);
    for seed in 1..=3 {
        let late = TermInstance::new(&catalogue::ENCODER_LATENCY).with_values(&[LATE]);
        let truth = (ImuError::default(), Model::default().with(late));
        let run =
            run(&scenario(tilted(25.0, 40.0), turns.clone(), truth, Some(white(&fibre())), seed));
        let fitted = |terms: &[(&'static Term, f64)]| {
            let mut model = Model::full();
            let estimated = |(term, latency): &(&'static Term, f64)| {
                let mut estimated = TermInstance::new(term).with_values(&[*latency]);
                estimated.roles = vec![Role::Within(1.0)];
                estimated
            };
            model.terms.extend(terms.iter().map(estimated));
            fit(
                std::slice::from_ref(&run),
                &model,
                &fibre(),
                NoiseKnowledge::Given(NoiseParameters::of(&fibre())),
                |_| (),
            )
            .unwrap()
        };
        let of_angle =
            fitted(&[(&catalogue::ACCEL_LATENCY, 0.0), (&catalogue::ENCODER_LATENCY, 0.0)]);
        let of_sensors = fitted(&[(&catalogue::GYRO_LAG, 0.0), (&catalogue::ACCEL_LATENCY, 0.0)]);
        let found = of_angle.parameters.last().unwrap();
        assert!((found.value - LATE).abs() < 4.0 * found.sigma && found.sigma < 1e-4, "{found:?}");
        let apart = of_angle.log_likelihood - of_sensors.log_likelihood;
        assert!(apart.abs() < 0.1, "seed {seed}: {apart}");
    }
}
