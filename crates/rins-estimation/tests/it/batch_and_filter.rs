//! The batch and the filter are two solutions of one model.

use rins_estimation::{
    Evidence, Filter, Noise, NoiseKnowledge, NoiseParameters, TriadStrengths, fit, linearise,
};
use rins_frames::units::{DEG_PER_HOUR, MICRO_G, PPM};
use rins_imu::{Axis, ImuError, TriadError};
use rins_terms::Model;

use crate::support::{fibre, profile, run, scenario, tilted, white};

/// Rounding, where prior and posterior differ by six orders of magnitude.
const WITHIN_SIGMAS: f64 = 1e-4;

#[test]
fn filter_ends_where_the_batch_does() {
    let imu = fibre();
    let gyro = TriadError::default().with_scale(Axis::Z, 200.0 * PPM).with_bias(Axis::X, 1e-7);
    let error = ImuError { gyro, ..ImuError::default() };
    let turns = profile(&[(0.0, 10.0), (10.0, 40.0), (-20.0, 40.0)]);
    let run =
        run(&scenario(tilted(25.0, 40.0), turns, (error, Model::default()), Some(white(&imu)), 3));
    let model = Model::full();
    let free = model.free(&imu);
    let places: Vec<(usize, usize)> = free.iter().map(|f| (f.term, f.parameter)).collect();
    let parted = run.clone().leaving_out(vec![400..700, 1500..1600]);
    let sigmas: Vec<f64> = free.iter().map(|f| f.sigma).collect();
    let nothing = vec![0.0; sigmas.len()];
    let sheet = NoiseParameters::of(&imu);
    let coloured = NoiseParameters {
        gyro: TriadStrengths { flicker: 0.02 * DEG_PER_HOUR, walk: 1e-10, ..sheet.gyro },
        accel: TriadStrengths { flicker: 10.0 * MICRO_G, ..sheet.accel },
        jitter: 1e-6,
    };
    for (strengths, run) in [(sheet, &run), (coloured, &run), (coloured, &parted)] {
        let linear = linearise(run, &model, &places);
        let noise = Noise::on(&run.rig, &strengths);
        let batch = Evidence::of(&linear, &noise).unwrap().posterior(&sigmas, &nothing).unwrap();
        let mut filter = Filter::new(&linear, &noise, &sigmas, &nothing);
        let mut squares = 0.0;
        while let Some(innovation) = filter.step().unwrap() {
            squares += innovation.norm_squared();
        }
        for (place, of) in free.iter().enumerate() {
            let sigma = batch.sigma(place);
            let off = (filter.parameters()[place] - batch.step[place]) / sigma;
            assert!(off.abs() < WITHIN_SIGMAS, "{}: {off} sigma apart", of.id);
            let ratio = filter.covariance()[(place, place)].sqrt() / sigma;
            assert!((ratio - 1.0).abs() < WITHIN_SIGMAS, "{}: sigmas in ratio {ratio}", of.id);
        }
        // The same likelihood in two ways: the squared innovations of all steps, and the remaining sum of squares.
        assert!((squares / batch.square - 1.0).abs() < 1e-4, "{squares} against {}", batch.square);
    }
}

#[test]
fn iteration_ends_where_a_step_is_nothing() {
    let imu = fibre();
    let gyro = TriadError::default().with_scale(Axis::Z, 500.0 * PPM);
    let turns = profile(&[(10.0, 40.0), (-10.0, 40.0)]);
    let truth = (ImuError { gyro, ..ImuError::default() }, Model::default());
    let run = run(&scenario(tilted(25.0, 0.0), turns, truth, Some(white(&imu)), 4));
    let mut seen = 0;
    let strengths = NoiseParameters::of(&imu);
    let fitted = fit(&[run], &Model::full(), &imu, NoiseKnowledge::Given(strengths), |_| seen += 1);
    let fitted = fitted.unwrap();
    assert_eq!(seen, fitted.iterations.len());
    let steps: Vec<f64> = fitted.iterations.iter().map(|iteration| iteration.step).collect();
    assert!(steps.len() < 8 && steps[0] > 100.0, "{steps:?}");
    assert!(steps.last().is_some_and(|step| *step < 1e-3), "{steps:?}");
    let found = fitted.parameter("gyro.scale.z").unwrap();
    assert!((found.value - 500.0 * PPM).abs() < 4.0 * found.sigma, "{found:?}");
}
