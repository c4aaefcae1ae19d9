//! The prediction with dense matrices, and a comparison of the structured with the generic filter.

use nalgebra::{Matrix3, SMatrix, Vector3};
use rins_ekf::Block;
use rins_frames::EARTH_RATE;

use super::Means;
use crate::layout::{ATTITUDE, POSITION, SPIN_AXIS_ERRORS, STATES, VELOCITY};

/// A matrix over the whole state.
type StateMatrix = SMatrix<f64, STATES, STATES>;

/// The matrix `F` of eqs. (11)-(15) for gyros with the rate `spin_rate` \[rad/s\].
///
/// Row two of (13) contains `+(ρ + 2Ω)_x δv_z`, which the paper prints with a minus.
fn dynamics(means: &Means<f64>, spin_rate: f64) -> StateMatrix {
    let Means { curvatures: [meridian, transverse], latitude: [sin, cos], gravity, .. } = *means;
    let velocity: Vector3<f64> = means.velocity.into();
    let earth_rate = Vector3::new(0.0, cos, sin) * EARTH_RATE;
    let east = velocity.x * transverse;
    let nav_rate = earth_rate + Vector3::new(-velocity.y * meridian, east, east * sin / cos);
    let coriolis = earth_rate + nav_rate;
    let radius = 1.0 / meridian;
    let climb = velocity.z / radius;
    let force: Vector3<f64> = means.specific_force.into();

    let mut f = StateMatrix::zeros();
    // (14); the wander angle is zero over such a short distance.
    let along = Matrix3::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, radius) / radius;
    POSITION.set(VELOCITY, &mut f, &along);
    let shrink = Matrix3::from_diagonal(&Vector3::new(-climb, -climb, 0.0));
    POSITION.set(POSITION, &mut f, &shrink);
    // (13)
    let weight = Matrix3::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 2.0 / radius) * gravity;
    VELOCITY.set(POSITION, &mut f, &weight);
    VELOCITY.set(VELOCITY, &mut f, &-coriolis.cross_matrix());
    VELOCITY.set(ATTITUDE, &mut f, &force.cross_matrix());
    // (12) and (15)
    ATTITUDE.set(ATTITUDE, &mut f, &-nav_rate.cross_matrix());
    ATTITUDE.set(SPIN_AXIS_ERRORS, &mut f, &(means.nav_from_body.lane(0) * -spin_rate));
    f
}

/// `Θ Ψ V Θ` over an interval, as in [`super::Transition`].
fn transition(f: &StateMatrix, interval: f64) -> StateMatrix {
    let part = |block: Block<3>, share: f64| {
        let mut factor = StateMatrix::identity();
        for row in block.start()..block.end() {
            for column in 0..STATES {
                factor[(row, column)] += f[(row, column)] * interval * share;
            }
        }
        factor
    };
    let half_position = part(POSITION, 0.5);
    let mut velocity = part(VELOCITY, 1.0);
    let attitude = part(ATTITUDE, 1.0);
    // The attitude error at the middle: rotated with the level, then by the gyro errors.
    let half_way = (attitude - StateMatrix::identity()) * 0.5;
    let force = VELOCITY.get(ATTITUDE, &velocity);
    let force = force + force * ATTITUDE.get(ATTITUDE, &half_way);
    VELOCITY.set(ATTITUDE, &mut velocity, &force);
    let by_gyros = force * ATTITUDE.get(SPIN_AXIS_ERRORS, &half_way);
    VELOCITY.set(SPIN_AXIS_ERRORS, &mut velocity, &by_gyros);
    half_position * attitude * velocity * half_position
}

mod tests {
    use super::*;
    use nalgebra::SVector;
    use rand::RngExt;
    use rand_pcg::Pcg64;
    use rins_ekf::Filter;
    use rins_frames::units::DEG;
    use rins_frames::{Dcm, EulerAngles, InFrame, Increments, Site};
    use rins_imu::{ImuSpec, TriadSpec};
    use rins_lanes::{Matrix, Vector};
    use rins_motion::{
        NavState, Navigator, Profile, Segment, Station, TrueMotion, VerticalChannel,
    };

    use crate::filter::{AngleSource, Start};
    use crate::kernel::PLAIN;
    use crate::kernel::{Kernel, Reading, Sample, WithAxis};
    use crate::setup::{Setup, TableSpec};
    use crate::structured::{Covariance, Transition};

    const INTERVAL: f64 = 0.02;

