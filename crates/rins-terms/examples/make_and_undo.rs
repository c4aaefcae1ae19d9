//! Makes what a mounted IMU and its encoder read on a turning table, and undoes it again.
//!
//! `cargo run --release -p rins-terms --example make_and_undo`
#![expect(clippy::print_stdout, reason = "an example prints")]

use rins_frames::units::{ARCSEC, DEG, DEG_PER_SECOND, PPM};
use rins_frames::{EulerAngles, Site};
use rins_motion::{Profile, Recording, Segment, Station, TrueMotion};
use rins_terms::{
    MeasurementModel, Model, Surroundings, TermInstance, Track, catalogue, compensated,
};

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let site = Site { latitude: 34.25 * DEG, longitude: 108.9 * DEG, height: 400.0 };
    let attitude = EulerAngles { roll: 25.0 * DEG, ..EulerAngles::default() };
    let turn = Segment { rate: 10.0 * DEG_PER_SECOND, duration: 72.0 };
    let motion = TrueMotion {
        station: Station::with_normal_gravity(site),
        nav_from_table: attitude.dcm(),
        profile: Profile::new(&[turn], Some(5.0 * DEG_PER_SECOND))?,
    };
    let scale = TermInstance::new(&catalogue::GYRO_SCALE).with_values(&[0.0, 0.0, 300.0 * PPM]);
    let zero = TermInstance::new(&catalogue::ENCODER_ZERO).with_values(&[40.0 * ARCSEC]);
    let model = Model { terms: vec![scale, zero] };

    let samples: Vec<_> = motion.samples(0.02).collect();
    let times: Vec<f64> = samples.iter().map(|sample| sample.time).collect();
    let angles = std::iter::once(0.0).chain(samples.iter().map(|sample| sample.angle)).collect();
    let around = Surroundings::new(motion.station, motion.nav_from_table);
    let track = Track::new(around, times.clone(), vec![0.02; times.len()], angles, None);
    let mut making = MeasurementModel::new(&model, &track);
    let mut read = Recording { times, ..Recording::default() };
    let mut table_angle = Vec::new();
    for (moment, sample) in track.moments().zip(&samples) {
        let reading = making.read(&moment, &sample.increments);
        read.increments.push(reading.increments);
        table_angle.push(sample.angle + reading.angle_error);
    }
    read.table_angle = Some(table_angle);

    let undone = compensated(&model, around, &read)?;
    let turned = |recording: &Recording| -> f64 {
        recording.increments.iter().map(|sample| sample.angle.components().z).sum()
    };
    let truth: f64 = samples.iter().map(|sample| sample.increments.angle.components().z).sum();
    println!("read:   {:+8.3} arcsec too far", (turned(&read) - truth) / ARCSEC);
    println!("undone: {:+8.3} arcsec", (turned(&undone) - truth) / ARCSEC);
    Ok(())
}
