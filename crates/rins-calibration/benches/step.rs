//! One prediction and update of 12, 24, 40 and 48 states by 6 rows, compared with the textbook's dense form, and in lanes.

use std::hint::black_box;

use criterion::measurement::WallTime;
use criterion::{BenchmarkGroup, Criterion, Throughput, criterion_group, criterion_main};
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use rins_calibration::structured::{
    Comparison, Covariance, Input, Means, NAVIGATION, States, Transition, With,
};
use rins_lanes::{Arch, Lane, Matrix, Real, Simd, Vector, WithSimd, rotation};

/// The number of steps in one timing; each has another transition.
const STEPS: usize = 200;

/// The tolerance of the covariances after the steps, in units of sigmas.
const AGREEMENT: f64 = 1e-10;

const INTERVAL: f64 = 0.02;
const VELOCITY_NOISE: f64 = 1e-4;
const DENSITIES: [f64; 2] = [3e-4, 6e-6];

/// Constants that affect the sensors in turn.
#[derive(Clone, Copy)]
enum InTurn {}

const fn in_turn<const N: usize>() -> [Input; N] {
    let mut inputs = [Input::None; N];
    let mut index = NAVIGATION;
    while index < N {
        // The first twelve are errors of the gyros, as those of the paper.
        inputs[index] = if index < 21 { Input::Gyro(index % 3) } else { Input::Accel(index % 3) };
        index += 1;
    }
    inputs
}

impl<const N: usize> States<N> for InTurn {
    const INPUTS: [Input; N] = in_turn();
    const AXIS: Option<usize> = None;
}

/// The means of a step.
fn means<T: Real>(like: T, step: usize) -> Means<T> {
    let turn = Vector::constant(like, [0.3, 0.4, 0.0035 * step as f64]);
    let (sin, cos) = 0.6_f64.sin_cos();
    Means {
        interval: INTERVAL,
        curvatures: [like.constant(1.0 / 6.35e6), like.constant(1.0 / 6.39e6)],
        latitude: [like.constant(sin), like.constant(cos)],
        velocity: Vector::zeros(like),
        gravity: 9.8,
        specific_force: Vector::constant(like, [0.01, -0.02, 9.8]),
        nav_from_body: rotation::exp(&turn),
    }
}

fn regressors<T: Real, const N: usize>(like: T) -> [T; N] {
    core::array::from_fn(|index| like.constant(0.17 / (1 + index / 3) as f64))
}

fn comparison<T: Real, const N: usize>(means: &Means<T>, rates: [T; N]) -> Comparison<T, N> {
    let like = rates[0];
    let earth_rate = Vector::constant(like, [0.0, 6e-5, 4e-5]);
    let gyro = DENSITIES[1] * DENSITIES[1];
    Comparison {
        difference: Vector::constant(like, [1e-6, -2e-6, 3e-6]),
        by_attitude: means.nav_from_body.transpose() * Matrix::cross(&earth_rate),
        with: With::Rates(rates),
        noise: [gyro / INTERVAL; 3],
        cross: Some(means.nav_from_body.scaled(-gyro)),
    }
}

/// Priors of each kind of states, in their units.
fn prior(row: usize, column: usize) -> f64 {
    let sigma = |index: usize| match index {
        0..3 => 1e-9,
        _ => 1e-4,
    };
    if row == column { sigma(row) * sigma(row) } else { 0.0 }
}

/// The sum of the innovations, so that the compiler cannot omit any of them, and the covariance.
#[inline(always)]
#[expect(clippy::inline_always, reason = "it is compiled with the machine's instructions")]
fn structured<T: Real, const N: usize>(
    means: &[Means<T>],
    rates: &[T; N],
) -> (Covariance<T, N>, T) {
    let like = rates[0];
    let mut p = Covariance::from_fn(like, |row, column| like.constant(prior(row, column)));
    let velocity = Vector::constant(like, [1e-5, 2e-5, -3e-5]);
    let mut sum = like.constant(0.0);
    for means in means {
        Transition::<T, InTurn, N>::new(means, *rates, DENSITIES).carry(&mut p);
        let comparison = comparison(means, *rates);
        let found = p.update::<InTurn>(&comparison, &velocity, VELOCITY_NOISE);
        sum = sum + found.state[6] + found.state[N - 1];
    }
    (p, sum)
}