    /// The tolerance of the difference between structured and generic filter during a run, relative to sigmas, if the prior
    /// variances do not greatly exceed the measurement noise.
    const AGREEMENT: f64 = 1e-12;

    /// The same for the position, which is not measured: the rounding errors of 18,000 steps accumulate.
    const OF_POSITION: f64 = 3e-12;

    const RATE: f64 = 20.0 * DEG;
    const STEPS: usize = 100;

    type State = SVector<f64, STATES>;

    /// The tolerance of the prediction relative to the initial error: the products of two seconds with the Earth's rate and
    /// the curvature, which the model neglects.
    const WITHIN: f64 = 2e-3;

    fn motion() -> TrueMotion {
        let site = Site { latitude: 0.6, longitude: 0.3, height: 200.0 };
        let angles = EulerAngles { roll: 0.5, pitch: 0.3, yaw: 0.7 };
        let turn = Segment { rate: RATE, duration: STEPS as f64 * INTERVAL };
        TrueMotion {
            station: Station::with_normal_gravity(site),
            nav_from_table: angles.dcm(),
            profile: Profile::new(&[turn], None).unwrap(),
        }
    }

    /// Small errors of each kind: 1 m, 1 mm/s, 1 arcsec.
    fn scale() -> State {
        let mut scale = State::repeat(5e-6);
        POSITION.set_in(&mut scale, &Vector3::new(2e-7, 2e-7, 1.0));
        VELOCITY.set_in(&mut scale, &Vector3::repeat(1e-3));
        scale
    }

    /// The rotation of the level by a displacement; the geographic frame also rotates about up.
    fn d_theta(error: &State, latitude: f64) -> Vector3<f64> {
        let d = POSITION.of(error);
        Vector3::new(d.x, d.y, d.y * latitude.tan())
    }

    fn with_error(truth: &NavState, error: &State) -> NavState {
        let Site { latitude, longitude, height } = truth.position;
        let d = POSITION.of(error);
        let phi = ATTITUDE.of(error) + d_theta(error, latitude);
        NavState {
            position: Site {
                latitude: latitude - d.x,
                longitude: longitude + d.y / latitude.cos(),
                height: height + d.z,
            },
            velocity: truth.velocity + InFrame::from_components(VELOCITY.of(error)),
            nav_from_body: Dcm::from_rotation_vector(&-phi) * truth.nav_from_body,
        }
    }

    fn error_between(computed: &NavState, truth: &NavState, gyro: &Vector3<f64>) -> State {
        let latitude = truth.position.latitude;
        let mut error = State::zeros();
        let d = Vector3::new(
            latitude - computed.position.latitude,
            (computed.position.longitude - truth.position.longitude) * latitude.cos(),
            computed.position.height - truth.position.height,
        );
        POSITION.set_in(&mut error, &d);
        let velocity = computed.velocity - truth.velocity;
        VELOCITY.set_in(&mut error, velocity.components());
        let phi = -(computed.nav_from_body * truth.nav_from_body.inverse()).rotation_vector();
        let psi = phi - d_theta(&error, latitude);
        ATTITUDE.set_in(&mut error, &psi);
        SPIN_AXIS_ERRORS.set_in(&mut error, gyro);
        error
    }

    #[test]
    fn transition_predicts_a_perturbed_strapdown_run() {
        let motion = motion();
        let start = Navigator::at_rest(
            &motion.station,
            motion.nav_from_table * Dcm::about_z(0.0),
            VerticalChannel::Free,
        );
        for state in 0..SPIN_AXIS_ERRORS.end() {
            let mut error = State::zeros();
            error[state] = scale()[state];
            let gyro = SPIN_AXIS_ERRORS.of(&error);
            let mut truth = start.clone();
            let mut computed = Navigator::new(
                with_error(start.state(), &error),
                &motion.station,
                VerticalChannel::Free,
            );
            let mut predicted = error;
            for sample in motion.samples(INTERVAL) {
                let before = *truth.state();
                let angle = sample.increments.angle.components();
                let measured = Increments {
                    angle: InFrame::from_components(angle + gyro * angle.z),
                    ..sample.increments
                };
                truth.step(&sample.increments);
                computed.step(&measured);
                let place = before.position;
                let (sin, cos) = place.latitude.sin_cos();
                let mean =
                    (before.nav_from_body.matrix() + truth.state().nav_from_body.matrix()) * 0.5;
                let means = Means {
                    interval: INTERVAL,
                    curvatures: [place.meridian_radius(), place.transverse_radius()]
                        .map(|radius| 1.0 / (radius + place.height)),
                    latitude: [sin, cos],
                    velocity: Vector::from(*before.velocity.components()),
                    gravity: motion.station.gravity,
                    specific_force: Vector::from(truth.force_gain().components() / INTERVAL),
                    nav_from_body: Matrix::from(&mean),
                };
                let f = dynamics(&means, angle.z / INTERVAL);
                predicted = transition(&f, INTERVAL) * predicted;
            }
            let found = error_between(computed.state(), truth.state(), &gyro);
            // In units of comparable effect, so that no kind of state dominates.
            let relative = (found - predicted).component_div(&scale());
            assert!(
                relative.amax() < WITHIN * (predicted.component_div(&scale()).amax()),
                "state {state}: off by {relative}, predicted {predicted}"
            );
        }
    }

