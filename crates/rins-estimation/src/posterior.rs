//! Information and score, and the estimate that they and prior knowledge make.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// What data say of parameters about the values where they were made linear.
#[derive(Clone, Debug, PartialEq)]
pub struct Evidence {
    /// The Fisher information, in inverse squares of the parameters' SI units.
    pub information: DMatrix<f64>,
    /// The derivative of the log-likelihood.
    pub score: DVector<f64>,
    /// The sum of the squared whitened innovations.
    pub square: f64,
    /// How many figures the data hold.
    pub figures: usize,
    /// Half the logarithm of the determinant of the innovations' covariances, summed up.
    pub log_determinant: f64,
}

impl Evidence {
    /// Of no data on `parameters` of them.
    pub fn none(parameters: usize) -> Self {
        Self {
            information: DMatrix::zeros(parameters, parameters),
            score: DVector::zeros(parameters),
            square: 0.0,
            figures: 0,
            log_determinant: 0.0,
        }
    }

    /// From the products of the whitened columns, that of the residuals first.
    pub(crate) fn from_products(
        products: &DMatrix<f64>,
        figures: usize,
        log_determinant: f64,
    ) -> Self {
        let p = products.ncols() - 1;
        Self {
            information: products.view((1, 1), (p, p)).into_owned(),
            score: -products.view((1, 0), (p, 1)).column(0),
            square: products[(0, 0)],
            figures,
            log_determinant,
        }
    }

    /// Adds what other data say; `places` says which parameter here each of theirs is, and `signs` what each of theirs is
    /// multiplied by to be that: 1 or -1.
    pub fn add(&mut self, other: &Self, places: &[usize], signs: &[f64]) {
        for (row, &to_row) in places.iter().enumerate() {
            self.score[to_row] += signs[row] * other.score[row];
            for (column, &to_column) in places.iter().enumerate() {
                let product = signs[row] * signs[column];
                self.information[(to_row, to_column)] += product * other.information[(row, column)];
            }
        }
        self.square += other.square;
        self.figures += other.figures;
        self.log_determinant += other.log_determinant;
    }

    /// What is said of the parameters `kept`, those in `others` integrated out with their priors: each one's place, `sigma`, and how
    /// far its expected value is from where the data were made linear.
    ///
    /// `None` if the information is not finite.
    pub(crate) fn marginal(&self, kept: &[usize], others: &[(usize, f64, f64)]) -> Option<Self> {
        let places: Vec<usize> = others.iter().map(|&(place, ..)| place).collect();
        let block = |rows: &[usize], columns: &[usize]| {
            DMatrix::from_fn(rows.len(), columns.len(), |row, column| {
                self.information[(rows[row], columns[column])]
            })
        };
        let score = |places: &[usize]| {
            DVector::from_iterator(places.len(), places.iter().map(|&place| self.score[place]))
        };
        let of_others =
            Self { information: block(&places, &places), score: score(&places), ..self.clone() };
        let (sigmas, expected): (Vec<f64>, Vec<f64>) =
            others.iter().map(|&(_, sigma, expected)| (sigma, expected)).unzip();
        let Solved { scale, factor, step, square, log_determinant, .. } =
            of_others.solved(&sigmas, &expected)?;
        let across = DMatrix::from_diagonal(&scale) * block(&places, kept);
        Some(Self {
            information: block(kept, kept) - across.tr_mul(&factor.solve(&across)),
            score: score(kept) - across.tr_mul(&step),
            square,
            figures: self.figures,
            log_determinant: self.log_determinant + log_determinant,
        })
    }

    /// The estimate with these priors: each parameter's `sigma`, and how far its expected value is from
    /// where the data were made linear.
    ///
    /// `None` if the information is not finite.
    pub fn posterior(&self, sigmas: &[f64], expected: &[f64]) -> Option<Posterior> {
        let Solved { scale, factor, step, square, log_likelihood, .. } =
            self.solved(sigmas, expected)?;
        let inverse = factor.inverse();
        let p = sigmas.len();
        let covariance = DMatrix::from_fn(p, p, |row, column| {
            inverse[(row, column)] * scale[row] * scale[column]
        });
        Some(Posterior { step: step.component_mul(&scale), covariance, log_likelihood, square })
    }

    /// The log-likelihood of [`Posterior`], without its covariance, which takes most of the time.
    pub fn log_likelihood(&self, sigmas: &[f64], expected: &[f64]) -> Option<f64> {
        self.solved(sigmas, expected).map(|solved| solved.log_likelihood)
    }

    fn solved(&self, sigmas: &[f64], expected: &[f64]) -> Option<Solved> {
        // In units of the priors' sigmas, so that kinds with different units do not drown each other.
        let scale = DVector::from_column_slice(sigmas);
        let p = sigmas.len();
        let scaled = DMatrix::from_fn(p, p, |row, column| {
            self.information[(row, column)] * scale[row] * scale[column]
                + if row == column { 1.0 } else { 0.0 }
        });
        let offset = DVector::from_fn(p, |row, _| expected[row] / scale[row]);
        let right = self.score.component_mul(&scale) + &offset;
        let factor = Cholesky::new(scaled)?;
        let step = factor.solve(&right);
        let log_determinant: f64 = factor.l_dirty().diagonal().iter().map(|x| x.ln()).sum();
        let square = self.square + offset.norm_squared() - right.dot(&step);
        let log_likelihood = -0.5 * square - self.log_determinant - log_determinant;
        Some(Solved { scale, factor, step, square, log_determinant, log_likelihood })
    }
}

/// What an estimate follows from, in units of the priors' sigmas.
struct Solved {
    scale: DVector<f64>,
    factor: Cholesky<f64, Dyn>,
    step: DVector<f64>,
    square: f64,
    /// Half the logarithm of the determinant of information and priors.
    log_determinant: f64,
    log_likelihood: f64,
}

/// An estimate.
#[derive(Clone, Debug, PartialEq)]
pub struct Posterior {
    /// From where the data were made linear to the estimate, in SI units.
    pub step: DVector<f64>,
    /// Its covariance.
    pub covariance: DMatrix<f64>,
    /// The logarithm of the probability of the data, the parameters integrated out, but for a constant.
    pub log_likelihood: f64,
    /// The squares that are left: of the data's residuals, and of the estimate against its priors.
    pub square: f64,
}

impl Posterior {
    /// The 1σ of a parameter.
    pub fn sigma(&self, parameter: usize) -> f64 {
        self.covariance[(parameter, parameter)].sqrt()
    }

    /// The correlation matrix.
    pub fn correlation(&self) -> DMatrix<f64> {
        correlation(&self.covariance)
    }
}

/// The correlations of a covariance matrix.
pub fn correlation(covariance: &DMatrix<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(covariance.nrows(), covariance.ncols(), |row, column| {
        if row == column {
            return 1.0;
        }
        covariance[(row, column)] / (covariance[(row, row)] * covariance[(column, column)]).sqrt()
    })
}
