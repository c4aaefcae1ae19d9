//! Measurements: linear functions of the state with noise, which may be correlated with the state's error.

use nalgebra::{SMatrix, SVector};

/// A linearized measurement `z = H x + v` with `v ~ N(0, R)`.
///
/// ```
/// use nalgebra::{Matrix1, RowVector2, Vector1};
/// use rins_ekf::Measurement;
/// // The first of two states, to 0.1 (1σ).
/// let position = Measurement::new(Vector1::new(3.0), RowVector2::new(1.0, 0.0), Matrix1::new(0.01));
/// # assert!(position.cross.is_none());
/// ```
///
/// A matrix with a wrong shape does not compile:
/// ```compile_fail,E0308
/// use nalgebra::{Matrix1, RowVector3, Vector1};
/// use rins_ekf::{Filter, Measurement};
/// fn use_it(filter: &mut Filter<2>) {
///     let of_three = Measurement::new(Vector1::new(3.0), RowVector3::zeros(), Matrix1::new(0.01));
///     filter.update(&of_three);
/// }
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Measurement<const M: usize, const N: usize> {
    /// `z`, in the measurement's units.
    pub value: SVector<f64, M>,
    /// `H`, the derivative of the measurement by the state.
    pub matrix: SMatrix<f64, M, N>,
    /// `R`, the covariance of the noise, of which the lower triangle is used.
    pub noise: SMatrix<f64, M, M>,
    /// `C = E[(x − x̂) vᵀ]`, the covariance of the state's error (*true minus estimate*) before the
    /// update with the measurement's noise; `None` is zero.
    pub cross: Option<SMatrix<f64, N, M>>,
}

impl<const M: usize, const N: usize> Measurement<M, N> {
    /// A measurement whose noise is independent of the state's error.
    pub fn new(
        value: SVector<f64, M>,
        matrix: SMatrix<f64, M, N>,
        noise: SMatrix<f64, M, M>,
    ) -> Self {
        Self { value, matrix, noise, cross: None }
    }

    /// A nonlinear measurement, linearized about `state`: `residual` is the measured minus the predicted value, `z − h(x̂)`,
    /// and `matrix` is the derivative of `h` there.
    pub fn linearised(
        residual: &SVector<f64, M>,
        state: &SVector<f64, N>,
        matrix: SMatrix<f64, M, N>,
        noise: SMatrix<f64, M, M>,
    ) -> Self {
        Self::new(residual + matrix * state, matrix, noise)
    }

    /// This measurement with noise that is correlated with the process noise of the prediction.
    ///
    /// `cross` is `C = E[(x − x̂) vᵀ]`, *true minus estimate*. It is nonzero if one sensor sample is both integrated and
    /// compared: with process noise `x = Φ x' + G n` and measurement noise `v = D n + …`, both from one `n ~ N(0, W)`, it is
    /// `C = G W Dᵀ`.
    ///
    /// ```
    /// use nalgebra::{Matrix1, Vector1};
    /// use rins_ekf::{Filter, Measurement};
    /// // A rate gyro with noise variance 4 is integrated over one second, which adds −n to the
    /// // computed angle's error; its difference from a perfect table rate measures the same −n.
    /// let mut filter = Filter { state: Vector1::new(0.0), covariance: Matrix1::new(4.0) };
    /// let difference = Measurement::new(Vector1::new(3.0), Matrix1::new(0.0), Matrix1::new(4.0))
    ///     .correlated_with_state_error(Matrix1::new(-4.0));
    /// filter.update(&difference)?;
    /// assert_eq!(filter.state, Vector1::new(-3.0)); // the angle is known again,
    /// assert_eq!(filter.covariance, Matrix1::new(0.0)); // exactly
    /// # Ok::<(), rins_ekf::UpdateError>(())
    /// ```
    #[must_use]
    pub fn correlated_with_state_error(self, cross: SMatrix<f64, N, M>) -> Self {
        Self { cross: Some(cross), ..self }
    }
}
