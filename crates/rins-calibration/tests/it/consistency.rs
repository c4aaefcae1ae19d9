//! Consistency of the filter's covariance: NEES, NIS and whiteness over seeded runs.
//!
//! The data agree exactly with the 12-state model: three gyro errors, white sensor noise, and the noise of the references as
//! in R. Only the strapdown step is common to simulation and filter.

use nalgebra::{Matrix3, SVector, Vector3};
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;
use rins_calibration::layout::{ATTITUDE, PAPER_STATES, POSITION, SPIN_AXIS_ERRORS, VELOCITY};
use rins_calibration::{
    AngleSource, AxisAttitude, Consistency, Reference, Setup, SpinAxisFilter, Start, TableReading,
    TableSpec,
};
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, MICRO_G, PPM};
use rins_frames::{Dcm, EulerAngles, InFrame, Increments, Nav, Site, Table};
use rins_imu::{ImuSpec, TriadSpec};
use rins_motion::{Profile, Segment, Station, TrueMotion};

const RUNS: u64 = 120;
const INTERVAL: f64 = 0.1;
const AXIS_SIGMA: f64 = 0.01 * DEG;
/// A wobble so small that the runs, which have none, are consistent with it: the gyros' angle random walk is 60 times that in
/// one interval.
const NO_WOBBLE: f64 = 1e-4 * ARCSEC;

fn setup() -> Setup {
    let gyro = TriadSpec::white(0.02 * DEG_PER_HOUR, 0.0, 300.0 * PPM, 60.0 * ARCSEC);
    let accel = TriadSpec { noise_density: 30.0 * MICRO_G, ..gyro };
    let site = Site { latitude: 34.25 * DEG, longitude: 108.9 * DEG, height: 400.0 };
    Setup {
        station: Station::with_normal_gravity(site),
        axis: Some(AxisAttitude {
            angles: EulerAngles { roll: 30.0 * DEG, pitch: 20.0 * DEG, yaw: 40.0 * DEG },
            sigma: AXIS_SIGMA,
        }),
        table: TableSpec {
            angle_noise: 0.3 * ARCSEC,
            wobble: NO_WOBBLE,
            rate_noise: 1.0 * DEG_PER_HOUR,
            latency: 0.0,
        },
        imu: ImuSpec { gyro, accel },
        velocity_noise: Setup::FIXED_TABLE_VELOCITY_NOISE,
    }
}

struct Draws(Pcg64);

impl Draws {
    fn scalar(&mut self, sigma: f64) -> f64 {
        let unit: f64 = StandardNormal.sample(&mut self.0);
        sigma * unit
    }

    fn vector(&mut self, sigma: f64) -> Vector3<f64> {
        Vector3::from_fn(|_, _| self.scalar(sigma))
    }
}

