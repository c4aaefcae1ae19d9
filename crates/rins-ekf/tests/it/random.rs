//! Random linear time-varying systems, and runs of them.

use nalgebra::{SMatrix, SVector};
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;
use rins_ekf::{Filter, Measurement, congruence};

/// States, measurements in a step, and noise sources that drive both.
pub(crate) const N: usize = 4;
pub(crate) const M: usize = 2;
pub(crate) const SHARED: usize = 1;

pub(crate) struct Random(Pcg64);

impl Random {
    pub(crate) fn seeded(seed: u64) -> Self {
        Self(Pcg64::seed_from_u64(seed))
    }

    pub(crate) fn matrix<const R: usize, const C: usize>(&mut self) -> SMatrix<f64, R, C> {
        SMatrix::from_fn(|_, _| StandardNormal.sample(&mut self.0))
    }

    /// A positive definite matrix with eigenvalues of 0.1 and more.
    pub(crate) fn covariance<const R: usize>(&mut self) -> SMatrix<f64, R, R> {
        congruence(&self.matrix::<R, R>(), &SMatrix::identity()) + SMatrix::identity() * 0.1
    }

    /// A draw from N(0, `covariance`).
    pub(crate) fn draw<const R: usize>(
        &mut self,
        covariance: &SMatrix<f64, R, R>,
    ) -> SVector<f64, R> {
        covariance.cholesky().unwrap().l() * self.matrix::<R, 1>()
    }
}

/// `x = Φ x' + G n + w`, `z = H x + D n + v`, with `n ~ N(0, I)` in both.
pub(crate) struct Step {
    pub(crate) transition: SMatrix<f64, N, N>,
    pub(crate) drive: SMatrix<f64, N, SHARED>,
    pub(crate) process: SMatrix<f64, N, N>,
    pub(crate) matrix: SMatrix<f64, M, N>,
    pub(crate) feed: SMatrix<f64, M, SHARED>,
    pub(crate) noise: SMatrix<f64, M, M>,
    pub(crate) value: SVector<f64, M>,
}

impl Step {
    /// The total process noise for a filter without `n` in its state.
    pub(crate) fn total_process(&self) -> SMatrix<f64, N, N> {
        congruence(&self.drive, &SMatrix::identity()) + self.process
    }

    pub(crate) fn measurement(&self) -> Measurement<M, N> {
        let noise = congruence(&self.feed, &SMatrix::identity()) + self.noise;
        let measurement = Measurement::new(self.value, self.matrix, noise);
        if self.feed.norm() > 0.0 {
            measurement.correlated_with_state_error(self.drive * self.feed.transpose())
        } else {
            measurement
        }
    }
}

/// Whether one noise drives the state and the measurements.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Shared {
    Yes,
    No,
}

pub(crate) struct Run {
    pub(crate) start: Filter<N>,
    pub(crate) steps: Vec<Step>,
    /// The true states at the ends of the steps.
    pub(crate) truth: Vec<SVector<f64, N>>,
}

/// A run of a random system, its data drawn from the model itself.
pub(crate) fn run(seed: u64, n_steps: usize, shared: Shared) -> Run {
    let mut random = Random::seeded(seed);
    let start = Filter::new(random.matrix(), random.covariance()).unwrap();
    let mut state = start.state + random.draw(&start.covariance);
    let mut steps = Vec::new();
    let mut truth = Vec::new();
    for _ in 0..n_steps {
        // With a norm near 1, so that the state stays bounded in a long run.
        let transition = SMatrix::identity() * 0.9 + random.matrix::<N, N>() * 0.1;
        let feed = match shared {
            Shared::Yes => random.matrix(),
            Shared::No => SMatrix::zeros(),
        };
        let mut step = Step {
            transition,
            drive: random.matrix(),
            process: random.covariance(),
            matrix: random.matrix(),
            feed,
            noise: random.covariance(),
            value: SVector::zeros(),
        };
        let n = random.matrix::<SHARED, 1>();
        state = step.transition * state + step.drive * n + random.draw(&step.process);
        step.value = step.matrix * state + step.feed * n + random.draw(&step.noise);
        steps.push(step);
        truth.push(state);
    }
    Run { start, steps, truth }
}
