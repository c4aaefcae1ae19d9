//! The generator and the catalogue, which share nothing, say the same.

use nalgebra::{Matrix3, Vector3};
use rins_blind::{Experiment, LAWS, Log, record};
use rins_frames::{Body, InFrame};
use rins_motion::{Profile, Segment};
use rins_simulation::{Encoder, Scenario, TableRecord, simulate};
use rins_terms::{
    MeasurementModel, Model, Need, SettingKind, Surroundings, Term, TermInstance, Track, catalogue,
};
use rins_trials::{Stand, hidden, is_hideable, recording};

use crate::bench::{DEGREE, experiment, known};

/// Three rates, both ways, and a rest.
const RATES: [f64; 7] = [0.0, 10.0, -10.0, 40.0, -40.0, 20.0, -20.0];

/// Whether the generator has an effect: those that trials hide, and those that need a wider range of temperature.
fn has_law(term: &Term) -> bool {
    is_hideable(term) || term.needs.contains(&Need::TemperatureRange)
}

/// How far apart the integrals of two signals may be, as a part of them.
fn tolerance(id: &str) -> f64 {
    match id {
        // The catalogue takes a table to turn once it is faster than 0.3 deg/s; here it does so at once.
        "encoder_backlash" => 0.15,
        // A mean of a kinked function is not the function of a mean, and Earth's rate crosses zero within samples;
        // a base takes a sample to give way here, and no time there; a change of rate counts from 0.3 deg/s on.
        "gyro_dead_zone" | "base_tilt_step" | "gyro_hysteresis" => 0.02,
        // The catalogue takes the slope over seconds, not in an instant.
        "gyro_shupe" => 0.01,
        _ => 0.004,
    }
}

/// A usual size of every parameter, large enough to show, in different directions.
fn sized(term: &'static Term, experiment: &Experiment) -> TermInstance {
    let imu = Stand::of(experiment, &known(experiment)).imu;
    let part = |place: usize| [0.3, -0.2, 0.25][place % 3];
    let size = |(place, p): (usize, &rins_terms::Parameter)| p.range(&imu).1 * part(place);
    let values: Vec<f64> = term.parameters.iter().enumerate().map(size).collect();
    TermInstance::new(term).with_values(&values).with_setting(SettingKind::Time, 77.7)
}

/// What `effect` adds, by the catalogue, to a run whose log without it is `plain`.
fn predicted(effect: TermInstance, experiment: &Experiment, plain: &Log) -> [Vec<Vector3<f64>>; 3] {
    let stand = Stand::of(experiment, &known(experiment));
    let rig = stand.run(plain, experiment.interval).expect("it is long enough").rig;
    let track = Track::new(
        Surroundings::new(rig.station, rig.nav_from_table),
        plain.times.clone(),
        vec![experiment.interval; plain.times.len()],
        std::iter::once(0.0).chain(plain.angles.iter().copied()).collect(),
        Some(plain.temperature.clone()),
    );
    // What is slow is so about the gyros' own axes.
    let is_misalignment =
        |chosen: &&TermInstance| chosen.term.id == catalogue::GYRO_MISALIGNMENT.id;
    let without =
        Model { terms: stand.model.terms.iter().filter(is_misalignment).cloned().collect() };
    // The generator's coefficients are about the temperature at the start.
    let with = without.clone().with(effect).about_temperature(plain.temperature[0]);
    let mut made = [MeasurementModel::new(&with, &track), MeasurementModel::new(&without, &track)];
    let mut signals = [Vec::new(), Vec::new(), Vec::new()];
    for moment in track.moments() {
        let interval = experiment.interval;
        let mut felt = recording(plain, interval).increments[0];
        felt.angle = InFrame::from_components(moment.rate * interval);
        felt.velocity = InFrame::from_components(moment.force * interval);
        let [read, felt] = made.each_mut().map(|making| making.read(&moment, &felt));
        let mean = |of: InFrame<Body>| *of.components() / interval;
        signals[0].push(mean(read.increments.angle - felt.increments.angle));
        signals[1].push(mean(read.increments.velocity - felt.increments.velocity));
        signals[2].push(Vector3::z() * (read.angle_error - felt.angle_error));
    }
    signals
}

fn integral(of: impl Iterator<Item = Vector3<f64>>) -> Vec<Vector3<f64>> {
    let mut sum = Vector3::zeros();
    of.map(|step| {
        sum += step;
        sum
    })
    .collect()
}

#[test]
fn every_signal_is_what_the_catalogue_says() {
    let base = experiment(&RATES, 20.0);
    let plain = record(&base);
    for term in catalogue::CATALOGUE.iter().filter(|term| has_law(term)) {
        let chosen = sized(term, &base);
        let log = record(&Experiment { effects: vec![hidden(&chosen)], ..base.clone() });
        let made = [
            integral(log.gyro.iter().zip(&plain.gyro).map(|(with, without)| with - without)),
            integral(log.accel.iter().zip(&plain.accel).map(|(with, without)| with - without)),
            log.angles
                .iter()
                .zip(&plain.angles)
                .map(|(with, without)| Vector3::z() * (with - without))
                .collect(),
        ];
        let [gyro, accel, angle] = predicted(chosen, &base, &plain);
        let theirs = [integral(gyro.into_iter()), integral(accel.into_iter()), angle];
        let mut shown = false;
        for (channel, (made, theirs)) in made.iter().zip(&theirs).enumerate() {
            let size: f64 = theirs.iter().map(Vector3::norm_squared).sum();
            let off: f64 = made.iter().zip(theirs).map(|(a, b)| (a - b).norm_squared()).sum();
            // 4 milliseconds of arc at the end, 20 ng for 2 min, two microseconds of arc.
            let least = [1e-6, 1e-5, 1e-11][channel];
            let count = made.len() as f64;
            if (size / count).sqrt() < least && (off / count).sqrt() < least {
                continue;
            }
            shown = true;
            let ratio = (off / size).sqrt();
            assert!(ratio < tolerance(term.id), "{}, channel {channel}: {ratio}", term.id);
        }
        assert!(shown, "{} does nothing", term.id);
    }
}

