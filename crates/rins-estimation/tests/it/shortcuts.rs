//! Faster methods have the result of the exact ones.

use std::sync::Arc;

use rins_estimation::{
    Evidence, Linear, Noise, NoiseKnowledge, NoiseParameters, Run, fit, fit_approximately,
    fit_near, linearise, linearise_coarsely,
};
use rins_frames::InFrame;
use rins_frames::units::PPM;
use rins_imu::{Axis, ImuError, TriadError};
use rins_terms::{Model, SettingKind, TermInstance, catalogue};
use rins_testing::assert_close;

use crate::support::{fibre, profile, run, scenario, tilted, white};

fn turned() -> Run {
    let gyro = TriadError::default().with_scale(Axis::Z, 200.0 * PPM).with_bias(Axis::X, 1e-7);
    let turns = profile(&[(0.0, 10.0), (10.0, 60.0), (-6.0, 120.0), (0.0, 10.0)]);
    let error = ImuError { gyro, ..ImuError::default() };
    let truth = (error, Model::default());
    run(&scenario(tilted(25.0, 40.0), turns, truth, Some(white(&fibre())), 3))
}

/// Effects on gyros, accelerometers, the encoder and the axis: constant, as steps, and as ramps.
fn many() -> Model {
    let mut model = Model::full();
    let terms = [
        TermInstance::new(&catalogue::GYRO_THERMAL_BIAS),
        TermInstance::new(&catalogue::GYRO_BIAS_STEP).with_setting(SettingKind::Time, 71.3),
        TermInstance::new(&catalogue::GYRO_G_SENSITIVITY),
        TermInstance::new(&catalogue::ACCEL_LEVER_ARM),
        TermInstance::new(&catalogue::ACCEL_LATENCY),
        TermInstance::new(&catalogue::ENCODER_LATENCY),
        TermInstance::new(&catalogue::ENCODER_HARMONIC).with_setting(SettingKind::Order, 6.0),
        TermInstance::new(&catalogue::TABLE_WOBBLE).with_setting(SettingKind::Order, 3.0),
        TermInstance::new(&catalogue::BASE_TILT_STEP).with_setting(SettingKind::Time, 88.9),
    ];
    model.terms.extend(terms.map(TermInstance::estimated));
    model
}

#[test]
fn coarse_pieces_show_each_effect_as_well() {
    let (run, model, imu) = (turned(), many(), fibre());
    let free = model.free(&imu);
    let columns: Vec<(usize, usize)> = free.iter().map(|f| (f.term, f.parameter)).collect();
    let noise = Noise::on(&run.rig, &NoiseParameters::of(&imu));
    let said = |linear: Linear| Evidence::of(&linear, &noise).unwrap();
    let fine = said(linearise(&run, &model, &columns));
    let coarse = said(linearise_coarsely(&run, &model, &columns));
    assert!(fine != coarse, "nothing is taken together");
    for (place, parameter) in free.iter().enumerate() {
        let of = |evidence: &Evidence| evidence.information[(place, place)];
        let (exact, near) = (of(&fine), of(&coarse));
        if exact == 0.0 {
            continue;
        }
        let off = (near / exact - 1.0).abs();
        // Squares of derivatives; effects that last less than a sample have the largest errors.
        let bound = if parameter.id.starts_with("base_tilt_step") { 0.1 } else { 0.01 };
        assert!(off < bound, "{}: {off}", parameter.id);
        // The significance in sigmas of an estimate of this parameter alone, exact and approximate.
        let estimate = |evidence: &Evidence| evidence.score[place] / of(evidence).sqrt();
        let (exact, near) = (estimate(&fine), estimate(&coarse));
        assert!(
            (near - exact).abs() < 0.02 + 2.0 * bound * (1.0 + exact.abs()),
            "{}: {exact} {near}",
            parameter.id
        );
    }
}