    /// Random numbers between -1 and 1.
    fn numbers(seed: u128) -> impl FnMut() -> f64 {
        let mut generator = Pcg64::new(11, seed);
        move || generator.random_range(-1.0..1.0)
    }

    /// The difference of two symmetric matrices, in units of the second's standard deviations.
    fn differences(got: &StateMatrix, want: &StateMatrix) -> StateMatrix {
        StateMatrix::from_fn(|row, column| {
            let scale = (want[(row, row)] * want[(column, column)]).sqrt();
            (got[(row, column)] - want[(row, column)]) / scale
        })
    }

    fn dense<M>(kernel: &Kernel<f64, M, STATES>) -> StateMatrix {
        StateMatrix::from_fn(|row, column| kernel.covariance.get(row, column))
    }

    /// A random motion, fast enough for every term to be significant.
    fn any_means(random: &mut impl FnMut() -> f64) -> Means<f64> {
        let mut vector = |scale: f64| Vector([0; 3].map(|_| scale * random()));
        let (velocity, specific_force) = (vector(300.0), vector(20.0));
        let nav_from_body = rins_lanes::rotation::exp(&vector(2.0));
        let (sin, cos) = 0.6_f64.sin_cos();
        Means {
            interval: 0.5,
            curvatures: [1.0 / 6.35e6, 1.0 / 6.39e6],
            latitude: [sin, cos],
            velocity,
            gravity: 9.8,
            specific_force,
            nav_from_body,
        }
    }

    #[test]
    fn sparse_factors_carry_any_covariance_as_dense_matrices_do() {
        for seed in 0..50 {
            let mut random = numbers(seed);
            let means = any_means(&mut random);
            let spin_rate = 3.0 * random();
            let root = StateMatrix::from_fn(|_, _| random());
            let p = root * root.transpose();
            let phi = transition(&dynamics(&means, spin_rate), means.interval);
            let mut q = StateMatrix::zeros();
            let density = |sigma: f64| Vector3::repeat(sigma * sigma * means.interval);
            VELOCITY.set_diagonal(&mut q, &density(0.3));
            ATTITUDE.set_diagonal(&mut q, &density(0.2));
            let want = phi * p * phi.transpose() + q;

            let mut carried = Covariance::from_fn(0.0, |row, column| p[(row, column)]);
            let mut regressors = [0.0; STATES];
            regressors[SPIN_AXIS_ERRORS.start()..SPIN_AXIS_ERRORS.end()].fill(spin_rate);
            let sparse = Transition::<f64, WithAxis, STATES>::new(&means, regressors, [0.3, 0.2]);
            for (unit, column) in phi.column_iter().enumerate() {
                let mut x = [0.0; STATES];
                x[unit] = 1.0;
                let off = State::from(sparse.times(x)) - column;
                assert!(off.amax() < 1e-14 * phi.amax(), "{off:e}");
            }
            sparse.carry(&mut carried);
            let got = StateMatrix::from_fn(|row, column| carried.get(row, column));
            let off = differences(&got, &want).amax();
            assert!(off < 1e-13, "{off:e}");
        }
    }

