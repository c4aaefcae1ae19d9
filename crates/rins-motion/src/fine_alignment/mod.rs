//! Fine alignment: attitude and gyro bias from a static interval with a base that may sway.

mod noise;

use std::ops::Range;

use nalgebra::{Matrix2, Matrix3, RowSVector, SMatrix, SVector, Vector1, Vector2, Vector3};
use rins_ekf::{Block, Filter, Innovation, Measurement, UpdateError};
use rins_frames::units::{ARCSEC, DEG_PER_HOUR};
use rins_frames::{Body, Dcm, EARTH_RATE, InFrame, Nav};

use self::noise::{Noise, Second, most_likely, scatter, seconds};
use crate::alignment::{AlignmentError, MeanUncertainty, align};
use crate::recording::Recording;
use crate::rest::RestMean;
use crate::station::Station;
use crate::strapdown::{Navigator, VerticalChannel};

/// `δv` east and north \[m/s\]; the vertical channel is held.
const VELOCITY: Block<2> = Block::first();
/// `φ` in n \[rad\].
const ATTITUDE: Block<3> = VELOCITY.then();
/// The gyro bias in b, true minus compensated \[rad/s\].
const GYRO_BIAS: Block<3> = ATTITUDE.then();
/// `φ` at the start of the static interval, in n \[rad\].
const START: Block<3> = GYRO_BIAS.then();
const STATES: usize = START.end();

/// The error of the coarse attitude about east and north, 1σ \[rad\]: the base sways by a few tenths of a degree during the
/// static interval, of which the coarse attitude is the mean.
const COARSE_TILT_SIGMA: f64 = 0.01;

/// The same about up \[rad\].
const COARSE_AZIMUTH_SIGMA: f64 = 0.2;

/// The smallest 1σ of the change of the base's heading over a static interval \[rad\].
const FIRM: f64 = ARCSEC;

/// The ratio of a bias to its data sheet sigma above which the data sheet is not used.
const BEYOND_THE_SHEET: f64 = 4.0;

/// The number of repetitions of the pass from its own estimate, before the last one.
const RELINEARISATIONS: usize = 1;

/// The 1σ of a gyro bias without prior knowledge \[rad/s\]; the equivalent azimuth error is larger.
const WIDE_BIAS_SIGMA: f64 = 2.0 * DEG_PER_HOUR;

/// The data sheet of the gyros.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct GyroFigures {
    /// The 1σ of a bias \[rad/s\].
    pub bias_sigma: f64,
    /// The square root of the power spectral density of white noise \[rad/s/√Hz\].
    pub noise_density: f64,
}

/// The result of a fine alignment.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct FineAlignment {
    /// The attitude at the start of the static interval, `C_b^n`.
    pub nav_from_body: Dcm<Nav, Body>,
    /// The covariance of its error `φ`, resolved in n \[rad²\].
    pub covariance: Matrix3<f64>,
    /// The gyro bias \[rad/s\] without its component along east, which is part of the azimuth.
    pub gyro_bias: InFrame<Body>,
    /// The 1σ of each component of the bias \[rad/s\].
    pub gyro_bias_sigma: Vector3<f64>,
    /// The prior 1σ of these components: a component on which the static interval has no information is assumed to be about
    /// zero.
    pub gyro_bias_assumed: Vector3<f64>,
    /// The Earth's rate measured by these gyros, after removal of the sway of the base \[rad/s\].
    pub earth_rate_seen: InFrame<Body>,
    /// The 1σ of that rate's magnitude \[rad/s\].
    pub earth_rate_sigma: f64,
    /// The 1σ of the latitude from the angle between that rate and gravity, without that of the tilt \[rad\].
    pub latitude_sigma: f64,
    /// The noise density of the gyros, at the upper end of its uncertainty \[rad/s/√Hz\].
    pub gyro_noise_density: f64,
    /// The mean normalized innovation squared of the zero-velocity updates; 2 if the model is correct.
    pub nis_mean: f64,
}

/// The reason why the fine alignment failed.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FineAlignmentError {
    /// The coarse alignment failed.
    #[error(transparent)]
    Coarse(#[from] AlignmentError),
    /// The span is too short for an alignment.
    #[error(
        "{duration:.2} s are too short for an alignment: two seconds are needed, and at least four samples"
    )]
    TooShort {
        /// The duration \[s\].
        duration: f64,
    },
    /// The filter failed.
    #[error("the alignment filter failed")]
    Update(#[from] UpdateError),
}

