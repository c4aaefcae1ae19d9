//! The units in which parameters are shown and written in files.

use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, MICRO_G, PPM, STANDARD_GRAVITY};

/// A unit of a parameter: how it is written, and one of it in SI units and radians.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unit {
    /// As files and screens show it, such as `deg/h/g`.
    pub symbol: &'static str,
    /// One of it in SI units and radians.
    pub factor: f64,
}

impl Unit {
    /// A plain number.
    pub const ONE: Self = Self::new("1", 1.0);
    /// Parts in a million.
    pub const PPM: Self = Self::new("ppm", PPM);
    /// Seconds of arc \[rad\].
    pub const ARCSEC: Self = Self::new("arcsec", ARCSEC);
    /// Degrees an hour \[rad/s\].
    pub const DEG_PER_HOUR: Self = Self::new("deg/h", DEG_PER_HOUR);
    /// Degrees an hour per hour \[rad/s²\].
    pub(crate) const DEG_PER_HOUR_PER_HOUR: Self = Self::new("deg/h/h", DEG_PER_HOUR / 3600.0);
    /// Degrees an hour per kelvin \[rad/s/K\].
    pub(crate) const DEG_PER_HOUR_PER_KELVIN: Self = Self::new("deg/h/K", DEG_PER_HOUR);
    /// Degrees an hour per kelvin squared \[rad/s/K²\].
    pub(crate) const DEG_PER_HOUR_PER_KELVIN_2: Self = Self::new("deg/h/K^2", DEG_PER_HOUR);
    /// Degrees an hour per kelvin cubed \[rad/s/K³\].
    pub(crate) const DEG_PER_HOUR_PER_KELVIN_3: Self = Self::new("deg/h/K^3", DEG_PER_HOUR);
    /// Degrees an hour per kelvin a minute \[rad/K\].
    pub(crate) const DEG_PER_HOUR_PER_KELVIN_PER_MINUTE: Self =
        Self::new("deg/h/(K/min)", DEG_PER_HOUR * 60.0);
    /// Degrees an hour per g \[rad s/m\].
    pub(crate) const DEG_PER_HOUR_PER_G: Self =
        Self::new("deg/h/g", DEG_PER_HOUR / STANDARD_GRAVITY);
    /// Degrees an hour per g².
    pub(crate) const DEG_PER_HOUR_PER_G2: Self =
        Self::new("deg/h/g^2", DEG_PER_HOUR / (STANDARD_GRAVITY * STANDARD_GRAVITY));
    /// Degrees an hour per gauss \[rad/s/T\].
    pub const DEG_PER_HOUR_PER_GAUSS: Self = Self::new("deg/h/G", DEG_PER_HOUR * 1e4);
    /// Millionths of standard gravity \[m/s²\].
    pub const MICRO_G: Self = Self::new("ug", MICRO_G);
    /// Millionths of standard gravity an hour \[m/s³\].
    pub(crate) const MICRO_G_PER_HOUR: Self = Self::new("ug/h", MICRO_G / 3600.0);
    /// Millionths of standard gravity per kelvin \[m/s²/K\].
    pub(crate) const MICRO_G_PER_KELVIN: Self = Self::new("ug/K", MICRO_G);
    /// Millionths of standard gravity per kelvin squared \[m/s²/K²\].
    pub(crate) const MICRO_G_PER_KELVIN_2: Self = Self::new("ug/K^2", MICRO_G);
    /// Millionths of standard gravity per kelvin cubed \[m/s²/K³\].
    pub(crate) const MICRO_G_PER_KELVIN_3: Self = Self::new("ug/K^3", MICRO_G);
    /// Millionths of standard gravity per g² \[s²/m\].
    pub(crate) const MICRO_G_PER_G2: Self =
        Self::new("ug/g^2", MICRO_G / (STANDARD_GRAVITY * STANDARD_GRAVITY));
    /// Millionths of standard gravity per g³ \[s⁴/m²\].
    pub(crate) const MICRO_G_PER_G3: Self =
        Self::new("ug/g^3", MICRO_G / (STANDARD_GRAVITY * STANDARD_GRAVITY * STANDARD_GRAVITY));
    /// Parts in a million per kelvin \[1/K\].
    pub(crate) const PPM_PER_KELVIN: Self = Self::new("ppm/K", PPM);
    /// Parts in a million an hour \[1/s\].
    pub(crate) const PPM_PER_HOUR: Self = Self::new("ppm/h", PPM / 3600.0);
    /// Millimetres \[m\].
    pub(crate) const MILLIMETRE: Self = Self::new("mm", 1e-3);
    /// Milliseconds \[s\].
    pub const MILLISECOND: Self = Self::new("ms", 1e-3);
    /// Microseconds \[s\].
    pub(crate) const MICROSECOND: Self = Self::new("us", 1e-6);
    /// Seconds of arc an hour \[rad/s\].
    pub(crate) const ARCSEC_PER_HOUR: Self = Self::new("arcsec/h", ARCSEC / 3600.0);
    /// Seconds of arc a turn: a ratio of angles.
    pub(crate) const ARCSEC_PER_TURN: Self =
        Self::new("arcsec/turn", ARCSEC / (2.0 * std::f64::consts::PI));
    /// Minutes of arc \[rad\].
    pub const ARCMIN: Self = Self::new("arcmin", 60.0 * ARCSEC);