    /// Six minutes at 50 Hz with a prior of the axis of 1σ `sigma` \[rad\]; the two filters may differ by `agreement`.
    fn run_beside_the_generic_filter(
        sigma: f64,
        agreement: f64,
        reading: fn(f64, f64) -> Reading<f64>,
    ) {
        let steps = 18_000;
        let mut random = numbers(1);
        let site = Site { latitude: 34.25 * DEG, longitude: 0.0, height: 400.0 };
        let angles = EulerAngles { roll: 0.5, pitch: 0.3, yaw: 0.7 };
        let turn = Segment { rate: 10.0 * DEG, duration: f64::from(steps) * INTERVAL };
        let motion = TrueMotion {
            station: Station::with_normal_gravity(site),
            nav_from_table: angles.dcm(),
            profile: Profile::new(&[turn], None).unwrap(),
        };
        let triad =
            |noise_density, bias_sigma| TriadSpec::white(noise_density, bias_sigma, 500e-6, 6e-4);
        let setup = Setup {
            station: motion.station,
            axis: None,
            table: TableSpec { angle_noise: 5e-6, wobble: 5e-6, rate_noise: 1e-6, latency: 0.0 },
            imu: ImuSpec { gyro: triad(6e-6, 5e-7), accel: triad(3e-4, 2e-3) },
            velocity_noise: 1e-4,
        };
        let start = Start {
            nav_from_table: motion.nav_from_table,
            axis_covariance: Matrix3::identity() * (sigma * sigma),
            angle: 0.0,
            angle_source: AngleSource::Read,
        };
        let p = start.covariance(&setup);
        let attitude = motion.nav_from_table.matrix();
        let mut kernel =
            Kernel::<f64, WithAxis, STATES>::at_rest(0.0, &setup, [attitude; 2], |i, j| p[(i, j)]);
        let mut generic = Filter { state: State::zeros(), covariance: p };
        for true_sample in motion.samples(INTERVAL) {
            let truth = true_sample.increments;
            let mut noisy = |vector: &Vector3<f64>, sigma: f64| {
                Vector([0, 1, 2].map(|axis| vector[axis] + sigma * random()))
            };
            let mut angle = noisy(truth.angle.components(), 1e-6);
            angle[0] += 3e-4 * angle[2];
            let velocity = noisy(truth.velocity.components(), 1e-4);
            let sample = Sample { angle, velocity, interval: INTERVAL };
            let (interval, means) = kernel.navigate(&sample);
            kernel.carry(&interval, &means);
            let phi = transition(&dynamics(&means, interval.rate[2]), INTERVAL);
            let mut q = StateMatrix::zeros();
            let density = |density: f64| Vector3::repeat(density * density * INTERVAL);
            VELOCITY.set_diagonal(&mut q, &density(setup.imu.accel.noise_density));
            ATTITUDE.set_diagonal(&mut q, &density(setup.imu.gyro.noise_density));
            generic.predict(&phi, &q);

            let reading = reading(true_sample.angle, true_sample.mean_rate);
            let comparison = kernel.compare(&interval, &reading);
            let off = kernel.mechanisation.velocity;
            let measurement = comparison.measurement(&off, setup.velocity_noise);
            let ratios = kernel.covariance.ratios::<WithAxis>(&comparison, setup.velocity_noise);
            assert!(ratios.iter().all(|&ratio| ratio < PLAIN));
            let found =
                kernel.covariance.update::<WithAxis>(&comparison, &off, setup.velocity_noise);
            let innovation = generic.update(&measurement).unwrap();
            let whitened = SVector::from(found.whitened) - innovation.whitened;
            assert!(whitened.norm() < agreement * innovation.whitened.norm());
            assert!(
                (found.log_likelihood() - innovation.log_likelihood()).abs() < 1e-9,
                "{}",
                found.log_likelihood()
            );
            for (index, &x) in found.state.iter().enumerate() {
                let sigma = generic.covariance[(index, index)].sqrt();
                assert!((x - generic.state[index]).abs() < agreement * sigma);
            }
            kernel.correct(&found.state, &interval);
            generic.state = State::zeros();
        }
        let off = differences(&dense(&kernel), &generic.covariance);
        let of_position = off.fixed_rows::<3>(0).amax();
        let of_others = off.fixed_view::<12, 12>(3, 3).amax();
        assert!(of_others < agreement, "{of_others:e}");
        assert!(of_position < OF_POSITION.max(agreement), "{of_position:e}");
    }

    #[test]
    fn structured_steps_against_angles_are_the_generic_filters() {
        let angle = |angle: f64, _: f64| Reading::Angle([angle.sin(), angle.cos()]);
        run_beside_the_generic_filter(1e-5, AGREEMENT, angle);
        // At two hundred times the encoder's noise both forms have 4e4 times the rounding error.
        run_beside_the_generic_filter(1e-3, 4e4 * f64::EPSILON * 20.0, angle);
    }

    #[test]
    fn structured_steps_against_rates_are_the_generic_filters() {
        run_beside_the_generic_filter(1e-5, AGREEMENT, |_, rate| Reading::Rate(rate));
    }
}
