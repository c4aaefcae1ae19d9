//! A model's parameters by their ids.

use rins_terms::{Model, Role, SettingKind, TermInstance, catalogue};

use crate::support::{run, sheet};

#[test]
fn presets_estimate_what_they_say() {
    let ids = |model: &Model| -> Vec<String> {
        model.free(&sheet()).into_iter().map(|free| free.id).collect()
    };
    assert_eq!(
        ids(&Model::paper12()),
        ["gyro.scale.z", "gyro.misalignment.xz", "gyro.misalignment.yz"]
    );
    assert_eq!(ids(&Model::full()).len(), 27);
}

#[test]
fn items_of_one_term_are_numbered_and_found() {
    let harmonic = |order: f64| {
        TermInstance::new(&catalogue::ENCODER_HARMONIC)
            .with_setting(SettingKind::Order, order)
            .estimated()
    };
    let model = Model::default().with(harmonic(2.0)).with(harmonic(4.0));
    assert_eq!(model.find("encoder_harmonic#2.sin"), Some((1, 1)));
    assert_eq!(model.find("encoder_harmonic.sin"), Some((0, 1)));
    assert_eq!(model.find("encoder_harmonic#3.sin"), None);
    let model = model
        .with_value("encoder_harmonic#2.sin", 1e-6)
        .with_role("encoder_harmonic.cos", Role::Within(2e-6));
    assert_eq!(model.value("encoder_harmonic#2.sin"), Some(1e-6));
    assert_eq!(model.free(&sheet())[0].sigma, 2e-6);
    // Four times a turn, and no more than that.
    let at = |angle: f64| {
        let mut moment = run().track.moments().next().unwrap();
        moment.end.angle = angle;
        model.signals(&moment).angle.re
    };
    let eighth = std::f64::consts::FRAC_PI_8;
    assert!((at(eighth) - 1e-6).abs() < 1e-18 && (at(3.0 * eighth) + 1e-6).abs() < 1e-18);
}
