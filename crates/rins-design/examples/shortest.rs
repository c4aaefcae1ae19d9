//! The shortest schedule that distinguishes a g-sensitivity of the gyros from an eccentricity of the encoder.

use rins_design::{Effect, Goal, Limits, Pair, Planned, information, propose};
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, DEG_PER_SECOND, MICRO_G, PPM};
use rins_frames::{EulerAngles, Site};
use rins_imu::{ImuSpec, TriadSpec};
use rins_motion::{Profile, Segment, Station};
use rins_simulation::{Encoder, Scenario, TableRecord};
use rins_terms::{Model, TermInstance, catalogue};

#[expect(clippy::print_stdout, reason = "an example prints")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let triad = |noise, bias| TriadSpec::white(noise, bias, 500.0 * PPM, 120.0 * ARCSEC);
    let imu = ImuSpec {
        gyro: triad(0.02 * DEG_PER_HOUR, 0.1 * DEG_PER_HOUR),
        accel: triad(30.0 * MICRO_G, 200.0 * MICRO_G),
    };
    let site = Site { latitude: 45.0 * DEG, longitude: 0.0, height: 0.0 };
    let station = Station::with_normal_gravity(site);
    let tilted = EulerAngles { roll: 25.0 * DEG, pitch: 0.0, yaw: 0.0 }.dcm();
    let turn = Segment { rate: 10.0 * DEG_PER_SECOND, duration: 60.0 };
    let scenario = Scenario {
        table: TableRecord::Angle(Encoder::default()),
        ..Scenario::perfect(station, tilted, Profile::new(&[turn], Some(0.1))?, 0.02)
    };
    let given = Planned::new("one rate".into(), scenario, imu, (0.1 * ARCSEC, 0.1 * ARCSEC, None));

    let terms = [&catalogue::GYRO_G_SENSITIVITY, &catalogue::ENCODER_ECCENTRICITY];
    let model = terms
        .iter()
        .fold(Model::full(), |model, term| model.with(TermInstance::new(term).estimated()));
    let effects = terms.map(Effect::of);
    let pair = Pair::of(&information(std::slice::from_ref(&given), &model)?, &effects);
    println!("one rate separates them by {:.2?} sigma", pair.separation);
    let limits = Limits {
        rate: 100.0 * DEG_PER_SECOND,
        acceleration: 10.0 * DEG_PER_SECOND,
        duration: 1800.0,
        directions: 2,
    };
    let goal = Goal::separate(&effects, &pair);
    let proposal = propose(&given, &model, &goal, &limits, |_, _| {})?;
    println!("{}: {:.1} sigma", proposal.candidate.words, proposal.reached);
    Ok(())
}
