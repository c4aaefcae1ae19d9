//! Tests of the unit algebra.

use proptest::prelude::*;

use super::{Dimension, Quantity, Unit, kinds};
use rins_testing::assert_close;

const NAMES: [&str; 12] =
    ["rad", "deg", "arcsec", "s", "ms", "h", "Hz", "m", "km", "g", "ppm", "K"];

fn any_unit() -> impl Strategy<Value = &'static str> {
    prop::sample::select(&NAMES[..])
}

fn value(text: &str) -> f64 {
    Quantity::parse(text).unwrap().value
}

proptest! {
    #[test]
    fn products_commute(a in any_unit(), b in any_unit()) {
        let ab = Unit::parse(&format!("{a}*{b}")).unwrap();
        let ba = Unit::parse(&format!("{b} * {a}")).unwrap();
        prop_assert_eq!(ab, ba);
    }

    #[test]
    fn quotients_undo_products(a in any_unit(), b in any_unit()) {
        let plain = Unit::parse(a).unwrap();
        let back = Unit::parse(&format!("{a}*{b}/{b}")).unwrap();
        prop_assert_eq!(back.dimension, plain.dimension);
        prop_assert!((back.factor / plain.factor - 1.0).abs() < 1e-15);
    }

    #[test]
    fn division_is_read_from_left_to_right(a in any_unit(), b in any_unit(), c in any_unit()) {
        let chain = Unit::parse(&format!("{a}/{b}/{c}")).unwrap();
        let nested = Unit::parse(&format!("{a}/({b}*{c})")).unwrap();
        prop_assert_eq!(chain.dimension, nested.dimension);
        prop_assert!((chain.factor / nested.factor - 1.0).abs() < 1e-15);
    }

    #[test]
    fn a_root_squared_is_the_unit(a in any_unit()) {
        let plain = Unit::parse(a).unwrap();
        for text in [format!("sqrt({a})^2"), format!("sqrt({a}^2)"), format!("({a}^0.5)^2")] {
            let squared = Unit::parse(&text).unwrap();
            prop_assert_eq!(squared.dimension, plain.dimension);
            prop_assert!((squared.factor / plain.factor - 1.0).abs() < 1e-15);
        }
    }

    #[test]
    fn powers_add(a in any_unit(), m in -3..4_i32, n in -3..4_i32) {
        let split = Unit::parse(&format!("{a}^{m}*{a}^{n}")).unwrap();
        let whole = Unit::parse(&format!("{a}^{}", m + n)).unwrap();
        prop_assert_eq!(split.dimension, whole.dimension);
        prop_assert!((split.factor / whole.factor - 1.0).abs() < 1e-14);
    }

    #[test]
    fn half_powers_add(a in any_unit(), m in -5..6_i32, n in -5..6_i32) {
        // The square makes every half-integer exponent an integer.
        let half = |halves: i32| format!("({a}^2)^{}", f64::from(halves) / 2.0);
        let split = Unit::parse(&format!("{}*{}", half(m), half(n))).unwrap();
        let whole = Unit::parse(&half(m + n)).unwrap();
        prop_assert_eq!(split.dimension, whole.dimension);
        prop_assert!((split.factor / whole.factor - 1.0).abs() < 1e-14);
    }

    #[test]
    fn a_negative_power_divides(a in any_unit(), halves in 1..6_i32) {
        let exponent = f64::from(halves) / 2.0;
        let power = Unit::parse(&format!("({a}^2)^-{exponent}")).unwrap();
        let quotient = Unit::parse(&format!("1/({a}^2)^{exponent}")).unwrap();
        prop_assert_eq!(power.dimension, quotient.dimension);
        prop_assert!((power.factor / quotient.factor - 1.0).abs() < 1e-14);
    }

    #[test]
    fn any_text_is_read_or_refused(text in ".{0,130}") {
        let _ = Quantity::parse(&text);
        let _ = Unit::parse(&text);
    }

    #[test]
    fn any_text_of_a_quantitys_letters_is_read_or_refused(text in "[0-9e+.*/()^√a-z -]{0,40}") {
        if let Ok(quantity) = Quantity::parse(&text) {
            prop_assert!(quantity.value.is_finite());
        }
    }
}

