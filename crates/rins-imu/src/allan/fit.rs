//! The laws whose sum explains Allan variances, those only that are significant.

use nalgebra::{DMatrix, DVector, Matrix4, Matrix4xX, MatrixXx4, Vector4};

use super::covariance::Covariances;
use super::law::NoiseLaw;
use super::point::{AllanPoint, improbability};

/// A law is seen if its squared strength is so many sigma of what chance would make of it.
const SIGNIFICANCE: f64 = 4.0;

/// A law that is not seen is bounded so many sigma above what was found of it.
const BOUND_SIGMAS: f64 = 2.0;

/// How far real noise may be off the sum of laws, relative to the variance; the first that does.
/// Beyond it, it is not the laws that rule, and the shortest times are left out.
const DISAGREEMENTS: [f64; 5] = [0.0, 0.01, 0.02, 0.05, 0.1];

/// What is said where the laws explain the variances at no times.
const NO_AGREEMENT: f64 = 1.0;

/// At so many times at least, one more than there are laws, they are compared with variances.
pub(super) const FEWEST_POINTS: usize = NoiseLaw::ALL.len() + 1;

/// The laws do not fit if one of the points is as improbable as this, all counted.
const MISFIT: f64 = 0.01;

/// The weights hang on the strengths, and settle within so many rounds.
const ROUNDS: usize = 50;

/// The noise that an Allan deviation shows.
#[derive(Clone, Debug, PartialEq)]
pub struct NoiseSeen {
    /// The deviation at each averaging time.
    pub points: Vec<AllanPoint>,
    /// The strength of each of [`NoiseLaw::ALL`].
    pub strengths: [NoiseTerm; 4],
    /// What the Allan variance is off the sum of the laws beyond chance, relative to it: zero where
    /// the laws explain it. All sigmas hold it.
    pub disagreement: f64,
    /// The averaging time from which on the laws were compared with the variance \[s\]: the shortest,
    /// if not something that follows none of them, such as a laser gyro's dither, rules there.
    pub explained_from: f64,
}

/// How strong a noise is, in the unit of its [`NoiseLaw`].
#[derive(Clone, Debug, PartialEq)]
pub enum NoiseTerm {
    /// It shows.
    Seen {
        /// The strength.
        value: f64,
        /// Its 1σ, the other laws that are seen being estimated along.
        sigma: f64,
        /// The laws that explain the same in its place: beside one of them it is not significant.
        rivals: Vec<NoiseLaw>,
    },
    /// What shows of it may be chance.
    NotSeen {
        /// It is not stronger than this, two sigma above what was found.
        below: f64,
    },
}

/// Which of the laws may be there.
type Laws = [bool; 4];

/// Finds the laws in Allan variances at these times \[s\].
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

/// The variance that a unit of each squared strength makes at each time.
fn design(times: &[f64]) -> MatrixXx4<f64> {
    MatrixXx4::from_fn(times.len(), |row, law| NoiseLaw::ALL[law].allan_variance(times[row]))
}

struct Fit<'a> {
    /// Those from the place `first` on.
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

    /// How the variances scatter under noise of these squared strengths, and off its laws.
    fn scatter(&self, squares: &Vector4<f64>) -> DMatrix<f64> {
        let all = self.covariances.of(squares);
        let mut scatter = all.view_range(self.first.., self.first..).into_owned();
        let mean = &self.design * squares;
        for (k, mean) in mean.iter().enumerate() {
            scatter[(k, k)] += (self.disagreement * mean).powi(2);
        }
        scatter
    }

    /// The squared strengths of these laws, none negative, by least squares whose weights are what
    /// the strengths found make of the scatter.
    fn solve(&self, laws: Laws) -> Vector4<f64> {
        // Each law as strong as the median of what the points allow it alone.
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

    /// Of all mixtures of these laws without a negative one, that which fits best.
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

    /// What turns variances into the squared strengths of these laws, weighted by that scatter.
    fn gain(&self, laws: Laws, scatter: &DVector<f64>) -> Option<Matrix4xX<f64>> {
        let mut whitened = self.design.clone();
        for (mut row, scatter) in whitened.row_iter_mut().zip(scatter) {
            row /= scatter.sqrt();
        }
        // To columns of length one, for the units differ; a law left out leaves a one behind.
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

    /// The squared strength of `law` that is found along with `laws`, negative ones too, and its 1σ
    /// where the noise is of the squared strengths `squares`.
    fn found(&self, laws: Laws, squares: &Vector4<f64>, law: usize) -> Option<(f64, f64)> {
        let scatter = self.scatter(squares);
        let gain = self.gain(laws, &scatter.diagonal())?;
        let value = (gain.row(law) * &self.variances).x;
        let variance = (gain.row(law) * &scatter * gain.row(law).transpose()).x;
        Some((value, variance.max(0.0).sqrt()))
    }

    /// Whether no point is improbable under these strengths.
    fn explains(&self, squares: &Vector4<f64>) -> bool {
        let mean = &self.design * squares;
        let scatter = self.scatter(squares).diagonal();
        let least = (0..mean.len())
            .map(|k| improbability(self.variances[k], mean[k], scatter[k]))
            .fold(1.0, f64::min);
        least * mean.len() as f64 > MISFIT
    }

    /// The squared strengths of the laws that chance does not explain: the least significant is
    /// left out until all are significant, or one is left.
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

    /// How strong a law is where those of `squares` are there.
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
        // The stronger it is, the more it scatters itself.
        let mut with = *squares;
        with[law] = above(squares);
        NoiseTerm::NotSeen { below: above(&with).sqrt() }
    }

    /// The laws that may stand in the place of `law` among `laws`.
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