/// Fine alignment on the samples `span` of a recording, during which the base of the IMU has a fixed position.
///
/// The static interval is integrated from the coarse attitude, with zero-velocity updates of a filter whose states are
/// velocity, attitude, gyro bias and the attitude at the start. The gyros track the sway of the base, which would bias a mean
/// over the interval as part of the Earth's rate.
///
/// Azimuth and the bias along east are indistinguishable in a static interval. The prior of the bias along east is zero with
/// the sigma of the gyros' data sheet or, if there is none, with the estimated biases along north and up. Gravity holds no
/// information on the bias along up: the heading of the base at the end equals that at the start, with an uncertainty equal
/// to the tilt of the base. If the bias along north or up greatly exceeds its data sheet sigma, the estimate is used instead.
/// Unknown noise is estimated by maximum likelihood.
///
/// # Errors
/// [`FineAlignmentError`] if the coarse alignment fails or the span is too short.
pub fn align_finely(
    recording: &Recording,
    span: Range<usize>,
    station: &Station,
    gyro: Option<&GyroFigures>,
) -> Result<FineAlignment, FineAlignmentError> {
    let held = recording.increments.get(span.clone()).unwrap_or_default();
    let duration = held.iter().map(|sample| sample.interval).sum();
    let too_short = FineAlignmentError::TooShort { duration };
    let mean = RestMean::of(recording, span.clone()).ok_or(too_short.clone())?;
    let scattered = |sigma: &Vector3<f64>| sigma.norm() / 3.0_f64.sqrt();
    let uncertainty = MeanUncertainty {
        angular_rate: scattered(&mean.angular_rate_sigma),
        specific_force: scattered(&mean.specific_force_sigma),
    };
    let excess = mean.rates.angular_rate.norm() - EARTH_RATE;
    if excess > EARTH_RATE {
        let azimuth_sigma = excess / (EARTH_RATE * station.site.latitude.cos());
        return Err(AlignmentError::NorthNotFound { azimuth_sigma }.into());
    }
    let coarse = align(&mean.rates, &uncertainty, station)?;
    let seconds = seconds(recording, span);
    let guess = scatter(&seconds).ok_or(too_short)?;

    let run = |start: &Prior, noise: Noise| -> Result<(Pass, Score), UpdateError> {
        let mut pass = Pass::new(station, start, noise);
        let mut score = Score::default();
        for second in &seconds {
            let innovation = pass.second(recording, second)?;
            score.nis += innovation.nis() / seconds.len() as f64;
            score.log_likelihood += innovation.log_likelihood();
        }
        pass.hold_heading()?;
        Ok((pass, score))
    };
    // The first pass estimates the size of the bias; the split between azimuth and the bias along east is determined
    // afterwards. The following passes start there with small remaining corrections: a correction of the azimuth by 0.1 rad
    // is not a small error.
    let bias_elsewhere = gyro.map_or(WIDE_BIAS_SIGMA, |gyro| gyro.bias_sigma);
    let first = Prior {
        nav_from_body: coarse.nav_from_body,
        bias_along_east: WIDE_BIAS_SIGMA,
        bias_elsewhere: WIDE_BIAS_SIGMA,
    };
    let (mut pass, _) = run(&first, guess)?;
    let found = pass.start.matrix() * pass.bias;
    let [north, up] = pass.beyond_the_sheet(bias_elsewhere);
    let bias_along_east = gyro.map_or_else(
        || found.y.hypot(found.z) / std::f64::consts::SQRT_2,
        |gyro| gyro.bias_sigma.max(north),
    );
    let bias_elsewhere = bias_elsewhere.max(north).max(up);
    pass.settle_bias_along_east(bias_along_east)?;
    let mut prior = Prior { nav_from_body: pass.start, bias_along_east, bias_elsewhere };
    let known = gyro.map(|gyro| gyro.noise_density);
    let noise = most_likely(guess, known, |noise| Ok(run(&prior, noise)?.1.log_likelihood))?;
    for _ in 0..RELINEARISATIONS {
        prior.nav_from_body = run(&prior, noise)?.0.start;
    }
    let (pass, score) = run(&prior, noise)?;
    Ok(FineAlignment { nis_mean: score.nis, ..pass.found(station) })
}

/// The initial values of a pass over the static interval.
#[derive(Clone, Copy, Debug)]
struct Prior {
    nav_from_body: Dcm<Nav, Body>,
    /// The 1σ of the gyro bias along east \[rad/s\].
    bias_along_east: f64,
    /// The 1σ of the gyro bias along north and up \[rad/s\].
    bias_elsewhere: f64,
}

/// The likelihood of the noise in a pass over the static interval.
#[derive(Clone, Copy, Debug, Default)]
struct Score {
    nis: f64,
    log_likelihood: f64,
}

