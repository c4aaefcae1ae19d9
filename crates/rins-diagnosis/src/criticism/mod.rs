//! What remains when the best hypothesis is in the model.

pub(crate) mod bursts;
pub(crate) mod every_turn;
pub(crate) mod levels;
pub(crate) mod noise;
pub(crate) mod noisier;
pub(crate) mod periodic;
pub(crate) mod residuals;
pub(crate) mod rounding;
pub(crate) mod shocks;
pub(crate) mod structure;
pub(crate) mod switching;
pub(crate) mod tails;
pub(crate) mod unexplained;
pub(crate) mod waves;
