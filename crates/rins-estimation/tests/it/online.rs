//! The online filter ends where the batch does, and continues from a checkpoint to the same bits.

use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rins_estimation::{
    Estimate, NoiseKnowledge, NoiseParameters, OnlineCheckpoint, OnlineFilter, OnlineSample,
    OnlineSetup, Reference, Rig, Run, TriadStrengths, fit,
};
use rins_frames::Increments;
use rins_frames::units::{ARCSEC, DEG_PER_HOUR, MICRO_G, PPM};
use rins_imu::{Axis, ImuError, ImuSpec, TriadError};
use rins_motion::Recording;
use rins_simulation::{Scenario, TableRecord, simulate};
use rins_terms::{Model, TermInstance, catalogue};

use crate::support::{fibre, profile, run, scenario, tilted, white};

/// The largest difference between the estimates of filter and batch, in sigmas, and between their sigmas, relative.
const WITHIN: f64 = 0.01;

/// An IMU with errors of about the sigmas of its data sheet.
fn errors(part: f64) -> ImuError {
    let gyro = TriadError::default()
        .with_scale(Axis::Z, 400.0 * PPM * part)
        .with_scale(Axis::X, -250.0 * PPM * part)
        .with_misalignment(Axis::X, Axis::Z, 80.0 * ARCSEC * part)
        .with_misalignment(Axis::Y, Axis::Z, -50.0 * ARCSEC * part)
        .with_bias(Axis::X, 0.08 * DEG_PER_HOUR * part)
        .with_bias(Axis::Z, -0.1 * DEG_PER_HOUR * part);
    let accel = TriadError::default()
        .with_scale(Axis::Z, -200.0 * PPM * part)
        .with_misalignment(Axis::Y, Axis::X, 40.0 * ARCSEC * part)
        .with_bias(Axis::X, 150.0 * MICRO_G * part)
        .with_bias(Axis::Z, -200.0 * MICRO_G * part);
    ImuError { gyro, accel }
}

fn samples(run: &Run) -> Vec<OnlineSample> {
    let recording: &Recording = &run.recording;
    let table = |sample: usize| match run.rig.reference {
        Reference::Command { .. } => recording.table_rate.as_ref().map(|rate| rate[sample]),
        _ => recording.table_angle.as_ref().map(|angle| angle[sample]),
    };
    let of = |sample: usize| OnlineSample {
        time: recording.times[sample],
        increments: recording.increments[sample],
        table: table(sample),
    };
    (0..recording.len()).map(of).collect()
}

/// A run with what is known before it.
struct Case {
    name: &'static str,
    run: Run,
    model: Model,
    imu: ImuSpec,
    noise: NoiseParameters,
}

impl Case {
    fn of(name: &'static str, scenario: &Scenario) -> Self {
        let imu = fibre();
        let noise = NoiseParameters::of(&imu);
        Self { name, run: run(scenario), model: Model::full(), imu, noise }
    }

    fn setup(&self) -> OnlineSetup {
        let times = &self.run.recording.times;
        let interval = (times[times.len() - 1] - times[0]) / (times.len() - 1) as f64;
        let setup = OnlineSetup::new(self.run.rig, self.model.clone(), self.imu, interval);
        let duration = times.len() as f64 * interval;
        let angle_steps = self.run.angle_steps;
        OnlineSetup { noise: self.noise, angle_steps, duration, ..setup }
    }
}

