//! What of an estimate the data show, and what only together with other parameters.

use nalgebra::{DMatrix, DVector};
use rins_estimation::{Estimate, Fit};

/// A parameter is seen if the data bring its sigma below this part of what was known beforehand.
const SEEN: f64 = 0.5;

/// A parameter is a combination if that brings its sigma below this part.
const HELD: f64 = 0.2;

/// A partner belongs to a combination if it brings its variance down by this factor at least.
const WORTHWHILE: f64 = 1.5;

/// A combination is complete when its sigma is that near, as a ratio, to the best of all combinations.
const COMPLETE: f64 = 1.5;

/// The most partners that a combination is written with.
const MOST_PARTNERS: usize = 5;

/// What the data show of a parameter, in SI units.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Finding {
    /// Whether they show it alone.
    pub(crate) identifiable: bool,
    /// The value of what they show: the parameter, or the combination.
    pub(crate) value: f64,
    /// Its 1σ.
    pub(crate) sigma: f64,
    /// The 1σ of the parameter before.
    pub(crate) prior_sigma: f64,
    /// The other parameters of the combination: their place among all, and their coefficient.
    pub(crate) partners: Vec<(usize, f64)>,
}

/// What the data of a fit show of each of its parameters.
///
/// Where only prior knowledge of others keeps a parameter in place, it is the combination with the fewest of
/// them that the data do show: of two whose errors go together, `x - cov(x, y)/var(y) y`. What the data
/// do not show in any combination has no partners.
pub(crate) fn findings(fit: &Fit) -> Vec<Finding> {
    let unseen: Vec<bool> =
        fit.parameters.iter().map(|e| e.sigma > SEEN * e.parameter.sigma).collect();
    (0..fit.parameters.len()).map(|place| finding(fit, place, &unseen)).collect()
}

fn finding(fit: &Fit, place: usize, unseen: &[bool]) -> Finding {
    let estimate = &fit.parameters[place];
    let prior_sigma = estimate.parameter.sigma;
    let alone = Finding {
        identifiable: !unseen[place],
        value: estimate.value,
        sigma: estimate.sigma,
        prior_sigma,
        partners: Vec::new(),
    };
    // What is seen can only hold what is not.
    let others = (0..unseen.len()).filter(|&other| other != place);
    let candidates: Vec<usize> = others.filter(|&other| unseen[place] || unseen[other]).collect();
    let Some((sigma, partners)) = combination(&fit.covariance, place, &candidates) else {
        return alone;
    };
    if sigma > HELD * estimate.sigma || sigma > SEEN * prior_sigma {
        return alone;
    }
    let others = partners.iter().map(|(other, c)| c * fit.parameters[*other].value);
    let value = estimate.value + others.sum::<f64>();
    Finding { identifiable: false, value, sigma, prior_sigma, partners }
}

/// What the data show of a parameter, as a person reads it.
pub(crate) fn words(parameters: &[Estimate], findings: &[Finding], place: usize) -> String {
    let finding = &findings[place];
    if finding.identifiable {
        return "alone, by this schedule".into();
    }
    if finding.partners.is_empty() {
        return "not shown by this schedule: it is what was known before".into();
    }
    let unit = parameters[place].parameter.unit;
    let partners: Vec<String> = finding
        .partners
        .iter()
        .map(|&(other, coefficient)| {
            let other = &parameters[other].parameter;
            let share = coefficient * other.unit.factor / unit.factor;
            let sign = if share < 0.0 { "-" } else { "+" };
            let per = if unit.symbol == other.unit.symbol {
                String::new()
            } else {
                format!(" {}/({})", unit.symbol, other.unit.symbol)
            };
            format!("{sign} {}{per} x {}", figure(share.abs()), other.id)
        })
        .collect();
    let id = &parameters[place].parameter.id;
    format!(
        "only the combination {id} {}; alone {} ± {} {}",
        partners.join(" "),
        figure(parameters[place].value / unit.factor),
        figure(parameters[place].sigma / unit.factor),
        unit.symbol
    )
}

