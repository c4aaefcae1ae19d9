//! The growth of navigation errors under way, against that at rest and against strapdown navigation.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, SMatrix, Vector3};
use rins_design::{Draw, GROWTH_STATES, Growth, GrowthError, Service, Voyage};
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, DEG_PER_SECOND, MICRO_G, PPM};
use rins_frames::{Dcm, EulerAngles, Nav, Site, Table};
use rins_imu::{NoiseModel, Seed};
use rins_motion::{CarriedTable, Carrier, Leg, Oscillation, Segment, Station, Sway};
use rins_terms::{Model, Surroundings, TermInstance, catalogue};

const HOUR: f64 = 3600.0;
const RATE: f64 = 6.0 * DEG_PER_SECOND;
const TURN: f64 = TAU / RATE;

fn reciprocating() -> Vec<Segment> {
    [RATE, -RATE].map(|rate| Segment { rate, duration: TURN }).to_vec()
}

fn station(latitude: f64) -> Station {
    Station::with_normal_gravity(Site { latitude: latitude * DEG, longitude: 0.0, height: 0.0 })
}

fn tilted() -> Dcm<Nav, Table> {
    EulerAngles { roll: 20.0 * DEG, pitch: -10.0 * DEG, yaw: 40.0 * DEG }.dcm()
}

/// Three legs of half an hour to an hour, and a ship's sway.
fn patrol(sways: bool) -> Carrier {
    let leg = |heading: f64, speed: f64, minutes: f64| Leg {
        heading: heading * DEG,
        speed,
        duration: 60.0 * minutes,
        turn_rate: Some(1.0 * DEG_PER_SECOND),
        acceleration: Some(0.05),
    };
    let of = |amplitude: f64, period: f64, phase: f64| {
        Some(Oscillation { amplitude: amplitude * DEG, period, phase })
    };
    let sway = Sway {
        roll: of(4.0, 9.1, 0.0),
        pitch: of(2.0, 6.3, 1.0),
        yaw: of(1.0, 13.0, 2.0),
        heave: Some(Oscillation { amplitude: 0.5, period: 8.0, phase: 0.0 }),
    };
    let legs = [leg(30.0, 8.0, 40.0), leg(140.0, 12.0, 30.0), leg(260.0, 5.0, 55.0)];
    Carrier::new(&legs, if sways { sway } else { Sway::default() }, 100.0 * HOUR)
        .expect("legs of a ship")
}

fn model() -> (Model, Vec<(usize, usize)>) {
    let model = Model::sensors();
    let places = model.places().collect();
    (model, places)
}

/// Irregular errors of all parameters, of navigation grade.
fn errors(model: &Model, part: f64) -> Vec<f64> {
    let mut seed = 0.37_f64;
    let of = |id: String| {
        let size = match (id.contains("bias"), id.starts_with("gyro")) {
            (true, true) => 0.01 * DEG_PER_HOUR,
            (true, false) => 20.0 * MICRO_G,
            _ => 5.0 * PPM,
        };
        seed = (seed * 7.13 + 0.29).fract();
        part * size * (2.0 * seed - 1.0)
    };
    model.ids().map(of).collect()
}

/// At rest, short steps give what the exact pieces give.
#[test]
fn voyage_at_rest_is_the_service_ashore() {
    let (model, places) = model();
    let white = [NoiseModel::white(1e-7), NoiseModel::white(1e-4)];
    let cycle = reciprocating();
    let table =
        CarriedTable::new((station(45.0), tilted()), Carrier::at_rest(), &cycle, false).unwrap();
    let voyage =
        Voyage { table: &table, model: &model, parameters: &places, noise: white.each_ref() };
    let service = Service {
        surroundings: Surroundings::new(station(45.0), tilted()),
        cycle: &cycle,
        model: &model,
        parameters: &places,
        noise: [1e-7, 1e-4],
    };
    let times = [1.0 * HOUR, 12.3 * HOUR];
    for (short, exact) in voyage.growth(&times).unwrap().iter().zip(service.growth(&times).unwrap())
    {
        for column in 0..places.len() {
            let [one, other] =
                [short, &exact].map(|grown| grown.by_parameter.column(column).into_owned());
            // Where a turn and back nearly cancels, to a hundredth of a meter.
            let off = (one - other).norm();
            assert!(off < 2e-4 * other.norm() + 0.01, "{one} {other}");
        }
        let [one, other] = [short, &exact].map(|grown| Growth::radial(&grown.by_noise));
        assert!((one / other - 1.0).abs() < 1e-4, "{one} {other}");
        assert!((short.by_start - exact.by_start).norm() < 1e-4 * exact.by_start.norm());
    }
}