/// Runs of different kinds.
fn cases() -> Vec<Case> {
    let imu = fibre();
    let simulated = |tilt: (f64, f64), turns: &[(f64, f64)], error: ImuError, seed: u64| {
        let truth = (error, Model::default());
        scenario(tilted(tilt.0, tilt.1), profile(turns), truth, Some(white(&imu)), seed)
    };
    let reversal = [(0.0, 10.0), (10.0, 40.0), (-10.0, 40.0)];
    let mut cases = vec![
        Case::of("level axis, reversal", &simulated((0.0, 0.0), &reversal, errors(1.0), 1)),
        Case::of("tilted axis, reversal", &simulated((30.0, 50.0), &reversal, errors(1.0), 2)),
        Case::of("one direction", &simulated((20.0, 0.0), &[(20.0, 60.0)], errors(-1.0), 3)),
        Case::of(
            "four positions",
            &simulated(
                (45.0, 10.0),
                &[
                    (0.0, 10.0),
                    (10.0, 9.0),
                    (0.0, 10.0),
                    (10.0, 9.0),
                    (0.0, 10.0),
                    (10.0, 9.0),
                    (0.0, 10.0),
                ],
                errors(0.5),
                4,
            ),
        ),
        Case::of(
            "slow rotation",
            &simulated((70.0, 0.0), &[(2.0, 30.0), (-2.0, 30.0)], errors(1.0), 5),
        ),
        Case::of("errors of three sigma", &simulated((25.0, 40.0), &reversal, errors(3.0), 6)),
    ];
    let mut coloured =
        Case::of("colored noise", &simulated((25.0, 40.0), &reversal, errors(1.0), 7));
    coloured.noise.gyro =
        TriadStrengths { flicker: 0.02 * DEG_PER_HOUR, walk: 1e-10, ..coloured.noise.gyro };
    coloured.noise.accel = TriadStrengths { flicker: 10.0 * MICRO_G, ..coloured.noise.accel };
    cases.push(coloured);

    let mut gaps = Case::of("missing samples", &simulated((25.0, 40.0), &reversal, errors(1.0), 8));
    let kept: Vec<usize> = (0..gaps.run.recording.len())
        .filter(|sample| !(600..650).contains(sample) && *sample != 1400)
        .collect();
    let all = &gaps.run.recording;
    let recording = Recording {
        times: kept.iter().map(|&sample| all.times[sample]).collect(),
        increments: kept.iter().map(|&sample| all.increments[sample]).collect(),
        table_angle: all
            .table_angle
            .as_ref()
            .map(|list| kept.iter().map(|&one| list[one]).collect()),
        ..Recording::default()
    };
    gaps.run = Run::new(gaps.run.rig, recording).unwrap();
    cases.push(gaps);

    let attitude = [2e-3, -3e-3, 1e-3];
    let arm = TermInstance::new(&catalogue::ACCEL_LEVER_ARM).with_values(&[0.01, -0.02]);
    let truth = Model::default()
        .with(TermInstance::new(&catalogue::AXIS_ATTITUDE).with_values(&attitude))
        .with(arm);
    let fast = [(0.0, 5.0), (60.0, 30.0), (-30.0, 30.0)];
    let leaning =
        scenario(tilted(60.0, 20.0), profile(&fast), (errors(1.0), truth), Some(white(&imu)), 9);
    let mut leaning = Case::of("attitude and lever arm", &leaning);
    leaning.model = Model::full().with(TermInstance::new(&catalogue::ACCEL_LEVER_ARM).estimated());
    cases.push(leaning);

    let read = simulated((30.0, 0.0), &reversal, errors(1.0), 10);
    let commanded = Scenario { table: TableRecord::CommandedRate, ..read.clone() };
    let mut command = Case::of("commanded rate", &read);
    let rig = Rig { reference: Reference::Command { noise: 1e-7 }, ..command.run.rig };
    command.run = Run::new(rig, simulate(&commanded).unwrap().recording).unwrap();
    cases.push(command);
    cases
}

/// The largest difference of two lists of estimates in sigmas, and of their sigmas, relative, with the parameter.
fn apart(one: &[Estimate], other: &[Estimate]) -> (f64, String) {
    let of = |(one, other): (&Estimate, &Estimate)| {
        let off = ((one.value - other.value) / other.sigma).abs();
        (off.max((one.sigma / other.sigma - 1.0).abs()), other.parameter.id.clone())
    };
    one.iter().zip(other).map(of).max_by(|a, b| a.0.total_cmp(&b.0)).unwrap()
}

#[test]
fn online_estimates_end_where_the_batch_does() {
    for case in cases() {
        let setup = case.setup();
        let batch = fit(
            &[case.run.clone().in_epochs_of(setup.epoch)],
            &case.model,
            &case.imu,
            NoiseKnowledge::Given(case.noise),
            |_| (),
        )
        .unwrap();
        let mut online = OnlineFilter::new(setup).unwrap();
        for sample in samples(&case.run) {
            online.push(&sample).unwrap();
        }
        let (before, _) = apart(&online.estimates(), &batch.parameters);
        let online = online.finish().unwrap();
        let (off, id) = apart(&online.estimates(), &batch.parameters);
        println!("{:24} {off:.6} sigma ({id}), {before:.3} before the end", case.name);
        assert!(off < WITHIN, "{}: {id} is {off} sigma from the batch", case.name);
        let nis = online.innovation_variance().unwrap();
        assert!((0.9..1.1).contains(&nis), "{}: {nis}", case.name);
    }
}

