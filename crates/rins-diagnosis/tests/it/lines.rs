//! Lines, slower and faster than an epoch: of a sensor, of the base, and such as come and go.

use rins_diagnosis::{Cause, Diagnosis, Stratum, Structure, suppose};
use rins_estimation::{NoiseKnowledge, NoiseParameters};
use rins_frames::units::{ARCSEC, DEG_PER_HOUR, MICRO_G};
use rins_terms::{Model, SettingKind, TermInstance, catalogue};

use crate::hidden::{RATES, found};
use crate::outside::with;
use crate::support::{SEED, STRONG, fibre, run};

fn line(frequency: f64, axis: f64, values: &[f64]) -> TermInstance {
    TermInstance::new(&catalogue::INTERFERENCE_LINE)
        .with_setting(SettingKind::Frequency, frequency)
        .with_setting(SettingKind::Axis, axis)
        .with_values(values)
}

/// With these amplitudes \[arcsec\].
fn sway(frequency: f64, values: &[f64; 6]) -> TermInstance {
    let values = values.map(|value| value * ARCSEC);
    TermInstance::new(&catalogue::BASE_SWAY)
        .with_setting(SettingKind::Frequency, frequency)
        .with_values(&values)
}

fn hiding(terms: &[TermInstance], rates: &[f64]) -> Diagnosis {
    let hidden = Model { terms: terms.to_vec() };
    found(&run(rates, hidden, 0.0, SEED), NoiseKnowledge::Likely)
}

/// That the frequency of a cause and all its amplitudes are these, within their sigmas.
fn assert_is(cause: &Cause, truth: &TermInstance) {
    assert_eq!(cause.term.id, truth.term.id);
    assert_eq!(cause.settings[1..], truth.settings[1..], "{cause:?}");
    let (place, sigma) = cause.sought.unwrap();
    let off = (cause.settings[place] - truth.settings[place]) / sigma;
    assert!(off.abs() < 4.0 && sigma < 1e-3, "{off} sigma of {sigma} Hz");
    for estimate in &cause.parameters {
        let off = (estimate.value - truth.values[estimate.parameter.parameter]) / estimate.sigma;
        assert!(off.abs() < 4.0, "{}: {off} sigma", estimate.parameter.id);
    }
}

/// A line that one has in mind, faster than an epoch and at about its frequency, is measured as one that was searched for is.
#[test]
fn a_supposed_line_is_measured() {
    let hidden = [
        line(7.31, 2.0, &[0.01 * DEG_PER_HOUR, 0.06 * DEG_PER_HOUR, 0.0, 60.0 * MICRO_G]),
        sway(2.3, &[0.01, 0.06, 0.02, 0.0, 0.0, 0.03]),
    ];
    let run = run(&RATES, Model { terms: hidden.to_vec() }, 0.0, SEED);
    let supposed = [
        line(7.3098, 2.0, &[0.0; 4]).estimated(),
        sway(2.3, &[0.0; 6]).estimated(),
        TermInstance::new(&catalogue::ACCEL_LEVER_ARM).estimated(),
    ];
    let imu = fibre();
    let known = NoiseKnowledge::Given(NoiseParameters::of(&imu));
    let runs = std::slice::from_ref(&run);
    let diagnosis = suppose(runs, &Model::full(), &supposed, &imu, known).unwrap();
    assert_eq!(diagnosis.causes.len(), 3);
    for truth in &hidden {
        let is_it = |cause: &&Cause| cause.term.id == truth.term.id;
        assert_is(diagnosis.causes.iter().find(is_it).unwrap(), truth);
    }
    assert_eq!(diagnosis.causes[2].term.id, "accel_lever_arm");
    assert!(diagnosis.causes[1].ln_p < -50.0 && diagnosis.causes[2].ln_p > -7.0);
}

#[test]
fn lines_are_found_at_their_frequency() {
    let rate = 0.03 * DEG_PER_HOUR;
    let hidden = [
        line(0.137, 2.0, &[rate, 0.0, 0.0, 0.0]),
        line(7.31, 2.0, &[0.0, 2.0 * rate, 0.0, 0.0]),
        sway(0.21, &[0.3, 0.0, 0.0, 0.2, 0.1, 0.1]),
        // An epoch shows these at 0.3 Hz, if at all.
        sway(2.3, &[0.05, 0.0, 0.0, -0.05, 0.0, 0.03]),
        sway(2.3, &[0.01, 0.06, 0.0, 0.0, 0.0, 0.0]),
        // Of ten thousand sigmas: what is left of a frequency a little off is no other line.
        sway(0.37, &[0.0, 6.0, 0.0, -3.0, 0.0, 1.0]),
        // One cause on both sensors of an axis.
        line(5.77, 1.0, &[2.0 * rate, 0.0, 0.0, 60.0 * MICRO_G]),
    ];
    for chosen in &hidden {
        let diagnosis = hiding(std::slice::from_ref(chosen), &RATES);
        let [cause] = &diagnosis.causes[..] else { panic!("{chosen:?}: {:?}", diagnosis.causes) };
        assert_is(cause, chosen);
        assert!(cause.rivals.is_empty(), "{:?}", cause.rivals);
        assert!(diagnosis.unexplained.is_empty(), "{chosen:?}: {:?}", diagnosis.unexplained);
    }
}

