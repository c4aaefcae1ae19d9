//! How finely runs tell when something happened: at how many times it could have been found.

use nalgebra::{Cholesky, DMatrix};
use rins_estimation::{Fit, Indefinite};
use rins_terms::{SettingKind, Term, TermInstance};

use crate::candidates::Candidate;
use crate::case::Case;
use crate::suggested::LOOKS;

impl Case<'_> {
    /// Of each of the effects that were found, among how many more of its kind than are always tried: a line among all
    /// frequencies, an event among all times that the runs tell apart, which what is over within an epoch could have had in each.
    pub(crate) fn found_among(
        &self,
        present: &Fit,
        found: &[TermInstance],
    ) -> Result<Vec<f64>, Indefinite> {
        let epochs: f64 = present.linear.iter().map(|run| run.epochs() as f64).sum();
        let of_lines = |cause: &TermInstance| {
            if has_frequency(cause.term) { LOOKS * epochs } else { 1.0 }
        };
        let mut among: Vec<f64> = found.iter().map(of_lines).collect();
        let events: Vec<(usize, usize)> = (0..found.len())
            .filter_map(|index| Some((index, found[index].term.setting(SettingKind::Time)?)))
            .collect();
        if events.is_empty() {
            return Ok(among);
        }
        // Every event as it was found, and an epoch later.
        let epoch = present.linear[0].mean_epoch();
        let twice = |&(index, time): &(usize, usize)| {
            [0.0, epoch].map(|later| Candidate::beside(&found[index], time, later))
        };
        let list: Vec<Candidate> = events.iter().flat_map(twice).collect();
        let survey = self.survey(present, &list, std::slice::from_ref(&present.noise))?;
        let always = f64::from(SettingKind::EVENT_TIMES);
        for (event, (index, _)) in events.into_iter().enumerate() {
            let own = survey.of_term(self.given.terms.len() + index).concat();
            let likeness = survey.left(0, &own, &[]).and_then(|left| {
                let places = [0, 1].map(|later| survey.of_candidate(2 * event + later).concat());
                likeness(&left.block(&places.concat()).0)
            });
            let times = likeness.map_or(always, |likeness| -likeness.ln() * epochs);
            among[index] = times.min(epochs).max(always) / always;
        }
        Ok(among)
    }
}

/// Whether an effect is a line of any frequency.
pub(crate) fn has_frequency(term: &Term) -> bool {
    term.setting(SettingKind::Frequency).is_some()
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
