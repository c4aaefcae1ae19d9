//! Why the runs of a history cannot be compared.

/// The reason why the runs of a history cannot be compared.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum HistoryError {
    /// Values, covariance and parameters are not of one size, or a parameter is given twice.
    #[error(
        "values, covariance and parameters of a run differ in number, or a parameter is given twice"
    )]
    Shape,
    /// A value or a covariance is not finite.
    #[error("a value or a covariance is not finite")]
    NotFinite,
    /// The covariance is not positive definite.
    #[error("the covariance of a run is not positive definite")]
    Covariance,
    /// The typical range of a parameter is not positive and finite.
    #[error("the typical range of {id}, {low} to {high}, must be positive and finite")]
    Typical {
        /// The parameter.
        id: String,
        /// The smallest variation.
        low: f64,
        /// The largest variation.
        high: f64,
    },
    /// Fewer than two runs.
    #[error("{runs} run says nothing of what changes between runs: at least 2 are needed")]
    FewRuns {
        /// The number of runs.
        runs: usize,
    },
    /// A forecast needs a condition that is not stated.
    #[error("the forecast of {id} needs the {condition} of the run: the parameter depends on it")]
    Condition {
        /// The parameter.
        id: String,
        /// The condition.
        condition: &'static str,
    },
}
