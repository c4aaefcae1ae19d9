//! A mission, for a machine.

use rins_frames::units::ARCSEC;
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::Mission;
use super::scheme::{SchemeInService, Spread};
use super::simulated::SampleSpread;
use super::want::Wanted;
use crate::basis::BasisResult;

/// Meters of a nautical mile.
pub(crate) const NAUTICAL_MILE: f64 = 1852.0;

/// The result of `rins mission`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct MissionResult {
    /// The version of this schema: 2.
    pub schema: u32,
    /// `mission`.
    pub command: String,
    /// The mission file.
    pub mission: String,
    /// The schemes, as the file lists them.
    pub schemes: Vec<SchemeResult>,
    /// What else is to be known.
    pub notes: Vec<String>,
    /// Its basis: inputs, repairs and assumptions.
    #[serde(flatten)]
    pub basis: BasisResult,
}

/// The navigation errors under one scheme; a list has a value for each of `hours`.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SchemeResult {
    /// Its name.
    pub name: String,
    /// The time since the start \[h\].
    pub hours: Vec<f64>,
    /// The position error east by the stated errors \[nmi\]; null if none are stated.
    pub east_nmi: Option<Vec<f64>>,
    /// The same north.
    pub north_nmi: Option<Vec<f64>>,
    /// The secular part of the error east by the stated errors \[nmi\]; null if none are stated, or a cycle does not close.
    pub law_nmi: Option<Vec<f64>>,
    /// The radius that holds half of the position errors \[nmi\]; null if no uncertainty is stated.
    pub cep50_nmi: Option<Vec<f64>>,
    /// The radius that holds 95 % of them.
    pub cep95_nmi: Option<Vec<f64>>,
    /// The root mean square of the radial position error \[nmi\] (TRMS).
    pub trms_nmi: Option<Vec<f64>>,
    /// The root mean square of the horizontal velocity error \[m/s\].
    pub velocity_rms_m_s: Option<Vec<f64>>,
    /// The root mean square of the tilt, both axes together \[arcsec\].
    pub tilt_rms_arcsec: Option<Vec<f64>>,
    /// The root mean square of the heading error \[arcsec\].
    pub heading_rms_arcsec: Option<Vec<f64>>,
    /// The TRMS at the end divided by the time \[nmi/h\].
    pub nmi_per_hour: Option<f64>,
    /// The TRMS with the uncertainties of the data sheet, before the calibration \[nmi\]; null if no calibration is given.
    pub trms_before_nmi: Option<Vec<f64>>,
    /// The radial position error at the end by each source alone, 1σ; the largest first.
    pub budget: Vec<BudgetResult>,
    /// The same position errors of simulated missions; null if none were simulated.
    pub simulated: Option<SimulatedResult>,
    /// Which uncertainties hold the wanted figure; null if none is wanted.
    pub want: Option<WantResult>,
}

/// The position errors of simulated missions, navigated by strapdown with drawn errors; a list has a value for each time.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SimulatedResult {
    /// The number of missions.
    pub runs: u32,
    /// The seed of their errors.
    pub seed: u64,
    /// The sampling rate of the navigation \[Hz\].
    pub sample_rate_hz: f64,
    /// The time that the simulation took \[s\].
    pub seconds: f64,
    /// The median of the radial position error \[nmi\].
    pub cep50_nmi: Vec<f64>,
    /// Its interval of 95 %.
    pub cep50_within_nmi: Vec<[f64; 2]>,
    /// The radius that holds 95 % of the missions \[nmi\].
    pub cep95_nmi: Vec<f64>,
    /// The root mean square of the radial position error \[nmi\].
    pub trms_nmi: Vec<f64>,
    /// Its interval of 95 %.
    pub trms_within_nmi: Vec<[f64; 2]>,
}

/// The uncertainties that hold a wanted TRMS.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct WantResult {
    /// The wanted TRMS \[nmi\].
    pub trms_nmi: f64,
    /// The time since the start \[h\].
    pub hours: f64,
    /// Whether better sensor errors can hold it: noise and the initial attitude alone must leave less.
    pub possible: bool,
    /// The position error by noise and the initial attitude alone, 1σ \[nmi\].
    pub fixed_nmi: f64,
    /// The TRMS with the present uncertainties, as independent errors \[nmi\].
    pub present_nmi: f64,
    /// The TRMS with the uncertainties that are asked for \[nmi\].
    pub reached_nmi: f64,
    /// The same by simulated missions \[nmi\]; null if none were simulated.
    pub simulated_nmi: Option<f64>,
    /// The parameters, those that must improve most first.
    pub parameters: Vec<WantedParameterResult>,
}

