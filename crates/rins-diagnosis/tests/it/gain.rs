//! What is gained is measured on data that played no part: something where an effect is, nothing where none is.

use rins_diagnosis::{Gain, GainError, GainVerdict, Overlay};
use rins_estimation::{Fit, NoiseKnowledge, NoiseParameters, Run, fit};
use rins_frames::EulerAngles;
use rins_frames::units::{ARCSEC, DEG, PPM};
use rins_terms::{Model, SettingKind, TermInstance, catalogue};

use crate::support::{SEED, fibre, run, run_at, run_of};

/// Stretches of 50 s: a rest, and such of five revolutions and more.
const RATES: [f64; 5] = [0.0, 40.0, -40.0, 80.0, -80.0];

fn asymmetric() -> TermInstance {
    TermInstance::new(&catalogue::GYRO_SCALE_ASYMMETRY)
}

fn fitted(run: &Run, model: &Model) -> Fit {
    let imu = fibre();
    let known = NoiseKnowledge::Given(NoiseParameters::of(&imu));
    fit(std::slice::from_ref(run), model, &imu, known, |_| ()).unwrap()
}

/// The full model, and the same with an asymmetry of the gyro's scale.
fn fits(run: &Run) -> (Fit, Fit) {
    let model = Model::full();
    (fitted(run, &model), fitted(run, &model.with(asymmetric().estimated())))
}

fn hiding(ppm: f64, seed: u64) -> Run {
    let model = Model { terms: vec![asymmetric().with_values(&[ppm * PPM])] };
    run(&RATES, model, 0.0, seed)
}

fn within(run: &Run) -> Gain {
    let (before, after) = fits(run);
    let known = NoiseKnowledge::Given(NoiseParameters::of(&fibre()));
    Gain::within(std::slice::from_ref(run), (&before, &after), &fibre(), known).unwrap()
}

#[test]
fn an_effect_that_is_there_foretells_better() {
    let gain = within(&hiding(3.0, SEED));
    assert_eq!(gain.verdict, GainVerdict::Improved);
    assert!(gain.rise() > 20.0 && gain.interval.0 < gain.rise(), "{gain:?}");
    assert!(gain.interval.1 > gain.rise());
    // Right again: chi-square of six degrees.
    assert!((gain.after.nis_mean - 6.0).abs() < 0.8, "{}", gain.after.nis_mean);
    assert!(gain.before.nis_mean > gain.after.nis_mean + 1.0);
    let drift = gain.drifts.last().unwrap();
    assert!(drift.attitude[1] < 0.5 * drift.attitude[0], "{drift:?}");
}

/// An asymmetry grows with the rate, a step that was taken for it does not.
#[test]
fn what_was_found_at_slower_rates_foretells_the_fastest() {
    let known = NoiseKnowledge::Given(NoiseParameters::of(&fibre()));
    let there = hiding(3.0, SEED);
    let (before, after) = fits(&there);
    let runs = std::slice::from_ref(&there);
    let gain = Gain::at_the_fastest_rate(runs, (&before, &after), &fibre(), known).unwrap();
    assert_eq!(gain.verdict, GainVerdict::Improved, "{gain:?}");
    assert!(gain.rise() > 20.0, "{}", gain.rise());
    // Both stretches at 80 deg/s: of 50 s each, ramps of 24 and 32 s left, nine turns of 4.5 s.
    let held: usize = gain.spans.iter().flatten().map(std::ops::Range::len).sum();
    let share = held as f64 / there.recording.len() as f64;
    assert!((0.12..9.0 * 4.5 / 250.0).contains(&share), "{share}");

    let one_rate = run(&[0.0, 40.0, -40.0], Model::default(), 0.0, SEED);
    let (before, after) = fits(&one_rate);
    let runs = std::slice::from_ref(&one_rate);
    let none = Gain::at_the_fastest_rate(runs, (&before, &after), &fibre(), known);
    assert_eq!(none, Err(GainError::OneRate));
}

