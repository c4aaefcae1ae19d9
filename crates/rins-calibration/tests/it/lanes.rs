//! Runs in parallel: each is bitwise equal to the run alone, in lanes of any width.

use nalgebra::Matrix3;
use rins_calibration::{
    AngleSource, Reference, Setup, SpinAxisFilter, SpinAxisLanes, Start, TableReading, TableSpec,
    layout::PAPER_STATES,
};
use rins_frames::units::{DEG, DEG_PER_HOUR, PPM};
use rins_frames::{EulerAngles, InFrame, Increments, Site};
use rins_imu::{ImuSpec, Seed, Sensor, TriadSpec};
use rins_lanes::{Arch, Lane, Real, Scalar, Simd, Vector, WithSimd};
use rins_motion::{Profile, Segment, Station, TrueMotion};
use rins_testing::assert_close;

const INTERVAL: f64 = 0.02;
const STEPS: usize = 600;
const RATE: f64 = 10.0 * DEG;
/// More runs than any machine has lanes.
const RUNS: u64 = 8;

fn motion() -> TrueMotion {
    let site = Site { latitude: 34.25 * DEG, longitude: 0.0, height: 400.0 };
    let angles = EulerAngles { roll: 30.0 * DEG, pitch: 20.0 * DEG, yaw: 40.0 * DEG };
    let turn = Segment { rate: RATE, duration: STEPS as f64 * INTERVAL };
    TrueMotion {
        station: Station::with_normal_gravity(site),
        nav_from_table: angles.dcm(),
        profile: Profile::new(&[turn], None).expect("a segment that lasts is a profile"),
    }
}

fn start(motion: &TrueMotion) -> (Setup, Start) {
    let triad =
        |noise_density, bias_sigma| TriadSpec::white(noise_density, bias_sigma, 500.0 * PPM, 6e-4);
    let gyro = triad(0.02 * DEG_PER_HOUR, 0.1 * DEG_PER_HOUR);
    let setup = Setup {
        station: motion.station,
        axis: None,
        table: TableSpec { angle_noise: 0.0, wobble: 0.0, rate_noise: 0.0, latency: 0.0 },
        imu: ImuSpec { gyro, accel: triad(3e-4, 2e-3) },
        velocity_noise: Setup::FIXED_TABLE_VELOCITY_NOISE,
    };
    let start = Start {
        nav_from_table: motion.nav_from_table,
        axis_covariance: Matrix3::identity() * 1e-6,
        angle: 0.0,
        angle_source: AngleSource::Defined,
    };
    (setup, start)
}

/// The samples of one run, each run with its own noise.
fn samples(motion: &TrueMotion, run: u64) -> Vec<Increments> {
    let mut stream = Seed { seed: 5, run }.stream(Sensor::Encoder);
    let mut noise =
        |sigma: f64| InFrame::new(stream.sample(), stream.sample(), stream.sample()) * sigma;
    let samples = motion.samples(INTERVAL).map(|sample| {
        let truth = sample.increments;
        let errors = InFrame::new(3e-4, -2e-4, 4e-4) * truth.angle.components().z;
        Increments {
            angle: truth.angle + errors + noise(1e-8),
            velocity: truth.velocity + noise(4e-5),
            ..truth
        }
    });
    samples.collect()
}

/// The estimates and the covariance of each run after the last step.
struct SideBySide<'a> {
    runs: &'a [Vec<Increments>],
    motion: &'a TrueMotion,
}

type End = ([f64; 3], Vec<f64>);

impl WithSimd for SideBySide<'_> {
    type Output = Vec<End>;

    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it is compiled with the machine's instructions")]
    fn with_simd<S: Simd>(self, simd: S) -> Vec<End> {
        let like = Lane::splat(simd, 0.0);
        let (setup, start) = start(self.motion);
        let mut ends = Vec::new();
        for group in self.runs.chunks(like.lanes()) {
            let mut filters = SpinAxisLanes::new(like, &setup, &start);
            let samples = |lane: usize| &group[lane.min(group.len() - 1)];
            for step in 0..STEPS {
                let gather = |of: fn(&Increments) -> [f64; 3]| {
                    Vector([0, 1, 2].map(|axis| like.each(|lane| of(&samples(lane)[step])[axis])))
                };
                let angle = gather(|sample| (*sample.angle.components()).into());
                let velocity = gather(|sample| (*sample.velocity.components()).into());
                filters.step([&angle, &velocity], INTERVAL, like.constant(RATE));
            }
            ends.extend((0..group.len()).map(|lane| end(&filters, lane)));
        }
        ends
    }
}

fn end<T: Real>(filters: &SpinAxisLanes<T>, lane: usize) -> End {
    (filters.estimate().lane(lane), filters.covariance(lane).iter().copied().collect())
}

fn alone(motion: &TrueMotion, samples: &[Increments]) -> SpinAxisLanes<f64> {
    let (setup, start) = start(motion);
    let mut filter = SpinAxisLanes::new(0.0, &setup, &start);
    for sample in samples {
        let vector = |v: &InFrame<rins_frames::Body>| Vector::from(*v.components());
        filter.step([&vector(&sample.angle), &vector(&sample.velocity)], INTERVAL, RATE);
    }
    filter
}

#[test]
fn a_run_has_the_same_bits_alone_and_in_lanes_of_any_width() {
    let motion = motion();
    let runs: Vec<_> = (0..RUNS).map(|run| samples(&motion, run)).collect();
    let wanted: Vec<End> = runs.iter().map(|run| end(&alone(&motion, run), 0)).collect();
    assert_ne!(wanted[0], wanted[1], "runs that are all alike compare nothing");
    let side_by_side = || SideBySide { runs: &runs, motion: &motion };

    assert_eq!(Arch::new().dispatch(side_by_side()), wanted);
    assert_eq!(Scalar.vectorize(side_by_side()), wanted);
    #[cfg(target_arch = "x86_64")]
    {
        use rins_lanes::x86::{V3, V4};
        if let Some(four_lanes) = V3::try_new() {
            assert_eq!(Simd::vectorize(four_lanes, side_by_side()), wanted);
        }
        if let Some(eight_lanes) = V4::try_new() {
            assert_eq!(Simd::vectorize(eight_lanes, side_by_side()), wanted);
        }
    }
}

#[test]
fn twelve_states_are_those_of_the_filter_that_carries_the_axis_along() {
    let motion = motion();
    let samples = samples(&motion, 0);
    let (setup, start) = start(&motion);
    let mut filter = SpinAxisFilter::new(setup, &start);
    for sample in &samples {
        filter.step(sample, &Reference::fixed(TableReading::Rate(RATE))).unwrap();
    }
    let twelve = alone(&motion, &samples);
    let p = filter.covariance();
    for index in 0..3 {
        let sigma = p[(9 + index, 9 + index)].sqrt();
        // The three additional states change the rounding.
        assert_close!(twelve.estimate()[index], filter.estimate()[index], 1e-9 * sigma);
    }
    let q = twelve.covariance(0);
    for index in 0..PAPER_STATES {
        assert_close!(q[(index, index)] / p[(index, index)], 1.0, 1e-9);
    }
}