/// The shipped case, navigated by strapdown for three days under every scheme: the linear model, and figures of an independent one.
#[test]
fn three_days_of_strapdown_are_the_linear_model() {
    let dwell = Segment { rate: 0.0, duration: 300.0 };
    let quarter = |rate: f64| [dwell, Segment { rate, duration: 0.25 * TURN }];
    let four = [RATE, RATE, RATE, -RATE, -RATE, -RATE].into_iter().flat_map(quarter).collect();
    let (model, places) = model();
    let errors: Vec<f64> = model
        .ids()
        .map(|id| match id.as_str() {
            id if id.starts_with("gyro.bias") => 0.01 * DEG_PER_HOUR,
            id if id.starts_with("gyro.scale") => 5.0 * PPM,
            "gyro.misalignment.xz" | "gyro.misalignment.yz" => 5.0 * ARCSEC,
            id if id.starts_with("accel.bias") => 20.0 * MICRO_G,
            _ => 0.0,
        })
        .collect();
    let times = [24.0 * HOUR, 48.0 * HOUR, 72.0 * HOUR];
    let silent = NoiseModel::default();
    for (cycle, figures) in [
        (vec![Segment { rate: 0.0, duration: HOUR }], vec![(0, 14.78)]),
        (vec![Segment { rate: RATE, duration: TURN }], vec![(0, 85.08)]),
        (reciprocating(), vec![(0, 7.444), (2, 21.88)]),
        (four, vec![(0, 7.46)]),
    ] {
        let place = (station(45.0), Dcm::identity());
        let table = CarriedTable::new(place, Carrier::at_rest(), &cycle, false).unwrap();
        let (model, parameters) = (&model, &places[..]);
        let voyage = Voyage { table: &table, model, parameters, noise: [&silent; 2] };
        let draw = Draw { errors: errors.clone(), attitude: Vector3::zeros(), seed: Seed::new(1) };
        let full = &voyage.simulated(&[draw], 0.2, &times, &|_| {}).unwrap()[0];
        let nautical = |meters: f64| meters / 1852.0;
        for (place, grown) in voyage.growth(&times).unwrap().iter().enumerate() {
            let [east, north] = grown.position(&errors);
            let off = (east - full[place][0]).hypot(north - full[place][1]);
            let size = full[place][0].hypot(full[place][1]);
            assert!(off < 0.01 * size, "{place}: {off} m of {size} m");
        }
        for (place, figure) in figures {
            let east = nautical(full[place][0]);
            assert!((east / figure - 1.0).abs() < 0.01, "{east} nmi, not {figure}");
        }
    }
}

/// What is left of strapdown navigation beside the linear model is of second order, with legs and sway, isolated or not.
#[test]
fn strapdown_under_way_differs_by_the_second_order() {
    const HOURS: f64 = 6.0;
    for (latitude, mounting, sways, stabilized) in [
        (45.0, Dcm::identity(), true, true),
        (-20.0, tilted(), true, false),
        (60.0, tilted(), false, true),
    ] {
        let place = (station(latitude), mounting);
        let table = CarriedTable::new(place, patrol(sways), &reciprocating(), stabilized).unwrap();
        let (model, places) = model();
        let silent = [NoiseModel::default(), NoiseModel::default()];
        let voyage =
            Voyage { table: &table, model: &model, parameters: &places, noise: silent.each_ref() };
        let draws = [1.0, 0.5].map(|part| Draw {
            errors: errors(&model, part),
            attitude: Vector3::new(3.0, -5.0, 20.0) * (part * ARCSEC),
            seed: Seed::new(1),
        });
        let full = voyage.simulated(&draws, 0.05, &[HOURS * HOUR], &|_| {}).unwrap();
        let grown = &voyage.growth(&[HOURS * HOUR]).unwrap()[0];
        let left: Vec<f64> = draws
            .iter()
            .zip(full)
            .map(|(draw, full)| {
                let [east, north] = grown.position(&draw.errors);
                let by_start = grown.by_start.fixed_view::<2, 3>(5, 0) * draw.attitude;
                let off = (east + by_start[1] - full[0][0]).hypot(north + by_start[0] - full[0][1]);
                let size = full[0][0].hypot(full[0][1]);
                assert!(size > 300.0, "{size} m");
                assert!(off < 0.01 * size, "{latitude} deg: {off} of {size} m");
                off
            })
            .collect();
        let ratio = left[0] / left[1];
        assert!((3.0..5.0).contains(&ratio) || left[0] < 3.0, "{latitude} deg: {left:?} m");
    }
}

