//! Gyros that show nothing of a slow rate.

use rins_estimation::NoiseKnowledge;
use rins_frames::units::DEG_PER_HOUR;
use rins_terms::{Model, SettingKind, TermInstance, catalogue};

use crate::hidden::{RATES, found};
use crate::support::{SEED, run};

fn zones(widths: [f64; 3], axes: f64) -> Model {
    let zone =
        TermInstance::new(&catalogue::GYRO_DEAD_ZONE).with_setting(SettingKind::RateAxes, axes);
    Model { terms: vec![zone.with_values(&widths.map(|width| width * DEG_PER_HOUR))] }
}

/// Each gyro's own width, from where it is hardly seen to where a third of what a gyro sees of the Earth's rate is lost;
/// and no width of a gyro that has none. Gyro x is 40 arcsec off the body's axis, and sees 7 deg/h of a table at 10 deg/s.
#[test]
fn dead_zones_are_found_with_their_widths_about_whichever_axes() {
    let cases = [
        (0.0, [0.3, 0.0, 0.0]),
        (0.0, [0.0, 1.0, 0.0]),
        (0.0, [2.5, 0.4, 0.0]),
        (1.0, [0.6, 0.0, 0.0]),
    ];
    for (axes, widths) in cases {
        let run = run(&RATES, zones(widths, axes), 0.0, SEED);
        let diagnosis = found(&run, NoiseKnowledge::Likely);
        let [cause] = &diagnosis.causes[..] else { panic!("{widths:?}: {:?}", diagnosis.causes) };
        assert_eq!(cause.term.id, "gyro_dead_zone", "{widths:?}");
        assert_eq!(cause.settings, [axes], "{widths:?}");
        assert!(cause.ln_p < -20.0, "{widths:?}: {}", cause.ln_p);
        let there = widths.iter().filter(|width| **width > 0.0).count();
        assert_eq!(cause.parameters.len(), there, "{widths:?}: {:?}", cause.parameters);
        for estimate in &cause.parameters {
            let width = widths[estimate.parameter.parameter] * DEG_PER_HOUR;
            let off = (estimate.value - width) / estimate.sigma;
            assert!(off.abs() < 4.0, "{widths:?}, {}: {off} sigma off", estimate.parameter.id);
            assert!(estimate.sigma < 0.1 * width, "{widths:?}: {}", estimate.sigma / width);
        }
        assert!(diagnosis.unexplained.is_empty(), "{widths:?}: {:?}", diagnosis.unexplained);
    }
}

/// What comes once a turn is not a dead zone of whatever depth fits.
#[test]
fn a_field_that_gyros_feel_is_no_dead_zone() {
    let mut values = [0.0; 9];
    values[0] = 0.1 * rins_terms::Unit::DEG_PER_HOUR_PER_GAUSS.factor;
    let field = TermInstance::new(&catalogue::GYRO_MAGNETIC).with_values(&values);
    let run = run(&RATES, Model { terms: vec![field] }, 0.0, SEED);
    let diagnosis = found(&run, NoiseKnowledge::Likely);
    assert!(!diagnosis.causes.is_empty());
    for cause in &diagnosis.causes {
        let is_zone = |id: &str| id == "gyro_dead_zone";
        assert!(!is_zone(cause.term.id), "{cause:?}");
        assert!(!cause.rivals.iter().any(|rival| is_zone(rival.term.id)), "{cause:?}");
    }
}
