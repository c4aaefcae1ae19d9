//! The overlapping Allan deviation of increments, with its confidence bounds.

use std::iter;

use nalgebra::DVector;
use statrs::distribution::{ChiSquared, ContinuousCDF};

use super::covariance::Covariances;
use super::fit::{FEWEST_POINTS, NoiseSeen, noise_seen};
use super::point::{AllanPoint, CONFIDENCE, degrees_of_freedom};

/// The maximum length of a cluster as a fraction of the series: longer ones have too few neighbors to be informative.
const LONGEST_CLUSTER: usize = 5;

/// The averaging times for series of one length, and the covariances of their Allan variances.
///
/// The averaging times are the interval times powers of two, up to a fifth of the series.
///
/// ```
/// use rins_imu::{AllanPlan, NoiseModel, Seed, Span, NoiseTerm, Triad, TriadNoise};
/// const INTERVAL: f64 = 0.01;
///
/// let span = Span { interval: INTERVAL, duration: 100.0 };
/// let mut noise = TriadNoise::new(&NoiseModel::white(0.5), &span, Triad::Gyro, Seed::new(1))?;
/// let rest: Vec<f64> = (0..10_000).map(|_| noise.next(INTERVAL).components().x).collect();
///
/// let seen = AllanPlan::new(rest.len(), INTERVAL)?.noise(&rest)?;
/// let NoiseTerm::Seen { value, sigma, .. } = seen.strengths[1] else { panic!("white noise shows") };
/// assert!((value - 0.5).abs() < 4.0 * sigma && sigma < 0.01);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Debug)]
pub struct AllanPlan {
    n_samples: usize,
    interval: f64,
    clusters: Vec<usize>,
    covariances: Covariances,
}

/// The reason why a series gives no noise parameters.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum AllanError {
    /// There are too few samples to distinguish the laws.
    #[error("{n_samples} samples are too few for an Allan deviation: {needed} are needed")]
    TooShort {
        /// The number of samples.
        n_samples: usize,
        /// The minimum number of samples.
        needed: usize,
    },
    /// The interval is not positive.
    #[error("an interval of {interval} s is not a finite number above zero")]
    Interval {
        /// The interval \[s\].
        interval: f64,
    },
    /// The length of the series differs from the planned one.
    #[error("{n_samples} samples where {planned} were planned for")]
    Length {
        /// The number of samples.
        n_samples: usize,
        /// The planned number of samples.
        planned: usize,
    },
    /// A sample is not a finite number.
    #[error("sample {sample} is not a finite number")]
    NotFinite {
        /// Its index in the series.
        sample: usize,
    },
    /// All samples are equal, so that there is no noise.
    #[error("the reading never changes: its noise cannot be determined")]
    Constant,
}

impl AllanPlan {
    /// A plan for series of `n_samples` increments over `interval` \[s\] each.
    ///
    /// # Errors
    /// [`AllanError::TooShort`] below 80 samples, and [`AllanError::Interval`].
    pub fn new(n_samples: usize, interval: f64) -> Result<Self, AllanError> {
        if !(interval.is_normal() && interval > 0.0) {
            return Err(AllanError::Interval { interval });
        }
        let longest = n_samples / LONGEST_CLUSTER;
        let clusters: Vec<usize> =
            iter::successors(Some(1_usize), |cluster| cluster.checked_mul(2))
                .take_while(|cluster| *cluster <= longest)
                .collect();
        if clusters.len() < FEWEST_POINTS {
            let needed = LONGEST_CLUSTER << (FEWEST_POINTS - 1);
            return Err(AllanError::TooShort { n_samples, needed });
        }
        let covariances = Covariances::new(n_samples, interval, &clusters);
        Ok(Self { n_samples, interval, clusters, covariances })
    }

    /// The averaging times \[s\].
    pub fn times(&self) -> Vec<f64> {
        self.clusters.iter().map(|&cluster| cluster as f64 * self.interval).collect()
    }

    /// The Allan deviation of these increments \[rad or m/s\], and the noise parameters fitted to it.
    ///
    /// # Errors
    /// [`AllanError::Length`], [`AllanError::NotFinite`], [`AllanError::Constant`].
    pub fn noise(&self, increments: &[f64]) -> Result<NoiseSeen, AllanError> {
        let n_samples = increments.len();
        if n_samples != self.n_samples {
            return Err(AllanError::Length { n_samples, planned: self.n_samples });
        }
        if let Some(sample) = increments.iter().position(|increment| !increment.is_finite()) {
            return Err(AllanError::NotFinite { sample });
        }
        if increments.iter().all(|one| one.total_cmp(&increments[0]).is_eq()) {
            return Err(AllanError::Constant);
        }
        let integral = integral(increments);
        let variances = self
            .clusters
            .iter()
            .map(|&cluster| allan_variance(&integral, cluster) / (self.interval * self.interval));
        let variances = DVector::from_iterator(self.clusters.len(), variances);
        Ok(noise_seen(&self.times(), &variances, &self.covariances))
    }
}

impl AllanPoint {
    /// A point whose variance has a χ² distribution with mean `fitted` and variance `scatter`.
    pub(super) fn new(time: f64, variance: f64, fitted: f64, scatter: f64) -> Self {
        let (low, high) = bounds(degrees_of_freedom(fitted, scatter));
        let deviation = variance.sqrt();
        Self { time, deviation, bounds: (deviation * low, deviation * high), fitted: fitted.sqrt() }
    }
}

/// The factors by which a deviation with this number of degrees of freedom is multiplied to get its bounds.
fn bounds(degrees: f64) -> (f64, f64) {
    let tail = (1.0 - CONFIDENCE) / 2.0;
    ChiSquared::new(degrees).map_or((0.0, f64::INFINITY), |law| {
        let factor = |probability: f64| (degrees / law.inverse_cdf(probability)).sqrt();
        (factor(1.0 - tail), factor(tail))
    })
}

/// The cumulative sums of the increments, minus the part of a constant rate, which has no effect but would
/// cost digits.
fn integral(increments: &[f64]) -> Vec<f64> {
    let mean = increments.iter().sum::<f64>() / increments.len() as f64;
    let sums = increments.iter().scan(0.0, |sum, increment| {
        *sum += increment - mean;
        Some(*sum)
    });
    iter::once(0.0).chain(sums).collect()
}

/// The overlapping Allan variance, over clusters of `cluster` samples of unit length, of a rate with
/// this integral (‹riley2008›, chapter 5).
pub(super) fn allan_variance(integral: &[f64], cluster: usize) -> f64 {
    let triples = integral.iter().zip(&integral[cluster..]).zip(&integral[2 * cluster..]);
    let n_terms = triples.len() as f64;
    let sum: f64 =
        triples.map(|((first, middle), last)| (last - 2.0 * middle + first).powi(2)).sum();
    sum / (2.0 * (cluster * cluster) as f64 * n_terms)
}
