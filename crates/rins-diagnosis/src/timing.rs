//! How finely runs tell when something happened: at how many times it could have been found.

use nalgebra::{Cholesky, DMatrix};
use rins_estimation::{Fit, Indefinite};
use rins_terms::Chosen;

use crate::candidates::{Candidate, EVENTS};
use crate::case::Case;
use crate::suggested::LOOKS;
use crate::survey::Survey;

impl Case<'_> {
    /// Of each of the effects that were found, among how many more of its kind than are always tried: a line among all
    /// frequencies, an event among all times that the runs tell apart, which what is over within an epoch could have had in each.
    pub(crate) fn found_among(
        &self,
        present: &Fit,
        found: &[Chosen],
    ) -> Result<Vec<f64>, Indefinite> {
        let of = |(index, cause): (usize, &Chosen)| match cause.term.setting("time") {
            Some(place) => self.times_of(present, index, cause, place),
            None if has_frequency(cause) => Ok(LOOKS * epochs(present)),
            None => Ok(1.0),
        };
        found.iter().enumerate().map(of).collect()
    }

    fn times_of(
        &self,
        present: &Fit,
        index: usize,
        cause: &Chosen,
        place: usize,
    ) -> Result<f64, Indefinite> {
        let epochs = epochs(present);
        let list = [0.0, present.linear[0].mean_epoch()]
            .map(|later| Candidate::beside(cause, place, later));
        let noises = std::slice::from_ref(&present.noise);
        let survey = Survey::of(self.runs, present, self.imu, &list, noises)?;
        let own = survey.of_term(self.given.terms.len() + index).concat();
        let likeness = survey.left(0, &own, &[]).and_then(|left| {
            let places: Vec<usize> =
                (0..2).flat_map(|candidate| survey.of_candidate(candidate).concat()).collect();
            likeness(&left.block(&places).0)
        });
        let always = f64::from(EVENTS);
        let times = likeness.map_or(always, |likeness| -likeness.ln() * epochs);
        Ok(times.min(epochs).max(always) / always)
    }
}

/// Whether an effect is a line of any frequency.
pub(crate) fn has_frequency(chosen: &Chosen) -> bool {
    chosen.term.setting("frequency").is_some()
}

fn epochs(fit: &Fit) -> f64 {
    fit.linear.iter().map(|run| run.epochs() as f64).sum()
}

/// The correlation of what is shown of the first half of some parameters with what is of the second, root mean square over their
/// directions; none if something is not shown at all.
fn likeness(information: &DMatrix<f64>) -> Option<f64> {
    let half = information.nrows() / 2;
    let block = |row: usize, column: usize| {
        information.view((row * half, column * half), (half, half)).into_owned()
    };
    let one = Cholesky::new(block(0, 0))?.solve(&block(0, 1));
    let other = Cholesky::new(block(1, 1))?.solve(&block(1, 0));
    let square = (one * other).trace() / half as f64;
    (half > 0).then(|| square.sqrt().min(1.0))
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::DVector;
    use rins_testing::assert_close;

    #[test]
    fn likeness_is_one_of_the_same_and_none_of_what_has_nothing_in_common() {
        let apart = DMatrix::from_diagonal(&DVector::from_row_slice(&[1.0, 4.0, 2.0, 3.0]));
        assert_eq!(likeness(&apart), Some(0.0));
        let shape = DMatrix::from_row_slice(2, 2, &[2.0, 0.5, 0.5, 1.0]);
        let with = |correlation: f64| {
            DMatrix::from_fn(4, 4, |row, column| {
                let common = if row / 2 == column / 2 { 1.0 } else { correlation };
                common * shape[(row % 2, column % 2)]
            })
        };
        assert_close!(likeness(&with(1.0)).unwrap(), 1.0, 1e-12);
        assert_close!(likeness(&with(0.6)).unwrap(), 0.6, 1e-12);
        assert_eq!(likeness(&DMatrix::zeros(4, 4)), None);
    }
}