/// A hundredth of what interference and floors usually do, and at frequencies between those of a spectrum. The gain is half the
/// square of the sigmas, but for what noise takes of it while the line is not known: at the nearest frequency of the spectrum
/// it would be less than half of that.
#[test]
fn lines_between_the_frequencies_of_a_spectrum_are_named() {
    let line = line(0.1364, 2.0, &[0.0376 * DEG_PER_HOUR, 0.0, 0.0, 0.0]);
    let sway = sway(0.2136, &[0.030, 0.0, 0.0, 0.0, 0.0, 0.0]);
    for chosen in [line, sway] {
        let diagnosis = hiding(std::slice::from_ref(&chosen), &RATES);
        let [cause] = &diagnosis.causes[..] else { panic!("{chosen:?}: {:?}", diagnosis.causes) };
        assert_is(cause, &chosen);
        assert!(cause.gain > STRONG, "{cause:?}");
        let sigmas: f64 = cause.parameters.iter().map(|one| (one.value / one.sigma).powi(2)).sum();
        let share = 2.0 * cause.gain / sigmas;
        assert!((0.65..1.1).contains(&share), "{share}: {cause:?}");
        assert!(cause.rivals.is_empty(), "{:?}", cause.rivals);
    }
}

/// A term is of one axis: the same line on two of them is two causes, and no base that sways.
#[test]
fn line_on_two_axes_is_no_sway() {
    let rate = 0.05 * DEG_PER_HOUR;
    let both =
        [1.0, 2.0].map(|axis| line(6.2, axis, &[rate / axis, 0.0, 0.0, 80.0 * MICRO_G * axis]));
    let mut diagnosis = hiding(&both, &RATES);
    diagnosis.causes.sort_by(|a, b| a.settings[1].total_cmp(&b.settings[1]));
    let [x, y] = &diagnosis.causes[..] else { panic!("{:?}", diagnosis.causes) };
    assert_is(x, &both[0]);
    assert_is(y, &both[1]);
}

/// On a table that stands still the gyros do not tell a base that sways from a line in them.
#[test]
fn sway_of_a_table_at_rest_may_be_a_line() {
    let swaying = sway(3.3, &[0.0, 0.1, 0.0, 0.0, 0.0, 0.0]);
    let diagnosis = hiding(&[swaying], &[0.0; 7]);
    assert!(!diagnosis.causes.is_empty());
    for cause in &diagnosis.causes {
        assert!(cause.rivals.iter().any(|rival| rival.term.id == "base_sway"), "{cause:?}");
    }
}

/// Whether something of the catalogue was found that is not the same all along the time.
fn changes(diagnosis: &Diagnosis) -> bool {
    let along_time = Structure::Inconstant(Stratum::Time);
    diagnosis.unexplained.iter().any(|one| one.structure == along_time)
}

/// A line that is there in every other ninth of the run only stands between sidebands.
#[test]
fn line_that_comes_and_goes_is_one() {
    let height = 0.2 * DEG_PER_HOUR;
    for frequency in [0.73, 4.41] {
        let run = with(0.0, SEED, |time| {
            let is_there = (time / 39.0).floor() % 2.0 > 0.5;
            let rate = if is_there { height } else { 0.0 };
            ([0.0, rate * (std::f64::consts::TAU * frequency * time).sin(), 0.0], [0.0; 3])
        });
        let diagnosis = found(&run, NoiseKnowledge::Likely);
        let [cause] = &diagnosis.causes[..] else {
            panic!("{frequency}: {:?} {:?}", diagnosis.causes, diagnosis.unexplained)
        };
        assert_eq!(cause.term.id, "interference_line");
        assert!((cause.settings[0] - frequency).abs() < 1e-3, "{:?}", cause.settings);
        assert!(changes(&diagnosis), "{frequency}: {:?}", diagnosis.unexplained);
    }
}

/// Two lines near each other beat: they are two, and the same all along.
#[test]
fn lines_that_beat_are_two() {
    let height = 0.1 * DEG_PER_HOUR;
    let both = [4.41, 4.47].map(|frequency| line(frequency, 2.0, &[height, 0.0, 0.0, 0.0]));
    let mut diagnosis = hiding(&both, &RATES);
    diagnosis.causes.sort_by(|a, b| a.settings[0].total_cmp(&b.settings[0]));
    let [low, high] = &diagnosis.causes[..] else { panic!("{:?}", diagnosis.causes) };
    assert_is(low, &both[0]);
    assert_is(high, &both[1]);
    assert!(!changes(&diagnosis), "{:?}", diagnosis.unexplained);
}
