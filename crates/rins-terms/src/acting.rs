//! Terms at work on sample after sample.

use num_dual::Dual64;

use crate::model::{Chosen, Model};
use crate::moment::Moment;
use crate::signals::Signals;

/// A term at work: with its parameters, and perhaps a derivative by one of them.
#[derive(Clone, Debug)]
pub struct Acting<'a> {
    chosen: &'a Chosen,
    parameters: Vec<Dual64>,
}

impl<'a> Acting<'a> {
    /// With its parameters.
    pub fn new(chosen: &'a Chosen) -> Self {
        let parameters = chosen.values.iter().map(|&value| Dual64::from_re(value)).collect();
        Self { chosen, parameters }
    }

    /// With a derivative by one of its parameters.
    pub fn by(chosen: &'a Chosen, parameter: usize) -> Self {
        let mut acting = Self::new(chosen);
        acting.parameters[parameter].eps = 1.0;
        acting
    }

    /// The terms of a model that do anything.
    pub fn present(model: &'a Model) -> Vec<Self> {
        let present = |chosen: &&Chosen| chosen.values.iter().any(|value| *value != 0.0);
        model.terms.iter().filter(present).map(Self::new).collect()
    }

    /// What it adds.
    #[inline]
    pub fn signals(&self, moment: &Moment) -> Signals {
        Self::together(std::slice::from_ref(self), moment)
    }

    /// What some terms add.
    #[inline]
    pub fn together(terms: &[Self], moment: &Moment) -> Signals {
        let mut signals = Signals::default();
        for Self { chosen, parameters } in terms {
            chosen.term.act(parameters, &chosen.settings, moment, &mut signals);
        }
        signals
    }
}
