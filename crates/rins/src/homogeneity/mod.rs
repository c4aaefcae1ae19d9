//! Whether the parameters of the sensors are the same in several runs.

mod comparison;
mod conditions;
mod result;
mod words;

pub(crate) use self::comparison::RunComparison;
pub(crate) use self::conditions::conditions;
pub use self::result::{HomogeneityResult, VariantResult, VariationResult};
pub(crate) use self::words::{HOMOGENEITY, homogeneity, summary};
