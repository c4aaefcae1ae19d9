//! The Earth model against published figures, the exact normal potential, and numerical differentiation.

use std::f64::consts::{FRAC_PI_2, FRAC_PI_4};

use nalgebra::{Matrix3, Vector3};
use proptest::prelude::*;
use rins_frames::{EARTH_RATE, InFrame, Nav, Site};
use rins_testing::{any_latitude, assert_close};

/// The defining and derived constants of WGS84, as printed in NIMA TR8350.2, tables 3.1-3.4.
const A: f64 = 6378137.0;
const B: f64 = 6356752.3142;
const GM: f64 = 3.986004418e14;
/// The constants of GRS80 that differ (Moritz 1980).
const GRS80_GM: f64 = 3.986005e14;
const LINEAR_ECCENTRICITY: f64 = 5.2185400842339e5;

fn site(latitude: f64, height: f64) -> Site {
    Site { latitude, longitude: 0.3, height }
}

/// Earth-centered coordinates from geodetic ones, by the parametric latitude.
fn position(latitude: f64, longitude: f64, height: f64) -> Vector3<f64> {
    let parametric = (B / A * latitude.tan()).atan();
    let (sin, cos) = latitude.sin_cos();
    let radius = A * parametric.cos() + height * cos;
    Vector3::new(
        radius * longitude.cos(),
        radius * longitude.sin(),
        B * parametric.sin() + height * sin,
    )
}

/// East, north and up as rows, by numerical differentiation of positions.
fn nav_from_earth(latitude: f64, longitude: f64) -> Matrix3<f64> {
    const STEP: f64 = 1e-4;
    let along = |d_latitude: f64, d_longitude: f64| {
        let ahead = position(latitude + d_latitude, longitude + d_longitude, 0.0);
        (ahead - position(latitude - d_latitude, longitude - d_longitude, 0.0)).normalize()
    };
    let (east, north) = (along(0.0, STEP), along(STEP, 0.0));
    Matrix3::from_rows(&[east.transpose(), north.transpose(), east.cross(&north).transpose()])
}

/// The normal gravity potential in ellipsoidal-harmonic coordinates (Heiskanen and Moritz 1967,
/// eq. 2-62), exact outside the ellipsoid.
fn normal_potential(latitude: f64, height: f64) -> f64 {
    let e = LINEAR_ECCENTRICITY;
    let r = position(latitude, 0.0, height);
    let (equatorial, polar) = (r.x * r.x, r.z * r.z);
    let excess = equatorial + polar - e * e;
    let u2 = excess.midpoint((excess * excess + 4.0 * e * e * polar).sqrt());
    let u = u2.sqrt();
    let sin2 = polar / u2;
    // The closed form of q cancels seven digits; this is its series in e/u.
    let q = |u: f64| -> f64 {
        (1..12)
            .map(|k| {
                let k = f64::from(k);
                let sign = if k % 2.0 == 0.0 { -1.0 } else { 1.0 };
                sign * 2.0 * k / ((2.0 * k + 1.0) * (2.0 * k + 3.0)) * (e / u).powf(2.0 * k + 1.0)
            })
            .sum()
    };
    let rate2 = EARTH_RATE * EARTH_RATE;
    GM / e * (e / u).atan()
        + rate2 * A * A / 2.0 * q(u) / q(B) * (sin2 - 1.0 / 3.0)
        + rate2 / 2.0 * (u2 + e * e) * (1.0 - sin2)
}

#[test]
fn normal_gravity_has_the_published_values() {
    // NIMA TR8350.2, table 3.4, to its last digit.
    assert_close!(site(0.0, 0.0).normal_gravity(), 9.7803253359, 1e-10);
    assert_close!(site(FRAC_PI_2, 0.0).normal_gravity(), 9.8321849378, 1e-10);
    assert_close!(site(-FRAC_PI_2, 0.0).normal_gravity(), 9.8321849378, 1e-10);
    // GRS80 (Moritz 1980) has the same ellipsoid to 0.1 mm and the same rotation, so that its
    // gravity is proportional to its GM, except for the centrifugal part of that 1e-7.
    assert_close!(site(FRAC_PI_4, 0.0).normal_gravity(), 9.806199203 * GM / GRS80_GM, 1e-8);
}

#[test]
fn gravity_falls_by_three_microgals_a_centimetre() {
    let gradient = |latitude: f64| {
        (site(latitude, 100.0).normal_gravity() - site(latitude, -100.0).normal_gravity()) / 200.0
    };
    // The conventional free-air gradient is 0.3086 mGal/m; it varies by 0.1 % with latitude.
    assert_close!(gradient(FRAC_PI_4), -3.086e-6, 1e-9);
}

