//! Allan deviations, variances and correlations of simulated noise.

use std::f64::consts::PI;

use rins_frames::InFrame;
use rins_imu::{AllanPlan, GaussMarkov, NoiseModel, Quantisation, Seed, Span, Triad, TriadNoise};
use rins_testing::assert_close;

const INTERVAL: f64 = 0.02;

fn source(model: &NoiseModel, n_samples: usize, run: u64) -> TriadNoise {
    let span = Span { interval: INTERVAL, duration: INTERVAL * n_samples as f64 };
    TriadNoise::new(model, &span, Triad::Gyro, Seed { seed: 2019, run })
        .expect("the tests' models are possible")
}

/// The Allan variance of rates for a cluster of a power of two samples.
fn allan_variance(increments: &[f64], cluster: usize) -> f64 {
    let plan = AllanPlan::new(increments.len(), INTERVAL).expect("the series are long");
    let seen = plan.noise(increments).expect("the series are noise");
    seen.points[cluster.ilog2() as usize].deviation.powi(2)
}

/// The Allan deviation at each cluster size, from the variance averaged over `n_runs` runs of three axes.
fn allan_deviations(
    model: &NoiseModel,
    n_samples: usize,
    n_runs: u64,
    clusters: &[usize],
) -> Vec<f64> {
    let mut sums = vec![0.0; clusters.len()];
    for run in 0..n_runs {
        let mut noise = source(model, n_samples, run);
        let increments: Vec<_> =
            (0..n_samples).map(|_| *noise.next(INTERVAL).components()).collect();
        for axis in 0..3 {
            let series: Vec<f64> = increments.iter().map(|increment| increment[axis]).collect();
            for (sum, &cluster) in sums.iter_mut().zip(clusters) {
                *sum += allan_variance(&series, cluster);
            }
        }
    }
    sums.iter().map(|sum| (sum / (3 * n_runs) as f64).sqrt()).collect()
}

/// Asserts deviations against `theory(τ)`; the tolerance covers four sigma of the estimate.
fn assert_deviations(model: &NoiseModel, theory: impl Fn(f64) -> f64, relative: f64) {
    let clusters = [1, 4, 16, 64];
    let found = allan_deviations(model, 1 << 16, 8, &clusters);
    for (deviation, cluster) in found.into_iter().zip(clusters) {
        let want = theory(cluster as f64 * INTERVAL);
        assert_close!(deviation, want, relative * want);
    }
}

#[test]
fn white_noise_averages_down_as_its_density_says() {
    // At 64 intervals there are 24 × 1024 independent clusters: four sigma are 2 %.
    assert_deviations(&NoiseModel::white(0.5), |time| 0.5 / time.sqrt(), 0.02);
}

#[test]
fn random_walk_grows_as_its_density_says() {
    let model = NoiseModel { bias_random_walk: 0.5, ..NoiseModel::default() };
    assert_deviations(&model, |time| 0.5 * (time / 3.0).sqrt(), 0.02);
}

#[test]
fn flicker_floor_is_flat_at_0_664_of_the_bias_instability() {
    let model = NoiseModel { flicker: Some(0.5), ..NoiseModel::default() };
    let floor = 0.5 * (2.0 * std::f64::consts::LN_2 / PI).sqrt();
    assert_close!(floor / 0.5, 0.664, 0.0005);
    let found = allan_deviations(&model, 1 << 16, 8, &[4, 16, 64]);
    for (deviation, within) in found.into_iter().zip([0.03, 0.02, 0.02]) {
        assert_close!(deviation, floor, within * floor);
    }
}

#[test]
fn gauss_markov_noise_forgets_within_its_correlation_time() {
    let (sigma, correlation_time) = (2.0, 1.0);
    let process = GaussMarkov { sigma, correlation_time };
    let model = NoiseModel { gauss_markov: vec![process], ..NoiseModel::default() };
    let n_samples = 400_000;
    let mut noise = source(&model, n_samples, 0);
    let biases: Vec<_> = (0..n_samples)
        .map(|_| {
            let _ = noise.next(INTERVAL);
            *noise.wander().components()
        })
        .collect();
    // 3 × 8000 correlation times: a sigma of the variance is √(2 / 24000) of it, 1 %.
    for lag in [0, 25, 50, 100] {
        let pairs = biases.iter().zip(&biases[lag..]);
        let covariance = pairs.map(|(a, b)| a.dot(b)).sum::<f64>() / (3 * n_samples) as f64;
        let want = sigma * sigma * (-(lag as f64) * INTERVAL / correlation_time).exp();
        assert_close!(covariance, want, 0.04 * sigma * sigma);
    }
}

