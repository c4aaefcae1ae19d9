//! How well a block of parameters explains what is left, and at what price.

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use rins_terms::{Term, catalogue};

/// A direction of an effect's parameters counts as shown if its amplitude is found to this part of what is usual at least.
const LEAST_SHOWN: f64 = 1.0;

/// Up to how many times its usual amplitude an effect is as likely as any.
pub(crate) const USUAL: f64 = 3.0;

/// The least part of its usual amplitude at which an effect is looked for.
const SLIGHT: f64 = 0.003;

/// How many e-folds of odds an e-fold of amplitude beyond the usual costs ...
const UNUSUAL: f64 = 1.0;

/// ... and how many at most: less than what the unknown costs, which has no usual amplitude.
const MOST_UNUSUAL: f64 = 5.0;

/// What two elements of a matrix pay beforehand that are neither of one sensor nor of the two that turn, to the same or each to
/// its own: it happens, but one thing that acts on all of these is more likely.
const SCATTERED: f64 = 3.0;

/// What tilts the base turns it about the table's axis besides, if that is not upright, but never about that alone: nobody could
/// tell this from a slip of the encoder.
pub(crate) const ABOUT_AXIS: usize = 2;

/// What data say of some parameters of an effect.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Score {
    /// The amplitudes, in units of what is usual of them; of what is not shown they are nothing.
    pub(crate) estimate: DVector<f64>,
    /// By how much the squares would fall: a chi-square of `dof` degrees if the effect is not there.
    pub(crate) statistic: f64,
    /// How many directions of the parameters are shown.
    pub(crate) dof: usize,
    /// The logarithm of the odds for it over nothing, whatever its amplitude within what is usual.
    pub(crate) evidence: f64,
    /// What of these it lost by being smaller than what is looked for.
    pub(crate) slight: f64,
    /// The largest of the amplitudes, in units of what is usual of it.
    pub(crate) amplitude: f64,
}

/// Scores a block: information and score in units of the usual amplitudes.
///
/// The scale of an amplitude is unknown over decades, so that it is expected to be what it seems to be: an
/// estimate costs the logarithm of how much more precise it is than that, whatever unit or grade. What is more than
/// usual costs more, but is not ruled out: nature is not bound by a table.
pub(crate) fn scored(information: &DMatrix<f64>, score: &DVector<f64>) -> Score {
    let SymmetricEigen { eigenvalues, eigenvectors } = SymmetricEigen::new(information.clone());
    let mut shown = Vec::new();
    let estimate = DVector::zeros(score.len());
    let mut sum =
        Score { estimate, statistic: 0.0, dof: 0, evidence: 0.0, slight: 0.0, amplitude: 0.0 };
    for (value, direction) in eigenvalues.iter().zip(eigenvectors.column_iter()) {
        if value * USUAL * USUAL > LEAST_SHOWN {
            let along = direction.dot(score);
            sum.estimate += direction * (along / value);
            sum.statistic += along * along / value;
            sum.dof += 1;
            shown.push(*value);
        }
    }
    sum.amplitude = sum.estimate.amax();
    let scale = sum.amplitude.max(SLIGHT);
    let precision = |scale: f64| -> f64 {
        shown.iter().map(|value| 0.5 * (1.0 + value * scale * scale).ln()).sum()
    };
    let unusual = UNUSUAL * (scale / USUAL).ln().max(0.0);
    sum.evidence = 0.5 * sum.statistic - precision(scale) - unusual.min(MOST_UNUSUAL);
    sum.slight = precision(scale) - precision(sum.amplitude);
    sum
}

/// Which parameters of an effect may be there alone: every choice of up to three; of more, each, pairs, and all, and of a
/// matrix rows, columns, the diagonal and the first two rows. Of a cosine and a sine there are both: the phase is anyone's
/// guess.
pub(crate) fn choices(term: &Term) -> Vec<Choice> {
    let units = units(term);
    let of_parameters = |Choice { parameters, unlikely }| {
        let flat = parameters.into_iter().flat_map(|unit: usize| units[unit].clone());
        Choice { parameters: flat.collect(), unlikely }
    };
    let tilts = term.is(&catalogue::BASE_TILT_STEP);
    let mut list: Vec<Choice> = choices_of(units.len()).into_iter().map(of_parameters).collect();
    list.retain(|choice| !(tilts && choice.parameters == [ABOUT_AXIS]));
    list
}

/// Parameters of an effect that may be there without the others.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Choice {
    pub(crate) parameters: Vec<usize>,
    /// How many e-folds of odds it pays beforehand.
    pub(crate) unlikely: f64,
}

impl Choice {
    /// Any but two elements that have little in common.
    const fn likely(parameters: Vec<usize>) -> Self {
        Self { parameters, unlikely: 0.0 }
    }

    /// Two among `n`, in rows of so many.
    fn pair(one: usize, other: usize, row: usize) -> Self {
        let turning = one < row && (row..2 * row).contains(&other);
        let alike = other - one == row || (one, other) == (0, row + 1);
        let has_in_common = one / row == other / row || (turning && alike);
        let unlikely = if has_in_common { 0.0 } else { SCATTERED };
        Self { parameters: vec![one, other], unlikely }
    }
}

/// The parameters of an effect, a cosine and its sine together.
fn units(term: &Term) -> Vec<Vec<usize>> {
    let mut units: Vec<Vec<usize>> = Vec::new();
    for (place, parameter) in term.parameters.iter().enumerate() {
        let sine = parameter.name.ends_with("sin");
        match units.last_mut() {
            Some(unit) if sine => unit.push(place),
            _ => units.push(vec![place]),
        }
    }
    units
}