/// The same in the form of `Φ`, `Q`, `H`, `R` and `C`.
struct Dense<const N: usize> {
    transition: SMatrix<f64, N, N>,
    noise: SMatrix<f64, N, N>,
    matrix: SMatrix<f64, 6, N>,
    variances: SMatrix<f64, 6, 6>,
    cross: SMatrix<f64, N, 6>,
    value: SVector<f64, 6>,
}

fn dense<const N: usize>(means: &Means<f64>, rates: &[f64; N]) -> Dense<N> {
    let earth_rate = Vector3::new(0.0, means.latitude[1], means.latitude[0]) * 7.292115e-5;
    let force: Vector3<f64> = means.specific_force.into();
    let c = means.nav_from_body.lane(0);
    let [radius, g] = [1.0 / means.curvatures[0], means.gravity];
    let mut f = SMatrix::<f64, N, N>::zeros();
    let along = Matrix3::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, radius) / radius;
    f.fixed_view_mut::<3, 3>(0, 3).copy_from(&along);
    let weight = Matrix3::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 2.0 / radius) * g;
    f.fixed_view_mut::<3, 3>(3, 0).copy_from(&weight);
    f.fixed_view_mut::<3, 3>(3, 3).copy_from(&(earth_rate * -2.0).cross_matrix());
    f.fixed_view_mut::<3, 3>(3, 6).copy_from(&force.cross_matrix());
    f.fixed_view_mut::<3, 3>(6, 6).copy_from(&(-earth_rate).cross_matrix());
    let mut matrix = SMatrix::<f64, 6, N>::zeros();
    for (index, &rate) in rates.iter().enumerate().skip(NAVIGATION) {
        match <InTurn as States<N>>::INPUTS[index] {
            Input::Gyro(axis) => {
                f.fixed_view_mut::<3, 1>(6, index).copy_from(&(c.column(axis) * -rate));
                matrix[(3 + axis, index)] = rate;
            }
            Input::Accel(axis) => {
                f.fixed_view_mut::<3, 1>(3, index).copy_from(&(c.column(axis) * rate));
            }
            Input::None => {}
        }
    }
    let comparison = comparison(means, *rates);
    let by = comparison.by_attitude.lane(0);
    matrix.fixed_view_mut::<3, 3>(0, 3).fill_with_identity();
    matrix.fixed_view_mut::<3, 3>(3, 6).copy_from(&by);
    matrix.fixed_view_mut::<3, 2>(3, 0).copy_from(&by.fixed_columns::<2>(0));
    let mut noise = SMatrix::<f64, N, N>::zeros();
    for axis in 0..3 {
        noise[(3 + axis, 3 + axis)] = DENSITIES[0] * DENSITIES[0] * INTERVAL;
        noise[(6 + axis, 6 + axis)] = DENSITIES[1] * DENSITIES[1] * INTERVAL;
    }
    let mut cross = SMatrix::<f64, N, 6>::zeros();
    let gyro = DENSITIES[1] * DENSITIES[1];
    cross.fixed_view_mut::<3, 3>(6, 3).copy_from(&(c * -gyro));
    Dense {
        transition: transition(&f),
        noise,
        matrix,
        variances: SMatrix::from_diagonal(&SVector::from_fn(|row, _| {
            if row < 3 { VELOCITY_NOISE * VELOCITY_NOISE } else { comparison.noise[row - 3] }
        })),
        cross,
        value: SVector::from([1e-5, 2e-5, -3e-5, 1e-6, -2e-6, 3e-6]),
    }
}

