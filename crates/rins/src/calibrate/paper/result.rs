//! The paper's calibration, for a machine.

use rins_calibration::Parameter;

use super::PaperCalibration;
use super::observability::{SYSTEMATIC_NOTE, meaning};
use crate::calibrate::budget::BudgetResult;
use crate::calibrate::compensation::EQUATION;
use crate::calibrate::result::{CalibrateResult, ParameterResult};
use crate::free_navigation::BeforeAfterResult;
use crate::identifiability::{
    IdentifiabilityResult, OBSERVABLE, ObservabilityResult, SummandResult,
};
use crate::log::{static_intervals, statics_result};

pub(super) fn result(of: &PaperCalibration) -> CalibrateResult {
    let PaperCalibration { log, calibration, budget, remarks, .. } = of;
    let rows = calibration.correlation.row_iter();
    let statics = statics_result(&static_intervals(&log.loaded), |interval| {
        (interval.span.start > 0).then(|| {
            "static, but this method uses only the interval that the log starts with".into()
        })
    });
    let mut notes = vec![SYSTEMATIC_NOTE.to_owned()];
    notes.extend(remarks.iter().cloned());
    CalibrateResult {
        schema: crate::SCHEMA,
        command: "calibrate".into(),
        model: "paper12".into(),
        rig: log.name.clone(),
        rigs: vec![log.name.clone()],
        parameters: calibration.parameters.iter().map(parameter).collect(),
        correlation: rows.map(|row| row.iter().copied().collect()).collect(),
        axis_attitude_deg: calibration.nav_from_table.euler_angles().into(),
        navigation: BeforeAfterResult::of(&calibration.before, &calibration.after),
        consistency: (&calibration.consistency).into(),
        prior_consistency: Vec::new(),
        conformity: Vec::new(),
        homogeneity: Vec::new(),
        variations: Vec::new(),
        iterations: Vec::new(),
        log_likelihood: None,
        noise: None,
        identifiability: identifiability(&calibration.parameters),
        error_budget: BudgetResult::of(&of.ids(), budget),
        compensation: EQUATION.into(),
        static_intervals: statics,
        runs: Vec::new(),
        notes,
        basis: of.basis.clone(),
    }
}

fn parameter(parameter: &Parameter) -> ParameterResult {
    let factor = parameter.kind.factor();
    let coefficients: Vec<f64> = parameter
        .partners
        .iter()
        .map(|partner| partner.share * partner.kind.factor() / factor)
        .collect();
    let summands = parameter.partners.iter().zip(&coefficients);
    let combination = summands.map(|(partner, coefficient)| SummandResult {
        id: partner.id.clone(),
        run: None,
        coefficient: *coefficient,
        exactly: None,
    });
    let observability = if parameter.identifiable() { OBSERVABLE } else { "combination" };
    ParameterResult {
        id: parameter.id.clone(),
        run: None,
        value: parameter.value / factor,
        sigma: parameter.sigma / factor,
        unit: parameter.kind.unit().into(),
        uncertainty: None,
        marginal: None,
        prior_sigma: None,
        data_sigma: None,
        observability: ObservabilityResult {
            observability: observability.into(),
            identifiable: parameter.identifiable(),
            exactly: None,
            aliases: parameter.partners.iter().map(|partner| partner.id.clone()).collect(),
            combination: combination.collect(),
            gauge: None,
        },
        alias_coefficients: coefficients,
        meaning: meaning(parameter),
    }
}

fn identifiability(parameters: &[Parameter]) -> IdentifiabilityResult {
    let ids = |alone: bool| -> Vec<String> {
        let those = parameters.iter().filter(|parameter| parameter.identifiable() == alone);
        those.map(|parameter| parameter.id.clone()).collect()
    };
    IdentifiabilityResult {
        unknowns: parameters.len(),
        rank: None,
        null_space_dimension: None,
        better_than_prior: None,
        least_information: None,
        null_information: None,
        observable: ids(true),
        combination: ids(false),
        unobservable: Vec::new(),
        gauges: Vec::new(),
    }
}
