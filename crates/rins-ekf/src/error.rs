//! The reasons for the refusal of a covariance or a measurement.

use core::fmt;

/// The input with a number that is not finite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum Quantity {
    /// The filter's state.
    State,
    /// The filter's covariance.
    Covariance,
    /// The measurement's value.
    Value,
    /// The measurement's matrix `H`.
    Matrix,
    /// The measurement's noise covariance `R`.
    Noise,
    /// The covariance `C` of the state's error with the measurement's noise.
    Cross,
}

impl fmt::Display for Quantity {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(match self {
            Self::State => "state",
            Self::Covariance => "covariance",
            Self::Value => "measured value",
            Self::Matrix => "measurement matrix",
            Self::Noise => "measurement noise",
            Self::Cross => "covariance of state error and measurement noise",
        })
    }
}

/// The reason why a measurement was not used.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum UpdateError {
    /// An input holds a number that is not finite.
    #[error("the {quantity} holds a number that is not finite")]
    NotFinite {
        /// The input.
        quantity: Quantity,
    },
    /// `S = H P Hᵀ + R` has no Cholesky factor.
    #[error(
        "the innovation covariance is not positive definite: its smallest diagonal element is {smallest:e}"
    )]
    InnovationNotPositiveDefinite {
        /// Its smallest diagonal element.
        smallest: f64,
    },
    /// The updated covariance would have a negative variance: the magnitudes differ by more than the precision of `f64`, or
    /// the covariance or the cross-covariance is invalid.
    #[error(
        "state {index} would have the variance {variance:e}; scale the states, or check the covariances"
    )]
    NegativeVariance {
        /// The state's index.
        index: usize,
        /// The resulting variance.
        variance: f64,
    },
    /// A measurement is so precise, relative to the remaining variances of the states that it combines, that the updated
    /// covariance cannot represent the result: sigmas would have relative errors of more than about 1e-3 in the plain form,
    /// 1e-6 in the factorized one.
    #[error(
        "the states in row {row} of the measurement keep a variance of {ratio:e} times its noise, more than the covariance can resolve; use the factorised form, or start with smaller variances"
    )]
    Unresolved {
        /// The measurement's row.
        row: usize,
        /// `Σ h² P / R` of the row after the update.
        ratio: f64,
    },
    /// The correlation with the state's error exceeds the variance of a row's noise.
    #[error(
        "the noise of row {row} would have the variance {variance:e} once the state's error is known; their covariance is too large"
    )]
    NoiseOverexplained {
        /// The measurement's row.
        row: usize,
        /// The remaining variance.
        variance: f64,
    },
    /// Every input is finite and the result is not.
    #[error("the update overflows; scale the states or the measurement")]
    Overflow,
}

/// The reason why a matrix is not a covariance.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum CovarianceError {
    /// An input holds a number that is not finite.
    #[error("the {quantity} holds a number that is not finite")]
    NotFinite {
        /// The input.
        quantity: Quantity,
    },
    /// Two symmetric elements differ.
    #[error(
        "the covariance is not symmetric: element ({row}, {column}) is off its mirror image by {difference:e}"
    )]
    NotSymmetric {
        /// The element's row.
        row: usize,
        /// The element's column.
        column: usize,
        /// The difference of the two elements.
        difference: f64,
    },
    /// A linear combination of states has a variance that is not positive.
    #[error(
        "the covariance is not positive definite: state {index} has the variance {variance:e} once those before it are known"
    )]
    NotPositiveDefinite {
        /// The state's index.
        index: usize,
        /// Its variance given the states before it.
        variance: f64,
    },
    /// The variance of a linear combination of states is so much smaller than those of the states that the matrix, whose
    /// numbers have sixteen digits, cannot represent it.
    #[error(
        "state {index} has {part:e} of its variance left once those after it are known, less than a covariance matrix can hold; build its factors from independent sources"
    )]
    Unresolved {
        /// The state's index.
        index: usize,
        /// Its variance given the states after it, divided by its own.
        part: f64,
    },
}
