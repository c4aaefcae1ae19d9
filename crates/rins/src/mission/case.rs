//! What is common to the schemes of a mission.

use anyhow::Context;
use nalgebra::SMatrix;
use rins_design::{GROWTH_STATES, Growth, Service, Voyage};
use rins_io::{MissionFile, RotationScheme, shown};
use rins_motion::{CarriedTable, Carrier};
use rins_terms::{Model, Surroundings};

use super::figure::WantedFigure;
use super::uncertainty::Uncertainty;

/// A covariance of the states.
pub(super) type OfStates = SMatrix<f64, GROWTH_STATES, GROWTH_STATES>;

/// What is common to the schemes of a mission.
pub(super) struct Case<'a> {
    pub(super) file: &'a MissionFile,
    pub(super) model: &'a Model,
    pub(super) places: &'a [(usize, usize)],
    pub(super) uncertainty: Option<&'a Uncertainty>,
    /// The uncertainty before the calibration, if there is one.
    pub(super) before: Option<&'a Uncertainty>,
    pub(super) want: Option<&'a WantedFigure>,
}

impl Case<'_> {
    /// The covariance of the states at the start.
    pub(super) fn start(&self) -> OfStates {
        let mut start = OfStates::zeros();
        for axis in 0..3 {
            start[(axis, axis)] = self.file.attitude_sigma.powi(2);
        }
        start
    }

    /// The table of a scheme.
    pub(super) fn table(&self, scheme: &RotationScheme) -> anyhow::Result<CarriedTable> {
        let carrier = self.file.carrier.clone().unwrap_or_else(Carrier::at_rest);
        let place = (self.file.station, self.file.nav_from_table);
        let table = CarriedTable::new(place, carrier, &scheme.cycle, scheme.stabilized);
        table.with_context(|| format!("{}: scheme {:?}", shown(&self.file.path), scheme.name))
    }

    /// The growth of the errors, with the noise of the uncertainty.
    pub(super) fn growth(
        &self,
        scheme: &RotationScheme,
        table: &CarriedTable,
    ) -> anyhow::Result<(Vec<Growth>, Option<Vec<f64>>)> {
        let file = self.file;
        let none = <[_; 2]>::default();
        let noise = self.uncertainty.map_or(&none, |of| &of.noise);
        let service = Service {
            surroundings: Surroundings::new(file.station, file.nav_from_table),
            cycle: &scheme.cycle,
            model: self.model,
            parameters: self.places,
            noise: noise.each_ref().map(|model| model.white_density),
        };
        let is_ashore = file.carrier.is_none();
        let law = if is_ashore { service.secular_east()? } else { None };
        let is_colored = self.uncertainty.is_some_and(Uncertainty::is_colored);
        let growth = if is_ashore && !is_colored {
            service.growth(&file.times)?
        } else {
            let noise = noise.each_ref();
            let (model, parameters) = (self.model, self.places);
            Voyage { table, model, parameters, noise }.growth(&file.times)?
        };
        Ok((growth, law))
    }
}
