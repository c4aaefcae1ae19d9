//! What all runs say of amplitudes: the same sums for every hypothesis.

use nalgebra::{Cholesky, DMatrix, DVector, Dyn};

use crate::run_estimate::RunEstimate;

/// The 1σ of a parameter's mean over all runs, in units of its largest typical variation: so wide that it says nothing.
pub(crate) const WIDE: f64 = 1e4;

/// A block of amplitudes of one parameter.
#[derive(Clone, Debug)]
pub(crate) struct Amplitudes {
    /// Which parameter.
    pub(crate) quantity: usize,
    /// What one of each amplitude adds to it, a row for each run.
    pub(crate) columns: DMatrix<f64>,
}

/// Estimates of all runs in units of the largest typical variation of each parameter, about a mean of all runs.
#[derive(Clone, Debug)]
pub(crate) struct Information {
    /// The unit of each parameter.
    pub(crate) units: Vec<f64>,
    /// A value of each parameter about which the numbers are.
    pub(crate) about: Vec<f64>,
    /// The information of each run.
    of_runs: Vec<DMatrix<f64>>,
    /// The score of each run.
    score: Vec<DVector<f64>>,
}

/// What all runs say of the means of all parameters and of blocks of amplitudes, without a prior.
#[derive(Clone, Debug)]
pub(crate) struct Gram {
    /// The means, one block each, and then the amplitudes.
    blocks: Vec<Amplitudes>,
    /// Where each block starts, and where the last one ends.
    starts: Vec<usize>,
    /// How many of the blocks are means.
    means: usize,
    information: DMatrix<f64>,
    score: DVector<f64>,
}

/// What is known of amplitudes and means together, given the scales.
pub(crate) struct Solution<'a> {
    gram: &'a Gram,
    /// The information with the prior's, factored.
    factor: Cholesky<f64, Dyn>,
    estimate: DVector<f64>,
    /// The logarithm of the marginal likelihood, but for a constant.
    pub(crate) ln_marginal: f64,
}

impl Information {
    /// The estimates in units of the typical variations.
    pub(crate) fn of(runs: &[RunEstimate], units: Vec<f64>) -> Self {
        let n = units.len();
        let scaled = |run: &RunEstimate| {
            DMatrix::from_fn(n, n, |a, b| run.information[(a, b)] * units[a] * units[b])
        };
        let information: Vec<DMatrix<f64>> = runs.iter().map(scaled).collect();
        let scores: Vec<DVector<f64>> =
            runs.iter().map(|run| DVector::from_fn(n, |a, _| run.score[a] * units[a])).collect();
        // About a common value, so that large values with small variations keep their digits.
        let total = information.iter().fold(DMatrix::zeros(n, n), |sum, one| sum + one);
        let pulled = scores.iter().fold(DVector::zeros(n), |sum: DVector<f64>, one| sum + one);
        let weak = DMatrix::from_diagonal(&total.diagonal().map(|x| WEAK * x + f64::MIN_POSITIVE));
        let common = Cholesky::new(&total + weak)
            .map_or_else(|| DVector::zeros(n), |factor| factor.solve(&pulled));
        let score = scores.iter().zip(&information).map(|(score, own)| score - own * &common);
        let score = score.collect();
        let about = common.iter().zip(&units).map(|(value, unit)| value * unit).collect();
        Self { units, about, of_runs: information, score }
    }

    /// Whether any run says anything of a parameter.
    pub(crate) fn sees(&self, quantity: usize) -> bool {
        self.of_runs.iter().any(|one| one[(quantity, quantity)] > 0.0)
    }

    /// The information between two blocks of amplitudes.
    fn between(&self, one: &Amplitudes, other: &Amplitudes) -> DMatrix<f64> {
        let mut sum = DMatrix::zeros(one.columns.ncols(), other.columns.ncols());
        for (run, information) in self.of_runs.iter().enumerate() {
            let weight = information[(one.quantity, other.quantity)];
            if weight != 0.0 {
                sum.ger(
                    weight,
                    &one.columns.row(run).transpose(),
                    &other.columns.row(run).transpose(),
                    1.0,
                );
            }
        }
        sum
    }

    /// The score of a block of amplitudes.
    fn score(&self, one: &Amplitudes) -> DVector<f64> {
        let mut sum = DVector::zeros(one.columns.ncols());
        for (run, score) in self.score.iter().enumerate() {
            sum.axpy(score[one.quantity], &one.columns.row(run).transpose(), 1.0);
        }
        sum
    }

    /// What the runs say of the means and of these blocks.
    pub(crate) fn gram(&self, amplitudes: impl Iterator<Item = Amplitudes>) -> Gram {
        let (runs, means) = (self.of_runs.len(), self.units.len());
        let columns = DMatrix::from_element(runs, 1, 1.0);
        let mean = |quantity: usize| Amplitudes { quantity, columns: columns.clone() };
        let blocks: Vec<Amplitudes> = (0..means).map(mean).chain(amplitudes).collect();
        let mut starts = vec![0];
        for one in &blocks {
            starts.push(starts[starts.len() - 1] + one.columns.ncols());
        }
        let size = starts[blocks.len()];
        let mut information = DMatrix::zeros(size, size);
        let mut score = DVector::zeros(size);
        for (a, one) in blocks.iter().enumerate() {
            for (b, other) in blocks.iter().enumerate().take(a + 1) {
                let part = self.between(one, other);
                information.view_mut((starts[a], starts[b]), part.shape()).copy_from(&part);
                let part = part.transpose();
                information.view_mut((starts[b], starts[a]), part.shape()).copy_from(&part);
            }
            score.rows_mut(starts[a], one.columns.ncols()).copy_from(&self.score(one));
        }
        Gram { blocks, starts, means, information, score }
    }

