//! Eqs. (6) to (9), printed and corrected, compared with the linear model and a navigator.
//!
//! `cargo run -p rins-motion --example mechanism`
#![expect(clippy::print_stdout, reason = "an example prints")]

use rins_frames::units::{ARCSEC, DEG, DEG_PER_SECOND, PPM};
use rins_frames::{EulerAngles, InFrame, Nav, Site};
use rins_motion::mechanism::{
    ClosedForm, ConstantTurn, LinearModel, NavErrors, Neglected, SensorErrors, Sign,
    SpinAxisErrors, cost, flat_navigation,
};
use rins_motion::{
    NavState, Navigator, Profile, ProfileError, Segment, Station, TrueMotion, VerticalChannel,
};

const DURATION: f64 = 360.0;
const INTERVAL: f64 = 0.02;

fn main() -> Result<(), ProfileError> {
    let site = Site { latitude: 34.25 * DEG, longitude: 0.0, height: 0.0 };
    let angles = EulerAngles { roll: 30.0 * DEG, pitch: 20.0 * DEG, yaw: 40.0 * DEG };
    let turn = ConstantTurn {
        station: Station::with_normal_gravity(site),
        nav_from_table: angles.dcm(),
        rate: 10.0 * DEG_PER_SECOND,
    };
    let errors = SpinAxisErrors {
        misalignment_xz: 60.0 * ARCSEC,
        misalignment_yz: 60.0 * ARCSEC,
        scale_z: 300.0 * PPM,
    };

    println!("after {DURATION} s            east      north     roll     pitch      yaw");
    for (name, sign) in [("printed", Sign::Printed), ("corrected", Sign::Strapdown)] {
        let form = ClosedForm::new(turn, errors, sign);
        let velocity = form.velocity_error(DURATION).total();
        row(name, &turn, &velocity, &form.attitude_error(DURATION));
    }
    let flat = flat_navigation(&turn, &errors, &NavErrors::none(), DURATION);
    row("flat, not linearised", &turn, &flat.velocity, &flat.attitude);
    let linear = LinearModel::new(turn, VerticalChannel::Held).propagate(
        &NavErrors::none(),
        &SensorErrors::from(errors),
        DURATION,
    );
    row("linear, round Earth", &turn, &linear.velocity, &linear.attitude);
    let navigated = navigate(&turn, &errors)?;
    row("navigator", &turn, &navigated.velocity, &navigated.attitude);

    println!("\nleft out in eqs. (6) to (9), and what that costs:");
    for neglected in Neglected::ALL {
        let cost = cost(neglected, &turn, &errors, DURATION);
        row(&format!("{neglected:?}"), &turn, &cost.velocity, &cost.attitude);
    }
    Ok(())
}

fn navigate(turn: &ConstantTurn, errors: &SpinAxisErrors) -> Result<NavErrors, ProfileError> {
    let segment = Segment { rate: turn.rate, duration: DURATION };
    let motion = TrueMotion {
        station: turn.station,
        nav_from_table: turn.nav_from_table,
        profile: Profile::new(&[segment], None)?,
    };
    let sensors = SensorErrors::from(*errors);
    let attitude = turn.nav_from_body(0.0);
    let mut navigator = Navigator::at_rest(&turn.station, attitude, VerticalChannel::Held);
    let mut truth: NavState = *navigator.state();
    for sample in motion.samples(INTERVAL) {
        navigator.step(&sensors.measured(&sample.increments));
    }
    truth.nav_from_body = turn.nav_from_body(DURATION);
    Ok(NavErrors::between(navigator.state(), &truth))
}

fn row(name: &str, turn: &ConstantTurn, velocity: &InFrame<Nav>, attitude: &InFrame<Nav>) {
    let v = velocity.components();
    let errors = NavErrors { attitude: *attitude, ..NavErrors::none() };
    let EulerAngles { roll, pitch, yaw } = errors.of_euler_angles(turn.nav_from_body(DURATION));
    println!(
        "{name:22} {:8.4} {:10.4} m/s {:8.4} {:8.4} {:8.4} deg",
        v.x,
        v.y,
        roll / DEG,
        pitch / DEG,
        yaw / DEG,
    );
}
