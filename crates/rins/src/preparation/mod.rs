//! Preparation of logs for the estimation: gross errors are refused, the axis is aligned, rotation and static intervals are
//! divided, and priors are set.

mod attitude;
mod axis;
mod case;
mod prepared;
mod rests;

pub(crate) use self::axis::across_axis;
pub(crate) use self::case::EstimationProblem;
pub(crate) use self::prepared::{Prepared, repeats_in_words, screened};