#[test]
fn wandering_bias_starts_in_its_stationary_distribution() {
    let process = GaussMarkov { sigma: 2.0, correlation_time: 1e6 };
    let model = NoiseModel { gauss_markov: vec![process], ..NoiseModel::default() };
    let n_runs = 4000;
    let start = |run| source(&model, 100, run).wander().components().norm_squared();
    let variance = (0..n_runs).map(start).sum::<f64>() / (3 * n_runs) as f64;
    assert_close!(variance, 4.0, 4.0 * 4.0 * (2.0 / (3 * n_runs) as f64).sqrt());
}

#[test]
fn statistics_do_not_depend_on_how_time_is_cut() {
    let model = NoiseModel {
        white_density: 0.3,
        bias_random_walk: 0.5,
        gauss_markov: vec![GaussMarkov { sigma: 0.7, correlation_time: 0.4 }],
        ..NoiseModel::default()
    };
    let n_runs = 20_000;
    let variance_over_one_second = |cuts: &[f64]| {
        let of = |run| {
            let mut noise = source(&model, 100, run);
            let sum = cuts.iter().fold(InFrame::zeros(), |sum, &cut| sum + noise.next(cut));
            sum.components().norm_squared()
        };
        (0..n_runs).map(of).sum::<f64>() / (3 * n_runs) as f64
    };
    // N² + K²/3 + 2 σ² T (1 - T (1 - e^(-1/T))), over one second.
    let want = 0.09 + 0.25 / 3.0 + 2.0 * 0.49 * 0.4 * (1.0 - 0.4 * (1.0 - (-2.5_f64).exp()));
    let within = 4.0 * want * (2.0 / (3 * n_runs) as f64).sqrt();
    assert_close!(variance_over_one_second(&[1.0]), want, within);
    assert_close!(variance_over_one_second(&[0.1, 0.4, 0.4, 0.1]), want, within);
}

#[test]
fn pulses_are_as_noisy_as_theory_says() {
    let bit = 0.01;
    let quantisation = Some(Quantisation::Increment(bit));
    let mut noise = source(&NoiseModel { quantisation, ..NoiseModel::white(1.0) }, 1 << 16, 0);
    let mut clean = source(&NoiseModel::white(1.0), 1 << 16, 0);
    let added: Vec<f64> = (0..1 << 16)
        .map(|_| {
            let zero = InFrame::zeros();
            (noise.corrupt(&zero, INTERVAL) - clean.corrupt(&zero, INTERVAL)).components().x
        })
        .collect();
    // √3 Q/τ with Q the standard deviation of a uniform error of one bit.
    for cluster in [1, 8, 64] {
        let time = cluster as f64 * INTERVAL;
        let want = 3.0_f64.sqrt() * bit / 12.0_f64.sqrt() / time;
        assert_close!(allan_variance(&added, cluster).sqrt(), want, 0.02 * want);
    }
}

#[test]
fn no_noise_changes_no_bit() {
    let mut noise = source(&NoiseModel::default(), 10, 0);
    let increment = InFrame::new(1e-3, -2e-3, 0.0);
    assert_eq!(noise.corrupt(&increment, INTERVAL), increment);
}

#[test]
fn same_seed_makes_the_same_noise_and_another_run_another() {
    let model = NoiseModel { flicker: Some(1.0), ..NoiseModel::white(1.0) };
    let (mut one, mut same, mut other) =
        (source(&model, 10, 3), source(&model, 10, 3), source(&model, 10, 4));
    for _ in 0..10 {
        let noise = one.next(INTERVAL);
        assert_eq!(noise, same.next(INTERVAL));
        assert_ne!(noise, other.next(INTERVAL));
    }
}

#[test]
fn impossible_interval_makes_nan_and_not_a_number_that_looks_right() {
    let mut noise = source(&NoiseModel::white(1.0), 10, 0);
    assert!(noise.next(-0.01).components().x.is_nan());
    assert!(noise.next(f64::NAN).components().x.is_nan());
    assert!(noise.next(0.01).components().x.is_finite());
}