/// The choices among `n`.
fn choices_of(n: usize) -> Vec<Choice> {
    if n <= 3 {
        let some = |bits: usize| (0..n).filter(|place| bits >> place & 1 == 1).collect();
        return (1..1_usize << n).map(|bits| Choice::likely(some(bits))).collect();
    }
    let row = if n.is_multiple_of(3) { n / 3 } else { n };
    let mut all: Vec<Choice> = (0..n).map(|place| Choice::likely(vec![place])).collect();
    for one in 0..n {
        all.extend((one + 1..n).map(|other| Choice::pair(one, other, row)));
    }
    let mut together: Vec<Vec<usize>> = Vec::new();
    if row < n {
        if row > 2 {
            together.extend((0..n).step_by(row).map(|first| (first..first + row).collect()));
        }
        // One thing, a component of gravity or of a field, may act on all three sensors, ...
        together.extend((0..row).map(|column| (column..n).step_by(row).collect()));
        // ... each sensor to what is along it, or those that turn to all.
        together.extend((row == 3).then(|| (0..n).step_by(row + 1).collect()));
        together.push((0..2 * row).collect());
    }
    together.push((0..n).collect());
    all.extend(together.into_iter().map(Choice::likely));
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use rins_testing::assert_close;

    /// One parameter: the statistic is the square of the estimate over its sigma.
    #[test]
    fn statistic_is_the_square_of_the_estimate_in_sigmas() {
        let sigma = 0.02;
        let information = DMatrix::from_element(1, 1, 1.0 / (sigma * sigma));
        for estimate in [0.05, 0.5, 40.0] {
            let score = DVector::from_element(1, estimate / (sigma * sigma));
            let scored = scored(&information, &score);
            assert_close!(scored.statistic, (estimate / sigma).powi(2), 1e-9 * scored.statistic);
            assert_eq!(scored.dof, 1);
        }
    }

    #[test]
    fn what_data_do_not_show_counts_for_nothing() {
        let information = DMatrix::from_diagonal(&DVector::from_column_slice(&[1e4, 1e-3]));
        let score = DVector::from_column_slice(&[300.0, 1e-3]);
        let scored = scored(&information, &score);
        assert_eq!(scored.dof, 1);
        assert_close!(scored.statistic, 9.0, 1e-9);
    }

    /// Of two effects that explain the same, it counts which is as large as usual, and not how wide that is.
    #[test]
    fn a_usual_amplitude_is_cheaper_than_an_unusual_one() {
        // The same signal to noise, the usual amplitude being so much smaller than what is found.
        let at = |amplitude: f64| {
            let information = DMatrix::from_element(1, 1, (3e3 / amplitude).powi(2));
            let score = &information * DVector::from_element(1, amplitude);
            scored(&information, &score).evidence
        };
        assert_close!(at(0.03), at(1.0), 1e-6);
        assert_close!(at(3.0) - at(30.0), UNUSUAL * 10.0_f64.ln(), 1e-6);
        assert_close!(at(3.0) - at(1e3), MOST_UNUSUAL, 1e-6);
    }

    /// What a latency of microseconds loses against one of milliseconds that shows as well is known.
    #[test]
    fn what_is_too_small_to_be_looked_for_says_what_it_lost_by_that() {
        let at = |amplitude: f64| {
            let information = DMatrix::from_element(1, 1, (3e3 / amplitude).powi(2));
            let score = &information * DVector::from_element(1, amplitude);
            scored(&information, &score)
        };
        let (slight, usual) = (at(1e-4 * SLIGHT), at(0.03));
        assert_close!(usual.slight, 0.0, 1e-12);
        assert_close!(slight.slight, 1e4_f64.ln(), 1e-6);
        assert_close!(slight.evidence + slight.slight, usual.evidence, 1e-6);
    }

    #[test]
    fn a_cosine_is_not_there_without_its_sine() {
        let of = |term| choices(term).into_iter().map(|choice| choice.parameters);
        assert!(of(&catalogue::ENCODER_ECCENTRICITY).eq([[0, 1]]));
        assert!(of(&catalogue::INTERFERENCE_LINE).eq([vec![0, 1], vec![2, 3], vec![0, 1, 2, 3]]));
        let (xy, xz, yz) = (vec![0, 1, 2, 3], vec![0, 1, 4, 5], vec![2, 3, 4, 5]);
        let [x, y, z] = [vec![0, 1], vec![2, 3], vec![4, 5]];
        assert!(of(&catalogue::BASE_SWAY).eq([x, y, xy, z, xz, yz, (0..6).collect()]));
        assert!(of(&catalogue::BASE_TILT_STEP).eq([
            vec![0],
            vec![1],
            vec![0, 1],
            vec![0, 2],
            vec![1, 2],
            vec![0, 1, 2]
        ]));
        assert_eq!(choices(&catalogue::ACCEL_LEVER_ARM).len(), 3);
    }

    #[test]
    fn choices_are_distinct_and_within_the_term() {
        for n in [1, 2, 3, 4, 6, 9, 18] {
            let all = choices_of(n);
            for (place, Choice { parameters, .. }) in all.iter().enumerate() {
                assert!(parameters.iter().all(|&parameter| parameter < n));
                assert!(parameters.is_sorted());
                let is_same = |other: &Choice| other.parameters == *parameters;
                assert!(!all[..place].iter().any(is_same), "{n}: {parameters:?}");
            }
            assert_eq!(all.last().map(|choice| choice.parameters.len()), Some(n));
        }
    }
}
