//! Results of runs do not depend on the way in which they are computed.

use rins_campaign::{Campaign, RunResult};
use rins_imu::NoiseModel;
use rins_simulation::TableRecord;

use crate::support::{cell, encoder};

fn bits(run: &RunResult) -> Vec<u64> {
    let estimate = run.as_ref().expect("the run has estimates");
    let numbers = estimate.value.iter().chain(estimate.covariance.iter());
    numbers.chain([&estimate.nis_ratio]).map(|x| x.to_bits()).collect()
}

#[test]
fn a_runs_bits_do_not_depend_on_its_neighbours() {
    let prepared = cell(10.0, TableRecord::CommandedRate).prepare().unwrap();
    let together = prepared.run(0..11);
    for (first, run) in [(0_u64, 0_usize), (3, 3), (10, 10)] {
        let other = prepared.run(first..first + 2);
        assert_eq!(bits(&other[0]), bits(&together[run]));
    }
    assert_ne!(bits(&together[0]), bits(&together[1]));
}

#[test]
fn runs_side_by_side_find_what_each_finds_alone() {
    let prepared = cell(20.0, TableRecord::CommandedRate).prepare().unwrap();
    let side_by_side = prepared.run(5..8);
    for (number, run) in (5..8).zip(side_by_side) {
        let (lane, alone) = (run.unwrap(), prepared.run_alone(number).unwrap());
        for row in 0..3 {
            let sigma = alone.covariance[(row, row)].sqrt();
            // A run computed alone has three more states, with other rounding errors.
            assert!((lane.value[row] - alone.value[row]).abs() < 1e-9 * sigma);
            let ratio = lane.covariance[(row, row)] / alone.covariance[(row, row)];
            assert!((ratio - 1.0).abs() < 1e-9);
        }
        assert!((lane.nis_ratio - alone.nis_ratio).abs() < 1e-9);
    }
}

#[test]
fn runs_with_an_encoder_have_its_noise() {
    let prepared = cell(10.0, encoder()).prepare().unwrap();
    let runs = prepared.run(0..2);
    assert_ne!(bits(&runs[0]), bits(&runs[1]));
    let nis = runs[0].as_ref().unwrap().nis_ratio;
    assert!((0.8..1.2).contains(&nis), "{nis}");
}

#[test]
fn chunks_hold_every_run_of_every_cell_once() {
    let one = cell(10.0, TableRecord::CommandedRate);
    let campaign = Campaign { cells: vec![one.clone(), one], runs: 150 };
    let mut seen = Vec::new();
    for (place, chunk) in (0..).zip(campaign.chunks()) {
        assert_eq!(chunk.index, place);
        seen.extend(chunk.runs.map(|run| (chunk.cell, run)));
    }
    let all: Vec<_> = (0..2).flat_map(|cell| (0..150).map(move |run| (cell, run))).collect();
    assert_eq!(seen, all);
    assert_eq!(campaign.chunk_count(), 6);
}

#[test]
fn what_no_run_can_do_is_refused_before_any() {
    let mut short = cell(1.0, TableRecord::CommandedRate);
    let refused = short.prepare().unwrap_err().to_string();
    assert!(refused.contains("50 samples"), "{refused}");
    short = cell(10.0, TableRecord::Nothing);
    assert!(short.prepare().is_err());
    let mut noisy = cell(10.0, TableRecord::CommandedRate);
    noisy.scenario.noise.as_mut().unwrap().gyro = NoiseModel::white(-1.0);
    assert!(noisy.prepare().unwrap_err().to_string().contains("gyro noise"));
}

#[test]
fn a_run_that_fails_says_why() {
    let mut loud = cell(10.0, TableRecord::CommandedRate);
    loud.scenario.noise.as_mut().unwrap().gyro = NoiseModel::white(f64::MAX);
    let runs = loud.prepare().unwrap().run(0..3);
    assert_eq!(runs.len(), 3);
    for run in runs {
        let reason = run.unwrap_err().reason;
        assert!(reason.contains("failed") || reason.contains("finite"), "{reason}");
    }
}
