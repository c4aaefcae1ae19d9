//! Every derivative that a term carries is that of what it adds.

use nalgebra::Vector3;
use proptest::prelude::*;
use rins_frames::units::DEG;
use rins_frames::{Dcm, EulerAngles, Site, Table};
use rins_motion::Station;
use rins_terms::catalogue::CATALOGUE;
use rins_terms::{
    Acting, Dual64, Instant, KinematicState, Model, Signals, Surroundings, TermInstance,
};
use rins_testing::assert_close;
use rins_testing::{any_euler_angles, any_latitude};

use crate::support::sheet;

/// Any moment of a table anywhere, at any rate and acceleration that tables have.
fn any_moment() -> impl Strategy<Value = KinematicState<'static>> {
    let table = (0.0..3600.0_f64, -20.0..20.0_f64, -1.0..1.0_f64, -0.5..0.5_f64);
    let heat = (-20.0..20.0_f64, -0.1..0.1_f64);
    (any_latitude(), any_euler_angles(), table, heat).prop_map(
        |(latitude, [roll, pitch, yaw], (time, angle, rate, acceleration), heat)| {
            let site = Site { latitude, longitude: 0.0, height: 0.0 };
            let attitude = EulerAngles { roll, pitch, yaw };
            let surroundings =
                Surroundings::new(Station::with_normal_gravity(site), attitude.dcm());
            let interval = 0.01;
            let (temperature, warming_rate) = heat;
            let sense = rate.signum();
            let mean = Instant {
                time,
                angle,
                rate,
                acceleration,
                sense,
                rate_change: sense,
                temperature: Some(temperature),
                warming_rate,
            };
            let end = Instant {
                time: time + interval / 2.0,
                angle: angle + rate * interval / 2.0,
                rate: rate + acceleration * interval / 2.0,
                ..mean
            };
            let mut moment = KinematicState {
                sample: 0,
                interval,
                duration: 4000.0,
                mean,
                end,
                rate: Vector3::zeros(),
                force: Vector3::zeros(),
                surroundings,
                track: None,
            };
            moment.rate = moment.in_body(&surroundings.earth_rate) + Vector3::z() * rate;
            moment.force = moment.in_body(&surroundings.specific_force);
            moment
        },
    )
}

fn numbers(signals: &Signals) -> Vec<Dual64> {
    let mut numbers = Vec::new();
    numbers.extend(signals.gyro);
    numbers.extend(signals.accel);
    numbers.extend(signals.tilt);
    numbers.push(signals.angle);
    numbers
}

proptest! {
    #[test]
    fn derivatives_are_those_of_differences(
        moment in any_moment(),
        sizes in proptest::collection::vec((0.2..1.0_f64, any::<bool>()), 18),
    ) {
        for term in CATALOGUE.iter().filter(|term| term.is_signal()) {
            let values: Vec<f64> = term
                .parameters
                .iter()
                .zip(&sizes)
                .map(|(p, (size, minus))| p.sigma(&sheet()) * if *minus { -size } else { *size })
                .collect();
            // The slope of a lock-in has no bound at its edge: it is a mean, tested below.
            if term.id == "gyro_dead_zone" {
                continue;
            }
            let at = |place: usize, change: f64| {
                let mut chosen = TermInstance::new(term).with_values(&values);
                chosen.values[place] += change;
                numbers(&chosen.signals(&moment, None))
            };
            let chosen = TermInstance::new(term).with_values(&values);
            for (place, parameter) in term.parameters.iter().enumerate() {
                let step = 1e-3 * values[place].abs();
                let exact = numbers(&chosen.signals(&moment, Some(place)));
                let (above, below) = (at(place, step), at(place, -step));
                // Second differences of what is not linear, and the rounding of the first.
                let size = exact.iter().map(|x| x.eps.abs()).fold(0.0, f64::max);
                let value = exact.iter().map(|x| x.re.abs()).fold(0.0, f64::max);
                let within = 1e-5 * size + 1e-12 * value / step + f64::MIN_POSITIVE;
                for ((above, below), exact) in above.iter().zip(&below).zip(&exact) {
                    let difference = (above.re - below.re) / (2.0 * step);
                    prop_assert!(
                        (difference - exact.eps).abs() <= within,
                        "{}.{}: {} is not {}, {}",
                        term.id, parameter.name, exact.eps, difference, within
                    );
                }
            }
        }
    }
}

/// A dead zone is as flat at the width zero as it looks: a linear test must start elsewhere.
#[test]
fn a_dead_zone_of_no_width_has_no_slope() {
    let track =
        crate::support::turning(&[rins_motion::Segment { rate: 5.0 * DEG, duration: 1.0 }]).track;
    let moment = track.moments().next().unwrap();
    let term = rins_terms::catalogue::term("gyro_dead_zone").unwrap();
    let signals = TermInstance::new(term).signals(&moment, Some(2));
    assert_eq!(signals.gyro[2].eps, 0.0);
    let wide = TermInstance::new(term).with_values(&[0.0, 0.0, 1e-6]).signals(&moment, Some(2));
    assert!(wide.gyro[2].eps < 0.0);
}

