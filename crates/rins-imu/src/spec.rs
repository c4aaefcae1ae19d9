//! The data sheet of an IMU.

/// The data-sheet values of one triad, 1σ, in SI units.
///
/// For gyros a bias is in rad/s, for accelerometers in m/s²; scale and misalignment errors are ratios.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct TriadSpec {
    /// The noise density: root power spectral density of white noise \[per √Hz\].
    pub noise_density: f64,
    /// The standard deviation of the bias.
    pub bias_sigma: f64,
    /// The standard deviation of the scale error.
    pub scale_sigma: f64,
    /// The standard deviation of the misalignment \[rad\].
    pub misalignment_sigma: f64,
    /// The bias instability `B` of IEEE Std 952, the flicker floor.
    pub bias_instability: Option<f64>,
    /// The rate random walk `K` \[per √s\].
    pub random_walk: Option<f64>,
    /// The measurement range: the largest rate.
    pub range: Option<f64>,
    /// The least significant bit of a reading.
    pub resolution: Option<f64>,
}

impl TriadSpec {
    /// A data sheet with white noise and constant errors only.
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

/// The data sheet of an IMU.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct ImuSpec {
    /// The values of the gyros.
    pub gyro: TriadSpec,
    /// The values of the accelerometers.
    pub accel: TriadSpec,
}
