//! The fit of noise laws to Allan variances, with significant laws only.

use nalgebra::{DMatrix, DVector, Matrix4, Matrix4xX, MatrixXx4, Vector4};

use super::covariance::Covariances;
use super::law::NoiseLaw;
use super::point::{AllanPoint, improbability};

/// The significance of a law: the minimum ratio of its squared parameter to the standard deviation in its absence.
const SIGNIFICANCE: f64 = 4.0;

/// The upper bound of an insignificant law, in sigmas above its estimate.
const BOUND_SIGMAS: f64 = 2.0;

/// The disagreement of the variance with the sum of the laws, relative to the variance; the first sufficient value is used.
/// If none is, the shortest times do not follow the laws and are excluded.
const DISAGREEMENTS: [f64; 5] = [0.0, 0.01, 0.02, 0.05, 0.1];

/// The disagreement that is reported if the laws do not explain the variances at any times.
const NO_AGREEMENT: f64 = 1.0;

/// The minimum number of variances that are compared with the laws, one more than there are laws.
pub(super) const FEWEST_POINTS: usize = NoiseLaw::ALL.len() + 1;

/// The p-value of the worst point, corrected for the number of points, below which the laws do not fit.
const MISFIT: f64 = 0.01;

/// The maximum number of iterations of the weights, which depend on the noise parameters.
const ROUNDS: usize = 50;

/// The noise parameters from an Allan deviation.
#[derive(Clone, Debug, PartialEq)]
pub struct NoiseSeen {
    /// The deviation at each averaging time.
    pub points: Vec<AllanPoint>,
    /// The noise parameter of each of [`NoiseLaw::ALL`].
    pub strengths: [NoiseTerm; 4],
    /// The difference of the Allan variance from the sum of the laws beyond chance, relative to it: zero if
    /// the laws explain it. All sigmas include it.
    pub disagreement: f64,
    /// The averaging time from which on the laws were compared with the variance \[s\]: the shortest,
    /// unless an effect that follows none of them, such as the dither of a laser gyro, dominates there.
    pub explained_from: f64,
}

/// A noise parameter, in the unit of its [`NoiseLaw`].
#[derive(Clone, Debug, PartialEq)]
pub enum NoiseTerm {
    /// The law is significant.
    Seen {
        /// The noise parameter.
        value: f64,
        /// Its 1σ, with the other significant laws estimated.
        sigma: f64,
        /// The laws that explain the variances equally well in its place: together with one of them it is not significant.
        rivals: Vec<NoiseLaw>,
    },
    /// The law is not significant.
    NotSeen {
        /// The upper bound, two sigma above the estimate.
        below: f64,
    },
}

/// The laws that may be present.
type Laws = [bool; 4];

/// Fits the laws to Allan variances at these times \[s\].
pub(super) fn noise_seen(
    times: &[f64],
    variances: &DVector<f64>,
    covariances: &Covariances,
) -> NoiseSeen {
    let fit = (0..=times.len() - FEWEST_POINTS)
        .flat_map(|first| DISAGREEMENTS.map(|disagreement| (first, disagreement)))
        .map(|(first, off)| Fit::new(times, variances, covariances, first, off))
        .find(|fit| fit.explains(&fit.solve([true; 4])))
        .unwrap_or_else(|| Fit::new(times, variances, covariances, 0, NO_AGREEMENT));
    let squares = fit.significant();
    let strengths = std::array::from_fn(|law| fit.strength(&squares, law));
    let scatter = covariances.of(&squares).diagonal();
    let fitted = design(times) * squares;
    let points = (0..times.len())
        .map(|k| AllanPoint::new(times[k], variances[k], fitted[k], scatter[k]))
        .collect();
    let explained_from = times[fit.first];
    NoiseSeen { points, strengths, disagreement: fit.disagreement, explained_from }
}

