//! The filter and the smoother compared with least squares over the whole run.

use nalgebra::{Cholesky, DMatrix, DVector, SMatrix};
use proptest::prelude::*;
use rins_ekf::{Filter, Smoother, Step as Recorded};

use crate::random::{M, N, Run, SHARED, Shared, run};

/// The rounding error of the normal equations: their condition number, about 1e5 here, times the machine precision.
const BATCH_ROUNDING: f64 = 1e-10;

/// All states and shared noises of a run, and the inverse of their normal matrix.
///
/// The unknowns are the states at every time, then the shared noises; every measurement, transition or prior is a row of
/// residuals weighted by the inverse root of its covariance.
struct Batch {
    rows: Vec<(DMatrix<f64>, DVector<f64>)>,
    n_unknowns: usize,
}

impl Batch {
    fn of(run: &Run) -> Self {
        let n_steps = run.steps.len();
        let noise_at = |step: usize| (n_steps + 1) * N + step * SHARED;
        let n_unknowns = noise_at(n_steps);
        let mut batch = Self { rows: Vec::new(), n_unknowns };
        let identity = SMatrix::<f64, N, N>::identity();

        batch.add(&run.start.covariance, &[(0, dynamic(&identity))], &dynamic(&run.start.state));
        for (k, step) in run.steps.iter().enumerate() {
            let (before, after, noise) = (k * N, (k + 1) * N, noise_at(k));
            let unit = SMatrix::<f64, SHARED, SHARED>::identity();
            batch.add(&unit, &[(noise, dynamic(&unit))], &DMatrix::zeros(SHARED, 1));
            batch.add(
                &step.process,
                &[
                    (after, dynamic(&identity)),
                    (before, dynamic(&-step.transition)),
                    (noise, dynamic(&-step.drive)),
                ],
                &DMatrix::zeros(N, 1),
            );
            batch.add(
                &step.noise,
                &[(after, dynamic(&step.matrix)), (noise, dynamic(&step.feed))],
                &DMatrix::from_column_slice(M, 1, step.value.as_slice()),
            );
        }
        batch
    }

    fn add<const R: usize>(
        &mut self,
        covariance: &SMatrix<f64, R, R>,
        blocks: &[(usize, DMatrix<f64>)],
        value: &DMatrix<f64>,
    ) {
        let root = dynamic(&covariance.cholesky().unwrap().l());
        let mut row = DMatrix::zeros(R, self.n_unknowns);
        for (column, block) in blocks {
            row.view_mut((0, *column), block.shape()).copy_from(block);
        }
        let row = root.solve_lower_triangular(&row).unwrap();
        let value = root.solve_lower_triangular(value).unwrap();
        self.rows.push((row, value.column(0).into_owned()));
    }

    /// The estimates of all unknowns and their covariance.
    fn solved(&self) -> (DVector<f64>, DMatrix<f64>) {
        let mut information = DMatrix::zeros(self.n_unknowns, self.n_unknowns);
        let mut right = DVector::zeros(self.n_unknowns);
        for (row, value) in &self.rows {
            information += row.transpose() * row;
            right += row.transpose() * value;
        }
        let covariance = Cholesky::new(information).unwrap().inverse();
        (&covariance * right, covariance)
    }
}

fn dynamic<const R: usize, const C: usize>(matrix: &SMatrix<f64, R, C>) -> DMatrix<f64> {
    DMatrix::from_column_slice(R, C, matrix.as_slice())
}

/// The largest deviation of an estimate and its covariance from the batch's at time `k`.
fn deviation(
    (estimate, covariance): &(DVector<f64>, DMatrix<f64>),
    k: usize,
    state: &nalgebra::SVector<f64, N>,
    p: &SMatrix<f64, N, N>,
) -> f64 {
    let mean = (estimate.rows(k * N, N) - state).amax();
    let spread = (covariance.view((k * N, k * N), (N, N)) - p).amax();
    mean.max(spread)
}

fn filtered(run: &Run) -> Filter<N> {
    let mut filter = run.start.clone();
    for step in &run.steps {
        filter.predict(&step.transition, &step.total_process());
        filter.update(&step.measurement()).unwrap();
    }
    filter
}

/// Whether the filter is reset to zero after each step.
#[derive(Clone, Copy, PartialEq)]
enum Reset {
    Never,
    EveryStep,
}

