//! An effect, or some of its parameters, of which a schedule is asked.

use rins_estimation::Joint;
use rins_terms::Term;

/// An effect, or some of its parameters, of which a schedule is asked.
#[derive(Clone, Debug)]
pub struct Effect {
    /// What it is called.
    pub name: String,
    /// The full ids of its parameters.
    pub ids: Vec<String>,
    /// The term of the catalogue that it is.
    pub term: &'static Term,
}

impl Effect {
    /// All parameters of a term.
    ///
    /// ```
    /// let arm = rins_design::Effect::of(&rins_terms::catalogue::ACCEL_LEVER_ARM);
    /// assert_eq!(arm.ids.len(), 2);
    /// ```
    pub fn of(term: &'static Term) -> Self {
        Self { name: term.id.into(), ids: term.parameter_ids().collect(), term }
    }

    /// Where its parameters stand among the unknowns, of whichever run.
    pub(crate) fn places(&self, joint: &Joint) -> Vec<usize> {
        let is_of = |place: &usize| self.ids.contains(&joint.unknowns[*place].id);
        (0..joint.unknowns.len()).filter(is_of).collect()
    }
}
