//! One prediction and update of 12 states by 6 measurements, compared with the textbook's dense Joseph form.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::{SMatrix, SVector};
use rins_ekf::{Filter, Measurement};

const N: usize = 12;
const M: usize = 6;

struct Case {
    filter: Filter<N>,
    transition: SMatrix<f64, N, N>,
    noise: SMatrix<f64, N, N>,
    measurement: Measurement<M, N>,
}

/// All elements of all matrices are nonzero.
fn dense() -> Case {
    let wave = |i: usize, j: usize| (1.3 * i as f64 + 0.7 * j as f64).sin();
    let root = SMatrix::<f64, N, N>::from_fn(wave);
    Case {
        filter: Filter {
            state: SVector::from_fn(|i, _| wave(i, 3)),
            covariance: rins_ekf::congruence(&root, &SMatrix::identity())
                + SMatrix::identity() * 2.0,
        },
        transition: SMatrix::identity() + SMatrix::from_fn(wave) * 0.01,
        noise: SMatrix::identity() * 0.01,
        measurement: Measurement::new(
            SVector::from_fn(|i, _| wave(i, 1)),
            SMatrix::from_fn(|i, j| wave(j, i)),
            SMatrix::identity() * 0.5,
        ),
    }
}

/// The pattern of the calibration filter: attitude, velocity, and six constant sensor errors that drive them; velocity and
/// three rates are measured.
fn sparse() -> Case {
    let mut case = dense();
    let block_used = |i: usize, j: usize| match (i / 3, j / 3) {
        (0, 0 | 2 | 3) | (1, 0 | 1) => true,
        _ => i == j,
    };
    case.transition =
        SMatrix::from_fn(|i, j| if block_used(i, j) { case.transition[(i, j)] } else { 0.0 });
    case.measurement.matrix = SMatrix::from_fn(|i, j| {
        let used = if i < 3 { j == i + 3 } else { j >= 6 };
        if used { case.measurement.matrix[(i, j)] } else { 0.0 }
    });
    case
}

fn ours(case: &Case) -> Filter<N> {
    let mut filter = case.filter.clone();
    filter.predict(&case.transition, &case.noise);
    filter.update(&case.measurement).expect("the case is well conditioned");
    filter
}

fn dense_joseph(case: &Case) -> Filter<N> {
    let Measurement { value: z, matrix: h, noise: r, .. } = &case.measurement;
    let x = case.transition * case.filter.state;
    let p = case.transition * case.filter.covariance * case.transition.transpose() + case.noise;
    let s = h * p * h.transpose() + r;
    let gain = p * h.transpose() * s.try_inverse().expect("the case is well conditioned");
    let keep = SMatrix::<f64, N, N>::identity() - gain * h;
    Filter {
        state: x + gain * (z - h * x),
        covariance: keep * p * keep.transpose() + gain * r * gain.transpose(),
    }
}

fn step(criterion: &mut Criterion) {
    for (name, mut case) in [("dense", dense()), ("sparse", sparse())] {
        let (got, want) = (ours(&case), dense_joseph(&case));
        assert!((got.state - want.state).norm() < 1e-12);
        assert!((got.covariance - want.covariance).norm() < 1e-12);

        let mut group = criterion.benchmark_group(format!("filter/step/n12m6_{name}"));
        group.bench_function("rins", |b| b.iter(|| ours(black_box(&case))));
        group.bench_function("textbook", |b| b.iter(|| dense_joseph(black_box(&case))));
        case.measurement = case.measurement.correlated_with_state_error(SMatrix::zeros());
        group.bench_function("rins_correlated", |b| b.iter(|| ours(black_box(&case))));
        group.finish();
    }
}

criterion_group!(benches, step);
criterion_main!(benches);