/// What is asked of a parameter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct WantedParameterResult {
    /// Its id.
    pub id: String,
    /// The present standard deviation.
    pub present: f64,
    /// The standard deviation that is asked for.
    pub asked: f64,
    /// Their unit.
    pub unit: String,
    /// The radial position error that the latter causes, 1σ \[nmi\].
    pub share_nmi: f64,
}

/// The contribution of one source.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct BudgetResult {
    /// The id of the parameter, `initial attitude`, or `white noise`; `noise` if it includes bias instability or random walk.
    pub source: String,
    /// The radial position error, 1σ \[nmi\].
    pub radial_nmi: f64,
}

impl From<&Mission> for MissionResult {
    fn from(mission: &Mission) -> Self {
        Self {
            schema: 2,
            command: "mission".into(),
            mission: mission.name.clone(),
            schemes: mission.schemes.iter().map(|scheme| scheme.result(mission)).collect(),
            notes: mission.remarks.clone(),
            basis: mission.basis.clone(),
        }
    }
}

impl SchemeInService {
    fn result(&self, mission: &Mission) -> SchemeResult {
        let times = &mission.times;
        let along = |axis: usize| {
            let list = self.by_errors.as_ref()?;
            Some(list.iter().map(|position| position[axis] / NAUTICAL_MILE).collect())
        };
        let each = |of: fn(&Spread) -> f64| {
            let list = self.by_uncertainty.as_ref()?;
            Some(list.iter().map(of).collect::<Vec<f64>>())
        };
        let law = self.law.map(|law| times.iter().map(|time| law * time / NAUTICAL_MILE).collect());
        let budget = self.budget.iter().map(|(source, radial)| BudgetResult {
            source: source.clone(),
            radial_nmi: radial / NAUTICAL_MILE,
        });
        let trms = each(|spread| spread.rms / NAUTICAL_MILE);
        let last = trms.as_ref().and_then(|list| list.last().copied()).zip(times.last());
        SchemeResult {
            name: self.name.clone(),
            hours: times.iter().map(|time| time / 3600.0).collect(),
            east_nmi: along(0),
            north_nmi: along(1),
            law_nmi: law,
            cep50_nmi: each(|spread| spread.half / NAUTICAL_MILE),
            cep95_nmi: each(|spread| spread.most / NAUTICAL_MILE),
            nmi_per_hour: last.map(|(trms, time)| trms / (time / 3600.0)),
            trms_nmi: trms,
            velocity_rms_m_s: each(|spread| spread.velocity),
            tilt_rms_arcsec: each(|spread| spread.attitude[0] / ARCSEC),
            heading_rms_arcsec: each(|spread| spread.attitude[1] / ARCSEC),
            trms_before_nmi: self
                .before
                .as_ref()
                .map(|list| list.iter().map(|spread| spread.rms / NAUTICAL_MILE).collect()),
            budget: budget.collect(),
            simulated: self.simulated.as_ref().map(|simulated| {
                let each = |of: fn(&SampleSpread) -> f64| {
                    simulated.spreads.iter().map(|spread| of(spread) / NAUTICAL_MILE).collect()
                };
                let within = |of: fn(&SampleSpread) -> [f64; 2]| {
                    let list = simulated.spreads.iter();
                    list.map(|spread| of(spread).map(|end| end / NAUTICAL_MILE)).collect()
                };
                SimulatedResult {
                    runs: simulated.runs,
                    seed: simulated.seed,
                    sample_rate_hz: mission.sample_rate,
                    seconds: simulated.seconds,
                    cep50_nmi: each(|spread| spread.half),
                    cep50_within_nmi: within(|spread| spread.half_within),
                    cep95_nmi: each(|spread| spread.most),
                    trms_nmi: each(|spread| spread.rms),
                    trms_within_nmi: within(|spread| spread.rms_within),
                }
            }),
            want: self.wanted.as_ref().map(WantResult::from),
        }
    }
}

impl From<&Wanted> for WantResult {
    fn from(wanted: &Wanted) -> Self {
        let parameters = wanted.parameters.iter().map(|one| WantedParameterResult {
            id: one.id.clone(),
            present: one.present,
            asked: one.asked,
            unit: one.unit.into(),
            share_nmi: one.share / NAUTICAL_MILE,
        });
        Self {
            trms_nmi: wanted.want.rms / NAUTICAL_MILE,
            hours: wanted.want.time / 3600.0,
            possible: wanted.is_possible(),
            fixed_nmi: wanted.fixed / NAUTICAL_MILE,
            present_nmi: wanted.present / NAUTICAL_MILE,
            reached_nmi: wanted.reached / NAUTICAL_MILE,
            simulated_nmi: wanted.simulated.map(|simulated| simulated / NAUTICAL_MILE),
            parameters: parameters.collect(),
        }
    }
}