    /// The information and the score of a further block when all others, solved, are estimated too.
    pub(crate) fn beside(
        &self,
        further: &Amplitudes,
        others: &Solution<'_>,
    ) -> (DMatrix<f64>, DVector<f64>) {
        let Gram { blocks, starts, .. } = others.gram;
        let mut across = DMatrix::zeros(others.estimate.len(), further.columns.ncols());
        for (one, &start) in blocks.iter().zip(starts) {
            let part = self.between(one, further);
            across.view_mut((start, 0), part.shape()).copy_from(&part);
        }
        let explained = others.factor.solve(&across);
        let information = self.between(further, further) - across.tr_mul(&explained);
        let score = self.score(further) - across.tr_mul(&others.estimate);
        (0.5 * (&information + information.transpose()), score)
    }
}

impl Gram {
    /// The 1σ of every mean and amplitude, given the scale of each block of amplitudes.
    fn scales(&self, scales: &[f64]) -> impl Iterator<Item = f64> {
        let of_blocks = std::iter::repeat_n(WIDE, self.means).chain(scales.iter().copied());
        of_blocks
            .zip(&self.blocks)
            .flat_map(|(scale, block)| std::iter::repeat_n(scale, block.columns.ncols()))
    }

    /// The estimate of the means and the amplitudes with these scales.
    ///
    /// `None` if the information on them is not finite.
    pub(crate) fn solved(&self, scales: &[f64]) -> Option<Solution<'_>> {
        let mut information = self.information.clone();
        let mut ln_scales = 0.0;
        for (place, scale) in self.scales(scales).enumerate() {
            information[(place, place)] += scale.powi(-2);
            ln_scales += scale.ln();
        }
        let factor = Cholesky::new(information)?;
        let estimate = factor.solve(&self.score);
        let ln_det: f64 = factor.l_dirty().diagonal().iter().map(|x| x.ln()).sum();
        let ln_marginal = 0.5 * self.score.dot(&estimate) - ln_det - ln_scales;
        ln_marginal.is_finite().then_some(Solution { gram: self, factor, estimate, ln_marginal })
    }

    /// The information and the score of one block of amplitudes when all others are estimated too, with these scales.
    ///
    /// `None` if the information on the others is not finite.
    pub(crate) fn alone(
        &self,
        block: usize,
        scales: &[f64],
    ) -> Option<(DMatrix<f64>, DVector<f64>)> {
        let own = self.starts[self.means + block]..self.starts[self.means + block + 1];
        let all: Vec<f64> = self.scales(scales).collect();
        let others: Vec<usize> = (0..all.len()).filter(|place| !own.contains(place)).collect();
        let mut information = self.information.select_rows(&others).select_columns(&others);
        for (at, &place) in others.iter().enumerate() {
            information[(at, at)] += all[place].powi(-2);
        }
        let score = DVector::from_iterator(others.len(), others.iter().map(|&at| self.score[at]));
        let own: Vec<usize> = own.collect();
        let across = self.information.select_rows(&others).select_columns(&own);
        let factor = Cholesky::new(information)?;
        let explained = factor.solve(&across);
        let corner = self.information.select_rows(&own).select_columns(&own);
        let information = corner - across.tr_mul(&explained);
        let pull = DVector::from_iterator(own.len(), own.iter().map(|&at| self.score[at]));
        let score = pull - explained.tr_mul(&score);
        Some((0.5 * (&information + information.transpose()), score))
    }
}

/// The part of the information that a common value may be known by without any run.
const WEAK: f64 = 1e-9;

impl Solution<'_> {
    /// The mean and the variance of a parameter in a run.
    pub(crate) fn parameter(&self, quantity: usize, run: usize) -> (f64, f64) {
        let mut row = DVector::zeros(self.estimate.len());
        let Gram { blocks, starts, means, .. } = self.gram;
        row[quantity] = 1.0;
        for (one, &start) in blocks.iter().zip(starts).skip(*means) {
            if one.quantity == quantity {
                let values = one.columns.row(run).transpose();
                row.rows_mut(start, values.len()).copy_from(&values);
            }
        }
        (row.dot(&self.estimate), row.dot(&self.factor.solve(&row)))
    }

    /// The estimates and the variances of one block of amplitudes.
    pub(crate) fn block(&self, block: usize) -> Vec<(f64, f64)> {
        let Gram { starts, means, .. } = self.gram;
        let places = starts[means + block]..starts[means + block + 1];
        let variances = self.factor.inverse().diagonal();
        places.map(|place| (self.estimate[place], variances[place])).collect()
    }
}
