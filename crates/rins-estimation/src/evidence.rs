//! What a run says of the parameters: one pass of the filter, and one linear recursion a column.
//!
//! The filter's innovations and their derivatives by every parameter, whitened, are all there is to know
//! of a linear model: sums of their products are the information, and equal what a filter with the
//! parameters as states would find from a diffuse start.

use nalgebra::{Cholesky, DMatrix, SMatrix, SVector};

use crate::gram::Gram;
use crate::linear::{Epoch, Linear};
use crate::posterior::Evidence;
use crate::space::{NAVIGATION, SHOWN, Space, Step};
use crate::strengths::Noise;

type Square = SMatrix<f64, SHOWN, SHOWN>;

/// A filter whose covariance could not be factored.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "the innovations' covariance is not positive definite at epoch {epoch}: a noise is zero or out of all proportion"
)]
pub struct Indefinite {
    /// Which epoch.
    pub epoch: usize,
}

impl Evidence {
    /// What a linear run says, its noise being this strong.
    ///
    /// # Errors
    /// [`Indefinite`] if the noise makes no covariance.
    pub fn of(linear: &Linear, noise: &Noise) -> Result<Self, Indefinite> {
        let mut gram = Gram::new(linear.parameters + 1);
        let mut log_determinant = 0.0;
        pass(linear, noise, &[], |whitened, log_det| {
            gram.add(whitened);
            log_determinant += log_det;
        })?;
        let shown = if Space::new(linear, noise).shows_angle() { SHOWN } else { SHOWN - 1 };
        Ok(Self::from_products(&gram.finish(), linear.epochs.len() * shown, log_determinant))
    }
}

/// The whitened innovations of a linear run where the parameters are `delta` from where it is linear.
///
/// Each is N(0, I) if the model is right.
///
/// # Errors
/// [`Indefinite`] if the noise makes no covariance.
pub fn innovations(
    linear: &Linear,
    noise: &Noise,
    delta: &[f64],
) -> Result<Vec<SVector<f64, SHOWN>>, Indefinite> {
    let mut all = Vec::with_capacity(linear.epochs.len());
    let mut combination = vec![1.0];
    combination.extend_from_slice(delta);
    pass(linear, noise, &combination, |whitened, _| {
        all.push(-SVector::<f64, SHOWN>::from_column_slice(whitened.column(0).as_slice()));
    })?;
    Ok(all)
}

/// Runs the filter; `each` is given the whitened columns of every epoch, and half the
/// logarithm of the determinant.
///
/// With a `combination` the columns are summed up, each times its number, into one.
fn pass(
    linear: &Linear,
    noise: &Noise,
    combination: &[f64],
    mut each: impl FnMut(&DMatrix<f64>, f64),
) -> Result<(), Indefinite> {
    let space = Space::new(linear, noise);
    let columns = if combination.is_empty() { linear.parameters + 1 } else { 1 };
    let mut filter = Pass {
        covariance: space.start(),
        columns: DMatrix::zeros(space.states(), columns),
        whitened: DMatrix::zeros(SHOWN, columns),
        shows_angle: space.shows_angle(),
    };
    for (index, epoch) in linear.epochs.iter().enumerate() {
        let inputs = Inputs::of(epoch, combination);
        if epoch.fresh {
            space.forget_navigation(&mut filter.covariance);
            filter.columns.rows_mut(0, NAVIGATION).copy_from(&inputs.start(space.shows_angle()));
        }
        let log_determinant =
            filter.step(&space.step(epoch), &inputs).ok_or(Indefinite { epoch: index })?;
        each(&filter.whitened, log_determinant);
    }
    Ok(())
}

/// What an epoch adds to the columns.
pub(crate) struct Inputs {
    pub(crate) navigation: DMatrix<f64>,
    pub(crate) shown_attitude: DMatrix<f64>,
}

impl Inputs {
    pub(crate) fn of(epoch: &Epoch, combination: &[f64]) -> Self {
        let columns = epoch.attitude.ncols();
        let mut navigation = DMatrix::zeros(NAVIGATION, columns);
        navigation.rows_mut(0, 3).copy_from(&epoch.attitude);
        navigation.rows_mut(3, 3).copy_from(&epoch.velocity);
        let mut shown_attitude = DMatrix::zeros(3, columns);
        shown_attitude.copy_from(&(&epoch.mean_attitude + &epoch.reading));
        if combination.is_empty() {
            return Self { navigation, shown_attitude };
        }
        let weights = DMatrix::from_column_slice(columns, 1, combination);
        Self { navigation: navigation * &weights, shown_attitude: shown_attitude * weights }
    }
}

