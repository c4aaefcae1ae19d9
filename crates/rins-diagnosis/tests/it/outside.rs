//! What is in no catalogue: a bias that switches, a wave that is no sine.

use std::cell::RefCell;
use std::f64::consts::TAU;
use std::sync::Arc;

use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;
use rins_diagnosis::{Diagnosis, Structure, Unexplained};
use rins_estimation::{NoiseKnowledge, Run};
use rins_frames::InFrame;
use rins_frames::units::{DEG_PER_HOUR, MICRO_G};
use rins_terms::Model;

use crate::hidden::{RATES, found};
use crate::support::{INTERVAL, SEED, fibre, run};

/// Rates \[rad/s\] and forces \[m/s²\] of a sample.
type Readings = ([f64; 3], [f64; 3]);

/// A clean run with something more in each sample, told from the time since its start \[s\].
pub(crate) fn with(flicker: f64, seed: u64, added: impl Fn(f64) -> Readings) -> Run {
    over(&RATES, flicker, seed, |time, _| added(time))
}

/// The same over these rates \[deg/s\], told from the table angle \[rad\] too.
fn over(rates: &[f64], flicker: f64, seed: u64, added: impl Fn(f64, f64) -> Readings) -> Run {
    let mut run = run(rates, Model::default(), flicker, seed);
    let times = run.recording.times.clone();
    let angles = run.recording.table_angle.clone().unwrap();
    let samples = &mut Arc::make_mut(&mut run.recording).increments;
    for (sample, (time, angle)) in samples.iter_mut().zip(times.iter().zip(angles)) {
        let (rate, force) = added(time - times[0], angle);
        let [x, y, z] = rate.map(|rate| rate * sample.interval);
        sample.angle += InFrame::new(x, y, z);
        let [x, y, z] = force.map(|force| force * sample.interval);
        sample.velocity += InFrame::new(x, y, z);
    }
    run
}

fn switching(diagnosis: &Diagnosis) -> Vec<(&'static str, f64)> {
    let switches = |structure| matches!(structure, Structure::Switching(_));
    let of = diagnosis.unexplained.iter().filter(|one| switches(one.structure));
    of.filter_map(|one| Some((one.channel, one.amplitude?.0))).collect()
}

/// Times between switches that have no period \[s\].
const SWITCHES: [f64; 10] = [19.0, 47.0, 58.0, 101.0, 131.0, 143.0, 190.0, 228.0, 271.0, 309.0];

fn up(time: f64) -> bool {
    SWITCHES.iter().filter(|switch| **switch < time).count() % 2 == 1
}

#[test]
fn bias_that_switches_is_not_flicker() {
    let (rate, force) = (0.06 * DEG_PER_HOUR, 50.0 * MICRO_G);
    let cases: [(&str, f64, [f64; 3], [f64; 3]); 3] = [
        ("accel.y", force, [0.0; 3], [0.0, force, 0.0]),
        ("gyro.x", rate, [rate, 0.0, 0.0], [0.0; 3]),
        ("gyro.z", rate, [0.0, 0.0, rate], [0.0; 3]),
    ];
    for (sensor, height, rates, forces) in cases {
        let run =
            with(0.0, SEED, |time| if up(time) { (rates, forces) } else { Default::default() });
        let diagnosis = found(&run, NoiseKnowledge::Likely);
        let switching = switching(&diagnosis);
        let [(channel, amplitude)] = switching[..] else {
            panic!("{sensor}: {:?} {:?}", diagnosis.causes, diagnosis.unexplained)
        };
        assert_eq!(channel, sensor);
        assert!((amplitude / height - 1.0).abs() < 0.3, "{sensor}: {amplitude} of {height}");
    }
}

/// A door slams twice: too short for an epoch, too rare for heavy tails.
#[test]
fn doors_that_slam_are_shocks() {
    let slams = [130.0, 232.0];
    let run = with(0.0, SEED, |time| {
        let shaken = |slam: f64| {
            let since = time - slam;
            if since < 0.0 { 0.0 } else { (-since / 0.3).exp() * (TAU * 4.3 * since).sin() }
        };
        let force = 3e3 * MICRO_G * slams.map(shaken).iter().sum::<f64>();
        ([0.0; 3], [0.2 * force, 0.0, force])
    });
    let diagnosis = found(&run, NoiseKnowledge::Given);
    assert!(diagnosis.causes.is_empty(), "{:?}", diagnosis.causes);
    let [one] = &diagnosis.unexplained[..] else { panic!("{:?}", diagnosis.unexplained) };
    let Structure::Shocks(count, at) = one.structure else { panic!("{one:?}") };
    assert_eq!((one.channel, count), ("accel.z", 2));
    assert!(slams.iter().any(|slam| (at - slam).abs() < 1.0), "{at}");
}