/// One run: NEES of the paper's twelve states at the end, and all whitened innovations.
fn run(seed: u64, source: AngleSource, noise_claimed: f64) -> (f64, Vec<SVector<f64, 6>>) {
    let honest = setup();
    let mut draws = Draws(Pcg64::new(0xcafe, u128::from(seed)));
    let given: Dcm<Nav, Table> = honest.axis.expect("the setup gives an attitude").angles.dcm();
    let axis_error = draws.vector(AXIS_SIGMA);
    // C~ = (I - α×) C, so C = exp(α×) C~.
    let nav_from_table = Dcm::from_rotation_vector(&axis_error) * given;
    let gyro_error = Vector3::new(
        draws.scalar(honest.imu.gyro.misalignment_sigma),
        draws.scalar(honest.imu.gyro.misalignment_sigma),
        draws.scalar(honest.imu.gyro.scale_sigma),
    );
    let radius = honest.station.site.meridian_radius();
    let site = Site {
        latitude: honest.station.site.latitude + draws.scalar(1e-3 / radius),
        longitude: honest.station.site.longitude
            + draws.scalar(1e-3 / radius) / honest.station.site.latitude.cos(),
        height: honest.station.site.height + draws.scalar(1e-3),
    };
    let rate = 10.0 * DEG;
    let segments = [Segment { rate, duration: 40.0 }, Segment { rate: -rate, duration: 30.0 }];
    let motion = TrueMotion {
        station: Station { site, ..honest.station },
        nav_from_table,
        profile: Profile::new(&segments, Some(5.0 * DEG)).expect("the profile is sound"),
    };

    let first = match source {
        AngleSource::Read => draws.scalar(honest.table.angle_noise),
        AngleSource::Defined => 0.0,
    };
    let start = Start {
        nav_from_table: given,
        axis_covariance: Matrix3::identity() * (AXIS_SIGMA * AXIS_SIGMA),
        angle: first,
        angle_source: source,
    };
    let mut claimed = honest;
    claimed.imu.gyro.noise_density *= noise_claimed;
    claimed.imu.accel.noise_density *= noise_claimed;
    let mut filter = SpinAxisFilter::new(claimed, &start);
    let mut innovations = Vec::new();
    let root = INTERVAL.sqrt();
    for sample in motion.samples(INTERVAL) {
        let truth = sample.increments;
        let angle = truth.angle.components();
        let noise = draws.vector(honest.imu.gyro.noise_density * root);
        let measured = Increments {
            angle: InFrame::from_components(angle + gyro_error * angle.z + noise),
            velocity: InFrame::from_components(
                truth.velocity.components() + draws.vector(honest.imu.accel.noise_density * root),
            ),
            interval: INTERVAL,
        };
        let table = match source {
            AngleSource::Read => {
                TableReading::Angle(sample.angle + draws.scalar(honest.table.angle_noise))
            }
            AngleSource::Defined => {
                TableReading::Rate(sample.mean_rate + draws.scalar(honest.table.rate_noise))
            }
        };
        let velocity = InFrame::from_components(draws.vector(honest.velocity_noise));
        innovations.push(
            filter.step(&measured, &Reference { velocity, table }).expect("the data are sound"),
        );
    }

    let state = filter.state();
    let d_theta = Vector3::new(
        -(state.position.latitude - site.latitude),
        (state.position.longitude - site.longitude) * site.latitude.cos(),
        0.0,
    );
    let true_attitude =
        nav_from_table * Dcm::<Table, rins_frames::Body>::about_z(motion.profile.angle(70.0));
    let phi = -(state.nav_from_body * true_attitude.inverse()).rotation_vector();
    let mut error = SVector::<f64, PAPER_STATES>::zeros();
    let height = Vector3::new(0.0, 0.0, state.position.height - site.height);
    POSITION.set_in(&mut error, &(d_theta + height));
    VELOCITY.set_in(&mut error, state.velocity.components());
    ATTITUDE.set_in(&mut error, &(phi - d_theta));
    SPIN_AXIS_ERRORS.set_in(&mut error, &(gyro_error - filter.estimate()));
    let covariance =
        filter.covariance().fixed_view::<PAPER_STATES, PAPER_STATES>(0, 0).into_owned();
    let factor = covariance.cholesky().expect("P is positive definite");
    (error.dot(&factor.solve(&error)), innovations)
}

struct Score {
    nees: f64,
    nis: f64,
    not_white: usize,
}

fn score(source: AngleSource, noise_claimed: f64) -> Score {
    let mut score = Score { nees: 0.0, nis: 0.0, not_white: 0 };
    for seed in 0..RUNS {
        let (nees, innovations) = run(seed, source, noise_claimed);
        let consistency = Consistency::of(&innovations).expect("there are innovations");
        score.nees += nees / RUNS as f64;
        score.nis += consistency.nis_mean / RUNS as f64;
        score.not_white += usize::from(consistency.whiteness_p < 0.01);
    }
    score
}

/// The half-width of the 99 % interval of a mean of `count` chi-squared variables of `dof`.
fn bound(dof: f64, count: f64) -> f64 {
    2.576 * (2.0 * dof / count).sqrt()
}

fn assert_honest(source: AngleSource) {
    let score = score(source, 1.0);
    let (runs, steps) = (RUNS as f64, 70.0 / INTERVAL);
    let states = PAPER_STATES as f64;
    assert!(
        (score.nees - states).abs() < bound(states, runs),
        "mean NEES {} is not within {states} ± {}",
        score.nees,
        bound(states, runs)
    );
    assert!(
        (score.nis - 6.0).abs() < bound(6.0, runs * steps),
        "mean NIS {} is not within 6 ± {}",
        score.nis,
        bound(6.0, runs * steps)
    );
    // 1 % of 120 runs is 1.2; more than 6 has a probability below 1e-3.
    assert!(score.not_white <= 6, "{} of {RUNS} runs are not white", score.not_white);
}

#[test]
fn covariance_is_honest_against_a_commanded_rate() {
    assert_honest(AngleSource::Defined);
}

#[test]
fn covariance_is_honest_against_an_encoder() {
    assert_honest(AngleSource::Read);
}

#[test]
fn noise_claimed_at_half_or_twice_its_size_is_found_out() {
    for claimed in [0.5, 2.0] {
        let score = score(AngleSource::Read, claimed);
        let (states, steps) = (PAPER_STATES as f64, 70.0 / INTERVAL);
        assert!((score.nis - 6.0).abs() > 10.0 * bound(6.0, RUNS as f64 * steps));
        assert!((score.nees - states).abs() > bound(states, RUNS as f64));
    }
}
