//! Whether the parameters of the sensors are the same in several runs.

mod comparison;
mod conditions;
mod held_out;
mod result;
mod words;

pub(crate) use self::comparison::RunComparison;
pub(crate) use self::conditions::conditions;
pub(crate) use self::held_out::{HeldOutComparison, INTERVAL};
pub use self::result::{
    ForecastedResult, HeldOutParameterResult, HeldOutResult, HomogeneityResult, VariantResult,
    VariationResult,
};
pub(crate) use self::words::{HOMOGENEITY, homogeneity, summary};
