//! Sections of rig and scenario files that tests write, as literals for `concat!`.

/// Xi'an, 400 m above the ellipsoid.
///
/// ```
/// assert!(rins_testing::site!().starts_with("[site]\n"));
/// ```
#[macro_export]
macro_rules! site {
    () => {
        r#"[site]
latitude = "34.25 deg"
longitude = "108.9 deg"
height = "400 m"
"#
    };
}

/// The data sheets of a navigation-grade fibre-optic unit.
///
/// ```
/// assert!(rins_testing::data_sheets!().contains("\n[imu.accel]\n"));
/// ```
#[macro_export]
macro_rules! data_sheets {
    () => {
        r#"[imu.gyro]
noise = "0.02 deg/h/sqrt(Hz)"
bias_sigma = "0.1 deg/h"
scale_sigma = "500 ppm"
misalignment_sigma = "120 arcsec"

[imu.accel]
noise = "30 ug/sqrt(Hz)"
bias_sigma = "200 ug"
scale_sigma = "300 ppm"
misalignment_sigma = "60 arcsec"
"#
    };
}