#[test]
fn a_fit_beside_another_ends_where_one_from_nothing_does() {
    let (run, imu) = (turned(), fibre());
    let runs = std::slice::from_ref(&run);
    let knowledge = NoiseKnowledge::Likely(NoiseParameters::of(&imu));
    let first = fit(runs, &Model::full(), &imu, knowledge, |_| ()).unwrap();
    let mut model = Model::full();
    model.terms.push(TermInstance::new(&catalogue::ACCEL_LEVER_ARM).estimated());
    let alone = fit(runs, &model, &imu, knowledge, |_| ()).unwrap();
    let beside = fit_near(&first, runs, &model, &imu, knowledge).unwrap();
    for (one, other) in alone.parameters.iter().zip(&beside.parameters) {
        let apart = (one.value - other.value) / one.sigma;
        assert!(apart.abs() < 0.03, "{}: {apart} sigma", one.parameter.id);
        assert!((one.sigma / other.sigma - 1.0).abs() < 0.05, "{}", one.parameter.id);
    }
    let differ = alone.log_likelihood - beside.log_likelihood;
    assert!(differ.abs() < 0.2, "{differ}");
}

#[test]
fn threads_change_no_bit() {
    let (run, model, imu) = (turned(), many(), fibre());
    let columns: Vec<(usize, usize)> =
        model.free(&imu).iter().map(|f| (f.term, f.parameter)).collect();
    let noise = Noise::on(&run.rig, &NoiseParameters::of(&imu));
    let said = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| Evidence::of(&linearise_coarsely(&run, &model, &columns), &noise)).unwrap()
    };
    assert_eq!(said(1), said(3));
}

#[test]
fn an_approximate_fit_is_within_a_part_of_each_sigma() {
    let (run, imu) = (turned(), fibre());
    let runs = std::slice::from_ref(&run);
    let knowledge = NoiseKnowledge::Likely(NoiseParameters::of(&imu));
    let first = fit(runs, &Model::full(), &imu, knowledge, |_| ()).unwrap();
    let model = many();
    let exact = fit_near(&first, runs, &model, &imu, knowledge).unwrap();
    let near = fit_approximately(&first, runs, &model, &imu, knowledge).unwrap();
    assert!(near.parameters != exact.parameters, "nothing is approximated");
    for (one, other) in exact.parameters.iter().zip(&near.parameters) {
        // An approximate tilt lasts a sample longer or less.
        let bound = if one.parameter.id.starts_with("base_tilt_step") { 0.3 } else { 0.1 };
        let off = (other.value - one.value) / one.sigma;
        assert!(off.abs() < bound, "{}: {off}", one.parameter.id);
        assert!(other.sigma < 1.1 * one.sigma, "{}", one.parameter.id);
    }
    let off = near.log_likelihood - exact.log_likelihood;
    assert!(off.abs() < 0.3, "{off}");
}

/// The density of the same readings in another unit: residuals and their noise are the same, and the readings are spread wider.
#[test]
fn a_density_is_one_of_the_readings() {
    let (run, imu) = (turned(), fibre());
    let larger = 1.02;
    let mut scaled = run.clone();
    for sample in &mut Arc::make_mut(&mut scaled.recording).increments {
        sample.velocity = InFrame::from_components(sample.velocity.components() * larger);
    }
    let density = |run: &Run, scale: f64| {
        let mut model = Model::full();
        let accel = model.terms.iter_mut().find(|one| one.term.is(&catalogue::ACCEL_SCALE));
        accel.unwrap().values.fill(scale);
        let linear = linearise(run, &model, &[]);
        let noise = Noise::on(&run.rig, &NoiseParameters::of(&imu));
        let evidence = Evidence::of(&linear, &noise).unwrap();
        (-0.5 * evidence.square - evidence.log_determinant, linear.epochs() as f64)
    };
    let (one, epochs) = density(&run, 0.0);
    let (other, _) = density(&scaled, larger - 1.0);
    assert_close!(one - other, 3.0 * epochs * larger.ln(), 1e-3);
}
