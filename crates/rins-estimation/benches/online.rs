//! One sample of the online filter, with all parameters of the full model.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use rins_estimation::{OnlineFilter, OnlineSample, OnlineSetup, Reference, Rig};
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, DEG_PER_SECOND, MICRO_G, PPM};
use rins_frames::{EulerAngles, Site};
use rins_imu::{ImuSpec, TriadSpec};
use rins_motion::{Profile, Segment, Station, TrueMotion};
use rins_terms::Model;

/// The number of samples in one timing.
const SAMPLES: usize = 1000;

/// The interval of a sample \[s\].
const INTERVAL: f64 = 0.01;

/// A reversal of 20 s at 100 Hz on a tilted axis, and the filter of the full model, 27 parameters.
fn run() -> (OnlineFilter, Vec<OnlineSample>) {
    let site = Site { latitude: 45.0 * DEG, longitude: 0.0, height: 0.0 };
    let station = Station::with_normal_gravity(site);
    let nav_from_table = EulerAngles { roll: 0.0, pitch: 25.0 * DEG, yaw: 0.0 }.dcm();
    let turn = |sign: f64| Segment { rate: sign * 10.0 * DEG_PER_SECOND, duration: 10.0 };
    let profile = Profile::new(&[turn(1.0), turn(-1.0)], None).expect("segments are a profile");
    let motion = TrueMotion { station, nav_from_table, profile: profile.clone() };
    let samples = motion.samples(INTERVAL).enumerate().map(|(place, sample)| {
        let time = INTERVAL * (place + 1) as f64;
        OnlineSample { time, increments: sample.increments, table: Some(profile.angle(time)) }
    });
    let samples = samples.collect();
    let rig = Rig {
        station,
        nav_from_table,
        reference: Reference::Encoder { noise: ARCSEC },
        wobble: 0.1 * ARCSEC,
        velocity: 1e-5,
    };
    let gyro =
        TriadSpec::white(0.02 * DEG_PER_HOUR, 0.1 * DEG_PER_HOUR, 500.0 * PPM, 120.0 * ARCSEC);
    let accel = TriadSpec::white(30.0 * MICRO_G, 200.0 * MICRO_G, 300.0 * PPM, 60.0 * ARCSEC);
    let setup = OnlineSetup::new(rig, Model::full(), ImuSpec { gyro, accel }, INTERVAL);
    (OnlineFilter::new(setup).expect("a fixed table with an encoder"), samples)
}

/// The functions whose instructions `cargo xtask bench` counts, by their names.
mod counted {
    use super::{OnlineFilter, OnlineSample};

    #[inline(never)]
    pub(super) fn online_sample(filter: &OnlineFilter, samples: &[OnlineSample]) -> f64 {
        let mut filter = filter.clone();
        for sample in samples {
            filter.push(sample).expect("samples follow each other");
        }
        filter.estimates().iter().map(|estimate| estimate.value).sum()
    }
}

fn sample(criterion: &mut Criterion) {
    let (mut filter, samples) = run();
    let (before, timed) = samples.split_at(samples.len() - SAMPLES);
    for sample in before {
        filter.push(sample).expect("samples follow each other");
    }
    // The sensors of this run have no errors.
    let estimates = filter.estimates();
    assert!(estimates.iter().all(|estimate| estimate.value.abs() < estimate.sigma));
    assert!(counted::online_sample(&filter, timed).abs() < 1e-3);
    let mut group = criterion.benchmark_group("online_sample");
    group.throughput(criterion::Throughput::Elements(SAMPLES as u64));
    group.bench_function("full", |b| {
        b.iter(|| counted::online_sample(&filter, black_box(timed)));
    });
    group.finish();
}

criterion_group!(benches, sample);
criterion_main!(benches);
