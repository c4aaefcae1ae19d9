//! What a run says of the parameters: one pass of the filter, and one linear recursion a column.
//!
//! The filter's innovations and their derivatives by every parameter, whitened, are all there is to know
//! of a linear model: sums of their products are the information, and equal what a filter with the
//! parameters as states would find from a diffuse start.

use nalgebra::{Cholesky, DMatrix, SMatrix, SVector};
use rins_lanes::Arch;

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
        let epochs = linear.epochs.iter().filter(|epoch| !epoch.left_out).count();
        Ok(Self::from_products(&gram.finish(), epochs * linear.shown(), log_determinant))
    }
}

/// What an epoch shows, against what all before it foretold.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Foretold {
    /// The whitened innovation, N(0, I) if the model is right.
    pub innovation: SVector<f64, SHOWN>,
    /// The logarithm of the probability density of what was shown \[nats\].
    pub log_density: f64,
}

/// How well each epoch of a run was foretold where it is linear.
///
/// # Errors
/// [`Indefinite`] if the noise makes no covariance.
pub fn foretold(linear: &Linear, noise: &Noise) -> Result<Vec<Foretold>, Indefinite> {
    let mut none = vec![0.0; linear.parameters + 1];
    none[0] = 1.0;
    let constant = 0.5 * linear.shown() as f64 * std::f64::consts::TAU.ln();
    let mut all = Vec::with_capacity(linear.epochs.len());
    pass(linear, noise, &none, |whitened, log_determinant| {
        let innovation = -SVector::<f64, SHOWN>::from_column_slice(whitened.as_slice());
        let log_density = -0.5 * innovation.norm_squared() - log_determinant - constant;
        all.push(Foretold { innovation, log_density });
    })?;
    Ok(all)
}

/// The whitened innovations of a linear run where the parameters are `delta` from where it is linear.
///
/// Each is N(0, I) if the model is right. Epochs that play no part have none.
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
        all.push(-SVector::<f64, SHOWN>::from_column_slice(whitened.as_slice()));
    })?;
    Ok(all)
}

