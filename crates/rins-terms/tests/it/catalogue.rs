//! The catalogue is whole, and each of its terms does something.

use std::collections::BTreeSet;

use nalgebra::Vector3;
use rins_frames::units::{ARCSEC, DEG_PER_HOUR, MICRO_G};
use rins_imu::{NoiseModel, Seed};
use rins_terms::catalogue::{CATALOGUE, MOST_PARAMETERS, term};
use rins_terms::{
    Acting, Action, KinematicState, Model, Noises, Parameter, Prior, SettingKind, Signals, Term,
    TermInstance, values,
};

use crate::support::{run, sheet};

/// The effects that the catalogue must know, by sensor.
const WANTED: &str = "
    gyro_bias_step gyro_bias_ramp gyro_warmup gyro_thermal_bias gyro_thermal_polynomial gyro_thermal_lag gyro_shupe gyro_bias_instability
    gyro_rate_random_walk gyro_noise_level accel_noise_level gyro_quantisation gyro_scale_asymmetry
    gyro_scale_nonlinearity gyro_rate_dependent_bias gyro_thermal_scale gyro_scale_ramp gyro_g_sensitivity
    gyro_g2_sensitivity gyro_magnetic gyro_dead_zone gyro_hysteresis gyro_lag gyro_saturation
    accel_bias_step accel_bias_ramp accel_warmup accel_thermal_bias accel_thermal_polynomial accel_thermal_lag accel_scale accel_misalignment
    accel_quadratic accel_cubic accel_asymmetry accel_cross_coupling accel_lever_arm accel_size_effect
    accel_vibration_rectification accel_latency stuck_samples accel_quantisation accel_saturation
    encoder_eccentricity encoder_harmonic table_wobble table_rate_ripple encoder_latency encoder_backlash
    encoder_slip clock_drift timestamp_jitter dropped_samples readout_lag
    base_tilt_ramp base_tilt_step base_sway base_rotation base_rolling cable_torque_tilt thermal_one_per_turn
    wrong_latitude wrong_gravity unit_error axis_convention table_sense interference_line outliers";

/// What the catalogue has besides: the baseline, and the accelerometers' share of the noise.
const BESIDES: &str = "gyro.bias gyro.scale gyro.misalignment accel.bias accel.scale
    accel.misalignment axis.attitude axis.azimuth mounting encoder.zero accel_bias_instability accel_rate_random_walk";

#[test]
fn ids_are_unique_and_those_that_are_wanted() {
    let ids: Vec<&str> =
        CATALOGUE.iter().flat_map(|term| term.also.iter().copied().chain([term.id])).collect();
    let set: BTreeSet<&str> = ids.iter().copied().collect();
    assert_eq!(set.len(), ids.len(), "an id stands twice");
    let wanted: BTreeSet<&str> =
        WANTED.split_whitespace().chain(BESIDES.split_whitespace()).collect();
    assert_eq!(set, wanted);
}

/// A file names a term by its id or by another name that it has: each finds that very term, and what is nearly one finds none.
#[test]
fn every_id_finds_its_own_term() {
    for entry in CATALOGUE {
        for id in entry.also.iter().chain([&entry.id]) {
            let found = term(id).unwrap_or_else(|| panic!("{id} is not found"));
            assert!(std::ptr::eq(found, *entry), "{id} finds {}", found.id);
            let is_key = |c: char| c.is_ascii_lowercase() || c.is_ascii_digit() || "._".contains(c);
            assert!(id.chars().all(is_key), "{id:?} is no key of a file");
            for near in
                [&id[..id.len() - 1], &format!("{id}s"), &id.to_uppercase(), &format!(" {id}")]
            {
                assert!(
                    term(near).is_none_or(|other| !std::ptr::eq(other, *entry)),
                    "{near:?} finds {id}"
                );
            }
        }
    }
    assert_eq!(term("readout_lag").unwrap().id, "encoder_latency");
    assert!(term("").is_none());
}

#[test]
fn partners_exist_and_are_others() {
    for entry in CATALOGUE {
        for partner in entry.partners {
            assert!(term(partner).is_some(), "{}: no term {partner}", entry.id);
            assert_ne!(term(partner).unwrap().id, entry.id);
        }
        assert!(!entry.partners.is_empty(), "{} is like nothing else?", entry.id);
    }
}