fn recorded(run: &Run, reset: Reset) -> (Smoother<N>, Vec<nalgebra::SVector<f64, N>>) {
    let mut filter = run.start.clone();
    let mut smoother = Smoother::new(filter.clone());
    // The reference of an error-state filter: corrected, reset, and propagated outside the filter.
    let mut about = nalgebra::SVector::<f64, N>::zeros();
    let mut corrected = Vec::new();
    for step in &run.steps {
        filter.predict(&step.transition, &step.total_process());
        about = step.transition * about;
        let predicted = filter.clone();
        let mut measurement = step.measurement();
        measurement.value -= step.matrix * about;
        filter.update(&measurement).unwrap();
        smoother.push(Recorded {
            transition: step.transition,
            noise: step.total_process(),
            predicted,
            filtered: filter.clone(),
        });
        if reset == Reset::EveryStep {
            about += filter.state;
            filter.state = nalgebra::SVector::zeros();
        }
        corrected.push(about + filter.state);
    }
    (smoother, corrected)
}

proptest! {
    #[test]
    fn filter_is_least_squares(seed: u64, n_steps in 1..8_usize) {
        let run = run(seed, n_steps, Shared::No);
        let got = filtered(&run);
        let batch = Batch::of(&run).solved();
        let off = deviation(&batch, n_steps, &got.state, &got.covariance);
        prop_assert!(off < BATCH_ROUNDING, "off by {off:e}");
    }

    #[test]
    fn shared_noise_by_its_covariance_is_shared_noise_as_an_unknown(
        seed: u64,
        n_steps in 1..8_usize,
    ) {
        let run = run(seed, n_steps, Shared::Yes);
        let got = filtered(&run);
        let batch = Batch::of(&run).solved();
        let off = deviation(&batch, n_steps, &got.state, &got.covariance);
        prop_assert!(off < BATCH_ROUNDING, "off by {off:e}");
    }

    #[test]
    fn smoother_is_least_squares_at_every_time(seed: u64, n_steps in 1..8_usize) {
        let run = run(seed, n_steps, Shared::No);
        let batch = Batch::of(&run).solved();
        let smoothed = recorded(&run, Reset::Never).0.smoothed().unwrap();
        prop_assert_eq!(smoothed.len(), n_steps + 1);
        for (k, at) in smoothed.iter().enumerate() {
            let off = deviation(&batch, k, &at.state, &at.covariance);
            prop_assert!(off < BATCH_ROUNDING, "off by {off:e} at {k}");
            prop_assert_eq!(at.covariance, at.covariance.transpose());
        }
    }

    #[test]
    fn smoothed_corrections_of_a_reset_filter_lead_to_least_squares(
        seed: u64,
        n_steps in 1..8_usize,
    ) {
        let run = run(seed, n_steps, Shared::No);
        let batch = Batch::of(&run).solved();
        let (smoother, corrected) = recorded(&run, Reset::EveryStep);
        let smoothed = smoother.smoothed().unwrap();
        for (k, about) in corrected.iter().enumerate() {
            let at = &smoothed[k + 1];
            let off = deviation(&batch, k + 1, &(about + at.correction), &at.covariance);
            prop_assert!(off < BATCH_ROUNDING, "off by {off:e} at {k}");
        }
    }
}

#[test]
fn ignoring_shared_noise_is_not_least_squares() {
    let mut run = run(3, 6, Shared::Yes);
    let batch = Batch::of(&run).solved();
    let mut filter = run.start.clone();
    for step in &mut run.steps {
        filter.predict(&step.transition, &step.total_process());
        let mut measurement = step.measurement();
        measurement.cross = None;
        filter.update(&measurement).unwrap();
    }
    assert!(deviation(&batch, 6, &filter.state, &filter.covariance) > 1e-2);
}

#[test]
fn agrees_with_a_dense_filter_over_18000_steps() {
    let run = run(5, 18_000, Shared::Yes);
    let mut filter = run.start.clone();
    let (mut x, mut p) = (dynamic(&run.start.state), dynamic(&run.start.covariance));
    let mut worst: f64 = 0.0;
    for step in &run.steps {
        filter.predict(&step.transition, &step.total_process());
        let measurement = step.measurement();
        filter.update(&measurement).unwrap();

        let transition = dynamic(&step.transition);
        let h = dynamic(&measurement.matrix);
        let c = dynamic(&measurement.cross.unwrap());
        x = &transition * x;
        p = &transition * p * transition.transpose() + dynamic(&step.total_process());
        // The plain form, from the conditional mean of two correlated Gaussian variables.
        let with_innovation = &p * h.transpose() + &c;
        let s = &h * &with_innovation + c.transpose() * h.transpose() + dynamic(&measurement.noise);
        let gain = &with_innovation * s.try_inverse().unwrap();
        x = &x + &gain * (dynamic(&measurement.value) - &h * &x);
        p = &p - &gain * with_innovation.transpose();

        worst = worst.max((dynamic(&filter.state) - &x).amax() / x.amax());
        worst = worst.max((dynamic(&filter.covariance) - &p).amax() / p.amax());
    }
    assert!(worst < 1e-12, "off by {worst:e}");
}
