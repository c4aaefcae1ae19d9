//! The information matrix and the score of data, and the posterior with priors.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

/// The likelihood of data as a quadratic function of the parameters about the point of linearization.
#[derive(Clone, Debug, PartialEq)]
pub struct Evidence {
    /// The Fisher information, in inverse squares of the parameters' SI units.
    pub information: DMatrix<f64>,
    /// The score: the gradient of the log-likelihood.
    pub score: DVector<f64>,
    /// The sum of the squared whitened innovations.
    pub square: f64,
    /// The number of measurements.
    pub figures: usize,
    /// Half the log-determinant of the innovation covariances, summed over the epochs.
    pub log_determinant: f64,
}

impl Evidence {
    /// The evidence of no data on this number of parameters.
    pub fn none(parameters: usize) -> Self {
        Self {
            information: DMatrix::zeros(parameters, parameters),
            score: DVector::zeros(parameters),
            square: 0.0,
            figures: 0,
            log_determinant: 0.0,
        }
    }

    /// The evidence from the products of the whitened columns, with that of the residuals first.
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

    /// Adds the evidence of other data. `places` gives the place here of each of their parameters, and `signs` the factor
    /// that converts each of their parameters to the one here: 1 or -1.
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

    /// The marginal evidence on the parameters `kept`, with `others` integrated out with their priors: for each its place,
    /// `sigma`, and the mean of its prior relative to the point of linearization.
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

    /// The posterior with these priors: for each parameter its `sigma`, and the mean relative to the point of linearization.
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

    /// The log-likelihood of [`Posterior`] without its covariance, which takes most of the time.
    pub fn log_likelihood(&self, sigmas: &[f64], expected: &[f64]) -> Option<f64> {
        self.solved(sigmas, expected).map(|solved| solved.log_likelihood)
    }

    fn solved(&self, sigmas: &[f64], expected: &[f64]) -> Option<Solved> {
        // In units of the priors' sigmas, which scales parameters of different units equally.
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

/// The solution of the normal equations, in units of the priors' sigmas.
struct Solved {
    scale: DVector<f64>,
    factor: Cholesky<f64, Dyn>,
    step: DVector<f64>,
    square: f64,
    /// Half the log-determinant of the information with the priors.
    log_determinant: f64,
    log_likelihood: f64,
}

/// The posterior of the parameters.
#[derive(Clone, Debug, PartialEq)]
pub struct Posterior {
    /// The estimate relative to the point of linearization, in SI units.
    pub step: DVector<f64>,
    /// Its covariance.
    pub covariance: DMatrix<f64>,
    /// The log marginal likelihood (parameters integrated out), up to a constant.
    pub log_likelihood: f64,
    /// The sum of the squared whitened residuals of the data and of the priors at the estimate.
    pub square: f64,
}

impl Posterior {
    /// The posterior 1σ of a parameter.
    pub fn sigma(&self, parameter: usize) -> f64 {
        self.covariance[(parameter, parameter)].sqrt()
    }

    /// The correlation matrix.
    pub fn correlation(&self) -> DMatrix<f64> {
        correlation(&self.covariance)
    }
}

/// The correlation matrix of a covariance matrix.
pub fn correlation(covariance: &DMatrix<f64>) -> DMatrix<f64> {
    DMatrix::from_fn(covariance.nrows(), covariance.ncols(), |row, column| {
        if row == column {
            return 1.0;
        }
        covariance[(row, column)] / (covariance[(row, row)] * covariance[(column, column)]).sqrt()
    })
}
