//! The online filter ends where the batch does, and continues from a checkpoint to the same bits.

use rins_estimation::{
    NoiseKnowledge, NoiseParameters, OnlineFilter, OnlineSample, OnlineSetup,
    Reference, Run, TriadStrengths, fit,
};
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, MICRO_G, PPM};
use rins_imu::{Axis, ImuError, ImuSpec, TriadError};
use rins_motion::Recording;
use rins_simulation::{Encoder, Scenario, TableRecord};
use rins_terms::{Model, TermInstance, catalogue};

use crate::support::{ENCODER, fibre, profile, run, scenario, tilted, white};

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
                &[(0.0, 10.0), (10.0, 9.0), (0.0, 10.0), (10.0, 9.0), (0.0, 10.0), (10.0, 9.0), (0.0, 10.0)],
                errors(0.5),
                4,
            ),
        ),
        Case::of("slow rotation", &simulated((70.0, 0.0), &[(2.0, 30.0), (-2.0, 30.0)], errors(1.0), 5)),
        Case::of("errors of three sigma", &simulated((25.0, 40.0), &reversal, errors(3.0), 6)),
    ];
    let mut coloured = Case::of("colored noise", &simulated((25.0, 40.0), &reversal, errors(1.0), 7));
    coloured.noise.gyro = TriadStrengths { flicker: 0.02 * DEG_PER_HOUR, walk: 1e-10, ..coloured.noise.gyro };
    coloured.noise.accel = TriadStrengths { flicker: 10.0 * MICRO_G, ..coloured.noise.accel };
    cases.push(coloured);

    let mut gaps = Case::of("missing samples", &simulated((25.0, 40.0), &reversal, errors(1.0), 8));
    let kept: Vec<usize> =
        (0..gaps.run.recording.len()).filter(|sample| !(600..650).contains(sample) && *sample != 1400).collect();
    let all = &gaps.run.recording;
    let recording = Recording {
        times: kept.iter().map(|&sample| all.times[sample]).collect(),
        increments: kept.iter().map(|&sample| all.increments[sample]).collect(),
        table_angle: all.table_angle.as_ref().map(|list| kept.iter().map(|&one| list[one]).collect()),
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
    let leaning = scenario(tilted(60.0, 20.0), profile(&fast), (errors(1.0), truth), Some(white(&imu)), 9);
    let mut leaning = Case::of("attitude and lever arm", &leaning);
    leaning.model = Model::full().with(TermInstance::new(&catalogue::ACCEL_LEVER_ARM).estimated());
    cases.push(leaning);

    let commanded = Scenario {
        table: TableRecord::CommandedRate,
        ..simulated((30.0, 0.0), &reversal, errors(1.0), 10)
    };
    let recording = rins_simulation::simulate(&commanded).unwrap().recording;
    let rig = rins_estimation::Rig { reference: Reference::Command { noise: 1e-7 }, ..cases[0].run.rig };
    let rig = rins_estimation::Rig { nav_from_table: commanded.nav_from_table, ..rig };
    let command = Run::new(rig, recording).unwrap();
    cases.push(Case { run: command, ..Case::of("commanded rate", &simulated((30.0, 0.0), &reversal, errors(1.0), 10)) });
    let _ = (Encoder { noise: ENCODER, resolution: None, zero: 0.0 }, DEG);
    cases
}

#[test]
fn online_estimates_end_where_the_batch_does() {
    let mut report = String::new();
    let mut worst: f64 = 0.0;
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
        let start = std::time::Instant::now();
        for sample in samples(&case.run) {
            online.push(&sample).unwrap();
        }
        let took = start.elapsed().as_secs_f64() / case.run.recording.len() as f64;
        let before_finish = online.estimates();
        let online = online.finish().unwrap();
        let early = before_finish.iter().zip(&batch.parameters).map(|(one, other)| (one.value - other.value).abs() / other.sigma).fold(0.0, f64::max);
        let (mut apart, mut of, mut ratio) = (0.0_f64, String::new(), 1.0_f64);
        for (one, other) in online.estimates().iter().zip(&batch.parameters) {
            let off = (one.value - other.value).abs() / other.sigma;
            if off > apart {
                (apart, of) = (off, other.parameter.id.clone());
            }
            let wide = one.sigma / other.sigma;
            if (wide - 1.0).abs() > (ratio - 1.0).abs() {
                ratio = wide;
            }
        }
        let nis = online.innovation_variance().unwrap();
        report += &format!("{:26} {apart:.5} sigma ({of}), sigmas {ratio:.6}, {:.1} us a sample, nis {nis:.3}, before finish {early:.5}\n", case.name, took * 1e6);
        worst = worst.max(apart).max((ratio - 1.0).abs());
    }
    println!("{report}");
    assert!(worst < WITHIN, "{report}");
}