#[test]
fn published_conversions_hold() {
    // Definitions in the SI Brochure, table 8, and units of data sheets.
    assert_close!(value("180 deg"), core::f64::consts::PI, 1e-15);
    assert_close!(value("3600 arcsec"), value("1 deg"), 1e-17);
    assert_close!(value("60 arcmin"), value("1 deg"), 1e-17);
    assert_close!(value("1 rev"), value("360 deg"), 1e-15);
    assert_close!(value("1 g"), 9.80665, 1e-15);
    assert_close!(value("1000 ug"), value("1 mg"), 1e-17);
    assert_close!(value("15.041067 deg/h"), 7.292115e-5, 1e-12);
    assert_close!(value("1 deg/sqrt(h)"), value("60 deg/h/sqrt(Hz)"), 1e-17);
    assert_close!(value("1 m/s/sqrt(h)"), value("0.0166666666666666666 m/s^2/sqrt(Hz)"), 1e-16);
    assert_close!(value("1e-3 %"), value("10 ppm"), 1e-19);
    assert_close!(value("36 km/h"), 10.0, 1e-14);
    assert_close!(value("1 day"), 86400.0, 1e-9);
    assert_close!(value("2.5 kHz"), 2500.0, 1e-12);
    assert_close!(value("1 °/h"), value("1 deg/h"), 1e-20);
    assert_close!(value("1 µg/√Hz"), value("1 ug/sqrt(Hz)"), 1e-20);
    assert_close!(value("5 m/s²"), 5.0, 1e-15);
    assert_close!(value("-7e-1deg"), -value("0.7 deg"), 1e-17);
}

/// The value of each unit in SI units and radians: prefixes and units of the SI Brochure, table 8 and section 3.
#[test]
fn units_have_the_size_of_their_definition() {
    const RIGHT_ANGLE: f64 = core::f64::consts::FRAC_PI_2;
    let sizes = [
        ("1 mrad", 1e-3),
        ("1 urad", 1e-6),
        ("90 deg", RIGHT_ANGLE),
        ("5400 arcmin", RIGHT_ANGLE),
        ("324000 arcsec", RIGHT_ANGLE),
        ("100 gon", RIGHT_ANGLE),
        ("0.25 rev", RIGHT_ANGLE),
        ("0.25 turn", RIGHT_ANGLE),
        ("1 ms", 1e-3),
        ("1 us", 1e-6),
        ("1 ns", 1e-9),
        ("1 min", 60.0),
        ("1 h", 3600.0),
        ("1 day", 86_400.0),
        ("1 kHz", 1e3),
        ("1 mm", 1e-3),
        ("1 um", 1e-6),
        ("1 km", 1e3),
        ("1 mg", 9.80665e-3),
        ("1 ug", 9.80665e-6),
        ("1 ppm", 1e-6),
        ("1 %", 1e-2),
        ("1 K", 1.0),
        ("1 G", 1e-4),
    ];
    for (text, size) in sizes {
        assert!((value(text) / size - 1.0).abs() < 1e-15, "{text}: {} for {size}", value(text));
    }
}

/// A noise density can be written with the root in the denominator or as a power.
#[test]
fn a_density_is_the_same_with_a_root_and_with_a_power() {
    for (root, power) in [
        ("60 deg/h/sqrt(Hz)", "60 deg/h*Hz^-0.5"),
        ("1 ug/sqrt(kHz)", "1 ug*kHz^-0.5"),
        ("1 m/s/h/sqrt(h)", "1 m/s*h^-1.5"),
    ] {
        let [root, power] = [root, power].map(|text| Quantity::parse(text).unwrap());
        assert_eq!(root.dimension, power.dimension);
        assert!((root.value / power.value - 1.0).abs() < 1e-15, "{root:?} {power:?}");
    }
}

/// Each factor is a finite number and each exponent within its limit, but not their product.
#[test]
fn a_unit_too_large_or_too_small_for_a_number_is_refused() {
    let large = "ns^-20/us^20/um^20";
    let small = "ns^20*um^20*urad^20";
    for text in [large, small] {
        let found = Unit::parse(text);
        assert!(found.is_err(), "{text}: {found:?}");
    }
    assert!(Unit::parse("ns^20*um^15").is_ok());
}

