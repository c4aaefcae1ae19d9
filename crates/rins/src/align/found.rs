//! The attitude of an IMU over a static interval.

use std::ops::Range;

use nalgebra::Vector3;
use rins_frames::{Body, Dcm, InFrame, Nav, Rates, SignedAxes};
use rins_io::Loaded;
use rins_motion::{
    AlignmentError, FineAlignment, FineAlignmentError, GyroFigures, MeanUncertainty, PlaceSeen,
    RestMean, align_finely, level, place_seen, residual,
};

use crate::log::{longest, none_found};

/// The 1σ of an unknown azimuth \[rad\]: that of a uniform distribution over one turn.
pub(crate) const ANY_AZIMUTH: f64 = 1.813_799_364_234_217_8;

/// A bias is not observable over a static interval if its sigma exceeds this fraction of the assumed sigma.
const SHOWN: f64 = 0.9;

/// The shortest static interval that is used for alignment \[s\].
const SHORTEST_REST: f64 = 5.0;

/// The attitude found from a static interval.
#[derive(Debug)]
pub(crate) struct AlignmentSolution {
    /// The body's attitude over the static interval.
    pub(crate) nav_from_body: Dcm<Nav, Body>,
    /// The 1σ of the error about east, north and up \[rad\]; the third is `None` if north was not found.
    pub(crate) sigma: (f64, f64, Option<f64>),
    /// Why north was not found.
    pub(super) hidden: Option<AlignmentError>,
    /// The samples of the static interval.
    pub(crate) span: Range<usize>,
    pub(crate) start: f64,
    pub(super) mean: RestMean,
    /// The solution of the fine alignment filter; `None` if north was not found.
    pub(super) fine: Option<FineAlignment>,
    pub(super) uncertainty: MeanUncertainty,
    pub(super) place: PlaceSeen,
    /// The measured rates minus the predicted rates: an apparent bias.
    pub(crate) residual: Rates,
}

impl AlignmentSolution {
    /// Whether north was found from the Earth's rotation.
    pub(crate) const fn north_found(&self) -> bool {
        self.hidden.is_none()
    }

    /// Whether each gyro bias is observable over the static interval, along the sensors' own axes; if not, it is the assumed one.
    pub(super) fn bias_shown(&self, own_axes: &SignedAxes) -> [bool; 3] {
        let Some(fine) = self.fine else { return [true; 3] };
        let sigma = own_axes.undo(&fine.gyro_bias_sigma).abs();
        let assumed = own_axes.undo(&fine.gyro_bias_assumed).abs();
        [0, 1, 2].map(|axis| sigma[axis] < SHOWN * assumed[axis])
    }

    /// The 1σ of the Earth rate \[rad/s\] and of the latitude \[rad\] as the gyros measure them.
    pub(super) fn seen_sigma(&self) -> (f64, f64) {
        let level = self.uncertainty.specific_force / self.place.gravity;
        self.fine.map_or((self.uncertainty.angular_rate, self.place.latitude_sigma), |fine| {
            (fine.earth_rate_sigma, fine.latitude_sigma.hypot(level))
        })
    }
}

/// Aligns on the longest static interval of a run.
pub(crate) fn found(loaded: &Loaded) -> anyhow::Result<AlignmentSolution> {
    let span = longest(loaded, SHORTEST_REST).ok_or_else(|| {
        anyhow::anyhow!("{}, so there is nothing to align on", none_found(loaded, SHORTEST_REST))
    })?;
    found_over(loaded, span)
}

/// Aligns on one static interval of a run.
pub(crate) fn found_over(loaded: &Loaded, span: Range<usize>) -> anyhow::Result<AlignmentSolution> {
    let recording = &loaded.recording;
    let mean = RestMean::of(recording, span.clone())
        .ok_or_else(|| anyhow::anyhow!("the static interval holds no samples"))?;
    let uncertainty = uncertainty(loaded, &mean);
    let figures = loaded.rig.imu.map(|imu| GyroFigures {
        bias_sigma: imu.gyro.bias_sigma,
        noise_density: imu.gyro.noise_density,
    });
    let aligned = align_finely(recording, span.clone(), &loaded.station, figures.as_ref());
    // Without a data sheet, the error of the measured gravity is a lower bound of the tilt error.
    let gravity_error = mean.rates.specific_force.norm() / loaded.station.gravity - 1.0;
    let levelling = (uncertainty.specific_force / loaded.station.gravity).hypot(gravity_error);
    let (nav_from_body, sigma, fine, hidden) = match aligned {
        Ok(fine) => {
            let sigma = fine.covariance.diagonal().map(f64::sqrt);
            // The filter models noise only, and not the constant errors of the accelerometers.
            let constant = (accel_sigma(loaded) / loaded.station.gravity).hypot(gravity_error);
            let tilt = |sigma: f64| sigma.hypot(constant);
            (fine.nav_from_body, (tilt(sigma.x), tilt(sigma.y), Some(sigma.z)), Some(fine), None)
        }
        Err(FineAlignmentError::Coarse(hidden @ AlignmentError::NorthNotFound { .. })) => {
            let yaw = loaded.rig.attitude.map_or(0.0, |attitude| attitude.angles.yaw);
            (level(&mean.rates, yaw)?, (levelling, levelling, None), None, Some(hidden))
        }
        // An interval that is too short for the Earth rate is not too short for gravity.
        Err(FineAlignmentError::TooShort { .. }) => {
            let hidden = AlignmentError::NorthNotFound { azimuth_sigma: ANY_AZIMUTH };
            let yaw = loaded.rig.attitude.map_or(0.0, |attitude| attitude.angles.yaw);
            (level(&mean.rates, yaw)?, (levelling, levelling, None), None, Some(hidden))
        }
        Err(error) => return Err(error.into()),
    };
    // The filter estimates the Earth rate at the start of the interval, so `up` must refer to the start too.
    let seen = fine.map_or(mean.rates, |fine| {
        let up = InFrame::new(0.0, 0.0, mean.rates.specific_force.norm());
        let body_from_nav = fine.nav_from_body.inverse();
        Rates { angular_rate: fine.earth_rate_seen, specific_force: body_from_nav * up }
    });
    Ok(AlignmentSolution {
        nav_from_body,
        sigma,
        hidden,
        start: recording.times[span.start] - recording.increments[span.start].interval,
        place: place_seen(&seen, &uncertainty),
        residual: residual(&seen, nav_from_body, &loaded.station),
        fine,
        span,
        mean,
        uncertainty,
    })
}

/// The uncertainty of the mean from the scatter of the samples, and from the data sheet if there is one.
fn uncertainty(loaded: &Loaded, mean: &RestMean) -> MeanUncertainty {
    let scatter = |sigma: Vector3<f64>| sigma.norm() / 3.0_f64.sqrt();
    let gyro = loaded.rig.imu.map_or(0.0, |imu| imu.gyro.bias_sigma);
    MeanUncertainty {
        angular_rate: scatter(mean.angular_rate_sigma).hypot(gyro),
        specific_force: scatter(mean.specific_force_sigma).hypot(accel_sigma(loaded)),
    }
}

/// The 1σ of the constant error of a specific force of one g, by the data sheet \[m/s²\].
fn accel_sigma(loaded: &Loaded) -> f64 {
    loaded.rig.imu.map_or(0.0, |imu| {
        let shape = imu.accel.scale_sigma.max(imu.accel.misalignment_sigma);
        imu.accel.bias_sigma.hypot(shape * loaded.station.gravity)
    })
}