/// How far apart generator and catalogue are on a dead zone, as a part of it, where an IMU is so mounted.
fn apart(zone: TermInstance, mounting: [f64; 2]) -> f64 {
    let base = Experiment { mounting, ..experiment(&RATES, 20.0) };
    let plain = record(&base);
    let log = record(&Experiment { effects: vec![hidden(&zone)], ..base.clone() });
    let made = integral(log.gyro.iter().zip(&plain.gyro).map(|(with, without)| with - without));
    let [gyro, ..] = predicted(zone, &base, &plain);
    let theirs = integral(gyro.into_iter());
    let off: f64 = made.iter().zip(&theirs).map(|(a, b)| (a - b).norm_squared()).sum();
    (off / theirs.iter().map(Vector3::norm_squared).sum::<f64>()).sqrt()
}

/// Misalignment and mounting together say what a gyro sees of the table's turning about its own axis.
#[test]
fn a_dead_zone_is_about_the_gyros_own_axis() {
    let zone = |axes: f64| {
        let widths = [1.0, 2.0, 0.0].map(|width| width * DEGREE / 3600.0);
        TermInstance::new(&catalogue::GYRO_DEAD_ZONE)
            .with_values(&widths)
            .with_setting(SettingKind::RateAxes, axes)
    };
    let mounted = [2e-4, -1e-4];
    assert!(apart(zone(0.0), mounted) < 0.02);
    assert!(apart(zone(1.0), [0.0; 2]) < 0.02);
    // A mounting that is not known is none of the body's axes.
    assert!(apart(zone(1.0), mounted) > 0.1);
}

/// Every id that a trial may hide has a law, and every law an id of the catalogue.
#[test]
fn laws_and_catalogue_have_the_same_ids() {
    let ids: Vec<&str> = LAWS.iter().copied().flatten().map(|(id, _)| *id).collect();
    for term in catalogue::CATALOGUE.iter().filter(|term| has_law(term)) {
        assert!(ids.contains(&term.id), "{}", term.id);
    }
    for id in ids {
        assert!(catalogue::term(id).is_some(), "{id}");
    }
}

/// What the estimator's model leaves of a run without noise, in squares of the noise that there might be.
#[test]
fn perfect_run_leaves_nothing() {
    for rates in [&[10.0][..], &[10.0, -10.0], &RATES] {
        let mut base = experiment(rates, 360.0 / rates.len() as f64);
        base.mounting = [2e-4, -1e-4];
        let known = known(&base);
        let mut stand = Stand::of(&base, &known);
        stand.noise.imu.gyro.white = known.gyro.noise;
        stand.noise.imu.accel.white = known.accel.noise;
        let run = stand.run(&record(&base), base.interval).unwrap();
        let left = stand.told(&run, &[]).unwrap().square;
        assert!(left < 0.2, "{rates:?}: {left}");
        // A part in a million of gyro z shows a hundred times as much.
        base.gyro.matrix[(2, 2)] += 1e-6;
        base.gyro.matrix[(0, 1)] += 1e-3;
        let run = stand.run(&record(&base), base.interval).unwrap();
        let left = stand.told(&run, &[]).unwrap().square;
        assert!(left > 1.0, "{rates:?}: {left}");
    }
}

/// The exact increments of a perfect IMU at a constant rate, by the simulator's quadrature.
#[test]
fn increments_are_those_of_the_simulator() {
    let mut base = experiment(&[25.0], 20.0);
    for sensors in [&mut base.gyro, &mut base.accel] {
        sensors.bias = Vector3::zeros();
        sensors.matrix = Matrix3::zeros();
    }
    let log = recording(&record(&base), base.interval);
    let rig = Stand::of(&base, &known(&base)).run(&record(&base), base.interval).unwrap().rig;
    let turn = Segment { rate: 25.0 * DEGREE, duration: 20.0 };
    let profile = Profile::new(&[turn], None).unwrap();
    let scenario = Scenario {
        table: TableRecord::Angle(Encoder::default()),
        ..Scenario::perfect(rig.station, rig.nav_from_table, profile, base.interval)
    };
    let simulated = simulate(&scenario).unwrap().recording;
    assert_eq!(log.len(), simulated.len());
    for (ours, theirs) in log.increments.iter().zip(&simulated.increments) {
        let angle = (ours.angle.components() - theirs.angle.components()).norm();
        let velocity = (ours.velocity.components() - theirs.velocity.components()).norm();
        // Steps of a millisecond: a chord for an arc, (0.44 mrad)²/12 of gravity's share.
        assert!(angle < 1e-13, "{angle} rad");
        assert!(velocity < 0.02 * 9.81 * 2e-8, "{velocity} m/s");
    }
}