#[test]
fn flicker_is_no_bias_that_switches() {
    let run = with(0.01 * DEG_PER_HOUR, SEED, |_| Default::default());
    let diagnosis = found(&run, NoiseKnowledge::Likely);
    assert!(switching(&diagnosis).is_empty(), "{:?}", diagnosis.unexplained);
    // The flicker is there, and is taken for what it is.
    let flicker = diagnosis.after.noise[0].imu.gyro.flicker;
    assert!((0.5..2.0).contains(&(flicker / (0.01 * DEG_PER_HOUR))), "{flicker}");
}

/// A line whose frequency grows all along is none of one frequency.
#[test]
fn line_that_grows_faster_is_described() {
    let (from, to, duration) = (0.02, 0.3, 50.0 * RATES.len() as f64);
    let chirp = |time: f64| {
        let turns = time * (from + 0.5 * (to - from) * time / duration);
        ([0.02 * DEG_PER_HOUR * (TAU * turns).sin(), 0.0, 0.0], [0.0; 3])
    };
    let diagnosis = found(&with(0.0, SEED, chirp), NoiseKnowledge::Likely);
    assert!(diagnosis.causes.is_empty(), "{:?}", diagnosis.causes);
    let [one] = &diagnosis.unexplained[..] else { panic!("{:?}", diagnosis.unexplained) };
    let Structure::Chirp(begins, ends) = one.structure else { panic!("{one:?}") };
    assert!((begins - from).abs() < 0.01 && (ends - to).abs() < 0.01, "{begins} to {ends}");
}

/// A wave of the turning table whose strength changes its sign is no two lines of whatever is plugged in.
#[test]
fn wave_of_the_table_that_comes_and_goes_is_no_interference() {
    let height = 0.05 * DEG_PER_HOUR;
    let wave = |time: f64, angle: f64| {
        ([height * (angle + 1.0).cos() * (TAU * time / 230.0).sin(), 0.0, 0.0], [0.0; 3])
    };
    let run = over(&[11.0, 11.0, 11.0, 11.0, -11.0, -11.0, -11.0, -11.0], 0.0, 360, wave);
    let diagnosis = found(&run, NoiseKnowledge::Likely);
    let modulated = |one: &&Unexplained| one.structure == Structure::Modulated(1.0);
    let found: Vec<_> = diagnosis.unexplained.iter().filter(modulated).collect();
    let [one] = found[..] else { panic!("{:?} {:?}", diagnosis.causes, diagnosis.unexplained) };
    assert_eq!(one.channel, "gyro.x");
    let (amplitude, _) = one.amplitude.unwrap();
    assert!((amplitude / height - 1.0).abs() < 0.3, "{amplitude} of {height}");
}

/// What comes at one place of every turn is no interference that happens to keep time with the table, nor an encoder whose
/// errors happen to make one bump.
#[test]
fn bump_in_the_turn_is_one_waveform() {
    for (axis, channel) in [(0, "gyro.x"), (2, "gyro.z")] {
        let height = 0.3 * DEG_PER_HOUR;
        let bump = |_: f64, angle: f64| {
            let off = (angle - 1.0).sin().atan2((angle - 1.0).cos());
            let mut gyro = [0.0; 3];
            gyro[axis] = height * (-0.5 * (off / 0.17).powi(2)).exp();
            (gyro, [0.0; 3])
        };
        let diagnosis = found(&over(&[11.0; 8], 0.0, SEED, bump), NoiseKnowledge::Likely);
        assert!(diagnosis.causes.is_empty(), "{channel}: {:?}", diagnosis.causes);
        let [one] = &diagnosis.unexplained[..] else { panic!("{:?}", diagnosis.unexplained) };
        assert!(matches!(one.structure, Structure::EveryTurn(_)), "{one:?}");
        assert_eq!(one.channel, channel);
    }
}

/// A sawtooth is a line and its harmonics, and more than that.
#[test]
fn lines_of_one_waveform_are_one() {
    const PERIOD: f64 = 31.0;
    let height = 120.0 * MICRO_G;
    let run =
        with(0.0, SEED, |time| ([0.0; 3], [height * ((time / PERIOD).fract() - 0.5), 0.0, 0.0]));
    let diagnosis = found(&run, NoiseKnowledge::Given);
    let [period] = periods(&diagnosis, "accel.x")[..] else {
        panic!("{:?}", diagnosis.unexplained)
    };
    assert!((period / PERIOD - 1.0).abs() < 0.02, "{period}");
}

