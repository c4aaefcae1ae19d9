//! "Converges quickly": convergence times of the estimates, compared with the limit of gyro noise.

use std::f64::consts::PI;

use nalgebra::Vector3;
use rins_calibration::EstimatePoint;
use rins_simulation::Scenario;

/// The maximum difference of a converged estimate from its final value, in final sigmas.
pub(crate) const WITHIN: f64 = 3.0;

/// The rate about the spin axis at the end of a scenario, including the Earth rate \[rad/s\].
pub(crate) fn spin_rate(scenario: &Scenario) -> f64 {
    let earth = scenario.nav_from_table.inverse() * scenario.station.site.earth_rate();
    scenario.profile.rate(scenario.profile.duration()) + earth.components().z
}

/// The minimum 1σ of `M_xz`, `M_yz` or `S_z` after `time` \[s\] at a known rate \[rad/s\] about the spin axis, with
/// gyro noise of `density` \[rad/s/√Hz\] and a prior 1σ.
///
/// The gyro measures the error times the rate in white noise, so that the information per second is the
/// square of the ratio of rate to noise density.
pub(crate) fn information_bound(density: f64, rate: f64, prior: f64, time: f64) -> f64 {
    (prior.powi(-2) + (rate / density).powi(2) * time).sqrt().recip()
}

/// The time from which on an estimate stays within `multiple` final sigmas of its final value, for
/// each of `M_xz`, `M_yz` and `S_z`, counted from `start` \[s\].
pub(crate) fn convergence_times(
    points: &[EstimatePoint],
    start: f64,
    multiple: f64,
) -> Vector3<f64> {
    let Some(end) = points.last() else { return Vector3::repeat(f64::NAN) };
    Vector3::from_fn(|row, _| {
        let far = |point: &&EstimatePoint| {
            (point.estimate[row] - end.estimate[row]).abs() > multiple * end.sigma[row]
        };
        points.iter().rev().find(far).map_or(0.0, |last| last.time - start)
    })
}

/// The mean of the ratio of run length to convergence time for an estimate that is limited by white noise only.
///
/// Its error is a Brownian motion in 1/t (time inversion of the mean of white noise). In reversed time
/// it leaves a band of `multiple` final sigmas after a mean of `multiple²` times 1/T.
pub(crate) fn ideal_mean_ratio(multiple: f64) -> f64 {
    1.0 + multiple * multiple
}

/// The median of the ratio of convergence time to run length for the same estimate.
pub(crate) fn ideal_median_share(multiple: f64) -> f64 {
    // P(no exit from ±1 up to u) = 4/π Σ (-1)^k / (2k + 1) exp(-(2k + 1)² π² u / 8).
    let stays = |time: f64| {
        let terms = (0..8).map(|index| {
            let odd = 2.0 * f64::from(index) + 1.0;
            let sign = if index % 2 == 0 { 1.0 } else { -1.0 };
            sign / odd * libm::exp(-odd * odd * PI * PI * time / 8.0)
        });
        4.0 / PI * terms.sum::<f64>()
    };
    let (mut low, mut high) = (0.1, 10.0);
    for _ in 0..60 {
        let middle = 0.5 * (low + high);
        if stays(middle) > 0.5 {
            low = middle;
        } else {
            high = middle;
        }
    }
    1.0 / (1.0 + multiple * multiple * 0.5 * (low + high))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rins_imu::{Seed, Sensor};
    use rins_testing::assert_close;

    /// The mean of white noise over many runs, for which the closed forms hold.
    #[test]
    fn the_mean_of_white_noise_converges_as_its_closed_form_says() {
        const RUNS: u64 = 400;
        const SAMPLES: u32 = 20_000;
        let mut ratios = Vec::new();
        for run in 0..RUNS {
            let mut noise = Seed { seed: 3, run }.stream(Sensor::Encoder);
            let mut sum = 0.0;
            let points: Vec<EstimatePoint> = (1..=SAMPLES)
                .map(|count| {
                    sum += noise.sample();
                    let count = f64::from(count);
                    EstimatePoint {
                        time: count,
                        estimate: Vector3::repeat(sum / count),
                        sigma: Vector3::repeat(count.sqrt().recip()),
                    }
                })
                .collect();
            let time = convergence_times(&points, 0.0, WITHIN).x;
            ratios.push(f64::from(SAMPLES) / time.max(1.0));
        }
        let mean = ratios.iter().sum::<f64>() / RUNS as f64;
        // The standard deviation of an exit time from ±3 is 9 √(2/3); the tolerance is four standard deviations of the mean.
        let within = 4.0 * 9.0 * (2.0_f64 / 3.0).sqrt() / (RUNS as f64).sqrt();
        assert_close!(mean, ideal_mean_ratio(WITHIN), within);
        ratios.sort_by(f64::total_cmp);
        let below = ratios.iter().filter(|ratio| **ratio < ideal_median_share(WITHIN).recip());
        // A binomial count with probability one half, within four standard deviations.
        assert_close!(below.count() as f64, 0.5 * RUNS as f64, 4.0 * 0.5 * (RUNS as f64).sqrt());
    }

    #[test]
    fn the_bound_is_the_prior_at_first_and_falls_with_the_root_of_time() {
        let bound = |time| information_bound(1e-7, 0.2, 1e-3, time);
        assert_close!(bound(0.0), 1e-3, 1e-12);
        assert_close!(bound(100.0), 1e-7 / (0.2 * 10.0), 1e-12);
        assert_close!(bound(400.0) / bound(100.0), 0.5, 1e-6);
    }

    #[test]
    fn a_point_far_off_ends_the_convergence_before_it() {
        let point = |time: f64, estimate: f64| EstimatePoint {
            time,
            estimate: Vector3::repeat(estimate),
            sigma: Vector3::repeat(1.0),
        };
        let points = [point(11.0, 9.0), point(12.0, 0.0), point(13.0, -3.5), point(14.0, 0.0)];
        assert_close!(convergence_times(&points, 10.0, WITHIN).y, 3.0, 1e-12);
        assert_close!(convergence_times(&points, 10.0, 4.0).y, 1.0, 1e-12);
        // The only point is at its own value, so that no other is too far from it.
        assert!(convergence_times(&points[1..2], 10.0, WITHIN).norm() < f64::MIN_POSITIVE);
    }
}