    /// Degrees Celsius.
    pub const CELSIUS: Self = Self::new("degC", 1.0);
    /// Degrees an hour per root hertz, as a noise density \[rad/s/√Hz\].
    pub const DEG_PER_HOUR_PER_ROOT_HERTZ: Self = Self::new("deg/h/sqrt(Hz)", DEG_PER_HOUR);
    /// Millionths of standard gravity per root hertz, as a noise density \[m/s²/√Hz\].
    pub const MICRO_G_PER_ROOT_HERTZ: Self = Self::new("ug/sqrt(Hz)", MICRO_G);
    /// Seconds.
    pub const SECOND: Self = Self::new("s", 1.0);
    /// Hertz.
    pub const HERTZ: Self = Self::new("Hz", 1.0);
    /// Degrees a second \[rad/s\].
    pub const DEG_PER_SECOND: Self = Self::new("deg/s", DEG);
    /// Standard gravity \[m/s²\].
    pub const G: Self = Self::new("g", STANDARD_GRAVITY);
    /// Degrees an hour per root hour, as a random walk of a rate \[rad/s/√s\].
    pub const DEG_PER_HOUR_PER_ROOT_HOUR: Self = Self::new("deg/h/sqrt(h)", DEG_PER_HOUR / 60.0);
    /// Millionths of standard gravity per root hour, as a random walk \[m/s²/√s\].
    pub const MICRO_G_PER_ROOT_HOUR: Self = Self::new("ug/sqrt(h)", MICRO_G / 60.0);
    /// Degrees an hour per degree a second: a ratio of rates.
    pub(crate) const DEG_PER_HOUR_PER_DEG_PER_SECOND: Self =
        Self::new("deg/h/(deg/s)", 1.0 / 3600.0);
    /// Degrees an hour per (degree a second)² \[s/rad\].
    pub(crate) const DEG_PER_HOUR_PER_DEG_PER_SECOND_2: Self =
        Self::new("deg/h/(deg/s)^2", 1.0 / (3600.0 * DEG));
    /// Parts in a million per degree a second \[s/rad\].
    pub(crate) const PPM_PER_DEG_PER_SECOND: Self = Self::new("ppm/(deg/s)", PPM / DEG);
    /// Parts in a million per (degree a second)² \[s²/rad²\].
    pub(crate) const PPM_PER_DEG_PER_SECOND_2: Self = Self::new("ppm/(deg/s)^2", PPM / (DEG * DEG));
    /// Micrometres a second \[m/s\].
    pub const MICROMETRE_PER_SECOND: Self = Self::new("um/s", 1e-6);

    /// A unit of this name and size.
    pub const fn new(symbol: &'static str, factor: f64) -> Self {
        Self { symbol, factor }
    }
}
