//! A body on a carried table: what a navigator makes of its increments, and what is refused.

use rins_frames::units::{DEG, DEG_PER_SECOND};
use rins_frames::{Body, Dcm, EulerAngles, InFrame, Site, Table};
use rins_testing::assert_close;

use super::*;
use crate::{NavState, Navigator, Segment, Station, TrueMotion, VerticalChannel};

fn station() -> Station {
    Station::with_normal_gravity(Site { latitude: 50.0 * DEG, longitude: 0.1, height: 20.0 })
}

fn tilted() -> Dcm<Nav, Table> {
    EulerAngles { roll: 3.0 * DEG, pitch: -4.0 * DEG, yaw: 30.0 * DEG }.dcm()
}

fn reciprocating() -> Vec<Segment> {
    let turn = |rate: f64| Segment { rate, duration: 60.0 };
    vec![turn(6.0 * DEG_PER_SECOND), turn(-6.0 * DEG_PER_SECOND)]
}

fn legs() -> Vec<Leg> {
    let leg = |heading: f64, speed: f64, duration: f64| Leg {
        heading: heading * DEG,
        speed,
        duration,
        turn_rate: Some(1.0 * DEG_PER_SECOND),
        acceleration: Some(0.1),
    };
    vec![leg(0.0, 10.0, 900.0), leg(120.0, 6.0, 700.0), leg(260.0, 12.0, 800.5)]
}

fn swaying() -> Sway {
    let of =
        |amplitude: f64, period: f64, phase: f64| Some(Oscillation { amplitude, period, phase });
    Sway {
        roll: of(5.0 * DEG, 8.3, 0.3),
        pitch: of(2.0 * DEG, 6.1, 1.0),
        yaw: of(1.0 * DEG, 11.0, 2.0),
        heave: of(0.5, 9.0, 0.5),
    }
}

/// At rest the increments are those of a table on the ground.
#[test]
fn table_at_rest_is_that_on_the_ground() {
    let cycle = reciprocating();
    let profile = crate::Profile::new(&cycle.repeat(3), None).unwrap();
    let ground = TrueMotion { station: station(), nav_from_table: tilted(), profile };
    let carried =
        CarriedTable::new((station(), tilted()), Carrier::at_rest(), &cycle, false).unwrap();
    for (one, other) in ground.samples(0.07).zip(carried.samples(0.07)) {
        let angle = one.increments.angle - other.increments.angle;
        let velocity = one.increments.velocity - other.increments.velocity;
        assert!(angle.norm() < 1e-13 && velocity.norm() < 1e-12, "at {} s", one.time);
    }
}

/// A navigator that is fed the increments arrives where the carrier does, with its velocity and attitude, for each way of carrying.
///
/// The table turns at a constant rate: where its rate jumps, the coning and sculling of the previous increments are wrong.
#[test]
fn navigator_follows_the_carrier() {
    const INTERVAL: f64 = 0.01;
    for (sway, legs, stabilized) in [
        (Sway::default(), legs(), false),
        (swaying(), Vec::new(), true),
        (swaying(), legs(), false),
        (swaying(), legs(), true),
    ] {
        let carrier = Carrier::new(&legs, sway, 4000.0).unwrap();
        let table =
            CarriedTable::new((station(), tilted()), carrier, &reciprocating()[..1], stabilized)
                .unwrap();
        let first = table.state(0.0, &station().site);
        let start = NavState {
            position: station().site,
            velocity: InFrame::from_components(first.velocity),
            nav_from_body: Dcm::from_matrix(first.nav_from_body).unwrap(),
        };
        let vertical = VerticalChannel::Free;
        let mut navigator = Navigator::new(start, &station(), vertical);
        let mut end = None;
        for sample in table.samples(INTERVAL).take(300_000) {
            navigator.step(&sample.increments);
            end = Some(sample);
        }
        let end = end.unwrap();
        let truth = table.state(end.time, &end.site);
        let state = navigator.state();
        let radius = 6.37e6;
        let north = (state.position.latitude - end.site.latitude) * radius;
        let east = (state.position.longitude - end.site.longitude) * radius;
        // The residual sculling of the roll at 100 Hz; with legs, the jumps of the turn rate.
        let most = if legs.is_empty() || sway == Sway::default() { 0.05 } else { 0.5 };
        assert!(north.hypot(east) < most, "{north} {east} m");

        assert!((state.velocity.components() - truth.velocity).norm() < 1e-3);
        let body: Dcm<Nav, Body> = Dcm::from_matrix(truth.nav_from_body).unwrap();
        let off = (state.nav_from_body * body.inverse()).rotation_vector().norm();
        assert!(off < 1e-7, "{off} rad");
    }
}

