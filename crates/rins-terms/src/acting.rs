//! Terms at work on sample after sample.

use std::sync::Arc;

use nalgebra::Complex;
use num_dual::Dual64;

use crate::catalogue::{AXIS_ATTITUDE, GYRO_MISALIGNMENT};
use crate::following::{behind, following};
use crate::kinematic_state::KinematicState;
use crate::model::{Model, TermInstance};
use crate::signals::{Signals, derivatives};
use crate::term::Action;
use crate::track::Track;

/// A term of a model at work on a track: with its parameters, and perhaps a derivative by one of the model's.
#[derive(Clone, Debug)]
pub struct Acting<'a> {
    chosen: &'a TermInstance,
    parameters: Vec<Dual64>,
    /// What turns the gyros' axes from the body's, where the term acts on the rate about them.
    axes: Vec<Self>,
    /// How it follows the table or its temperature in each of the track's samples, where it does so slowly.
    follows: Option<Follows>,
}

/// How something is followed in each sample of a track.
#[derive(Clone, Debug)]
enum Follows {
    /// `exp(iζ)`, in units of it.
    Angle(Arc<[Complex<f64>]>),
    /// The temperature: by how much what follows is above it \[K\].
    Temperature(Arc<[f64]>),
}

impl<'a> Acting<'a> {
    /// The term at `place` in a model, with a derivative by parameter `by` of this or another term.
    fn of(
        model: &'a Model,
        place: usize,
        by: Option<(usize, usize)>,
        follows: Option<Follows>,
    ) -> Self {
        let chosen = &model.terms[place];
        let mut parameters: Vec<Dual64> =
            chosen.values.iter().map(|&value| Dual64::from_re(value)).collect();
        if let Some((_, parameter)) = by.filter(|by| by.0 == place) {
            parameters[parameter].eps = 1.0;
        }
        let mut axes = Vec::new();
        if let Action::Sensed(_) = chosen.term.action {
            let turning = (0..model.terms.len()).filter(|&other| turns_axes(&model.terms[other]));
            axes = turning.map(|other| Self::of(model, other, by, None)).collect();
        }
        Self { chosen, parameters, axes, follows }
    }

    /// Of each of some parameters, given as term and place within it, what has a derivative by it on `track`: the term
    /// itself, and what acts on a rate that it turns.
    pub fn by(model: &'a Model, track: &Track, parameters: &[(usize, usize)]) -> Vec<Vec<Self>> {
        let follows: Vec<Option<Follows>> =
            model.terms.iter().map(|chosen| follows(chosen, track)).collect();
        let list = |&(term, parameter): &(usize, usize)| {
            let of =
                |place| Self::of(model, place, Some((term, parameter)), follows[place].clone());
            let mut list = vec![of(term)];
            if turns_axes(&model.terms[term]) {
                let sensed =
                    |chosen: &TermInstance| matches!(chosen.term.action, Action::Sensed(_));
                let on_it = |&place: &usize| {
                    sensed(&model.terms[place]) && does_anything(&model.terms[place])
                };
                list.extend((0..model.terms.len()).filter(on_it).map(of));
            }
            list
        };
        parameters.iter().map(list).collect()
    }

    /// The terms of a model that do anything, on `track`.
    pub fn present(model: &'a Model, track: &Track) -> Vec<Self> {
        Self::at_work(model, |chosen| follows(chosen, track))
    }

    /// The same wherever a table is, what follows it having settled.
    pub(crate) fn settled(model: &'a Model) -> Vec<Self> {
        Self::at_work(model, |_| None)
    }

    fn at_work(model: &'a Model, follows: impl Fn(&TermInstance) -> Option<Follows>) -> Vec<Self> {
        let places = 0..model.terms.len();
        places
            .filter(|&place| does_anything(&model.terms[place]))
            .map(|place| Self::of(model, place, None, follows(&model.terms[place])))
            .collect()
    }

    /// What it adds at a moment of its track.
    ///
    /// # Panics
    /// May panic for a moment of a longer track.
    #[inline]
    pub fn signals(&self, moment: &KinematicState) -> Signals {
        Self::together(std::slice::from_ref(self), moment)
    }

    /// What some terms add at a moment of their track.
    ///
    /// # Panics
    /// May panic for a moment of a longer track.
    #[inline]
    pub fn together(terms: &[Self], moment: &KinematicState) -> Signals {
        let mut signals = Signals::default();
        for acting in terms {
            acting.act(moment, &mut signals);
        }
        signals
    }

    #[inline]
    fn act(&self, moment: &KinematicState, signals: &mut Signals) {
        let Self { chosen, parameters, .. } = self;
        match (&self.follows, chosen.term.action) {
            (Some(Follows::Angle(follows)), Action::Following(act)) => {
                act(parameters, moment.exp_angle() * follows[moment.sample], signals);
            }
            (Some(Follows::Temperature(behind)), Action::Soaking(act)) => {
                act(parameters, behind[moment.sample], signals);
            }
            _ if self.axes.is_empty() => {
                chosen.term.act(parameters, &chosen.settings, moment, signals);
            }
            _ => self.act_about_axes(moment, signals),
        }
    }

    /// Apart from the others, which are many.
    #[cold]
    fn act_about_axes(&self, moment: &KinematicState, signals: &mut Signals) {
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

impl Model {
    /// What all its terms add at `moment`, those that follow the table or its temperature having settled.
    pub fn signals(&self, moment: &KinematicState) -> Signals {
        Acting::together(&Acting::settled(self), moment)
    }
}

/// Whether a term says in which directions the gyros' own axes are, in the body or with it.
fn turns_axes(chosen: &TermInstance) -> bool {
    [GYRO_MISALIGNMENT.id, AXIS_ATTITUDE.id].contains(&chosen.term.id)
}

/// How a term follows the table on a track, or its temperature, if it does so slowly.
fn follows(chosen: &TermInstance, track: &Track) -> Option<Follows> {
    match chosen.term.action {
        Action::Following(_) => Some(Follows::Angle(following(track, chosen.settings[0]).into())),
        Action::Soaking(_) => Some(Follows::Temperature(behind(track, chosen.settings[0]).into())),
        _ => None,
    }
}

fn does_anything(chosen: &TermInstance) -> bool {
    chosen.values.iter().any(|value| *value != 0.0)
}
