//! The covariances of the Allan variances of one series, for any mixture of noise.

use nalgebra::{DMatrix, Matrix4, Vector4};

use super::law::NoiseLaw;

/// The ratio of cluster lengths above which variances are treated as independent: white noise then
/// correlates them by less than 2 %.
const LARGEST_RATIO: usize = 64;

/// The number of samples of a smooth covariance over the shorter cluster.
const SAMPLES_PER_CLUSTER: usize = 8;

/// The lag, in multiples of the two spans, beyond which second differences are treated as uncorrelated: the correlation of
/// flicker noise decreases with the inverse square of the lag, that of the others is zero.
const LARGEST_LAG: usize = 3;

/// The covariances of overlapping Allan variances, as quadratic forms of the squared noise parameters.
#[derive(Clone, Debug)]
pub(super) struct Covariances {
    /// The lower triangle, row by row.
    forms: Vec<Vec<Matrix4<f64>>>,
}

impl Covariances {
    /// The covariances of the Allan variances of `n_samples` increments over `interval` \[s\] each, at clusters of
    /// that many samples, in ascending order.
    pub(super) fn new(n_samples: usize, interval: f64, clusters: &[usize]) -> Self {
        let form = |longer: usize, shorter: usize| {
            let pair = Pair { n_samples, shorter, longer };
            if longer <= LARGEST_RATIO * shorter { pair.form(interval) } else { Matrix4::zeros() }
        };
        let forms = clusters
            .iter()
            .enumerate()
            .map(|(place, &longer)| {
                clusters[..=place].iter().map(|&shorter| form(longer, shorter)).collect()
            })
            .collect();
        Self { forms }
    }

    /// The covariances for noise with these squared noise parameters.
    pub(super) fn of(&self, squares: &Vector4<f64>) -> DMatrix<f64> {
        let n_points = self.forms.len();
        DMatrix::from_fn(n_points, n_points, |row, column| {
            let form = &self.forms[row.max(column)][row.min(column)];
            squares.dot(&(form * squares))
        })
    }
}

/// Two series of second differences, over clusters of `shorter` and `longer` samples.
struct Pair {
    n_samples: usize,
    shorter: usize,
    longer: usize,
}

impl Pair {
    /// The quadratic form of the covariance of the two variances.
    ///
    /// For Gaussian noise, the covariance of two squares is twice the squared covariance; it is
    /// summed over all pairs of second differences (‹greenhall2003›).
    fn form(&self, interval: f64) -> Matrix4<f64> {
        let terms = |cluster: usize| (self.n_samples + 1 - 2 * cluster) as f64;
        let (n_short, n_long) = (terms(self.shorter), terms(self.longer));
        // The number of second differences of the longer clusters that start `lag` after one of the shorter.
        let pairs = |lag: f64| (n_long.min(n_short - lag) - (-lag).max(0.0)).max(0.0);
        let stride = (self.shorter / SAMPLES_PER_CLUSTER).max(1);
        let farthest = (LARGEST_LAG * 2 * (self.shorter + self.longer)).min(self.n_samples);
        let n_steps = (farthest / stride).cast_signed();
        let mut sum = Matrix4::zeros();
        for step in -n_steps..=n_steps {
            let lag = step as f64 * stride as f64;
            let mut covariances = self.covariances(lag, interval);
            // The covariance of quantization noise is not smooth.
            covariances[0] = 0.0;
            sum += covariances * covariances.transpose() * (pairs(lag) * stride as f64);
        }
        for lag in self.knots() {
            let all = self.covariances(lag, interval);
            let mut cross = all * all.transpose();
            cross.view_mut((1, 1), (3, 3)).fill(0.0);
            sum += cross * pairs(lag);
        }
        let square = |cluster: usize| 2.0 * (cluster as f64 * interval).powi(2);
        sum * 2.0 / (n_short * n_long * square(self.shorter) * square(self.longer))
    }

    /// The lags at which two of the six angles in the second differences coincide.
    fn knots(&self) -> Vec<f64> {
        let (shorter, longer) = (self.shorter as f64, self.longer as f64);
        let mut knots: Vec<f64> = (0..3)
            .flat_map(|p| (0..3).map(move |q| f64::from(q) * longer - f64::from(p) * shorter))
            .collect();
        knots.sort_by(f64::total_cmp);
        knots.dedup();
        knots
    }

    /// The covariance, for each law, of a second difference of the longer clusters and one of the
    /// shorter that starts `lag` samples later, or earlier if it is negative.
    fn covariances(&self, lag: f64, interval: f64) -> Vector4<f64> {
        const WEIGHTS: [f64; 3] = [1.0, -2.0, 1.0];
        let mut sums = Vector4::zeros();
        for (p, on_short) in WEIGHTS.into_iter().enumerate() {
            for (q, on_long) in WEIGHTS.into_iter().enumerate() {
                let apart = lag + (p * self.shorter) as f64 - (q * self.longer) as f64;
                for (sum, law) in sums.iter_mut().zip(NoiseLaw::ALL) {
                    *sum += on_short * on_long * law.autocovariance(apart * interval);
                }
            }
        }
        sums
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use rins_testing::assert_close;

    const WHITE: Vector4<f64> = Vector4::new(0.0, 1.0, 0.0, 0.0);
    const WALK: Vector4<f64> = Vector4::new(0.0, 0.0, 0.0, 1.0);

    #[test]
    fn neighbours_of_white_noise_scatter_as_counted_by_hand() {
        // 99 differences of neighbors, of variance 2; 98 pairs of them share a sample: -1.
        let by_hand = 2.0 / (99.0 * 99.0 * 4.0) * (99.0 * 4.0 + 2.0 * 98.0);
        let covariances = Covariances::new(100, 1.0, &[1]).of(&WHITE);
        assert_close!(covariances[(0, 0)], by_hand, 1e-12);
    }

    #[test]
    fn thinned_sums_are_the_whole_ones() {
        let of = |pair: &Pair, squares: &Vector4<f64>| squares.dot(&(pair.form(0.1) * squares));
        // Clusters of 8 are summed over each lag, those of 64 over each eighth.
        for squares in [WHITE, WALK, Vector4::new(0.0, 0.0, 1.0, 0.0)] {
            let relative = |scale: usize| {
                let pair = |shorter, longer| Pair {
                    n_samples: 200 * scale,
                    shorter: shorter * scale,
                    longer: longer * scale,
                };
                let [near, short, long] =
                    [(8, 32), (8, 8), (32, 32)].map(|(a, b)| of(&pair(a, b), &squares));
                near / (short * long).sqrt()
            };
            assert_close!(relative(8), relative(1), 0.01);
        }
    }

    #[test]
    fn variances_of_far_times_hardly_correlate() {
        let of = |shorter, longer| {
            let pair = Pair { n_samples: 100_000, shorter, longer };
            WHITE.dot(&(pair.form(1.0) * WHITE))
        };
        let correlation = of(1, 64) / (of(1, 1) * of(64, 64)).sqrt();
        assert!((1e-4..0.02).contains(&correlation), "{correlation}");
    }
}