/// Of a slow sawtooth one line may be found, and what is left of it be no more than flicker.
#[test]
fn line_is_no_sawtooth_and_a_sawtooth_no_line() {
    const PERIOD: f64 = 47.0;
    let height = 0.1 * DEG_PER_HOUR;
    let found_on = |wave: &dyn Fn(f64) -> f64| {
        let run = with(0.003 * DEG_PER_HOUR, SEED, |time| {
            ([0.0, height * wave(time / PERIOD), 0.0], [0.0; 3])
        });
        found(&run, NoiseKnowledge::Likely)
    };
    let sawtooth = found_on(&|periods| 2.0 * periods.fract() - 1.0);
    let left = &sawtooth.unexplained;
    assert!(left.iter().any(|one| one.channel == "gyro.y"), "{left:?}");
    let line = found_on(&|periods| (TAU * periods).sin());
    assert!(line.unexplained.is_empty(), "{:?}", line.unexplained);
    let ids: Vec<&str> = line.causes.iter().map(|cause| cause.term.id).collect();
    assert_eq!(ids, ["interference_line"], "{:?}", line.causes);
}

/// A bias that drifts up and falls back, each time by as much, has no steps; one that steps twice by as much has.
#[test]
fn steps_that_undo_a_drift_are_a_waveform() {
    const PERIOD: f64 = 110.0;
    let height = 250.0 * MICRO_G;
    let found_on = |wave: &dyn Fn(f64) -> f64| {
        let run = with(0.0, SEED, |time| ([0.0; 3], [0.0, 0.0, height * wave(time / PERIOD)]));
        found(&run, NoiseKnowledge::Likely)
    };
    let sawtooth = found_on(&f64::fract);
    let [period] = periods(&sawtooth, "accel.z")[..] else {
        panic!("{:?} {:?}", sawtooth.causes, sawtooth.unexplained)
    };
    let times = 2.0 * period / PERIOD;
    assert!((times - times.round()).abs() < 0.05, "{period}");
    let steps = found_on(&|time| -f64::from(u8::from(time > 1.2) + u8::from(time > 2.7)));
    assert!(steps.unexplained.is_empty(), "{:?}", steps.unexplained);
    let causes: Vec<&str> = steps.causes.iter().map(|cause| cause.term.id).collect();
    assert_eq!(causes, ["accel_bias_step"; 2]);
}

/// The periods of what repeats on a channel, and is no sine \[s\].
fn periods(diagnosis: &Diagnosis, channel: &str) -> Vec<f64> {
    let of_channel = diagnosis.unexplained.iter().filter(|one| one.channel == channel);
    let period = |one: &Unexplained| match one.structure {
        Structure::Waveform(frequency) => Some(1.0 / frequency),
        _ => None,
    };
    of_channel.filter_map(period).collect()
}

/// A data sheet has one figure for three sensors, of which one may be worse than the others.
#[test]
fn sensor_that_is_noisier_than_the_other_is_told() {
    let imu = fibre();
    let cases = [
        ("gyro.y", 0.0, 0),
        ("gyro.y", 1.5 * imu.gyro.noise_density, 1),
        ("accel.x", 1.5 * imu.accel.noise_density, 1),
    ];
    for (sensor, density, told) in cases {
        let random = RefCell::new(Pcg64::seed_from_u64(7));
        let run = with(0.0, SEED, |_| {
            let white: f64 = StandardNormal.sample(&mut *random.borrow_mut());
            let more = density * white / INTERVAL.sqrt();
            match sensor {
                "gyro.y" => ([0.0, more, 0.0], [0.0; 3]),
                _ => ([0.0; 3], [more, 0.0, 0.0]),
            }
        });
        let diagnosis = found(&run, NoiseKnowledge::Likely);
        assert!(diagnosis.causes.is_empty(), "{sensor}: {:?}", diagnosis.causes);
        assert_eq!(diagnosis.unexplained.len(), told, "{sensor}: {:?}", diagnosis.unexplained);
        for one in diagnosis.unexplained {
            let Structure::Noisier(times) = one.structure else { panic!("{sensor}: {one:?}") };
            assert_eq!(one.channel, sensor);
            // White noise of 1 and of 1.5 beside each other is of 1.8.
            assert!((times / 1.8 - 1.0).abs() < 0.15, "{sensor}: {times}");
        }
    }
}