impl Inputs {
    /// Where attitude and velocity start: where the epoch's own readings put them, so that the start holds
    /// nothing that the readings do not.
    pub(crate) fn start(&self, shows_angle: bool) -> DMatrix<f64> {
        let mut start = DMatrix::zeros(NAVIGATION, self.navigation.ncols());
        start.rows_mut(0, 3).copy_from(&-&self.shown_attitude);
        if !shows_angle {
            start.row_mut(2).fill(0.0);
        }
        start
    }
}

/// The filter's covariance and the recursions of the columns.
struct Pass {
    covariance: DMatrix<f64>,
    columns: DMatrix<f64>,
    whitened: DMatrix<f64>,
    shows_angle: bool,
}

impl Pass {
    /// Goes on by one epoch; half the logarithm of the innovation covariance's determinant.
    fn step(&mut self, step: &Step, inputs: &Inputs) -> Option<f64> {
        let n = self.covariance.nrows();
        let p = &self.covariance;
        // Φ P, of which the rows below navigation are scaled.
        let navigation_p = &step.navigation * p;
        let attitude_p = &step.attitude * p;
        let mut shown_p = DMatrix::zeros(SHOWN, n);
        shown_p.rows_mut(0, 3).copy_from(&attitude_p);
        shown_p.rows_mut(3, 3).copy_from(&navigation_p.rows(3, 3));
        let mut shown = DMatrix::zeros(SHOWN, n);
        shown.rows_mut(0, 3).copy_from(&step.attitude);
        shown.rows_mut(3, 3).copy_from(&step.navigation.rows(3, 3));

        let s: Square = Square::from_iterator((&shown_p * shown.transpose()).iter().copied());
        let s = s + step.shown;
        let s = (s + s.transpose()) * 0.5;
        let l = Cholesky::new(s)?.l();

        // C = Φ P Hᵀ + cov(w, e), and W = L⁻¹ Cᵀ.
        let mut gain = DMatrix::zeros(SHOWN, n);
        gain.columns_mut(0, NAVIGATION).copy_from(&(&shown * navigation_p.transpose()));
        for (index, decay) in step.decay.iter().enumerate() {
            let place = NAVIGATION + index;
            gain.set_column(place, &(shown_p.column(place) * *decay));
        }
        gain += step.cross.transpose();
        l.solve_lower_triangular_mut(&mut gain);

        // The columns: what is shown, whitened, and what is carried on.
        let mut seen = DMatrix::zeros(SHOWN, self.columns.ncols());
        let carried = &step.navigation * &self.columns + &inputs.navigation;
        seen.rows_mut(0, 3).copy_from(&(&step.attitude * &self.columns + &inputs.shown_attitude));
        seen.rows_mut(3, 3).copy_from(&carried.rows(3, 3));
        if !self.shows_angle {
            seen.row_mut(2).fill(0.0);
        }
        l.solve_lower_triangular_mut(&mut seen);
        self.columns.rows_mut(0, NAVIGATION).copy_from(&carried);
        for (index, decay) in step.decay.iter().enumerate() {
            self.columns.row_mut(NAVIGATION + index).scale_mut(*decay);
        }
        self.columns.gemm_tr(-1.0, &gain, &seen, 1.0);
        self.whitened = seen;

        self.carry_covariance(step, &navigation_p, &gain);
        Some(l.diagonal().iter().map(|x| x.ln()).sum())
    }

    /// `Φ P Φᵀ + Q - Wᵀ W`.
    fn carry_covariance(&mut self, step: &Step, navigation_p: &DMatrix<f64>, gain: &DMatrix<f64>) {
        let n = self.covariance.nrows();
        let corner = navigation_p * step.navigation.transpose();
        let p = &mut self.covariance;
        for column in NAVIGATION..n {
            let decay = step.decay[column - NAVIGATION];
            for row in NAVIGATION..n {
                p[(row, column)] *= decay * step.decay[row - NAVIGATION];
            }
            p[(column, column)] += step.colour_noise[column - NAVIGATION];
            for row in 0..NAVIGATION {
                let value = navigation_p[(row, column)] * decay + step.noise[(column, row)];
                p[(row, column)] = value;
                p[(column, row)] = value;
            }
        }
        for column in 0..NAVIGATION {
            for row in 0..NAVIGATION {
                p[(row, column)] = 0.5 * (corner[(row, column)] + corner[(column, row)])
                    + step.noise[(row, column)];
            }
        }
        p.gemm_tr(-1.0, gain, gain, 1.0);
    }
}
