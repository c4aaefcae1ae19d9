//! A run, linearized at one point, epoch by epoch.

use std::sync::Arc;

use nalgebra::{DVector, SVector};
use rins_motion::Recording;
use rins_terms::{Model, Surroundings};

use super::normal::{Normal, Solution};
use super::setup::OnlineSetup;
use super::window::{EpochSamples, Held, Point, Smoother, epoch};
use crate::evidence::Indefinite;
use crate::linear::with_attitude;
use crate::noise_parameters::Noise;
use crate::pass::Pass;
use crate::run::Run;
use crate::space::{Durations, Space};
use crate::step::SHOWN;

/// What is common to all points of linearization.
#[derive(Clone, Debug)]
pub(super) struct Common {
    pub(super) setup: OnlineSetup,
    pub(super) smoother: Smoother,
    /// The free parameters: term and place within it.
    pub(super) free: Vec<(usize, usize)>,
    /// The means and the sigmas of the priors.
    pub(super) expected: Vec<f64>,
    pub(super) sigmas: Vec<f64>,
}

/// The filter over the epochs of a run at one point of linearization, and the normal equations of the parameters.
#[derive(Clone, Debug)]
pub(super) struct Linearized {
    /// The model at the point of linearization.
    pub(super) model: Model,
    /// The same without the attitude errors of the axis, which are in the surroundings.
    rest: Model,
    surroundings: Surroundings,
    space: Space,
    pub(super) pass: Pass,
    pub(super) normal: Normal,
    /// The number of epochs processed.
    pub(super) epochs: usize,
    /// The table angle at the end of the last epoch \[rad\].
    pub(super) angle: Option<f64>,
}

impl Linearized {
    /// Before the first epoch, at the values of `model`.
    pub(super) fn new(common: &Common, model: Model) -> Self {
        let setup = &common.setup;
        let run = Run::unchecked(setup.rig, Arc::new(Recording::default()));
        let (surroundings, rest) = with_attitude(&run, &model);
        let epoch = setup.interval * setup.epoch as f64;
        let durations = Durations { mean: epoch, usual: epoch, run: setup.duration };
        let noise = Noise::on(&setup.rig, &setup.noise);
        let mut space = Space::of(setup.rig.reference, durations, &noise);
        space.set_around(&surroundings.specific_force, &surroundings.earth_rate);
        Self {
            pass: Pass::new(&space, common.free.len() + 1),
            normal: Normal::new(&common.sigmas),
            model,
            rest,
            surroundings,
            space,
            epochs: 0,
            angle: None,
        }
    }

    /// Processes an epoch; the result is its whitened innovation at the point of linearization.
    pub(super) fn process(
        &mut self,
        common: &Common,
        kept: &[Held],
        samples: EpochSamples,
    ) -> Result<(), Indefinite> {
        let Self { surroundings, rest, .. } = self;
        let point = Point { surroundings: *surroundings, model: rest, free: &common.free };
        let (epoch, angle) =
            epoch((&common.setup, common.smoother), kept, samples, &point, self.angle);
        let failed = Indefinite { epoch: self.epochs };
        let is_fresh = samples.is_fresh();
        self.pass.step(&self.space, &epoch, &epoch.gains, is_fresh).ok_or(failed)?;
        self.normal.add(self.pass.whitened());
        self.angle = Some(angle);
        self.epochs += 1;
        Ok(())
    }

    /// The whitened innovation of the last epoch at an estimate relative to the point of linearization.
    pub(super) fn innovation(&self, step: &DVector<f64>) -> SVector<f64, SHOWN> {
        let whitened = self.pass.whitened();
        let width = whitened.len() / SHOWN;
        SVector::from_fn(|part, _| {
            let row = &whitened[part * width..][..width];
            let by: f64 = row[1..].iter().zip(step.iter()).map(|(by, step)| by * step).sum();
            -(row[0] + by)
        })
    }

    /// The estimate relative to the point of linearization; `None` if the information is not finite.
    pub(super) fn solve(&self, common: &Common) -> Option<Solution> {
        let values = common.free.iter().map(|&(term, place)| self.model.terms[term].values[place]);
        let expected = common.expected.iter().zip(values).map(|(expected, value)| expected - value);
        self.normal.solve(&DVector::from_iterator(common.free.len(), expected))
    }
}