/// A filter that is stopped after any sample and continued from the text of its checkpoint is the same to the last bit.
#[test]
fn resumed_filter_is_the_same_to_the_last_bit() {
    let cases = cases();
    for case in
        cases.iter().filter(|case| ["colored noise", "missing samples"].contains(&case.name))
    {
        let samples = &samples(&case.run)[..900];
        let mut whole = OnlineFilter::new(case.setup()).unwrap();
        for sample in samples {
            whole.push(sample).unwrap();
        }
        let whole = whole.finish().unwrap().checkpoint();
        let mut random = Pcg64::seed_from_u64(1);
        for _ in 0..8 {
            let stop = random.random_range(0..samples.len());
            let mut first = OnlineFilter::new(case.setup()).unwrap();
            for sample in &samples[..stop] {
                first.push(sample).unwrap();
            }
            let text = serde_json::to_string(&first.checkpoint()).unwrap();
            let read: OnlineCheckpoint = serde_json::from_str(&text).unwrap();
            assert_eq!(read.time(), stop.checked_sub(1).map(|last| samples[last].time));
            let mut second = OnlineFilter::resume(&read).unwrap();
            assert_eq!(second.estimates(), first.estimates());
            assert_eq!(second.compensation(), first.compensation());
            for sample in &samples[stop..] {
                second.push(sample).unwrap();
            }
            let second = second.finish().unwrap();
            assert!(second.checkpoint() == whole, "{}: stopped after sample {stop}", case.name);
        }
    }
}

#[test]
fn sample_that_is_not_valid_changes_nothing() {
    let case = &cases()[0];
    let samples = samples(&case.run);
    let mut filter = OnlineFilter::new(case.setup()).unwrap();
    for sample in &samples[..300] {
        filter.push(sample).unwrap();
    }
    let before = filter.checkpoint();
    let good = samples[300];
    let infinite = Increments { interval: f64::INFINITY, ..good.increments };
    for (bad, told) in [
        (OnlineSample { table: None, ..good }, "has no reading of the table"),
        (OnlineSample { table: Some(f64::NAN), ..good }, "not finite"),
        (OnlineSample { increments: infinite, ..good }, "interval of inf s"),
        (OnlineSample { time: samples[299].time, ..good }, "does not increase"),
    ] {
        let refused = filter.push(&bad).unwrap_err().to_string();
        assert!(refused.contains(told), "{refused}");
        assert!(filter.checkpoint() == before, "{refused}");
    }
}

#[test]
fn setup_and_checkpoint_are_checked() {
    let case = &cases()[0];
    let told = |setup: OnlineSetup| OnlineFilter::new(setup).unwrap_err().to_string();
    let rest = Rig { reference: Reference::Rest, ..case.run.rig };
    assert!(told(OnlineSetup { rig: rest, ..case.setup() }).contains("table angle"));
    assert!(
        told(OnlineSetup { interval: 0.0, ..case.setup() }).contains("interval of a sample is 0")
    );
    assert!(told(OnlineSetup { model: Model::default(), ..case.setup() }).contains("no parameter"));
    let drift = TermInstance::new(&catalogue::GYRO_BIAS_RAMP).estimated();
    let model = Model::full().with(drift);
    assert!(told(OnlineSetup { model, ..case.setup() }).contains(catalogue::GYRO_BIAS_RAMP.id));

    let text =
        serde_json::to_string(&OnlineFilter::new(case.setup()).unwrap().checkpoint()).unwrap();
    let spoilt = |from: &str, to: &str| {
        assert!(text.contains(from), "{from}");
        match serde_json::from_str::<OnlineCheckpoint>(&text.replacen(from, to, 1)) {
            Ok(read) => OnlineFilter::resume(&read).unwrap_err().to_string(),
            Err(error) => error.to_string(),
        }
    };
    for (from, to, told) in [
        ("\"version\":1", "\"version\":2", "another version"),
        ("gyro.bias", "gyro.bios", "a term is unknown"),
        ("\"score\":\"0000000000000000", "\"score\":\"", "cut"),
        ("\"score\":\"0", "\"score\":\"", "sixteen hexadecimal digits"),
        ("\"next\":0", "\"next\":7", "cut"),
    ] {
        let refused = spoilt(from, to);
        assert!(refused.contains(told), "{refused}");
    }
}