/// The right model gains about what a parameter costs, the half of a nat and less.
#[test]
fn an_effect_that_is_not_there_gains_nothing() {
    let gain = within(&hiding(0.0, SEED));
    assert!(gain.rise().abs() < 3.0, "{}", gain.rise());
    assert_eq!(gain.verdict, GainVerdict::NoImprovement, "{gain:?}");
}

#[test]
fn the_last_of_every_stretch_is_held_out_in_whole_revolutions() {
    let run = run(&[0.0, 40.0, 80.0], Model::default(), 0.0, SEED);
    let gain = within(&run);
    let angles = run.recording.table_angle.as_ref().unwrap();
    let times = &run.recording.times;
    let spans = &gain.spans[0];
    // 15 s of the rest in two pieces, one revolution of five, two of nine.
    assert_eq!((spans.len(), gain.blocks), (3, 5));
    for (span, revolutions) in spans.iter().zip([0.0, 1.0, 2.0]) {
        let turned = (angles[span.end - 1] - angles[span.start]).abs() / std::f64::consts::TAU;
        // To an epoch, a quarter of a second.
        assert!((turned - revolutions).abs() < 0.08, "{turned}");
    }
    assert!((times[spans[0].end] - times[spans[0].start] - 15.0).abs() < 1.0);
    assert_eq!(gain.samples, spans.iter().map(ExactSizeIterator::len).sum::<usize>());
}

/// What belongs to the sensor was found in one run and holds in another; one that is wrong does harm there.
#[test]
fn what_was_found_is_carried_to_another_run() {
    let known = NoiseKnowledge::Given(NoiseParameters::of(&fibre()));
    let found = hiding(3.0, SEED);
    let (before, after) = fits(&found);
    let on = |other: &Run| {
        let [others, runs] = [other, &found].map(std::slice::from_ref);
        Gain::on(others, runs, (&before, &after), &fibre(), known).unwrap()
    };
    let same = on(&hiding(3.0, SEED + 1));
    assert_eq!(same.verdict, GainVerdict::Improved, "{same:?}");
    let other = on(&hiding(-3.0, SEED + 2));
    assert_eq!(other.verdict, GainVerdict::NoImprovement);
    assert!(other.rise() < -20.0, "{}", other.rise());
}

/// A level table shows nothing of the scale of the accelerometers across its axis. What is only guessed of it is no part of
/// the model that is carried to a table that lies on its side.
#[test]
fn what_one_run_does_not_show_is_not_held_against_another() {
    let hidden = || {
        let scale = TermInstance::new(&catalogue::ACCEL_SCALE).with_values(&[3e-4, -2e-4, 2e-4]);
        Model { terms: vec![asymmetric().with_values(&[3.0 * PPM]), scale] }
    };
    let at = |roll: f64, seed| {
        let attitude = EulerAngles { roll: roll * DEG, pitch: 0.0, yaw: 40.0 * DEG };
        run_at(attitude, &RATES, hidden(), 0.0, seed)
    };
    let known = NoiseKnowledge::Given(NoiseParameters::of(&fibre()));
    let level = [at(0.0, SEED)];
    let (before, after) = fits(&level[0]);
    let gain = Gain::on(&[at(80.0, SEED + 1)], &level, (&before, &after), &fibre(), known).unwrap();
    assert_eq!(gain.verdict, GainVerdict::Improved, "{gain:?}");
    assert_eq!(gain.spans.len(), 1);
    assert!((gain.after.nis_mean - 6.0).abs() < 0.8, "{}", gain.after.nis_mean);
}