/// Flicker noise, random walk and white noise scatter as the covariance says.
#[test]
fn colored_noise_scatters_as_its_covariance() {
    const DRAWS: u64 = 200;
    let (model, _) = model();
    let cycle = reciprocating();
    let table = CarriedTable::new((station(45.0), tilted()), patrol(false), &cycle, false).unwrap();
    let gyro = |change: fn(&mut NoiseModel)| {
        let mut noise = NoiseModel::default();
        change(&mut noise);
        [noise, NoiseModel::default()]
    };
    let accel = NoiseModel { flicker: Some(5.0 * MICRO_G), ..NoiseModel::default() };
    for noise in [
        gyro(|noise| noise.flicker = Some(0.003 * DEG_PER_HOUR)),
        gyro(|noise| noise.bias_random_walk = 1e-10),
        gyro(|noise| noise.white_density = 1e-7),
        [NoiseModel::default(), accel],
    ] {
        let voyage =
            Voyage { table: &table, model: &model, parameters: &[], noise: noise.each_ref() };
        let times = [1.0 * HOUR, 4.0 * HOUR];
        let draws: Vec<Draw> = (0..DRAWS)
            .map(|run| Draw {
                errors: Vec::new(),
                attitude: Vector3::zeros(),
                seed: Seed { seed: 7, run },
            })
            .collect();
        let found = voyage.simulated(&draws, 0.25, &times, &|_| {}).unwrap();
        let grown = voyage.growth(&times).unwrap();
        for (place, grown) in grown.iter().enumerate() {
            let none = SMatrix::<f64, GROWTH_STATES, GROWTH_STATES>::zeros();
            let predicted = Growth::radial(&grown.covariance(&DMatrix::zeros(0, 0), &none));
            let squares: f64 =
                found.iter().map(|draw| draw[place][0].powi(2) + draw[place][1].powi(2)).sum();
            let ratio = (squares / draws.len() as f64).sqrt() / predicted;
            // Four sigmas of the rms of the draws that vary along one direction at worst.
            assert!((ratio - 1.0).abs() < 4.0 / (2.0 * DRAWS as f64).sqrt(), "{noise:?}: {ratio}");
        }
    }
}

#[test]
fn bad_input_is_told() {
    let (_, places) = model();
    let table = CarriedTable::new((station(45.0), tilted()), patrol(true), &reciprocating(), false)
        .unwrap();
    let of = |model: &Model, places: &[(usize, usize)], times: &[f64], noise: &NoiseModel| {
        let noise = [noise, noise];
        let voyage = Voyage { table: &table, model, parameters: places, noise };
        let draw = Draw {
            errors: vec![0.0; places.len()],
            attitude: Vector3::zeros(),
            seed: Seed::new(1),
        };
        let simulated = voyage.simulated(&[draw], 0.1, times, &|_| {});
        assert_eq!(voyage.growth(times).err(), simulated.as_ref().err().copied());
        simulated.err()
    };
    let sensors = Model::sensors();
    let silent = NoiseModel::default();
    assert_eq!(of(&sensors, &places, &[1.0, 2.0], &silent), None);
    assert_eq!(of(&sensors, &places, &[2.0, 1.0], &silent), Some(GrowthError::Time { time: 1.0 }));
    let curved = Model { terms: vec![TermInstance::new(&catalogue::ACCEL_QUADRATIC)] };
    assert!(matches!(of(&curved, &[(0, 0)], &[1.0], &silent), Some(GrowthError::NotAffine { .. })));
    let voyage = Voyage { table: &table, model: &sensors, parameters: &[], noise: [&silent; 2] };
    assert!(voyage.simulated(&[], 0.0, &[1.0], &|_| {}).is_err());
    let negative = NoiseModel::white(-1.0);
    let voyage = Voyage { noise: [&negative, &silent], ..voyage };
    let draw = Draw { errors: Vec::new(), attitude: Vector3::zeros(), seed: Seed::new(1) };
    assert!(matches!(voyage.simulated(&[draw], 0.1, &[1.0], &|_| {}), Err(GrowthError::Noise(_))));
}
