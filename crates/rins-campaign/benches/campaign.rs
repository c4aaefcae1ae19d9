//! The paper's campaign, 30 runs of 360 s at 50 Hz: simulation, mechanization and filter, compared with the same
//! with a filter of dense matrices.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::{Matrix3, SMatrix, SVector, Vector3};
use rins_calibration::layout::{ATTITUDE, PAPER_STATES, POSITION, SPIN_AXIS_ERRORS, VELOCITY};
use rins_calibration::{AngleSource, AxisAttitude, Setup, SpinAxisFilter, Start, TableSpec};
use rins_campaign::{Cell, RunResult};
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, DEG_PER_SECOND, MICRO_G, PPM};
use rins_frames::{Body, Dcm, EulerAngles, InFrame, Increments, Nav, Site, Table};
use rins_imu::{Axis, ImuError, ImuNoise, ImuSpec, NoiseModel, Seed, TriadError, TriadSpec};
use rins_motion::{Navigator, Profile, Segment, Station, VerticalChannel};
use rins_simulation::{Scenario, TableRecord, simulate};

const RUNS: u64 = 30;

/// The tolerance for the difference of the estimates, in sigmas: the other filter has another second-order transition matrix.
const AGREEMENT: f64 = 1e-3;

type State = SVector<f64, PAPER_STATES>;
type StateMatrix = SMatrix<f64, PAPER_STATES, PAPER_STATES>;

fn cell() -> Cell {
    let site = Site { latitude: 34.25 * DEG, longitude: 108.9 * DEG, height: 400.0 };
    let station = Station::with_normal_gravity(site);
    let angles = EulerAngles { roll: 30.0 * DEG, pitch: 20.0 * DEG, yaw: 40.0 * DEG };
    let triad = |noise_density| TriadSpec::white(noise_density, 0.0, 500.0 * PPM, 120.0 * ARCSEC);
    let imu = ImuSpec { gyro: triad(0.02 * DEG_PER_HOUR), accel: triad(30.0 * MICRO_G) };
    let noise = ImuNoise { gyro: NoiseModel::from(&imu.gyro), accel: NoiseModel::from(&imu.accel) };
    let turn = Segment { rate: 10.0 * DEG_PER_SECOND, duration: 360.0 };
    let gyro = TriadError::default()
        .with_scale(Axis::Z, 300.0 * PPM)
        .with_misalignment(Axis::X, Axis::Z, 60.0 * ARCSEC)
        .with_misalignment(Axis::Y, Axis::Z, 60.0 * ARCSEC);
    let profile = Profile::new(&[turn], None).expect("a segment that lasts is a profile");
    let scenario = Scenario {
        imu_error: ImuError { gyro, ..ImuError::default() },
        noise: Some(noise),
        table: TableRecord::CommandedRate,
        ..Scenario::perfect(station, angles.dcm(), profile, 0.02)
    };
    let setup = Setup {
        station,
        axis: Some(AxisAttitude { angles, sigma: 0.01 * DEG }),
        table: TableSpec { angle_noise: 0.0, wobble: 0.0, rate_noise: 0.0, latency: 0.0 },
        imu,
        velocity_noise: Setup::FIXED_TABLE_VELOCITY_NOISE,
    };
    Cell { scenario, setup }
}

fn in_lanes(cell: &Cell, runs: u64) -> Vec<RunResult> {
    cell.prepare().expect("the cell can be run").run(0..runs)
}

/// The paper's twelve states with dense matrices and the Joseph form.
struct Dense {
    setup: Setup,
    navigator: Navigator,
    estimate: Vector3<f64>,
    p: StateMatrix,
}

impl Dense {
    fn new(setup: &Setup, nav_from_table: Dcm<Nav, Table>) -> Self {
        let sigma = setup.axis.expect("the setup gives an attitude").sigma;
        let start = Start {
            nav_from_table,
            axis_covariance: Matrix3::identity() * (sigma * sigma),
            angle: 0.0,
            angle_source: AngleSource::Defined,
        };
        let all = SpinAxisFilter::new(*setup, &start).covariance();
        let nav_from_body = nav_from_table * Dcm::<Table, Body>::identity();
        Self {
            setup: *setup,
            navigator: Navigator::at_rest(&setup.station, nav_from_body, VerticalChannel::Free),
            estimate: Vector3::zeros(),
            p: all.fixed_view::<PAPER_STATES, PAPER_STATES>(0, 0).into_owned(),
        }
    }