/// The product of the factors of the structured transition.
fn transition<const N: usize>(f: &SMatrix<f64, N, N>) -> SMatrix<f64, N, N> {
    let part = |first: usize, share: f64| {
        let mut factor = SMatrix::<f64, N, N>::identity();
        let mut rows = factor.fixed_rows_mut::<3>(first);
        rows += f.fixed_rows::<3>(first) * (INTERVAL * share);
        factor
    };
    let (half_position, mut velocity, attitude) = (part(0, 0.5), part(3, 1.0), part(6, 1.0));
    let half_way = (attitude - SMatrix::identity()).fixed_rows::<3>(6) * 0.5;
    let force = f.fixed_view::<3, 3>(3, 6) * INTERVAL;
    let more = force * half_way.fixed_columns::<3>(6);
    let mut by_gyros = (force + more) * half_way;
    by_gyros.fixed_columns_mut::<3>(6).copy_from(&more);
    let mut rows = velocity.fixed_rows_mut::<3>(3);
    rows += by_gyros;
    half_position * attitude * velocity * half_position
}

/// Joseph's form with nalgebra's products; [`Dense::cross`] enters as for a correlated noise.
fn textbook<const N: usize>(steps: &[Dense<N>]) -> (SMatrix<f64, N, N>, f64) {
    let mut p = SMatrix::<f64, N, N>::from_fn(prior);
    let mut sum = 0.0;
    for step in steps {
        let Dense { transition, noise, matrix: h, variances: r, cross: c, value } = step;
        p = transition * p * transition.transpose() + noise;
        let hc = h * c;
        let s = h * p * h.transpose() + hc + hc.transpose() + r;
        let inverse = s.try_inverse().expect("the case is well conditioned");
        let gain = (p * h.transpose() + c) * inverse;
        let keep = SMatrix::<f64, N, N>::identity() - gain * h;
        let crossed = keep * c * gain.transpose();
        p = keep * p * keep.transpose() + gain * r * gain.transpose()
            - crossed
            - crossed.transpose();
        let state = gain * value;
        sum += state[6] + state[N - 1];
    }
    (p, sum)
}

struct Lanes<'a, const N: usize>(&'a [Means<f64>], &'a [f64; N]);

impl<const N: usize> WithSimd for Lanes<'_, N> {
    type Output = (usize, f64);

    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it is compiled with the machine's instructions")]
    fn with_simd<S: Simd>(self, simd: S) -> (usize, f64) {
        let like = Lane::splat(simd, 0.0);
        let rates = self.1.map(|rate| like.constant(rate));
        let velocity = Vector::constant(like, [1e-5, 2e-5, -3e-5]);
        let mut p = Covariance::from_fn(like, |row, column| like.constant(prior(row, column)));
        let mut sum = like;
        for means in self.0 {
            let ([m, t], [sin, cos]) = (means.curvatures, means.latitude);
            let c = means.nav_from_body;
            let means = Means {
                interval: INTERVAL,
                curvatures: [like.constant(m), like.constant(t)],
                latitude: [like.constant(sin), like.constant(cos)],
                velocity: Vector::constant(like, means.velocity.0),
                gravity: means.gravity,
                specific_force: Vector::constant(like, means.specific_force.0),
                nav_from_body: Matrix([
                    Vector::constant(like, c[0]).0,
                    Vector::constant(like, c[1]).0,
                    Vector::constant(like, c[2]).0,
                ]),
            };
            Transition::<Lane<S>, InTurn, N>::new(&means, rates, DENSITIES).carry(&mut p);
            let found = p.update::<InTurn>(&comparison(&means, rates), &velocity, VELOCITY_NOISE);
            sum = sum + found.state[6] + found.state[N - 1];
        }
        (sum.lanes(), sum.lane(sum.lanes() - 1))
    }
}

/// The data of the steps of one kind.
struct Case<const N: usize> {
    means: Vec<Means<f64>>,
    rates: [f64; N],
    dense: Vec<Dense<N>>,
}

impl<const N: usize> Case<N> {
    fn new() -> Self {
        let rates = regressors::<f64, N>(0.0);
        let means: Vec<_> = (0..STEPS).map(|step| means(0.0, step)).collect();
        let dense = means.iter().map(|means| dense::<N>(means, &rates)).collect();
        Self { means, rates, dense }
    }