struct Pass {
    navigator: Navigator,
    start: Dcm<Nav, Body>,
    bias: Vector3<f64>,
    filter: Filter<STATES>,
    noise: Noise,
    /// The prior 1σ of the bias along the body's axes \[rad/s\].
    assumed: Vector3<f64>,
    /// The sum of the azimuth corrections since the start \[rad\].
    azimuth_corrected: f64,
    /// The sum of the squared tilts of the base relative to the start after each second, about east and north together, and
    /// the number of seconds.
    tilts: (f64, f64),
}

impl Pass {
    fn new(station: &Station, prior: &Prior, noise: Noise) -> Self {
        let nav_from_body = prior.nav_from_body;
        let Noise([.., velocity]) = noise;
        let square = |sigma: Vector3<f64>| Matrix3::from_diagonal(&sigma.component_mul(&sigma));
        let coarse =
            square(Vector3::new(COARSE_TILT_SIGMA, COARSE_TILT_SIGMA, COARSE_AZIMUTH_SIGMA));
        let mut p = SMatrix::<f64, STATES, STATES>::zeros();
        VELOCITY.set(VELOCITY, &mut p, &(Matrix2::identity() * (velocity * velocity)));
        let wide = prior.bias_elsewhere;
        let c_nb = nav_from_body.matrix();
        let bias = square(Vector3::new(prior.bias_along_east, wide, wide));
        let bias = c_nb.transpose() * bias * c_nb;
        GYRO_BIAS.set(GYRO_BIAS, &mut p, &bias);
        for (rows, columns) in
            [(ATTITUDE, ATTITUDE), (ATTITUDE, START), (START, ATTITUDE), (START, START)]
        {
            rows.set(columns, &mut p, &coarse);
        }
        Self {
            navigator: Navigator::at_rest(station, nav_from_body, VerticalChannel::Held),
            start: nav_from_body,
            bias: Vector3::zeros(),
            filter: Filter { state: SVector::zeros(), covariance: p },
            noise,
            assumed: bias.diagonal().map(f64::sqrt),
            azimuth_corrected: 0.0,
            tilts: (0.0, 0.0),
        }
    }

    /// Integrates one second, and applies a zero-velocity update at its end.
    fn second(
        &mut self,
        recording: &Recording,
        second: &Second,
    ) -> Result<Innovation<2>, UpdateError> {
        let Noise([.., zero_velocity]) = self.noise;
        let mut force = Vector3::zeros();
        for sample in &recording.increments[second.span.clone()] {
            let angle = sample.angle.components() - self.bias * sample.interval;
            let compensated =
                rins_frames::Increments { angle: InFrame::from_components(angle), ..*sample };
            self.navigator.step(&compensated);
            force += self.navigator.force_gain().components();
        }
        self.predict(&(force / second.duration), second.duration);

        let mut h = SMatrix::<f64, 2, STATES>::zeros();
        h.fixed_view_mut::<2, 2>(0, VELOCITY.start()).copy_from(&Matrix2::identity());
        let r = Matrix2::identity() * (zero_velocity * zero_velocity);
        let velocity = self.navigator.state().velocity.components().xy();
        let innovation = self.filter.update(&Measurement::new(velocity, h, r))?;
        self.correct();
        self.tilts.0 += self.turned().xy().norm_squared();
        self.tilts.1 += 1.0;
        Ok(innovation)
    }

    /// The rotation since the start, in n \[rad\].
    fn turned(&self) -> Vector3<f64> {
        (self.navigator.state().nav_from_body * self.start.inverse()).rotation_vector()
    }

    /// Applies the measurement that the heading at the end equals that at the start, with an uncertainty equal to the tilt in
    /// between.
    fn hold_heading(&mut self) -> Result<(), UpdateError> {
        let (squares, seconds) = self.tilts;
        let variance = squares / (2.0 * seconds) + FIRM * FIRM;
        let mut h = RowSVector::<f64, STATES>::zeros();
        h[ATTITUDE.start() + 2] = 1.0;
        h[START.start() + 2] = -1.0;
        let r = SMatrix::<f64, 1, 1>::new(variance);
        self.filter.update(&Measurement::new(Vector1::new(-self.turned().z), h, r))?;
        self.correct();
        Ok(())
    }

    /// The biases along north and up that exceed this multiple of their sigma `said` \[rad/s\]; zero for others.
    fn beyond_the_sheet(&self, said: f64) -> [f64; 2] {
        let c_nb = self.start.matrix();
        let of_bias =
            self.filter.covariance.fixed_view::<3, 3>(GYRO_BIAS.start(), GYRO_BIAS.start());
        let (found, in_nav) = (c_nb * self.bias, c_nb * of_bias * c_nb.transpose());
        [1, 2].map(|axis| {
            let expected = (said * said + in_nav[(axis, axis)]).sqrt();
            let size = found[axis].abs();
            if size > BEYOND_THE_SHEET * expected { size } else { 0.0 }
        })
    }