#[test]
fn the_longest_text_is_read_and_the_next_is_not() {
    let long = |length: usize| format!("1{:1$}", "deg", length - 1).replacen("deg ", " deg", 1);
    for (length, is_read) in [(119, true), (120, true), (121, false), (400, false)] {
        let text = long(length);
        assert_eq!(text.len(), length);
        assert_eq!(Quantity::parse(&text).is_ok(), is_read, "{length} bytes");
    }
}

#[test]
fn dimensions_that_look_alike_are_told_apart() {
    let dimension = |text| Quantity::parse(text).unwrap().dimension;
    assert_ne!(dimension("1 rad/s"), dimension("1 Hz"));
    assert_ne!(dimension("1 rad"), dimension("1 ppm"));
    assert_ne!(dimension("1 deg/h"), dimension("1 deg/sqrt(h)"));
    assert_eq!(dimension("1 rad/s/s"), Dimension::ANGULAR_ACCELERATION);
    assert_eq!(dimension("1 deg/h/degC"), dimension("1 rad/s/K"));
}

#[test]
fn refusals_say_what_is_wrong() {
    let cases = [
        ("", r#""" does not begin with a number"#),
        ("deg", r#""deg" does not begin with a number"#),
        ("-", r#""-" does not begin with a number"#),
        ("5", r#""5" has no unit"#),
        ("1e", r#""1e": unknown unit "e""#),
        ("1e400 deg", r#""1e400 deg" is not finite"#),
        ("inf deg", r#""inf deg" is not finite"#),
        ("nan deg", r#""nan deg" is not finite"#),
        ("1e308 km", r#""1e308 km" is not finite"#),
        ("5 deg/hr", r#""5 deg/hr": unknown unit "hr"; did you mean "h"?"#),
        ("5 dps", r#""5 dps": unknown unit "dps"; did you mean "deg/s"?"#),
        ("5 HZ", r#""5 HZ": unknown unit "HZ"; did you mean "Hz"?"#),
        ("5 arcsecs", r#""5 arcsecs": unknown unit "arcsecs"; did you mean "arcsec"?"#),
        ("5 furlong", r#""5 furlong": unknown unit "furlong""#),
        ("5 deg/", r#""5 deg/" is not a product of units such as "deg/h/sqrt(Hz)""#),
        ("5 deg h", r#""5 deg h" is not a product of units such as "deg/h/sqrt(Hz)""#),
        ("5 sqrt(Hz", r#""5 sqrt(Hz" is not a product of units such as "deg/h/sqrt(Hz)""#),
        ("5 Hz)", r#""5 Hz)" is not a product of units such as "deg/h/sqrt(Hz)""#),
        ("5 m^0.25", r#""5 m^0.25" is not a product of units such as "deg/h/sqrt(Hz)""#),
        (
            "5 sqrt(sqrt(m))",
            r#""5 sqrt(sqrt(m))" is not a product of units such as "deg/h/sqrt(Hz)""#,
        ),
        (
            "5 m^99999999999",
            r#""5 m^99999999999" is not a product of units such as "deg/h/sqrt(Hz)""#,
        ),
        ("5 m^", r#""5 m^" is not a product of units such as "deg/h/sqrt(Hz)""#),
        ("1,5 deg", r#""1,5 deg" is not a product of units such as "deg/h/sqrt(Hz)""#),
    ];
    for (text, message) in cases {
        assert_eq!(Quantity::parse(text).unwrap_err().to_string(), message);
    }
}

#[test]
fn dimensions_without_a_name_are_shown_in_si_units() {
    let shown = |text| Quantity::parse(text).unwrap().dimension.to_string();
    assert_eq!(shown("1 deg/h/g"), "a quantity in rad s m^-1");
    assert_eq!(shown("1 sqrt(Hz)"), "a quantity in s^(-1/2)");
}

#[test]
fn figures_whose_squares_are_no_numbers_are_refused() {
    let said = |kind: &kinds::Kind, text: &str| kind.parse(text).unwrap_err().to_string();
    assert_eq!(
        said(&kinds::GYRO_BIAS, "-1e20 deg/h"),
        "\"-1e20 deg/h\" is out of range, expected no more than 1e12 in SI units"
    );
    assert_eq!(
        said(&kinds::GYRO_BIAS_SIGMA, "1e-40 rad/s"),
        "\"1e-40 rad/s\" is out of range, expected 1e-30 or more in SI units"
    );
    assert_eq!(kinds::GYRO_BIAS.parse("1e-40 rad/s"), Ok(1e-40));
}
