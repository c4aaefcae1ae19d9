//! One strapdown step, compared with the same mathematics on plain matrices, and in lanes.

use std::hint::black_box;

use criterion::{Criterion, criterion_group, criterion_main};
use nalgebra::{Matrix3, Vector3};
use rins_frames::units::{ARCSEC, DEG, DEG_PER_SECOND, PPM};
use rins_frames::{EulerAngles, InFrame, Increments, Site};
use rins_lanes::{Arch, Lane, Matrix, Real, Simd, Vector, WithSimd};
use rins_motion::{
    Mechanisation, Navigator, Profile, Segment, Station, TrueMotion, VerticalChannel,
};

/// The number of steps in one timing.
const STEPS: usize = 1000;

/// The tolerance of the difference after the run \[m/s\]: rounding over a thousand steps.
const AGREEMENT: f64 = 1e-9;

/// The paper's run, 20 s of it at 50 Hz, with its three gyro errors.
fn run() -> (TrueMotion, Vec<Increments>) {
    let site = Site { latitude: 34.25 * DEG, longitude: 0.0, height: 0.0 };
    let angles = EulerAngles { roll: 30.0 * DEG, pitch: 20.0 * DEG, yaw: 40.0 * DEG };
    let turn = Segment { rate: 10.0 * DEG_PER_SECOND, duration: 20.0 };
    let motion = TrueMotion {
        station: Station::with_normal_gravity(site),
        nav_from_table: angles.dcm(),
        profile: Profile::new(&[turn], None).expect("a segment that lasts is a profile"),
    };
    let gyro_errors = Vector3::new(60.0 * ARCSEC, 60.0 * ARCSEC, 300.0 * PPM);
    let measured = motion
        .samples(0.02)
        .map(|sample| {
            let truth = sample.increments;
            let error = InFrame::from_components(gyro_errors * truth.angle.components().z);
            Increments { angle: truth.angle + error, ..truth }
        })
        .collect();
    (motion, measured)
}

fn navigator(motion: &TrueMotion) -> Navigator {
    let attitude = EulerAngles::dcm(&motion.nav_from_table.euler_angles());
    Navigator::at_rest(&motion.station, attitude, VerticalChannel::Held)
}

fn typed(mut navigator: Navigator, measured: &[Increments]) -> Vector3<f64> {
    for increments in measured {
        navigator.step(increments);
    }
    *navigator.state().velocity.components()
}

/// The navigator's mathematics without frames, options or a state that others can correct, with the Earth's properties
/// calculated at each step.
struct Bare {
    site: Site,
    gravity_ratio: f64,
    v_n: Vector3<f64>,
    c_nb: Matrix3<f64>,
    accel_n: Vector3<f64>,
    before: Option<(Vector3<f64>, Vector3<f64>)>,
}

impl Bare {
    fn new(motion: &TrueMotion) -> Self {
        Self {
            site: motion.station.site,
            gravity_ratio: motion.station.gravity / motion.station.site.normal_gravity(),
            v_n: Vector3::zeros(),
            c_nb: *motion.nav_from_table.matrix(),
            accel_n: Vector3::zeros(),
            before: None,
        }
    }

    fn step(&mut self, dtheta: &Vector3<f64>, dv: &Vector3<f64>, t: f64) {
        let Self { site, v_n, c_nb, .. } = *self;
        let (sin, cos) = site.latitude.sin_cos();
        let r_m = site.meridian_radius() + site.height;
        let r_n = site.transverse_radius() + site.height;
        let v_mid = v_n + self.accel_n * (0.5 * t);
        let w_ie = Vector3::new(0.0, cos, sin) * rins_frames::EARTH_RATE;
        let w_en = Vector3::new(-v_mid.y / r_m, v_mid.x / r_n, v_mid.x / r_n * sin / cos);
        let zeta = (w_ie + w_en) * t;

        let across = dtheta.cross(dv);
        let square = dtheta.norm_squared();
        let mut gain_b = dv
            + across * (0.5 - square / 24.0 * (1.0 - square / 30.0))
            + dtheta.cross(&across) * (1.0 / 6.0 - square / 120.0 * (1.0 - square / 42.0));
        let mut phi = *dtheta;
        if let Some((dtheta_before, dv_before)) = self.before {
            gain_b += (dtheta_before.cross(dv) + dv_before.cross(dtheta)) / 12.0;
            phi += dtheta_before.cross(dtheta) / 12.0;
        }
        let gain_n = c_nb * gain_b;
        let g_n = Vector3::new(0.0, 0.0, -self.gravity_ratio * site.normal_gravity());
        let mut after = v_n + gain_n - zeta.cross(&gain_n) * 0.5
            + (g_n - (w_ie * 2.0 + w_en).cross(&v_mid)) * t;
        after.z = v_n.z;

        self.site.latitude += (v_n.y + after.y) * 0.5 / r_m * t;
        self.site.longitude += (v_n.x + after.x) * 0.5 / (r_n * cos) * t;
        let c = small_turn(&-zeta) * c_nb * small_turn(&phi);
        self.c_nb = c - (c * c.transpose() - Matrix3::identity()) * c * 0.5;
        self.accel_n = (after - v_n) / t;
        self.v_n = after;
        self.before = Some((*dtheta, *dv));
    }
}