    fn predict(&mut self, force: &Vector3<f64>, duration: f64) {
        let nav_rate = self.navigator.rate_of_nav_in_inertial();
        let c_nb = *self.navigator.state().nav_from_body.matrix();
        let mut f = SMatrix::<f64, STATES, STATES>::zeros();
        // A horizontal component of the force is due to a tilt that the filter has not estimated yet. In the derivatives a
        // wrong azimuth would rotate it, which would seem to be observable in the velocity.
        let upward = Vector3::new(0.0, 0.0, force.z);
        let by_attitude = rins_frames::cross_matrix(&upward).fixed_rows::<2>(0).into_owned();
        VELOCITY.set(ATTITUDE, &mut f, &by_attitude);
        ATTITUDE.set(ATTITUDE, &mut f, &-nav_rate.cross_matrix());
        // With the azimuth before its corrections, so that the unobservable direction stays constant: otherwise each
        // correction would seem to hold information on it (first-estimates Jacobian; ‹huang2010›).
        let before =
            Dcm::<Nav, Nav>::from_rotation_vector(&Vector3::new(0.0, 0.0, -self.azimuth_corrected));
        ATTITUDE.set(GYRO_BIAS, &mut f, &-(before.matrix() * c_nb));
        let step = f * duration;
        let transition = SMatrix::identity() + step + step * step * 0.5;
        let mut q = SMatrix::<f64, STATES, STATES>::zeros();
        let Noise([gyro, accel, _]) = self.noise;
        ATTITUDE.set(ATTITUDE, &mut q, &(Matrix3::identity() * (gyro * gyro * duration)));
        let accel = Matrix2::identity() * (accel * accel * duration);
        VELOCITY.set(VELOCITY, &mut q, &accel);
        self.filter.predict(&transition, &q);
    }

    fn correct(&mut self) {
        let x = &self.filter.state;
        let velocity: Vector2<f64> = VELOCITY.of(x);
        let state = self.navigator.state_mut();
        state.velocity -= InFrame::from_components(velocity.push(0.0));
        state.nav_from_body = Dcm::from_rotation_vector(&ATTITUDE.of(x)) * state.nav_from_body;
        self.start = Dcm::from_rotation_vector(&START.of(x)) * self.start;
        self.bias += GYRO_BIAS.of(x);
        self.azimuth_corrected += ATTITUDE.of(x).z;
        self.filter.state = SVector::zeros();
    }

    /// Determines the split between azimuth and the bias along east, which a static interval does not.
    fn settle_bias_along_east(&mut self, sigma: f64) -> Result<(), UpdateError> {
        let east = self.start.matrix().row(0).into_owned();
        let mut h = RowSVector::<f64, STATES>::zeros();
        h.fixed_view_mut::<1, 3>(0, GYRO_BIAS.start()).copy_from(&east);
        let value = Vector1::new(-(east * self.bias)[0]);
        let r = SMatrix::<f64, 1, 1>::new(sigma * sigma);
        self.filter.update(&Measurement::new(value, h, r))?;
        self.correct();
        Ok(())
    }

    fn found(&self, station: &Station) -> FineAlignment {
        let covariance = self.filter.covariance;
        let earth_rate = self.start.inverse() * station.site.earth_rate();
        let gyro_bias = InFrame::from_components(self.bias);
        let of_bias = covariance.fixed_view::<3, 3>(GYRO_BIAS.start(), GYRO_BIAS.start());
        let in_nav = self.start.matrix() * of_bias * self.start.matrix().transpose();
        let along = station.site.earth_rate().components().normalize();
        let across = Vector3::x().cross(&along);
        let spread = |direction: Vector3<f64>| direction.dot(&(in_nav * direction)).sqrt();
        FineAlignment {
            nav_from_body: self.start,
            covariance: covariance.fixed_view::<3, 3>(START.start(), START.start()).into_owned(),
            gyro_bias,
            gyro_bias_sigma: of_bias.diagonal().map(f64::sqrt),
            gyro_bias_assumed: self.assumed,
            earth_rate_sigma: spread(along),
            latitude_sigma: spread(across) / EARTH_RATE,
            earth_rate_seen: earth_rate + gyro_bias,
            gyro_noise_density: self.noise.0[0],
            nis_mean: 0.0,
        }
    }
}