#[test]
fn parameters_and_settings_are_sound() {
    for term in CATALOGUE {
        let names: BTreeSet<_> = term.parameters.iter().map(|parameter| parameter.name).collect();
        assert_eq!(names.len(), term.parameters.len(), "{}", term.id);
        assert!((1..=MOST_PARAMETERS).contains(&term.parameters.len()), "{}", term.id);
        for parameter in term.parameters {
            let (low, high) = parameter.range(&sheet());
            assert!(0.0 < low && low <= high && high.is_finite(), "{}", term.id);
            assert!(parameter.sigma(&sheet()) > 0.0);
        }
        for setting in term.settings {
            let (low, high) = setting.within;
            assert!(low <= setting.default && setting.default <= high, "{}", term.id);
        }
    }
}

/// The largest usual magnitude in each grade, in SI units.
fn largest(parameter: &Parameter) -> Vec<f64> {
    match parameter.prior {
        Prior::Usual(ranges) => ranges.map(|(_, high)| high * parameter.unit.factor).to_vec(),
        Prior::Anywhere(..) | Prior::Sheet(_) => vec![parameter.range(&sheet()).1],
    }
}

/// The settings with which a term acts within the run of these tests.
fn chosen(term: &'static Term) -> TermInstance {
    TermInstance::new(term).with_setting(SettingKind::Time, 50.0)
}

/// Whether a sensor of navigation grade could ever notice.
fn matters(signals: &Signals) -> bool {
    let largest = |vector: Vector3<f64>| vector.amax();
    largest(values(&signals.gyro)) > 1e-6 * DEG_PER_HOUR
        || largest(values(&signals.accel)) > 1e-3 * MICRO_G
        || largest(values(&signals.tilt)) > 1e-5 * ARCSEC
        || signals.angle.re.abs() > 1e-5 * ARCSEC
}

#[test]
fn every_parameter_of_a_signal_does_something_at_its_usual_magnitude() {
    let track = &run().track;
    let moments: Vec<_> = track.moments().collect();
    for term in CATALOGUE.iter().filter(|term| term.is_signal()) {
        for (place, parameter) in term.parameters.iter().enumerate() {
            for magnitude in largest(parameter) {
                let mut chosen = chosen(term);
                chosen.values[place] = magnitude;
                let model = Model::default().with(chosen);
                let acting = Acting::present(&model, track);
                let signals = |moment: &KinematicState| Acting::together(&acting, moment);
                assert!(
                    moments.iter().any(|moment| matters(&signals(moment))),
                    "{}.{} = {magnitude} does nothing",
                    term.id,
                    parameter.name
                );
                assert!(moments.iter().all(|moment| {
                    let signals = signals(moment);
                    values(&signals.gyro).iter().all(|x| x.is_finite())
                        && values(&signals.accel).iter().all(|x| x.is_finite())
                        && values(&signals.tilt).iter().all(|x| x.is_finite())
                        && signals.angle.re.is_finite()
                }));
            }
        }
    }
}

#[test]
fn parameters_of_zero_do_nothing() {
    let run = run();
    let noises = Noises { imu: quiet(), encoder: 1e-6 };
    for term in CATALOGUE {
        let model = Model::default().with(chosen(term));
        for moment in run.track.moments().step_by(97) {
            assert_eq!(model.signals(&moment), Signals::default(), "{}", term.id);
        }
        assert_eq!(model.stirred(noises.clone()), noises, "{}", term.id);
        let mut recording = run.recording.clone();
        model.distort(Seed::new(1), &mut recording);
        assert_eq!(recording, run.recording, "{}", term.id);
    }
}

#[test]
fn every_noise_and_every_fault_of_a_log_does_something_at_its_usual_magnitude() {
    let run = run();
    let noises = Noises { imu: quiet(), encoder: 1e-6 };
    for term in CATALOGUE {
        let high: Vec<f64> = term.parameters.iter().map(|p| p.range(&sheet()).0).collect();
        let model = Model::default().with(chosen(term).with_values(&high));
        match term.action {
            _ if term.is_signal() => {}
            Action::Noise(_) => assert_ne!(model.stirred(noises.clone()), noises, "{}", term.id),
            Action::Log(_) => {
                let mut recording = run.recording.clone();
                model.distort(Seed::new(1), &mut recording);
                assert_ne!(recording, run.recording, "{}", term.id);
                assert_eq!(recording.times, run.recording.times, "{}", term.id);
            }
            _ => panic!("{} does nothing", term.id),
        }
    }
}

fn quiet() -> rins_imu::ImuNoise {
    rins_imu::ImuNoise { gyro: NoiseModel::white(1e-7), accel: NoiseModel::white(1e-4) }
}