/// Rodrigues' formula for rotations well below 0.01 rad.
fn small_turn(v: &Vector3<f64>) -> Matrix3<f64> {
    let square = v.norm_squared();
    let cross = v.cross_matrix();
    Matrix3::identity()
        + cross * (1.0 - square / 6.0 * (1.0 - square / 20.0))
        + cross * cross * (0.5 - square / 24.0 * (1.0 - square / 30.0))
}

fn bare(motion: &TrueMotion, measured: &[Increments]) -> Vector3<f64> {
    let mut bare = Bare::new(motion);
    for increments in measured {
        let Increments { angle, velocity, interval } = increments;
        bare.step(angle.components(), velocity.components(), *interval);
    }
    bare.v_n
}

/// The same in lanes: every run integrates the same increments.
struct SideBySide<'a>(&'a TrueMotion, &'a [Increments]);

impl WithSimd for SideBySide<'_> {
    type Output = (usize, Vector3<f64>);

    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it is compiled with the machine's instructions")]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let Self(motion, measured) = self;
        let like = Lane::splat(simd, 0.0);
        let site = motion.station.site;
        let mut mechanisation = Mechanisation::new(
            [
                like.constant(site.latitude),
                like.constant(site.longitude),
                like.constant(site.height),
            ],
            Vector::zeros(like),
            Matrix::constant(like, motion.nav_from_table.matrix()),
            &motion.station,
            VerticalChannel::Held,
        );
        for increments in measured {
            let angle = Vector::constant(like, (*increments.angle.components()).into());
            let velocity = Vector::constant(like, (*increments.velocity.components()).into());
            mechanisation.step(&angle, &velocity, increments.interval);
        }
        let last = like.lanes() - 1;
        (like.lanes(), mechanisation.velocity.lane(last).into())
    }
}

/// The functions whose instructions `cargo xtask bench` counts, by their names.
mod counted {
    use super::{Arch, Increments, SideBySide, TrueMotion, Vector3, navigator, typed};

    #[inline(never)]
    pub(super) fn strapdown_step(motion: &TrueMotion, measured: &[Increments]) -> Vector3<f64> {
        typed(navigator(motion), measured)
    }

    #[inline(never)]
    pub(super) fn strapdown_lanes(
        motion: &TrueMotion,
        measured: &[Increments],
    ) -> (usize, Vector3<f64>) {
        Arch::new().dispatch(SideBySide(motion, measured))
    }
}

fn step(criterion: &mut Criterion) {
    let (motion, measured) = run();
    assert_eq!(measured.len(), STEPS);
    let by_types = counted::strapdown_step(&motion, &measured);
    let by_hand = bare(&motion, &measured);
    assert!(by_hand.norm() > 1e-3, "a run whose velocity stays zero compares nothing");
    assert!((by_types - by_hand).norm() < AGREEMENT, "{by_types} against {by_hand}");
    let (width, side_by_side) = counted::strapdown_lanes(&motion, &measured);
    assert!((by_types - side_by_side).norm() < AGREEMENT, "{by_types} against {side_by_side}");

    let mut group = criterion.benchmark_group("strapdown_step");
    group.throughput(criterion::Throughput::Elements(STEPS as u64));
    group.bench_function("one", |b| {
        b.iter(|| counted::strapdown_step(&motion, black_box(&measured)));
    });
    group.bench_function("bare", |b| b.iter(|| bare(&motion, black_box(&measured))));
    group.throughput(criterion::Throughput::Elements((STEPS * width) as u64));
    group.bench_function("lanes", |b| {
        b.iter(|| counted::strapdown_lanes(&motion, black_box(&measured)));
    });
    group.finish();
}

criterion_group!(benches, step);
criterion_main!(benches);
