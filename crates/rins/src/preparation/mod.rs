//! Preparation of logs for the estimation: gross errors are refused, the axis is aligned, rotation and static intervals are
//! divided, and priors are set.

mod attitude;
mod case;
mod prepared;
mod rests;

pub(crate) use self::case::EstimationProblem;
pub(crate) use self::prepared::{Prepared, across_axis, repeats_in_words, screened};
