//! From logs to what is estimated from them: screened, aligned, divided into what turns and what is static, with what is known
//! beforehand.

mod attitude;
mod case;
mod prepared;
mod rests;

pub(crate) use self::case::EstimationProblem;
pub(crate) use self::prepared::{Prepared, across_axis, repeats_in_words, screened};