/// The variance at each time for a unit of each squared noise parameter.
fn design(times: &[f64]) -> MatrixXx4<f64> {
    MatrixXx4::from_fn(times.len(), |row, law| NoiseLaw::ALL[law].allan_variance(times[row]))
}

struct Fit<'a> {
    /// The variances from the index `first` on.
    variances: DVector<f64>,
    covariances: &'a Covariances,
    design: MatrixXx4<f64>,
    first: usize,
    disagreement: f64,
}

impl<'a> Fit<'a> {
    fn new(
        times: &[f64],
        variances: &DVector<f64>,
        covariances: &'a Covariances,
        first: usize,
        disagreement: f64,
    ) -> Self {
        let variances = variances.rows_range(first..).into_owned();
        Self { variances, covariances, design: design(&times[first..]), first, disagreement }
    }

    /// The covariance of the variances under noise with these squared parameters, including the disagreement with the laws.
    fn scatter(&self, squares: &Vector4<f64>) -> DMatrix<f64> {
        let all = self.covariances.of(squares);
        let mut scatter = all.view_range(self.first.., self.first..).into_owned();
        let mean = &self.design * squares;
        for (k, mean) in mean.iter().enumerate() {
            scatter[(k, k)] += (self.disagreement * mean).powi(2);
        }
        scatter
    }

    /// The squared parameters of these laws, none negative, by iteratively reweighted least squares: the weights follow from
    /// the covariance under the estimated parameters.
    fn solve(&self, laws: Laws) -> Vector4<f64> {
        // The initial value of each law: the median over the points of what explains the variance by this law alone.
        let mut squares = Vector4::from_fn(|law, _| {
            let mut alone: Vec<f64> = self
                .variances
                .iter()
                .zip(self.design.column(law).iter())
                .map(|(v, a)| v / a)
                .collect();
            alone.sort_by(f64::total_cmp);
            if laws[law] { alone[alone.len() / 2] } else { 0.0 }
        });
        for _ in 0..ROUNDS {
            let before = squares;
            squares = self.least_squares(laws, &self.scatter(&before).diagonal());
            let change =
                (&self.design * (squares - before)).component_div(&(&self.design * squares));
            if change.amax() < 1e-9 {
                break;
            }
        }
        squares
    }

    /// The best fit by a subset of these laws without a negative squared parameter.
    fn least_squares(&self, laws: Laws, scatter: &DVector<f64>) -> Vector4<f64> {
        let mixtures = (1_u8..16).map(|bits| std::array::from_fn(|law| bits >> law & 1 == 1));
        mixtures
            .filter(|mixture: &Laws| mixture.iter().zip(laws).all(|(used, may)| may || !used))
            .filter_map(|mixture| {
                let squares = self.gain(mixture, scatter)? * &self.variances;
                let off = &self.variances - &self.design * squares;
                let cost = off.component_mul(&off).component_div(scatter).sum();
                (squares.min() >= 0.0).then_some((cost, squares))
            })
            .min_by(|a, b| a.0.total_cmp(&b.0))
            .map(|(_, squares)| squares)
            .unwrap_or_default()
    }

    /// The gain from variances to the squared parameters of these laws, weighted by that scatter.
    fn gain(&self, laws: Laws, scatter: &DVector<f64>) -> Option<Matrix4xX<f64>> {
        let mut whitened = self.design.clone();
        for (mut row, scatter) in whitened.row_iter_mut().zip(scatter) {
            row /= scatter.sqrt();
        }
        // Columns are normalized, because the units differ; an excluded law gets a unit diagonal.
        let lengths =
            Vector4::from_fn(
                |law, _| {
                    if laws[law] { whitened.column(law).norm() } else { f64::INFINITY }
                },
            );
        for (mut column, length) in whitened.column_iter_mut().zip(&lengths) {
            column /= *length;
        }
        let mut normal: Matrix4<f64> = whitened.transpose() * &whitened;
        for law in (0..4).filter(|law| !laws[*law]) {
            normal[(law, law)] = 1.0;
        }
        let mut gain = normal.cholesky()?.solve(&whitened.transpose());
        for (mut column, scatter) in gain.column_iter_mut().zip(scatter) {
            column /= scatter.sqrt();
        }
        for (mut row, length) in gain.row_iter_mut().zip(&lengths) {
            row /= *length;
        }
        Some(gain)
    }