/// Near its edge the slope by a width is a mean, which adds up over a sweep through the edge as the true one does.
#[test]
fn slopes_of_a_dead_zone_add_up_over_a_sweep() {
    const WIDTH: f64 = 1e-6;
    let track =
        crate::support::turning(&[rins_motion::Segment { rate: 5.0 * DEG, duration: 1.0 }]).track;
    let mut moment = track.moments().next().unwrap();
    let mut zone = |width: f64, rate: f64| {
        moment.rate.x = rate;
        let zone = TermInstance::new(&rins_terms::catalogue::GYRO_DEAD_ZONE);
        zone.with_values(&[width, 0.0, 0.0]).signals(&moment, Some(0)).gyro[0]
    };
    // Far from the edge it is that of -d²/2ω, within a part of d²/2ω².
    assert_close!(zone(WIDTH, 50.0 * WIDTH).eps, -1.0 / 50.0, 1e-5);
    // The integral of -d/√(ω² - d²) from the edge to three widths, which is -d acosh 3.
    let step = 1e-4 * WIDTH;
    let rates = (0..30_000).map(|place| (f64::from(place) + 0.5) * step);
    let sum: f64 = rates.map(|rate| zone(WIDTH, rate).eps * step).sum();
    assert_close!(sum, -WIDTH * 3.0_f64.acosh(), 5e-3 * WIDTH);
}

/// What a misalignment turns is what a zone takes away: in it a gyro shows nothing of either.
#[test]
fn a_misalignment_turns_a_dead_zone_too() {
    let track =
        crate::support::turning(&[rins_motion::Segment { rate: 5.0 * DEG, duration: 1.0 }]).track;
    let mut moment = track.moments().next().unwrap();
    moment.rate = Vector3::new(3e-6, -4e-5, 0.1);
    let misalignment =
        TermInstance::new(&rins_terms::catalogue::GYRO_MISALIGNMENT).with_values(&[1e-5; 6]);
    let zone =
        TermInstance::new(&rins_terms::catalogue::GYRO_DEAD_ZONE).with_values(&[1e-5, 2e-5, 1e-6]);
    let model = Model { terms: vec![zone, misalignment] };
    let read = |model: &Model| numbers(&model.signals(&moment));
    for (term, chosen) in model.terms.iter().enumerate() {
        for (place, value) in chosen.values.iter().enumerate() {
            let exact = numbers(&Acting::together(
                &Acting::by(&model, &track, &[(term, place)]).concat(),
                &moment,
            ));
            let moved = |by: f64| {
                let mut model = model.clone();
                model.terms[term].values[place] += by;
                read(&model)
            };
            let step = 1e-3 * value;
            for ((above, below), exact) in moved(step).iter().zip(&moved(-step)).zip(&exact) {
                let slope = (above.re - below.re) / (2.0 * step);
                // Outside the zone the slope is a mean over a tenth of it on either side.
                assert_close!(exact.eps, slope, 4e-3 * slope.abs() + 1e-9);
            }
        }
    }
    // Gyro x is in its zone, and shows nothing of what its axis is turned by; gyro y is outside.
    let shown = |place: usize, gyro: usize| {
        Acting::together(&Acting::by(&model, &track, &[(1, place)]).concat(), &moment).gyro[gyro]
            .eps
    };
    assert_close!(shown(1, 0), 0.0, 1e-12);
    assert!(shown(3, 1) > 0.1);
}

/// Where the axis is turned, the Earth's rate crosses a zone at another place.
#[test]
fn an_attitude_moves_a_dead_zone() {
    let track =
        crate::support::turning(&[rins_motion::Segment { rate: 5.0 * DEG, duration: 1.0 }]).track;
    let moment = track.moments().next().unwrap();
    let around = moment.surroundings;
    let zone = TermInstance::new(&rins_terms::catalogue::GYRO_DEAD_ZONE).with_values(&[8e-5; 3]);
    let attitude = TermInstance::new(&rins_terms::catalogue::AXIS_ATTITUDE);
    let model = Model { terms: vec![attitude, zone.clone()] };
    let mut shown = 0.0_f64;
    for place in 0..3 {
        let by = Acting::together(&Acting::by(&model, &track, &[(0, place)]).concat(), &moment);
        let turned = |angle: f64| {
            let mut tilt = Vector3::zeros();
            tilt[place] = angle;
            let turn = Dcm::<Table, Table>::from_rotation_vector(&tilt);
            let around = Surroundings::new(around.station, around.nav_from_table * turn);
            let spin = Vector3::z() * moment.mean.rate;
            let rate = moment.in_body(&around.earth_rate) + spin;
            numbers(&zone.signals(&KinematicState { rate, ..moment }, None))
        };
        for ((above, below), exact) in turned(1e-4).iter().zip(&turned(-1e-4)).zip(&by.gyro) {
            let slope = (above.re - below.re) / 2e-4;
            assert_close!(exact.eps, slope, 0.01 * slope.abs() + 1e-9);
            shown = shown.max(slope.abs());
        }
    }
    assert!(shown > 1e-5);
}
