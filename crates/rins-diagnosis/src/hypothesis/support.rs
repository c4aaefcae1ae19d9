//! Which parameters of a term are not zero, and how probable that is beforehand.

use rins_terms::{Term, catalogue};

use crate::generic::waveform::is_waveform;

/// A part of a term's parameters, the others being zero.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Support {
    /// The places of the parameters.
    pub(crate) parameters: Vec<usize>,
    /// The logarithm of its prior probability.
    pub(crate) ln_prior: f64,
}

/// The supports of a term.
pub(crate) fn supports(term: &Term) -> Vec<Support> {
    let all = choices(term);
    let total: f64 = all.iter().map(|choice| (-choice.unlikely).exp()).sum();
    let of =
        |Choice { parameters, unlikely }| Support { parameters, ln_prior: -unlikely - total.ln() };
    all.into_iter().map(of).collect()
}

/// What two elements of a matrix pay beforehand that are neither of one sensor nor of the two that turn, to the same or each to
/// its own: it happens, but one thing that acts on all of these is more likely.
const SCATTERED: f64 = 3.0;

/// What tilts the base turns it about the table's axis besides, if that is not upright, but never about that alone: nobody could
/// tell this from a slip of the encoder.
pub(crate) const ABOUT_AXIS: usize = 2;

/// Which parameters of an effect may be there alone: every choice of up to three; of more, each, pairs, and all, and of a
/// matrix rows, columns, the diagonal and the first two rows. Of a cosine and a sine there are both: the phase is anyone's
/// guess.
fn choices(term: &Term) -> Vec<Choice> {
    let units = units(term);
    let of_parameters = |Choice { parameters, unlikely }| {
        let flat = parameters.into_iter().flat_map(|unit: usize| units[unit].clone());
        Choice { parameters: flat.collect(), unlikely }
    };
    if is_waveform(term) {
        // Single orders have a term of their own.
        return vec![Choice::likely((0..term.parameters.len()).collect())];
    }
    if POLYNOMIALS.iter().any(|polynomial| polynomial.is(term)) {
        return polynomials();
    }
    let tilts = term.is(&catalogue::BASE_TILT_STEP);
    let mut list: Vec<Choice> = choices_of(units.len()).into_iter().map(of_parameters).collect();
    list.retain(|choice| !(tilts && choice.parameters == [ABOUT_AXIS]));
    list
}

/// The polynomials in temperature: three coefficients of each power, the linear ones first.
static POLYNOMIALS: [&Term; 2] =
    [&catalogue::GYRO_THERMAL_POLYNOMIAL, &catalogue::ACCEL_THERMAL_POLYNOMIAL];

/// What may be there of a polynomial of three axes: on any of them all powers up to the second or up to the third. A linear one is an
/// effect of its own, and a higher power without the lower ones would depend on where zero is.
fn polynomials() -> Vec<Choice> {
    let of = |degree: usize| {
        choices_of(3).into_iter().map(move |Choice { parameters: axes, .. }| {
            let power = |power: usize| axes.iter().map(move |axis| 3 * power + axis);
            Choice::likely((0..degree).flat_map(power).collect())
        })
    };
    (2..=catalogue::THERMAL_DEGREE).flat_map(of).collect()
}

/// Parameters of an effect that may be there without the others.
#[derive(Clone, Debug, PartialEq)]
struct Choice {
    parameters: Vec<usize>,
    /// How many e-folds of odds it pays beforehand.
    unlikely: f64,
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
    fn a_polynomial_has_all_its_lower_powers() {
        let all = choices(&catalogue::GYRO_THERMAL_POLYNOMIAL);
        assert_eq!(all.len(), 14);
        assert_eq!(all[0].parameters, [0, 3]);
        assert_eq!(all[13].parameters, (0..9).collect::<Vec<_>>());
        for Choice { parameters, .. } in all {
            let lower = |&place: &usize| place < 3 || parameters.contains(&(place - 3));
            assert!(parameters.iter().all(lower), "{parameters:?}");
        }
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