/// Runs the filter; `each` is given what every epoch shows of the columns, whitened, a row a column, and
/// half the logarithm of the determinant.
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
        columns: DMatrix::zeros(columns, space.states()),
        whitened: DMatrix::zeros(columns, SHOWN),
        carried: DMatrix::zeros(columns, NAVIGATION),
        shows_angle: linear.shows_angle(),
    };
    for (index, epoch) in linear.epochs.iter().enumerate() {
        if epoch.left_out {
            filter.pass_over(&space.step(epoch));
            continue;
        }
        let inputs = Inputs::of(epoch, combination);
        if epoch.fresh {
            space.forget_navigation(&mut filter.covariance);
            let start = inputs.start(linear.shows_angle());
            filter.columns.columns_mut(0, NAVIGATION).tr_copy_from(&start);
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
///
/// Here a column is a row: hundreds of them are carried by the same few numbers, one state after the other.
struct Pass {
    covariance: DMatrix<f64>,
    columns: DMatrix<f64>,
    whitened: DMatrix<f64>,
    carried: DMatrix<f64>,
    shows_angle: bool,
}

impl Pass {
    /// Goes on by one epoch; half the logarithm of the innovation covariance's determinant.
    fn step(&mut self, step: &Step, inputs: &Inputs) -> Option<f64> {
        let shown = step.shown_by();
        // P Φᵀ of navigation, and P Hᵀ, which has three columns of it.
        let of_navigation = times_transposed(&self.covariance, &step.navigation);
        let mut of_shown =
            times_transposed(&self.covariance, &step.attitude).resize_horizontally(SHOWN, 0.0);
        of_shown.columns_mut(3, 3).copy_from(&of_navigation.columns(3, 3));

        let s = Square::from_iterator((&shown * &of_shown).iter().copied()) + step.shown;
        let l = Cholesky::new((s + s.transpose()) * 0.5)?.l();

        // C = Φ P Hᵀ + cov(w, e), and W = C L⁻ᵀ.
        let corner = &step.navigation * &of_shown;
        of_shown.rows_mut(0, NAVIGATION).copy_from(&corner);
        for mut column in of_shown.column_iter_mut() {
            for (value, decay) in column.iter_mut().skip(NAVIGATION).zip(&step.decay) {
                *value *= decay;
            }
        }
        let mut gain = of_shown + &step.cross;
        over_transposed(gain.as_mut_slice(), &l);

        self.carry_columns(step, inputs, &l, &gain);
        self.carry_covariance(step, &of_navigation, &gain);
        Some(l.diagonal().iter().map(|x| x.ln()).sum())
    }

    /// Lets time go by for what has a memory; navigation starts anew afterwards.
    fn pass_over(&mut self, step: &Step) {
        for (index, decay) in step.decay.iter().enumerate() {
            let state = NAVIGATION + index;
            self.columns.column_mut(state).scale_mut(*decay);
            for (other, other_decay) in step.decay.iter().enumerate() {
                self.covariance[(NAVIGATION + other, state)] *= decay * other_decay;
            }
            self.covariance[(state, state)] += step.colour_noise[index];
        }
    }

    /// What of the columns is shown, whitened, and what is carried on.
    fn carry_columns(&mut self, step: &Step, inputs: &Inputs, l: &Square, gain: &DMatrix<f64>) {
        let Self { columns, whitened, carried, .. } = self;
        let count = columns.nrows();
        let columns = columns.as_mut_slice();
        carried.tr_copy_from(&inputs.navigation);
        add_times_transposed(carried.as_mut_slice(), columns, &step.navigation);
        let carried = carried.as_slice();
        whitened.columns_mut(0, 3).tr_copy_from(&inputs.shown_attitude);
        let seen = whitened.as_mut_slice();
        add_times_transposed(&mut seen[..3 * count], columns, &step.attitude);
        seen[3 * count..].copy_from_slice(&carried[3 * count..]);
        if !self.shows_angle {
            seen[2 * count..3 * count].fill(0.0);
        }
        over_transposed(seen, l);
        columns[..NAVIGATION * count].copy_from_slice(carried);
        Arch::new().dispatch(|| {
            let mut parts = seen.chunks_exact(count);
            let seen: [&[f64]; SHOWN] = std::array::from_fn(|_| parts.next().unwrap_or_default());
            for (state, column) in columns.chunks_exact_mut(count).enumerate() {
                let decay = if state < NAVIGATION { 1.0 } else { step.decay[state - NAVIGATION] };
                let gain: [f64; SHOWN] = std::array::from_fn(|part| gain[(state, part)]);
                take_away(column, decay, &gain, &seen);
            }
        });
    }

    /// `Φ P Φᵀ + Q - W Wᵀ`.
    fn carry_covariance(&mut self, step: &Step, of_navigation: &DMatrix<f64>, gain: &DMatrix<f64>) {
        let n = self.covariance.nrows();
        let corner = &step.navigation * of_navigation;
        let p = &mut self.covariance;
        for column in NAVIGATION..n {
            let decay = step.decay[column - NAVIGATION];
            let mut of_column = p.column_mut(column);
            for (value, other) in of_column.iter_mut().skip(NAVIGATION).zip(&step.decay) {
                *value *= decay * other;
            }
            p[(column, column)] += step.colour_noise[column - NAVIGATION];
            for row in 0..NAVIGATION {
                let value = of_navigation[(column, row)] * decay + step.noise[(column, row)];
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
        // One triangle, and the other from it: half the work, and no less symmetric.
        let p = p.as_mut_slice();
        Arch::new().dispatch(|| {
            let mut parts = gain.as_slice().chunks_exact(n);
            let gain: [&[f64]; SHOWN] = std::array::from_fn(|_| parts.next().unwrap_or_default());
            for (column, of_column) in p.chunks_exact_mut(n).enumerate() {
                let factors = gain.map(|gain| gain[column]);
                take_away(
                    &mut of_column[column..],
                    1.0,
                    &factors,
                    &gain.map(|gain| &gain[column..]),
                );
            }
        });
        self.covariance.fill_upper_triangle_with_lower_triangle();
    }
}

/// `P Aᵀ`, where `A` has few rows and many zeros, and `P` is symmetric.
fn times_transposed(p: &DMatrix<f64>, a: &DMatrix<f64>) -> DMatrix<f64> {
    let mut product = DMatrix::zeros(p.nrows(), a.nrows());
    add_times_transposed(product.as_mut_slice(), p.as_slice(), a);
    product
}

/// Adds `C Aᵀ` to `to`, where `A` has few rows and many zeros; column after column.
fn add_times_transposed(to: &mut [f64], c: &[f64], a: &DMatrix<f64>) {
    let count = c.len() / a.ncols();
    Arch::new().dispatch(|| {
        for (row, of_row) in to.chunks_exact_mut(count).enumerate() {
            for (column, of_column) in c.chunks_exact(count).enumerate() {
                let value = a[(row, column)];
                if value != 0.0 {
                    for (to, from) in of_row.iter_mut().zip(of_column) {
                        *to += value * from;
                    }
                }
            }
        }
    });
}

/// `C` becomes `C L⁻ᵀ`, column after column.
fn over_transposed(c: &mut [f64], l: &Square) {
    let count = c.len() / SHOWN;
    Arch::new().dispatch(|| {
        for column in 0..SHOWN {
            let (done, rest) = c.split_at_mut(column * count);
            let now = &mut rest[..count];
            for (before, done) in done.chunks_exact(count).enumerate() {
                let factor = l[(column, before)];
                for (now, done) in now.iter_mut().zip(done) {
                    *now -= factor * done;
                }
            }
            let factor = 1.0 / l[(column, column)];
            for value in now {
                *value *= factor;
            }
        }
    });
}

/// `x` becomes `x · decay - Σ gain · seen`.
#[inline(always)]
#[expect(clippy::inline_always, reason = "it is compiled with the machine's instructions")]
fn take_away(x: &mut [f64], decay: f64, gain: &[f64; SHOWN], seen: &[&[f64]; SHOWN]) {
    let seen = seen.map(|seen| &seen[..x.len()]);
    for (place, x) in x.iter_mut().enumerate() {
        let mut shown = 0.0;
        for part in 0..SHOWN {
            shown += gain[part] * seen[part][place];
        }
        *x = *x * decay - shown;
    }
}