    /// The estimated squared parameter of `law` together with `laws`, possibly negative, and its 1σ
    /// under noise with the squared parameters `squares`.
    fn found(&self, laws: Laws, squares: &Vector4<f64>, law: usize) -> Option<(f64, f64)> {
        let scatter = self.scatter(squares);
        let gain = self.gain(laws, &scatter.diagonal())?;
        let value = (gain.row(law) * &self.variances).x;
        let variance = (gain.row(law) * &scatter * gain.row(law).transpose()).x;
        Some((value, variance.max(0.0).sqrt()))
    }

    /// Whether no point is improbable under these parameters.
    fn explains(&self, squares: &Vector4<f64>) -> bool {
        let mean = &self.design * squares;
        let scatter = self.scatter(squares).diagonal();
        let least = (0..mean.len())
            .map(|k| improbability(self.variances[k], mean[k], scatter[k]))
            .fold(1.0, f64::min);
        least * mean.len() as f64 > MISFIT
    }

    /// The squared parameters of the significant laws: the least significant law is
    /// removed until all are significant, or one is left.
    fn significant(&self) -> Vector4<f64> {
        let mut squares = self.solve([true; 4]);
        loop {
            let laws = present(&squares);
            let weakest = (0..4)
                .filter(|law| laws[*law])
                .filter_map(|law| {
                    let without = self.solve(without(laws, law));
                    let (value, sigma) = self.found(laws, &without, law)?;
                    Some((value / sigma, without))
                })
                .min_by(|a, b| a.0.total_cmp(&b.0));
            match weakest {
                Some((score, without))
                    if score < SIGNIFICANCE && present(&without).contains(&true) =>
                {
                    squares = without;
                }
                _ => return squares,
            }
        }
    }

    /// The noise parameter of a law in the presence of those of `squares`.
    fn strength(&self, squares: &Vector4<f64>, law: usize) -> NoiseTerm {
        let mut laws = present(squares);
        if laws[law] {
            let sigma = self.found(laws, squares, law).map_or(f64::INFINITY, |(_, sigma)| sigma);
            let value = squares[law].sqrt();
            let rivals = self.rivals(laws, law);
            return NoiseTerm::Seen { value, sigma: sigma / (2.0 * value), rivals };
        }
        laws[law] = true;
        let above = |squares: &Vector4<f64>| {
            self.found(laws, squares, law)
                .map_or(f64::INFINITY, |(value, sigma)| value.max(0.0) + BOUND_SIGMAS * sigma)
        };
        // A larger parameter has a larger scatter.
        let mut with = *squares;
        with[law] = above(squares);
        NoiseTerm::NotSeen { below: above(&with).sqrt() }
    }

    /// The laws that can replace `law` among `laws`.
    fn rivals(&self, laws: Laws, law: usize) -> Vec<NoiseLaw> {
        let rivals = (0..4).filter(|rival| {
            let mut both = laws;
            both[*rival] = true;
            let instead = self.solve(without(both, law));
            let beside = self.found(both, &instead, law);
            !laws[*rival]
                && self.explains(&instead)
                && beside.is_some_and(|(value, sigma)| value < SIGNIFICANCE * sigma)
        });
        rivals.map(|rival| NoiseLaw::ALL[rival]).collect()
    }
}

fn present(squares: &Vector4<f64>) -> Laws {
    std::array::from_fn(|law| squares[law] > 0.0)
}

fn without(laws: Laws, law: usize) -> Laws {
    std::array::from_fn(|other| laws[other] && other != law)
}