    fn step(&mut self, sample: &Increments, table_rate: f64) {
        let t = sample.interval;
        let measured = sample.angle.components();
        let z = measured.z / (1.0 + self.estimate.z);
        let (x, y) = (measured.x - self.estimate.x * z, measured.y - self.estimate.y * z);
        let compensated = Increments { angle: InFrame::new(x, y, z), ..*sample };
        let before = *self.navigator.state();
        self.navigator.step(&compensated);
        let after = *self.navigator.state();
        let c = (before.nav_from_body.matrix() + after.nav_from_body.matrix()) * 0.5;
        let rate = compensated.angle.components() / t;
        let earth_rate = *before.position.earth_rate().components();
        let radius = before.position.meridian_radius() + before.position.height;
        let force = self.navigator.force_gain().components() / t;

        let mut f = StateMatrix::zeros();
        let along = Matrix3::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, radius) / radius;
        POSITION.set(VELOCITY, &mut f, &along);
        let weight = Matrix3::new(0.0, -1.0, 0.0, 1.0, 0.0, 0.0, 0.0, 0.0, 2.0 / radius);
        VELOCITY.set(POSITION, &mut f, &(weight * self.setup.station.gravity));
        VELOCITY.set(VELOCITY, &mut f, &(earth_rate * -2.0).cross_matrix());
        VELOCITY.set(ATTITUDE, &mut f, &force.cross_matrix());
        ATTITUDE.set(ATTITUDE, &mut f, &(-earth_rate).cross_matrix());
        ATTITUDE.set(SPIN_AXIS_ERRORS, &mut f, &(c * -rate.z));
        let step = f * t;
        let phi = StateMatrix::identity() + step + step * step * 0.5;
        let imu = &self.setup.imu;
        let mut q = StateMatrix::zeros();
        let density = |density: f64| Vector3::repeat(density * density * t);
        VELOCITY.set_diagonal(&mut q, &density(imu.accel.noise_density));
        ATTITUDE.set_diagonal(&mut q, &density(imu.gyro.noise_density));
        let p = phi * self.p * phi.transpose() + q;

        let mut h = SMatrix::<f64, 6, PAPER_STATES>::zeros();
        h.fixed_view_mut::<3, 3>(0, VELOCITY.start()).fill_with_identity();
        let by_attitude = c.transpose() * earth_rate.cross_matrix();
        h.fixed_view_mut::<3, 3>(3, ATTITUDE.start()).copy_from(&by_attitude);
        h.fixed_view_mut::<3, 2>(3, 0).copy_from(&by_attitude.fixed_columns::<2>(0));
        h.fixed_view_mut::<3, 3>(3, SPIN_AXIS_ERRORS.start()).fill_diagonal(rate.z);
        let density = imu.gyro.noise_density * imu.gyro.noise_density;
        let mut cross = SMatrix::<f64, PAPER_STATES, 6>::zeros();
        cross.fixed_view_mut::<3, 3>(ATTITUDE.start(), 3).copy_from(&(c * -density));
        let velocity_noise = self.setup.velocity_noise * self.setup.velocity_noise;
        let r = SMatrix::<f64, 6, 6>::from_diagonal(&SVector::from_fn(|row, _| {
            if row < 3 { velocity_noise } else { density / t }
        }));
        let off = rate - c.transpose() * earth_rate - Vector3::z() * table_rate;
        let mut value = SVector::<f64, 6>::zeros();
        value.fixed_rows_mut::<3>(0).copy_from(after.velocity.components());
        value.fixed_rows_mut::<3>(3).copy_from(&off);

        let hc = h * cross;
        let s = h * p * h.transpose() + hc + hc.transpose() + r;
        let gain = (p * h.transpose() + cross) * s.try_inverse().expect("it is well conditioned");
        let x: State = gain * value;
        let keep = StateMatrix::identity() - gain * h;
        let crossed = keep * cross * gain.transpose();
        self.p = keep * p * keep.transpose() + gain * r * gain.transpose()
            - crossed
            - crossed.transpose();

        let state = self.navigator.state_mut();
        state.position.latitude += x[0];
        state.position.longitude -= x[1] / state.position.latitude.cos();
        state.position.height -= x[2];
        state.velocity -= InFrame::from_components(VELOCITY.of(&x));
        let phi = ATTITUDE.of(&x) + Vector3::new(x[0], x[1], 0.0);
        state.nav_from_body = Dcm::from_rotation_vector(&phi) * state.nav_from_body;
        self.estimate += SPIN_AXIS_ERRORS.of(&x);
    }
}

fn with_dense_matrices(cell: &Cell, runs: u64) -> Vec<Vector3<f64>> {
    let Cell { scenario, setup } = cell;
    let estimate = |run: u64| {
        let seed = Seed { run, ..scenario.seed };
        let simulated = simulate(&Scenario { seed, ..scenario.clone() });
        let recording = simulated.expect("the scenario is sound").recording;
        let rates = recording.table_rate.expect("the rate is commanded");
        let mut filter = Dense::new(setup, scenario.nav_from_table);
        for (sample, rate) in recording.increments.iter().zip(rates) {
            filter.step(sample, rate);
        }
        filter.estimate
    };
    (0..runs).map(estimate).collect()
}

fn campaign(criterion: &mut Criterion) {
    let cell = cell();
    for (run, dense) in in_lanes(&cell, 2).iter().zip(with_dense_matrices(&cell, 2)) {
        let run = run.as_ref().expect("the run has estimates");
        for row in 0..3 {
            let off = (run.value[row] - dense[row]) / run.covariance[(row, row)].sqrt();
            assert!(off.abs() < AGREEMENT, "estimate {row} is off by {off:e} sigma");
        }
    }
    let mut group = criterion.benchmark_group("campaign_30");
    group.sample_size(10);
    group.throughput(criterion::Throughput::Elements(1));
    group.bench_function("lanes", |b| b.iter(|| in_lanes(black_box(&cell), RUNS)));
    group.bench_function("dense", |b| b.iter(|| with_dense_matrices(black_box(&cell), RUNS)));
    group.finish();
}

criterion_group!(benches, campaign);
criterion_main!(benches);