    fn in_lanes(&self) -> (usize, f64) {
        Arch::new().dispatch(Lanes(black_box(&self.means), &self.rates))
    }

    /// In the lanes of AVX2, if the machine has it, even if it has wider ones.
    fn in_avx2_lanes(&self) -> (usize, f64) {
        #[cfg(target_arch = "x86_64")]
        if let Some(four_lanes) = rins_lanes::x86::V3::try_new() {
            return Simd::vectorize(four_lanes, Lanes(black_box(&self.means), &self.rates));
        }
        self.in_lanes()
    }

    /// Checks that all timed functions have the same result; returns the number of lanes, and that of AVX2.
    fn check(
        &self,
        structured: fn(&Self) -> (Covariance<f64, N>, f64),
        lanes: fn(&Self) -> (usize, f64),
    ) -> [usize; 2] {
        let (got, sum) = structured(self);
        let (want, want_sum) = textbook(&self.dense);
        for row in 0..N {
            for column in 0..=row {
                let scale = (want[(row, row)] * want[(column, column)]).sqrt();
                let off = (got.get(row, column) - want[(row, column)]) / scale;
                assert!(off.abs() < AGREEMENT, "({row}, {column}) is off by {off:e}");
            }
        }
        assert!((sum / want_sum - 1.0).abs() < AGREEMENT, "{sum:e} against {want_sum:e}");
        let [width, four] = [lanes(self), self.in_avx2_lanes()].map(|(width, in_lanes)| {
            assert_eq!(in_lanes.to_bits(), sum.to_bits(), "a lane has the bits of its run");
            width
        });
        [width, four]
    }
}

/// The functions whose instructions `cargo xtask bench` counts, by their names.
mod counted {
    use super::{Case, Covariance, black_box, structured};

    #[inline(never)]
    pub(super) fn filter_step_12(case: &Case<12>) -> (Covariance<f64, 12>, f64) {
        structured(black_box(&case.means), &case.rates)
    }

    #[inline(never)]
    pub(super) fn filter_step_24(case: &Case<24>) -> (Covariance<f64, 24>, f64) {
        structured(black_box(&case.means), &case.rates)
    }

    #[inline(never)]
    pub(super) fn filter_step_40(case: &Case<40>) -> (Covariance<f64, 40>, f64) {
        structured(black_box(&case.means), &case.rates)
    }

    #[inline(never)]
    pub(super) fn filter_step_48(case: &Case<48>) -> (Covariance<f64, 48>, f64) {
        structured(black_box(&case.means), &case.rates)
    }

    #[inline(never)]
    pub(super) fn filter_lanes_12(case: &Case<12>) -> (usize, f64) {
        case.in_lanes()
    }
}

fn time<const N: usize>(
    criterion: &mut Criterion,
    structured: fn(&Case<N>) -> (Covariance<f64, N>, f64),
    lanes: fn(&Case<N>) -> (usize, f64),
) {
    let case = Case::<N>::new();
    let [width, four] = case.check(structured, lanes);
    let mut group: BenchmarkGroup<'_, WallTime> =
        criterion.benchmark_group(format!("filter_step_{N}"));
    group.throughput(Throughput::Elements(STEPS as u64));
    group.bench_function("one", |b| b.iter(|| structured(black_box(&case))));
    group.bench_function("dense", |b| b.iter(|| textbook(black_box(&case.dense))));
    group.throughput(Throughput::Elements((STEPS * width) as u64));
    group.bench_function("lanes", |b| b.iter(|| lanes(black_box(&case))));
    group.throughput(Throughput::Elements((STEPS * four) as u64));
    group.bench_function("avx2", |b| b.iter(|| black_box(&case).in_avx2_lanes()));
    group.finish();
}

fn steps(criterion: &mut Criterion) {
    time(criterion, counted::filter_step_12, counted::filter_lanes_12);
    time(criterion, counted::filter_step_24, Case::in_lanes);
    time(criterion, counted::filter_step_40, Case::in_lanes);
    time(criterion, counted::filter_step_48, Case::in_lanes);
}

criterion_group!(benches, steps);
criterion_main!(benches);
