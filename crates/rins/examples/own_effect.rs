//! An effect that the catalogue does not contain: a gyro error proportional to the square of the rate, simulated, and estimated
//! together with effects of the catalogue.

use rins::estimation::{NoiseKnowledge, NoiseParameters, Reference, Rig, Run, fit};
use rins::frames::units::{DEG, DEG_PER_HOUR, DEG_PER_SECOND, MICRO_G, PPM};
use rins::frames::{EulerAngles, Site};
use rins::imu::{ImuNoise, ImuSpec, NoiseModel, TriadSpec};
use rins::motion::{Profile, Segment, Station};
use rins::simulation::{Scenario, simulate};
use rins::terms::{
    Action, Model, Owner, Parameter, Parity, Prevalence, Prior, Term, TermInstance, Unit,
};

static BEND: Term = Term {
    id: "gyro_bend",
    also: &[],
    name: "bend of the gyro about the axis",
    cause: "the gyro's scale changes with its rate, in one direction of rotation up and in the other down",
    equation: "gyro z += k ω²",
    source: "an example",
    parameters: &[Parameter {
        name: "k",
        unit: Unit::new("ppm/(deg/s)", PPM / DEG_PER_SECOND),
        prior: Prior::Anywhere(0.1, 10.0),
    }],
    settings: &[],
    needs: &[],
    partners: &[],
    told_apart_by: "turn at several rates, both ways",
    owner: Owner::Sensor,
    prevalence: Prevalence::Standard,
    parity: Parity::Unchanged,
    action: Action::Signal(|p, _, moment, out| out.gyro[2] += p[0] * moment.rate.z.powi(2)),
};

#[expect(clippy::print_stdout, reason = "an example prints")]
fn main() -> Result<(), Box<dyn std::error::Error>> {
    let triad = |noise, bias| TriadSpec::white(noise, bias, 500.0 * PPM, 1e-3);
    let imu = ImuSpec {
        gyro: triad(0.02 * DEG_PER_HOUR, 0.1 * DEG_PER_HOUR),
        accel: triad(30.0 * MICRO_G, 200.0 * MICRO_G),
    };
    let site = Site { latitude: 45.0 * DEG, longitude: 0.0, height: 0.0 };
    let station = Station::with_normal_gravity(site);
    let nav_from_table = EulerAngles { roll: 25.0 * DEG, pitch: 0.0, yaw: 0.0 }.dcm();
    let turn = |rate| Segment { rate: rate * DEG_PER_SECOND, duration: 60.0 };
    let profile = Profile::new(&[10.0, -10.0, 40.0, -40.0].map(turn), Some(0.1))?;
    let truth = 2.0 * BEND.parameters[0].unit.factor;
    let scenario = Scenario {
        noise: Some(ImuNoise {
            gyro: NoiseModel::white(imu.gyro.noise_density),
            accel: NoiseModel::white(imu.accel.noise_density),
        }),
        effects: Model::default().with(TermInstance::new(&BEND).with_values(&[truth])),
        ..Scenario::perfect(station, nav_from_table, profile, 0.02)
    };
    let reference = Reference::Encoder { noise: 5e-7 };
    let rig = Rig { station, nav_from_table, reference, wobble: 5e-9, velocity: 1e-6 };
    let runs = [Run::new(rig, simulate(&scenario)?.recording)?];

    let model = Model::full().with(TermInstance::new(&BEND).estimated());
    let found = fit(&runs, &model, &imu, NoiseKnowledge::Given(NoiseParameters::of(&imu)), |_| ())?;
    let bend = found.parameter("gyro_bend.k").ok_or("it is estimated")?;
    let unit = bend.parameter.unit;
    let (value, sigma) = (bend.value / unit.factor, bend.sigma / unit.factor);
    println!("gyro_bend.k = {value:.5} ± {sigma:.5} {}, made with 2", unit.symbol);
    Ok(())
}
