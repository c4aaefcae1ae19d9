//! The options of the search for static intervals.

use rins_frames::units::{DEG, DEG_PER_SECOND};

/// The data sheet of a triad of sensors; values that it does not state are estimated from the log.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct SensorFigures {
    /// The 1σ of a bias \[rad/s\] or \[m/s²\].
    pub bias_sigma: Option<f64>,
    /// The square root of the power spectral density of white noise \[rad/s/√Hz\] or \[m/s²/√Hz\].
    pub noise_density: Option<f64>,
    /// The LSB \[rad/s\] or \[m/s²\].
    pub resolution: Option<f64>,
}

/// The options of the search for static intervals.
///
/// ```
/// use rins_inspection::{SensorFigures, StaticOptions};
/// let gyro = SensorFigures { bias_sigma: Some(0.09), ..SensorFigures::default() };
/// let options = StaticOptions { gyro, ..StaticOptions::default() };
/// assert_eq!(options.largest_bias(), 0.36);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct StaticOptions {
    /// The gyros' data sheet.
    pub gyro: SensorFigures,
    /// The accelerometers' data sheet.
    pub accel: SensorFigures,
    /// The shortest static interval \[s\]. The default is 1 s: the noise of shorter ones cannot be estimated at 10 Hz.
    pub shortest: f64,
    /// The static intervals that the user states, as start and end times \[s\]. They replace the search.
    pub stated: Vec<[f64; 2]>,
    /// The largest tilt of the base of a static IMU, as sway or in steps \[rad\]. The default is 0.5 deg: a wooden floor
    /// tilts so under a person, and a parked vehicle in wind.
    pub largest_sway: f64,
    /// The longest disturbance within an interval, if the attitude is the same after it \[s\]. The default is 30 s: somebody
    /// walks by, and back.
    pub longest_disturbance: f64,
    /// The largest bias of a gyro whose data sheet states no `bias_sigma` \[rad/s\]. The default is 1 deg/s, the zero-rate
    /// output of consumer MEMS gyros after one calibration at the factory.
    pub assumed_bias: f64,
    /// The largest sensitivity of a gyro bias to specific force \[(rad/s)/(m/s²)\]. The default is 0.2 deg/s/g, twice the 0.1
    /// deg/s/g of the data sheets of consumer MEMS gyros. The data sheet's `bias_sigma` per g limits it further.
    pub g_sensitivity: f64,
}

impl Default for StaticOptions {
    fn default() -> Self {
        Self {
            gyro: SensorFigures::default(),
            accel: SensorFigures::default(),
            shortest: 1.0,
            stated: Vec::new(),
            largest_sway: 0.5 * DEG,
            longest_disturbance: 30.0,
            assumed_bias: 1.0 * DEG_PER_SECOND,
            g_sensitivity: 0.2 * DEG_PER_SECOND / rins_frames::units::STANDARD_GRAVITY,
        }
    }
}

/// The largest bias, in its sigmas.
const BIAS_SIGMAS: f64 = 4.0;

/// The change of a bias during a log for any data sheet \[rad/s\]: warm-up and bias instability of MEMS gyros. Below it, a
/// constant rate about the vertical is not distinguishable from a bias by its size.
const LARGEST_RATE_CHANGE: f64 = 0.05 * DEG_PER_SECOND;

/// The change of a bias during a log, in its sigmas.
const CHANGE_OF_BIAS: f64 = 0.1;

impl StaticOptions {
    /// The largest mean rate about the vertical that may be a bias \[rad/s\]: four times the data sheet's `bias_sigma`, or
    /// the assumed bias without one.
    pub fn largest_bias(&self) -> f64 {
        self.gyro
            .bias_sigma
            .map_or(self.assumed_bias, |sigma| (BIAS_SIGMAS * sigma).max(LARGEST_RATE_CHANGE))
    }

    /// The largest difference of the biases at one attitude within a log \[rad/s\].
    pub(super) fn largest_rate_change(&self) -> f64 {
        self.gyro.bias_sigma.map_or(LARGEST_RATE_CHANGE, |sigma| {
            sigma.min(LARGEST_RATE_CHANGE.max(CHANGE_OF_BIAS * sigma))
        })
    }

    /// The largest change of a bias with specific force \[(rad/s)/(m/s²)\].
    pub(super) fn largest_g_sensitivity(&self) -> f64 {
        let sheet = self.gyro.bias_sigma.unwrap_or(f64::INFINITY);
        self.g_sensitivity.min(sheet / rins_frames::units::STANDARD_GRAVITY)
    }
}
