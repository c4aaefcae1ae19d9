//! Alignment in a static interval, then navigation through a rotation, with a little noise.
//!
//! `cargo run -p rins-inspection --example align_and_navigate`
#![expect(clippy::print_stdout, reason = "an example prints")]

use std::error::Error;

use nalgebra::Vector3;
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};
use rand_pcg::Pcg64;
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, DEG_PER_SECOND, MICRO_G};
use rins_frames::{Body, Dcm, EulerAngles, InFrame, Increments, Site, Table};
use rins_inspection::{StaticIntervals, StaticOptions};
use rins_motion::{
    MeanUncertainty, Navigator, Profile, Recording, RestMean, Segment, Station, TrueMotion,
    VerticalChannel, align,
};

const INTERVAL: f64 = 0.01;
const GYRO_NOISE: f64 = 0.02 * DEG_PER_HOUR;
const ACCEL_NOISE: f64 = 30.0 * MICRO_G;

fn main() -> Result<(), Box<dyn Error>> {
    let site = Site { latitude: 34.25 * DEG, longitude: 0.0, height: 0.0 };
    let segments = [(0.0, 140.0), (10.0, 360.0)]
        .map(|(rate, duration)| Segment { rate: rate * DEG_PER_SECOND, duration });
    let motion = TrueMotion {
        station: Station::with_normal_gravity(site),
        nav_from_table: EulerAngles { roll: 0.5 * DEG, pitch: 20.0 * DEG, yaw: 40.0 * DEG }.dcm(),
        profile: Profile::new(&segments, Some(20.0 * DEG_PER_SECOND))?,
    };
    let recording = record(&motion);

    let dwell = StaticIntervals::of(&recording, &StaticOptions::default())
        .spans(60.0)
        .into_iter()
        .next()
        .ok_or("the table never stands")?;
    let mean = RestMean::of(&recording, dwell.clone()).ok_or("the dwell is too short")?;
    let sigma = MeanUncertainty {
        angular_rate: mean.angular_rate_sigma.max(),
        specific_force: mean.specific_force_sigma.max(),
    };
    let alignment = align(&mean.rates, &sigma, &motion.station)?;
    let start = motion.nav_from_table * Dcm::<Table, Body>::identity();
    println!("at rest for the first {:.0} s", mean.duration);
    show("aligned to", alignment.nav_from_body, start);
    let sigma = alignment.covariance.diagonal().map(f64::sqrt) / ARCSEC;
    println!(
        "  its own sigma: east {:.1}, north {:.1}, up {:.1} arcsec",
        sigma.x, sigma.y, sigma.z
    );

    let mut navigator =
        Navigator::at_rest(&motion.station, alignment.nav_from_body, VerticalChannel::Held);
    for increments in &recording.increments[dwell.end..] {
        navigator.step(increments);
    }
    let angle = motion.profile.angle(motion.profile.duration());
    let end = motion.nav_from_table * Dcm::<Table, Body>::about_z(angle);
    show("navigated to", navigator.state().nav_from_body, end);
    let velocity = navigator.state().velocity.components();
    println!("  velocity: east {:.4}, north {:.4} m/s, and should be 0", velocity.x, velocity.y);
    Ok(())
}

fn record(motion: &TrueMotion) -> Recording {
    let mut rng = Pcg64::seed_from_u64(1);
    let mut white = |density: f64| {
        let mut one = || -> f64 { StandardNormal.sample(&mut rng) };
        let size = density * INTERVAL.sqrt();
        InFrame::from_components(Vector3::new(one(), one(), one()) * size)
    };
    let (times, increments) = motion
        .samples(INTERVAL)
        .map(|sample| {
            let Increments { angle, velocity, interval } = sample.increments;
            let angle = angle + white(GYRO_NOISE);
            (sample.time, Increments { angle, velocity: velocity + white(ACCEL_NOISE), interval })
        })
        .unzip();
    Recording { times, increments, ..Recording::default() }
}

fn show<To: rins_frames::Frame>(what: &str, computed: Dcm<To, Body>, truth: Dcm<To, Body>) {
    let off = (computed * truth.inverse()).rotation_vector() / ARCSEC;
    println!("{what} within east {:.1}, north {:.1}, up {:.1} arcsec", off.x, off.y, off.z);
}