/// Navigation starts from where the base is by then. Level to 60 seconds of arc it would gain 3 mm/s every second.
#[test]
fn base_that_gave_way_is_where_navigation_starts() {
    let step =
        || TermInstance::new(&catalogue::BASE_TILT_STEP).with_setting(SettingKind::Time, 80.0);
    let hidden = Model { terms: vec![step().with_values(&[60.0 * ARCSEC, 0.0, 0.0])] };
    let run = run(&RATES, hidden, 0.0, SEED);
    let model = Model::full();
    let (before, after) = (fitted(&run, &model), fitted(&run, &model.with(step().estimated())));
    let known = NoiseKnowledge::Given(NoiseParameters::of(&fibre()));
    let runs = std::slice::from_ref(&run);
    let gain = Gain::within(runs, (&before, &after), &fibre(), known).unwrap();
    let drift = gain.drifts.last().unwrap();
    let lost = 60.0 * ARCSEC * 9.8 * drift.after;
    assert!(drift.velocity[0] > 0.3 * lost, "{drift:?}, {lost} m/s");
    assert!(drift.velocity[1] < 0.1 * lost, "{drift:?}, {lost} m/s");
}

#[test]
fn too_short_a_run_holds_nothing_to_measure_by() {
    // Less than a revolution in 50 s is cut in pieces of 10 s: 15 s are held out.
    let run = run(&[5.0], Model::default(), 0.0, SEED);
    let (before, after) = fits(&run);
    let known = NoiseKnowledge::Given(NoiseParameters::of(&fibre()));
    let refused = Gain::within(std::slice::from_ref(&run), (&before, &after), &fibre(), known);
    assert_eq!(refused, Err(GainError::TooLittle { blocks: 2 }));
}

/// A table that never has a constant rate for 10 s: the last revolutions are held out as of any other.
#[test]
fn coast_down_is_held_out_by_revolutions() {
    let rates: Vec<f64> = (0..18).map(|step| 40.0 - 1.2 * f64::from(step)).collect();
    let there = asymmetric().with_values(&[6.0 * PPM]);
    let slow = run_of(&rates, 9.5, Model::default().with(there), SEED);
    let gain = within(&slow);
    assert!(gain.blocks >= 4, "{gain:?}");
    let last = gain.spans[0].last().unwrap();
    assert!(last.end > slow.recording.len() - 20, "{:?} of {}", gain.spans, slow.recording.len());
    let held: usize = gain.spans[0].iter().map(ExactSizeIterator::len).sum();
    let share = held as f64 / slow.recording.len() as f64;
    assert!((0.1..0.6).contains(&share), "{share}");
}

/// Of an eccentric encoder the second harmonic stays in gyro z, in the table angle, until the model has it.
#[test]
fn what_the_model_lacks_stays_in_the_residual() {
    let harmonic =
        TermInstance::new(&catalogue::ENCODER_HARMONIC).with_setting(SettingKind::Order, 2.0);
    let hidden = Model { terms: vec![harmonic.clone().with_values(&[2.0 * ARCSEC, 0.0])] };
    let run = run(&RATES, hidden, 0.0, SEED);
    let amplitude = |model: &Model| {
        let overlay = Overlay::of(&run, &fitted(&run, model), 0);
        assert_eq!(overlay.residuals.len(), run.recording.len());
        let (mut cos, mut sin, mut turning) = (0.0, 0.0, 0.0);
        for ((residual, angle), rate) in
            overlay.residuals.iter().zip(&overlay.angles).zip(&overlay.rates)
        {
            if *rate > 0.6 && *rate < 0.8 {
                cos += residual[2] * (2.0 * angle).cos();
                sin += residual[2] * (2.0 * angle).sin();
                turning += 0.5;
            }
        }
        f64::hypot(cos, sin) / turning
    };
    // The encoder's rate is off by k w e, 2 · 40 deg/s · 2 arcsec, seen smoothed.
    let expected = 2.0 * 0.698 * 2.0 * ARCSEC;
    let (without, with) =
        (amplitude(&Model::full()), amplitude(&Model::full().with(harmonic.estimated())));
    assert!((without / expected - 1.0).abs() < 0.1, "{without} of {expected}");
    assert!(with < 0.05 * without, "{with} and {without}");
}
