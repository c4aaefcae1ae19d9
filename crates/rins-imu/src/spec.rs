//! What a data sheet says of an IMU.

/// A data sheet's figures for one triad, 1σ, in SI units.
///
/// For gyros a bias is in rad/s, for accelerometers in m/s²; scale and misalignment errors are ratios.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriadSpec {
    /// The root power spectral density of white noise \[per √Hz\].
    pub noise_density: f64,
    /// How far a bias may be from zero.
    pub bias_sigma: f64,
    /// How far a scale error may be from zero.
    pub scale_sigma: f64,
    /// How far a misalignment may be from zero \[rad\].
    pub misalignment_sigma: f64,
    /// The flicker floor, as the bias instability `B` of IEEE Std 952.
    pub bias_instability: Option<f64>,
    /// The rate random walk density `K` \[per √s\].
    pub random_walk: Option<f64>,
    /// The largest rate that can be read.
    pub range: Option<f64>,
    /// The least significant bit of a reading.
    pub resolution: Option<f64>,
}

impl TriadSpec {
    /// The figures of a sheet that tells of white noise and of constant errors only.
    pub const fn white(
        noise_density: f64,
        bias_sigma: f64,
        scale_sigma: f64,
        misalignment_sigma: f64,
    ) -> Self {
        Self {
            noise_density,
            bias_sigma,
            scale_sigma,
            misalignment_sigma,
            bias_instability: None,
            random_walk: None,
            range: None,
            resolution: None,
        }
    }
}

/// A data sheet's figures for an IMU.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImuSpec {
    /// The gyros' figures.
    pub gyro: TriadSpec,
    /// The accelerometers' figures.
    pub accel: TriadSpec,
}