/// The body of a stabilized table keeps its azimuth while the carrier turns; without, it turns with it.
#[test]
fn stabilized_table_is_isolated_from_the_heading() {
    let still = [Segment { rate: 0.0, duration: 100.0 }];
    let azimuths = [false, true].map(|stabilized| {
        let carrier = Carrier::new(&legs(), Sway::default(), 4000.0).unwrap();
        let place = (station(), Dcm::identity());
        let table = CarriedTable::new(place, carrier, &still, stabilized).unwrap();
        // After the turn of the second leg.
        let state = table.state(1100.0, &station().site);
        let forward = state.nav_from_body.column(1).into_owned();
        forward.x.atan2(forward.y) / DEG
    });
    assert_close!(azimuths[0], 120.0, 1e-9);
    assert_close!(azimuths[1], 0.0, 1e-9);
}

/// Velocity is the derivative of the place, and acceleration that of the velocity, on both sides of every corner.
#[test]
fn course_is_continuous() {
    let carrier = Carrier::new(&legs(), swaying(), 10_000.0).unwrap();
    let mut corner = 0.0;
    let mut corners = 0;
    while corner < 9_000.0 {
        let [before, after] = [corner - 1e-7, corner + 1e-7].map(|time| carrier.at(time));
        assert!((before.velocity - after.velocity).norm() < 1e-6);
        assert!((before.yaw - after.yaw).abs() < 1e-6);
        let next = carrier.next_corner(corner);
        let middle = 0.5 * (corner + next);
        let [one, two] = [middle - 1e-4, middle + 1e-4].map(|time| carrier.at(time));
        let acceleration = (two.velocity - one.velocity) / 2e-4;
        assert!((acceleration - carrier.at(middle).acceleration).norm() < 1e-6);
        assert!(((two.yaw - one.yaw) / 2e-4 - carrier.at(middle).yaw_rate).abs() < 1e-8);
        corner = next;
        corners += 1;
    }
    assert!(corners > 20, "{corners}");
}

#[test]
fn what_no_carrier_can_do_is_refused() {
    let of = |legs: &[Leg]| Carrier::new(legs, Sway::default(), 4000.0);
    let all = legs();
    let without = |leg: usize, change: fn(&mut Leg)| {
        let mut legs = all.clone();
        change(&mut legs[leg]);
        of(&legs).unwrap_err()
    };
    assert!(matches!(
        without(1, |leg| leg.turn_rate = None),
        CarrierError::HeadingJumps { leg: 2, jump_deg } if (jump_deg - 120.0).abs() < 1e-9
    ));
    // The first leg is reached again from the last.
    assert!(matches!(
        without(0, |leg| leg.turn_rate = None),
        CarrierError::HeadingJumps { leg: 1, .. }
    ));
    assert!(matches!(
        without(2, |leg| leg.acceleration = None),
        CarrierError::SpeedJumps { leg: 3, .. }
    ));
    assert!(matches!(
        without(1, |leg| leg.duration = 100.0),
        CarrierError::TooShort { leg: 2, .. }
    ));
    assert!(matches!(without(1, |leg| leg.speed = f64::NAN), CarrierError::Leg { leg: 2, .. }));
    assert!(matches!(without(1, |leg| leg.duration = 0.0), CarrierError::Leg { leg: 2, .. }));
    let short = [Leg { duration: 1e-6, turn_rate: None, acceleration: None, ..all[0] }];
    assert!(matches!(of(&short), Err(CarrierError::TooMany { .. })));
    let never = Sway {
        roll: Some(Oscillation { amplitude: 0.1, period: 0.0, phase: 0.0 }),
        ..Sway::default()
    };
    assert!(matches!(Carrier::new(&all, never, 100.0), Err(CarrierError::Sway { .. })));
    assert!(of(&[]).is_ok());
}
