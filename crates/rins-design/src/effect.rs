//! An effect, or some of its parameters, whose observability a schedule determines.

use rins_estimation::Joint;
use rins_terms::Term;

/// An effect, or some of its parameters, whose observability a schedule determines.
#[derive(Clone, Debug)]
pub struct Effect {
    /// Its name.
    pub name: String,
    /// The full ids of its parameters.
    pub ids: Vec<String>,
    /// Its term of the catalogue.
    pub term: &'static Term,
}

impl Effect {
    /// The effect of a term with all its parameters.
    ///
    /// ```
    /// let arm = rins_design::Effect::of(&rins_terms::catalogue::ACCEL_LEVER_ARM);
    /// assert_eq!(arm.ids.len(), 2);
    /// ```
    pub fn of(term: &'static Term) -> Self {
        Self { name: term.id.into(), ids: term.parameter_ids().collect(), term }
    }

    /// The places of its parameters among the unknowns, of all runs.
    pub(crate) fn places(&self, joint: &Joint) -> Vec<usize> {
        let is_of = |place: &usize| self.ids.contains(&joint.unknowns[*place].id);
        (0..joint.unknowns.len()).filter(is_of).collect()
    }
}