/// A number to four digits.
pub(crate) fn figure(value: f64) -> String {
    let magnitude = value.abs();
    if magnitude == 0.0 {
        "0".into()
    } else if (1e-3..1e5).contains(&magnitude) {
        let digits = (3.0 - magnitude.log10().floor()).max(0.0);
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "from 0 to 6")]
        let digits = digits as usize;
        format!("{value:.digits$}")
    } else {
        format!("{value:.3e}")
    }
}

/// The combination of the parameter at `place` with the fewest candidates that is about as well known as any,
/// and its sigma.
fn combination(
    covariance: &DMatrix<f64>,
    place: usize,
    candidates: &[usize],
) -> Option<(f64, Vec<(usize, f64)>)> {
    let n = covariance.nrows();
    let scale = DVector::from_fn(n, |row, _| covariance[(row, row)].sqrt());
    let correlation = DMatrix::from_fn(n, n, |row, column| {
        covariance[(row, column)] / (scale[row] * scale[column])
    });
    // What is left of the variance, as a share, where all candidates are known.
    let (least, _) = regressed(&correlation, place, candidates)?;
    let mut partners: Vec<usize> = Vec::new();
    let mut share = 1.0;
    while share > COMPLETE * COMPLETE * least && partners.len() < MOST_PARTNERS {
        let others = candidates.iter().copied().filter(|other| !partners.contains(other));
        let (next, after) = others
            .filter_map(|other| {
                let with: Vec<usize> = partners.iter().copied().chain([other]).collect();
                regressed(&correlation, place, &with).map(|(share, _)| (other, share))
            })
            .min_by(|a, b| a.1.total_cmp(&b.1))?;
        if after * WORTHWHILE > share {
            break;
        }
        partners.push(next);
        share = after;
    }
    if partners.is_empty() {
        return None;
    }
    let (share, coefficients) = regressed(&correlation, place, &partners)?;
    let with = partners
        .iter()
        .zip(coefficients.iter())
        .map(|(&other, coefficient)| (other, -coefficient * scale[place] / scale[other]));
    Some((share.sqrt() * scale[place], with.collect()))
}

/// The share of the variance at `place` that is left where those of `others` are known, and the regression on
/// them, of unit variances all.
fn regressed(
    correlation: &DMatrix<f64>,
    place: usize,
    others: &[usize],
) -> Option<(f64, DVector<f64>)> {
    let among = DMatrix::from_fn(others.len(), others.len(), |row, column| {
        correlation[(others[row], others[column])]
    });
    let with = DVector::from_fn(others.len(), |row, _| correlation[(others[row], place)]);
    let coefficients = among.cholesky()?.solve(&with);
    let share = 1.0 - with.dot(&coefficients);
    (share > 0.0).then_some((share, coefficients))
}

#[cfg(test)]
mod tests {
    use super::*;
    use rins_testing::assert_close;

    /// Posterior covariance of three parameters of unit priors, of which the data show `x + 2 y` to `sigma`.
    fn together(sigma: f64) -> DMatrix<f64> {
        let shown = DVector::from_vec(vec![1.0, 2.0, 0.0]);
        let information = DMatrix::identity(3, 3) + &shown * shown.transpose() / (sigma * sigma);
        information.try_inverse().unwrap()
    }

    #[test]
    fn what_goes_together_is_found_with_its_coefficient() {
        let (sigma, partners) = combination(&together(1e-3), 0, &[1, 2]).unwrap();
        assert_eq!(partners.len(), 1);
        assert_eq!(partners[0].0, 1);
        assert_close!(partners[0].1, 2.0, 1e-4);
        assert_close!(sigma, 1e-3, 1e-6);
    }

    #[test]
    fn what_goes_with_nothing_has_no_combination() {
        assert_eq!(combination(&together(1e-3), 2, &[0, 1]), None);
    }
}
