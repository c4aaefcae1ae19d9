//! Terms at work on sample after sample.

use num_dual::Dual64;

use crate::catalogue::{AXIS_ATTITUDE, GYRO_MISALIGNMENT};
use crate::model::{Chosen, Model};
use crate::moment::Moment;
use crate::signals::{Signals, derivatives};
use crate::term::Action;

/// A term of a model at work: with its parameters, and perhaps a derivative by one of the model's.
#[derive(Clone, Debug)]
pub struct Acting<'a> {
    chosen: &'a Chosen,
    parameters: Vec<Dual64>,
    /// What turns the gyros' axes from the body's, where the term acts on the rate about them.
    axes: Vec<Self>,
}

impl<'a> Acting<'a> {
    /// The term at `place` in a model, with a derivative by parameter `by` of this or another term.
    fn of(model: &'a Model, place: usize, by: Option<(usize, usize)>) -> Self {
        let chosen = &model.terms[place];
        let mut parameters: Vec<Dual64> =
            chosen.values.iter().map(|&value| Dual64::from_re(value)).collect();
        if let Some((_, parameter)) = by.filter(|by| by.0 == place) {
            parameters[parameter].eps = 1.0;
        }
        let mut axes = Vec::new();
        if let Action::Sensed(_) = chosen.term.action {
            let turning = (0..model.terms.len()).filter(|&other| turns_axes(&model.terms[other]));
            axes = turning.map(|other| Self::of(model, other, by)).collect();
        }
        Self { chosen, parameters, axes }
    }

    /// What has a derivative by a parameter of a model's term: the term itself, and what acts on a rate that it turns.
    pub fn by(model: &'a Model, term: usize, parameter: usize) -> Vec<Self> {
        let by = Some((term, parameter));
        let mut list = vec![Self::of(model, term, by)];
        if turns_axes(&model.terms[term]) {
            let sensed = |chosen: &Chosen| matches!(chosen.term.action, Action::Sensed(_));
            let on_it =
                |&place: &usize| sensed(&model.terms[place]) && does_anything(&model.terms[place]);
            let others = (0..model.terms.len()).filter(on_it);
            list.extend(others.map(|place| Self::of(model, place, by)));
        }
        list
    }

    /// The terms of a model that do anything.
    pub fn present(model: &'a Model) -> Vec<Self> {
        let places = 0..model.terms.len();
        places
            .filter(|&place| does_anything(&model.terms[place]))
            .map(|place| Self::of(model, place, None))
            .collect()
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
        for acting in terms {
            acting.act(moment, &mut signals);
        }
        signals
    }

    #[inline]
    fn act(&self, moment: &Moment, signals: &mut Signals) {
        if self.axes.is_empty() {
            self.chosen.term.act(&self.parameters, &self.chosen.settings, moment, signals);
        } else {
            self.act_about_axes(moment, signals);
        }
    }

    /// Apart from the others, which are many.
    #[cold]
    fn act_about_axes(&self, moment: &Moment, signals: &mut Signals) {
        let mut turned = Signals::default();
        for Self { chosen, parameters, .. } in &self.axes {
            chosen.term.act(parameters, &chosen.settings, moment, &mut turned);
        }
        // A tilt is felt, and is in the rate; a derivative by it is not.
        let earth_rate = &moment.surroundings.earth_rate;
        let tilted = moment.in_body(&earth_rate.cross(&derivatives(&turned.tilt)));
        let mut sensed = turned.gyro;
        for (axis, sensed) in sensed.iter_mut().enumerate() {
            *sensed += Dual64::new(moment.rate[axis], tilted[axis]);
        }
        let Self { chosen, parameters, .. } = self;
        chosen.term.act_on((parameters, &chosen.settings), moment, &sensed, signals);
    }
}

/// Whether a term says in which directions the gyros' own axes are, in the body or with it.
fn turns_axes(chosen: &Chosen) -> bool {
    [GYRO_MISALIGNMENT.id, AXIS_ATTITUDE.id].contains(&chosen.term.id)
}

fn does_anything(chosen: &Chosen) -> bool {
    chosen.values.iter().any(|value| *value != 0.0)
}
