//! Table 3, and the consistency of its covariances.

use crate::bias_filter::BiasFilter;
use crate::coverage::{Model, Schedule, coverage};
use crate::experiment::{Experiment, Sensors};
use crate::monte_carlo::Campaign;
use nalgebra::Matrix3;
use rins_calibration::{AngleSource, Reference, Setup, SpinAxisFilter, Start, TableReading};
use rins_frames::units::{ARCSEC, PPM};
use rins_simulation::Simulated;
use rins_testing::{assert_close, chi_squared_mean_bounds};

const RUNS: u64 = 6;

/// The 1σ of one run, from gyro noise only: `N / (ω √T)`, 0.006 arcsec and 0.029 ppm.
const SIGMA: [f64; 3] = [0.00604, 0.00604, 0.0293];

/// Four sigma of a mean of six runs.
fn assert_mean(campaign: &Campaign, parameter: usize, want: f64) {
    let within = 4.0 * SIGMA[parameter] / (RUNS as f64).sqrt();
    assert_close!(campaign.estimates(parameter).mean, want, within);
    assert_close!(campaign.claimed(parameter), SIGMA[parameter], 0.01 * SIGMA[parameter]);
}

#[test]
fn table_3_holds_the_biases_and_the_filter_does_not_know() {
    let simulation = Experiment::simulation().unwrap();
    let campaign = Campaign::of(&simulation, RUNS, || ()).unwrap();
    // 0.05 deg/h divided by 10 deg/s plus the Earth's 11.7 deg/h along the axis: 0.2866 arcsec, 1.3893 ppm.
    for (parameter, want) in [60.2866, 60.2866, 301.389].into_iter().enumerate() {
        assert_mean(&campaign, parameter, want);
        assert_close!(campaign.overconfidence(parameter), 47.4, 1.0);
    }
    // 3 × 47.4² = 6740, far above a consistent NEES of three parameters.
    assert_close!(campaign.nees(), 6740.0, 200.0);
}

#[test]
fn without_biases_table_3_is_the_truth_and_the_covariance_honest() {
    let simulation = Experiment::simulation().unwrap().with(Sensors::WithoutGyroBias);
    let campaign = Campaign::of(&simulation, RUNS, || ()).unwrap();
    for (parameter, want) in [60.0, 60.0, 300.0].into_iter().enumerate() {
        assert_mean(&campaign, parameter, want);
    }
    let (low, high) = chi_squared_mean_bounds(3.0, campaign.runs.len());
    assert!((low..=high).contains(&campaign.nees()), "{} not in {low}..={high}", campaign.nees());
}

#[test]
fn a_campaign_is_the_same_on_one_thread_and_on_three() {
    let simulation = Experiment::simulation().unwrap();
    let estimates = |threads: usize| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        let campaign = pool.install(|| Campaign::of(&simulation, 3, || ()).unwrap());
        campaign.runs.iter().flat_map(|run| run.estimate.map(f64::to_bits).data.0[0]).collect()
    };
    let (one, three): (Vec<u64>, Vec<u64>) = (estimates(1), estimates(3));
    assert_eq!(one, three);
    assert_ne!(one[..3], one[3..6], "runs differ among each other");
}

#[test]
fn intervals_hold_the_truth_where_the_bias_is_a_state_or_cancels() {
    const COUNT: u64 = 80;
    let simulation = Experiment::simulation().unwrap();
    let honesty =
        |model, schedule| coverage(&simulation, model, schedule, (COUNT, 12.0), || ()).unwrap();
    for (model, schedule) in [
        (Model::WithGyroBias, Schedule::ConstantRate),
        (Model::WithGyroBias, Schedule::TwoRates),
        (Model::WithGyroBias, Schedule::Reversal),
        (Model::Paper, Schedule::Reversal),
    ] {
        let honesty = honesty(model, schedule);
        let (low, high) = chi_squared_mean_bounds(honesty.dof as f64, 80);
        assert!((low..=high).contains(&honesty.nees), "{model:?}, {schedule:?}: {honesty:?}");
        // 95 % of 80 runs are 76; 69 or fewer have a probability of 0.004 for each.
        assert!(honesty.coverage.iter().all(|share| *share > 0.86), "{schedule:?}: {honesty:?}");
    }
    for schedule in [Schedule::ConstantRate, Schedule::TwoRates] {
        let paper = honesty(Model::Paper, schedule);
        assert!(paper.overconfidence() > 10.0, "{schedule:?}: {paper:?}");
        assert!(paper.coverage.iter().all(|share| *share < 0.3), "{schedule:?}: {paper:?}");
    }
}

#[test]
fn the_two_filters_agree_where_there_is_no_bias() {
    let mut experiment = Experiment::simulation().unwrap().with(Sensors::WithoutGyroBias);
    experiment.setup.imu.gyro.bias_sigma = 0.0;
    let Experiment { scenario, setup } = &experiment;
    let Simulated { recording, .. } = experiment.run(0).unwrap();
    let mut paper = paper_filter(setup, &experiment);
    let mut other = BiasFilter::new(setup, scenario.nav_from_table);
    let rates = recording.table_rate.as_ref().unwrap();
    for (sample, &rate) in recording.increments.iter().zip(rates).take(3000) {
        paper.step(sample, &Reference::fixed(TableReading::Rate(rate))).unwrap();
        other.step(sample, rate).unwrap();
    }
    let start = rins_calibration::layout::SPIN_AXIS_ERRORS.start();
    for parameter in 0..3 {
        let sigma = paper.covariance()[(start + parameter, start + parameter)].sqrt();
        // A hundredth of sigma: position and height, which one filter treats as known.
        assert_close!(other.estimate()[parameter], paper.estimate()[parameter], 0.01 * sigma);
        let claimed = other.covariance()[(parameter, parameter)].sqrt();
        assert_close!(claimed, sigma, 1e-3 * sigma);
        let unit = if parameter < 2 { ARCSEC } else { PPM };
        assert!(sigma > 0.01 * unit, "after a minute it is not known too well to compare");
        assert!(other.estimate()[3 + parameter].abs() < f64::MIN_POSITIVE);
    }
}

fn paper_filter(setup: &Setup, experiment: &Experiment) -> SpinAxisFilter {
    let start = Start {
        nav_from_table: experiment.scenario.nav_from_table,
        axis_covariance: Matrix3::zeros(),
        angle: 0.0,
        angle_source: AngleSource::Defined,
    };
    SpinAxisFilter::new(*setup, &start)
}
