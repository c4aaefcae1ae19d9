//! The observability of parameters, for a machine.

use rins_estimation::{Identifiability, Observable};
use schemars::JsonSchema;
use serde::{Deserialize, Serialize};

use super::{OBSERVABLE, Sorted, coefficient, gauges};

/// What is observable of all parameters together.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct IdentifiabilityResult {
    /// How many parameters there are.
    pub unknowns: usize,
    /// The rank of the information of the data alone.
    pub rank: Option<usize>,
    /// How many dimensions the null space has.
    pub null_space_dimension: Option<usize>,
    /// How many directions the data determine better than what was known beforehand.
    pub better_than_prior: Option<usize>,
    /// The information that the least observable direction has for itself, in units of the prior.
    pub least_information: Option<f64>,
    /// That of the null space, which is rounding.
    pub null_information: Option<f64>,
    /// The ids of the parameters that are observable.
    pub observable: Vec<String>,
    /// Those that are observable only in combinations.
    pub combination: Vec<String>,
    /// Those that are unobservable.
    pub unobservable: Vec<String>,
    /// The gauges: combinations that no schedule shows.
    pub gauges: Vec<GaugeResult>,
}

/// A combination of parameters that no schedule shows.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct GaugeResult {
    /// What it is called.
    pub name: String,
    /// Why no schedule shows it.
    pub why: String,
    /// The ids of the parameters that are part of it.
    pub parameters: Vec<String>,
}

impl IdentifiabilityResult {
    /// What is observable of all parameters together.
    pub(crate) fn of(identifiability: &Identifiability) -> Self {
        let ids = |places: &[usize]| -> Vec<String> {
            places.iter().map(|&place| identifiability.unknowns[place].id.clone()).collect()
        };
        let Sorted { observable, in_combination, unobservable } = Sorted::of(identifiability);
        let gauges = gauges(identifiability).into_iter().map(|gauge| {
            let of = (0..identifiability.parameters.len())
                .filter(|&place| identifiability.parameters[place].gauge == Some(gauge));
            let of: Vec<usize> = of.collect();
            GaugeResult { name: gauge.name.into(), why: gauge.why.into(), parameters: ids(&of) }
        });
        let rank = identifiability.rank.rank();
        Self {
            unknowns: identifiability.unknowns.len(),
            rank: Some(rank),
            null_space_dimension: Some(identifiability.unknowns.len() - rank),
            better_than_prior: Some(identifiability.rank.kept.len()),
            least_information: Some(identifiability.rank.least_told),
            null_information: Some(identifiability.rank.most_null),
            observable: ids(&observable),
            combination: ids(&in_combination),
            unobservable: ids(&unobservable),
            gauges: gauges.collect(),
        }
    }
}

/// A parameter in a combination.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct SummandResult {
    /// The parameter's id.
    pub id: String,
    /// The run to which it belongs, from 1; null if it belongs to all.
    pub run: Option<usize>,
    /// What one of its unit counts, in the unit of the parameter beside which it stands.
    pub coefficient: f64,
    /// Whether nothing but this combination shows the parameter, or other combinations do a little.
    pub exactly: Option<bool>,
}

/// The observability of one parameter.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct ObservabilityResult {
    /// `observable`, `combination` or `prior_dominated`.
    pub observability: String,
    /// Whether it is observable by itself.
    pub identifiable: bool,
    /// Whether some combination is all that shows it.
    pub exactly: Option<bool>,
    /// The ids of the other parameters of its combination.
    pub aliases: Vec<String>,
    /// These with their coefficients.
    pub combination: Vec<SummandResult>,
    /// The gauge that it is part of.
    pub gauge: Option<String>,
}

/// A parameter before it is estimated: its prior and the uncertainty that the data leave.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize, JsonSchema)]
pub struct PredictedResult {
    /// Its id.
    pub id: String,
    /// The run to which it belongs, from 1; null if it belongs to all.
    pub run: Option<usize>,
    /// Its unit.
    pub unit: String,
    /// The 1σ known beforehand, in its unit.
    pub prior_sigma: f64,
    /// The 1σ by the data alone; null if they do not bound it.
    pub data_sigma: Option<f64>,
    /// The 1σ by both.
    pub sigma: f64,
    /// Its observability.
    #[serde(flatten)]
    pub observability: ObservabilityResult,
}

impl ObservabilityResult {
    pub(crate) fn of(identifiability: &Identifiability, place: usize) -> Self {
        let seen = &identifiability.parameters[place];
        let observability = match seen.shown {
            _ if seen.identifiable => OBSERVABLE,
            Observable::Combination | Observable::Part { .. } => "combination",
            Observable::Alone | Observable::Nothing => "prior_dominated",
        };
        let aliases =
            seen.aliases.iter().map(|alias| identifiability.unknowns[alias.unknown].id.clone());
        let combination = seen.aliases.iter().map(|alias| {
            let other = &identifiability.unknowns[alias.unknown];
            SummandResult {
                id: other.id.clone(),
                run: other.run.map(|run| run + 1),
                coefficient: coefficient(identifiability, place, alias),
                exactly: Some(alias.exactly),
            }
        });
        Self {
            observability: observability.into(),
            identifiable: seen.identifiable,
            exactly: Some(seen.aliases.iter().any(|alias| alias.exactly)),
            aliases: aliases.collect(),
            combination: combination.collect(),
            gauge: seen.gauge.map(|gauge| gauge.name.to_owned()),
        }
    }
}

impl PredictedResult {
    pub(crate) fn of(identifiability: &Identifiability, place: usize) -> Self {
        let (unknown, seen) =
            (&identifiability.unknowns[place], &identifiability.parameters[place]);
        let factor = unknown.unit.factor;
        Self {
            id: unknown.id.clone(),
            run: unknown.run.map(|run| run + 1),
            unit: unknown.unit.symbol.into(),
            prior_sigma: unknown.sigma / factor,
            data_sigma: seen.data_sigma.is_finite().then_some(seen.data_sigma / factor),
            sigma: seen.sigma / factor,
            observability: ObservabilityResult::of(identifiability, place),
        }
    }
}