#[test]
fn radii_at_equator_and_pole_are_those_of_the_ellipse() {
    assert_close!(site(0.0, 0.0).transverse_radius(), A, 1e-9);
    assert_close!(site(0.0, 0.0).meridian_radius(), B * B / A, 1e-3);
    assert_close!(site(FRAC_PI_2, 0.0).transverse_radius(), A * A / B, 1e-3);
    assert_close!(site(FRAC_PI_2, 0.0).meridian_radius(), A * A / B, 1e-3);
}

#[test]
fn earth_turns_once_in_a_sidereal_day() {
    assert_close!(2.0 * std::f64::consts::PI / EARTH_RATE, 86164.1, 0.1);
}

#[test]
fn earth_rate_points_north_on_the_equator_and_up_at_the_pole() {
    assert_eq!(site(0.0, 0.0).earth_rate(), InFrame::<Nav>::new(0.0, EARTH_RATE, 0.0));
    let pole = site(FRAC_PI_2, 0.0).earth_rate();
    assert_close!(pole.components().z, EARTH_RATE, 1e-20);
    assert_close!(pole.components().y, 0.0, 1e-20);
}

proptest! {
    #[test]
    fn normal_gravity_is_the_slope_of_the_potential(
        latitude in any_latitude(),
        height in -500.0..10_000.0_f64,
    ) {
        const STEP: f64 = 100.0;
        let slope = (normal_potential(latitude, height + STEP)
            - normal_potential(latitude, height - STEP)) / (2.0 * STEP);
        // The published formula omits squares of the flattening in the terms of height.
        let within = 1e-8 + 1e-10 * height.abs();
        assert_close!(site(latitude, height).normal_gravity(), -slope, within);
    }

    #[test]
    fn radii_are_the_slopes_of_the_position(latitude in any_latitude()) {
        const STEP: f64 = 1e-4;
        let northwards = position(latitude + STEP, 0.3, 0.0) - position(latitude - STEP, 0.3, 0.0);
        let eastwards = position(latitude, 0.3 + STEP, 0.0) - position(latitude, 0.3 - STEP, 0.0);
        let place = site(latitude, 0.0);
        // Chords are shorter than arcs by STEP²/6 of the radius, 1 cm.
        assert_close!(place.meridian_radius(), northwards.norm() / (2.0 * STEP), 0.02);
        let parallel = place.transverse_radius() * latitude.cos();
        assert_close!(parallel, eastwards.norm() / (2.0 * STEP), 0.02);
    }

    #[test]
    fn earth_rate_is_the_polar_axis(latitude in any_latitude()) {
        let expected = nav_from_earth(latitude, 0.3) * Vector3::z() * EARTH_RATE;
        let rate = site(latitude, 500.0).earth_rate();
        prop_assert!((rate.components() - expected).norm() < 1e-7 * EARTH_RATE);
    }

    #[test]
    fn transport_rate_is_how_fast_east_north_and_up_turn(
        latitude in -1.4..1.4_f64,
        east in -300.0..300.0_f64,
        north in -300.0..300.0_f64,
        height in 0.0..10_000.0_f64,
    ) {
        const STEP: f64 = 1e-4;
        const SECONDS: f64 = 10.0;
        // The displacement in one second of flight, by numerical differentiation of positions.
        let per_radian = |d_latitude: f64, d_longitude: f64| {
            (position(latitude + d_latitude, 0.3 + d_longitude, height)
                - position(latitude - d_latitude, 0.3 - d_longitude, height)).norm() / (2.0 * STEP)
        };
        let latitude_rate = north / per_radian(STEP, 0.0);
        let longitude_rate = east / per_radian(0.0, STEP);

        let at = |time: f64| {
            nav_from_earth(latitude + latitude_rate * time, 0.3 + longitude_rate * time)
        };
        let turned = (at(SECONDS) - at(-SECONDS)) / (2.0 * SECONDS) * at(0.0).transpose();
        // d/dt C_e^n = −[ω_en^n ×] C_e^n.
        let expected = -Vector3::new(turned[(2, 1)], turned[(0, 2)], turned[(1, 0)]);

        let rate = site(latitude, height).transport_rate(&InFrame::new(east, north, 0.0));
        // Differences over 10 s of flight neglect the second order of 3e-3 rad, near 80° a few times that.
        let within = 1e-3 * expected.norm() + 1e-10;
        prop_assert!((rate.components() - expected).norm() < within, "{rate:?} {expected}");
    }
}
