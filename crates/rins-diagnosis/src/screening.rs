//! One pass over a run tells of all candidates at once how much better each would explain it.

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use rins_estimation::{Evidence, Fit, Indefinite, Noise, Run, linearise};
use rins_imu::ImuSpec;
use rins_terms::Free;

use crate::candidates::Candidate;
use crate::probability::ln_tail;

/// A direction of a candidate's parameters counts if the data say a hundredth of what is known
/// of it anyway.
const LEAST_INFORMATION: f64 = 0.01;

/// What a run says of a candidate.
#[derive(Clone, Debug, PartialEq)]
pub struct Screened {
    /// Which candidate.
    pub candidate: usize,
    /// By how much the squares would fall: chi-square of `dof` degrees if the candidate is not there.
    pub statistic: f64,
    /// How many directions of its parameters the run shows; none is "not testable".
    pub dof: usize,
    /// The logarithm of the probability of so large a statistic by chance, for all shapes of the candidate.
    pub ln_p: f64,
    /// The logarithm of the odds for it, its amplitude expected to be usual, its shape unknown.
    pub evidence: f64,
    /// The logarithm of how much smaller than usual amplitudes those are that the data leave open: what
    /// an estimate costs in evidence.
    pub occam: f64,
}

/// What a fitted run says of every candidate.
///
/// # Errors
/// [`Indefinite`] if the noise makes no covariance.
pub fn screen(
    run: &Run,
    fit: &Fit,
    imu: &ImuSpec,
    noise: &Noise,
    candidates: &[Candidate],
) -> Result<Vec<Screened>, Indefinite> {
    let baseline = fit.model();
    let mut model = baseline.clone();
    model.terms.extend(candidates.iter().map(|candidate| candidate.chosen.clone()));
    let free = model.free(imu);
    let places: Vec<(usize, usize)> = free.iter().map(|f| (f.term, f.parameter)).collect();
    let linear = linearise(run, &model, &places);
    let evidence = Evidence::of(&linear, noise)?;
    let known = free.iter().filter(|f| f.term < baseline.terms.len()).count();
    let (information, score) = beyond_baseline(&evidence, &free, fit, known);
    Ok((0..candidates.len())
        .map(|candidate| {
            let term = baseline.terms.len() + candidate;
            let own: Vec<usize> =
                (0..free.len() - known).filter(|&i| free[known + i].term == term).collect();
            let looks = candidates[candidate].looks;
            screened(candidate, &information, &score, &own, looks)
        })
        .collect())
}

/// Information and score of the candidates' parameters in units of their priors, the baseline's estimated beside.
fn beyond_baseline(
    evidence: &Evidence,
    free: &[Free],
    fit: &Fit,
    known: usize,
) -> (DMatrix<f64>, DVector<f64>) {
    let scale = DVector::from_iterator(free.len(), free.iter().map(|f| f.sigma));
    let information = DMatrix::from_fn(free.len(), free.len(), |row, column| {
        evidence.information[(row, column)] * scale[row] * scale[column]
    });
    let score = evidence.score.component_mul(&scale);
    let rest = free.len() - known;
    let mut corner = information.view((0, 0), (known, known)).into_owned();
    for place in 0..known {
        corner[(place, place)] += 1.0;
    }
    // At the fit the baseline's own score and its priors' pull cancel.
    let pull = DVector::from_fn(known, |place, _| {
        let estimate = &fit.parameters[place];
        (estimate.expected - estimate.value) / scale[place]
    });
    let left = score.rows(0, known) + pull;
    let across = information.view((0, known), (known, rest)).into_owned();
    let Some(factor) = corner.cholesky() else {
        return (DMatrix::zeros(rest, rest), DVector::zeros(rest));
    };
    let solved = factor.solve(&across);
    let reduced = information.view((known, known), (rest, rest)) - across.transpose() * &solved;
    (reduced, score.rows(known, rest) - solved.transpose() * left)
}

fn screened(
    candidate: usize,
    information: &DMatrix<f64>,
    score: &DVector<f64>,
    own: &[usize],
    looks: f64,
) -> Screened {
    let block = DMatrix::from_fn(own.len(), own.len(), |r, c| information[(own[r], own[c])]);
    let score = DVector::from_fn(own.len(), |r, _| score[own[r]]);
    let SymmetricEigen { eigenvalues, eigenvectors } = SymmetricEigen::new(block);
    let (mut statistic, mut evidence, mut occam, mut dof) = (0.0, 0.0, 0.0, 0);
    for (value, direction) in eigenvalues.iter().zip(eigenvectors.column_iter()) {
        if *value > LEAST_INFORMATION {
            let square = direction.dot(&score).powi(2) / value;
            statistic += square;
            // Within its prior the estimate is drawn towards zero.
            evidence += 0.5 * square * value / (1.0 + value) - 0.5 * (1.0 + value).ln();
            occam += 0.5 * (1.0 + value).ln();
            dof += 1;
        }
    }
    let ln_p = if dof == 0 { 0.0 } else { (ln_tail(statistic, dof) + looks.ln()).min(0.0) };
    Screened { candidate, statistic, dof, ln_p, evidence: evidence - looks.ln(), occam }
}
