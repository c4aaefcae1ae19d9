//! The growth of navigation errors over days, against figures from elsewhere and against strapdown navigation.

use std::f64::consts::{FRAC_PI_2, TAU};

use nalgebra::DMatrix;
use rins_design::{Growth, GrowthError, Service};
use rins_frames::units::{
    ARCSEC, DEG, DEG_PER_HOUR, DEG_PER_ROOT_HOUR, DEG_PER_SECOND, MICRO_G, PPM,
};
use rins_frames::{Body, Dcm, EulerAngles, InFrame, Increments, Site, Table};
use rins_motion::{Navigator, Profile, Segment, Station, TrueMotion, VerticalChannel};
use rins_terms::{KinematicState, Model, Signals, Surroundings, catalogue, values};

const HOUR: f64 = 3600.0;
const NAUTICAL_MILE: f64 = 1852.0;
const RATE: f64 = 6.0 * DEG_PER_SECOND;
const TURN: f64 = TAU / RATE;

fn surroundings(latitude: f64, attitude: EulerAngles) -> Surroundings {
    let site = Site { latitude, longitude: 0.0, height: 0.0 };
    Surroundings::new(Station::with_normal_gravity(site), attitude.dcm())
}

fn upright() -> EulerAngles {
    EulerAngles { roll: 0.0, pitch: 0.0, yaw: 0.0 }
}

fn still() -> Vec<Segment> {
    vec![Segment { rate: 0.0, duration: HOUR }]
}

fn continuous() -> Vec<Segment> {
    vec![Segment { rate: RATE, duration: TURN }]
}

/// A turn forward, a turn back.
fn reciprocating() -> Vec<Segment> {
    [RATE, -RATE].map(|rate| Segment { rate, duration: TURN }).to_vec()
}

/// Five minutes in each of four positions a quarter of a turn apart, and back through them.
fn four_positions() -> Vec<Segment> {
    let dwell = Segment { rate: 0.0, duration: 300.0 };
    let quarter = |rate: f64| [dwell, Segment { rate, duration: FRAC_PI_2 / RATE }];
    [RATE, RATE, RATE, -RATE, -RATE, -RATE].into_iter().flat_map(quarter).collect()
}

/// The errors of the worked case: 0.01 deg/h, 5 ppm, 5 arcsec of gyros towards z, 20 µg.
fn errors(model: &Model) -> Vec<f64> {
    let of = |id: String| match id.as_str() {
        id if id.starts_with("gyro.bias") => 0.01 * DEG_PER_HOUR,
        id if id.starts_with("gyro.scale") => 5.0 * PPM,
        "gyro.misalignment.xz" | "gyro.misalignment.yz" => 5.0 * ARCSEC,
        id if id.starts_with("accel.bias") => 20.0 * MICRO_G,
        _ => 0.0,
    };
    model.ids().map(of).collect()
}

/// The position error east at these hours \[nmi\], at 45 deg with the axis upright.
fn east(cycle: &[Segment], hours: &[f64]) -> Vec<f64> {
    let model = Model::sensors();
    let parameters = model.places().collect::<Vec<_>>();
    let errors = errors(&model);
    let surroundings = surroundings(45.0 * DEG, upright());
    let service =
        Service { surroundings, cycle, model: &model, parameters: &parameters, noise: [0.0; 2] };
    let times: Vec<f64> = hours.iter().map(|hour| hour * HOUR).collect();
    let grown = service.growth(&times).expect("a cycle of a table at 45 deg");
    grown.iter().map(|one| one.position(&errors)[0] / NAUTICAL_MILE).collect()
}

/// Figures of an independent linear model, to all their digits.
#[test]
fn schemes_drift_as_an_independent_model_says() {
    let near = |got: f64, want: f64| assert!((got / want - 1.0).abs() < 0.01, "{got}, not {want}");
    near(east(&still(), &[24.0])[0], 14.78);
    near(east(&continuous(), &[24.0])[0], 85.08);
    let forth_and_back = east(&reciprocating(), &[24.0, 48.0, 72.0]);
    near(forth_and_back[0], 7.444);
    near(forth_and_back[2], 21.88);
    near(east(&four_positions(), &[24.0])[0], 7.46);
}

/// `(eps_z + S_z w) sin L cos L` in longitude for a table that turns on and on; without it, what is along the Earth's axis.
#[test]
fn secular_growth_is_the_law() {
    let model = Model::sensors();
    let places = model.places().collect::<Vec<_>>();
    // The law has the errors along the axis only.
    let along = |(id, error): (String, f64)| {
        if ["gyro.bias.z", "gyro.scale.z"].contains(&id.as_str()) { error } else { 0.0 }
    };
    let errors: Vec<f64> = model.ids().zip(errors(&model)).map(along).collect();
    let surroundings = surroundings(45.0 * DEG, upright());
    let law = |cycle: &[Segment]| {
        let service =
            Service { surroundings, cycle, model: &model, parameters: &places, noise: [0.0; 2] };
        let east = service.secular_east().expect("a cycle of a table at 45 deg")?;
        let rate: f64 = east.iter().zip(&errors).map(|(by, error)| by * error).sum();
        Some(rate * 24.0 * HOUR / NAUTICAL_MILE)
    };
    let near = |got: Option<f64>, want: f64| {
        assert!(got.is_some_and(|got| (got / want - 1.0).abs() < 0.01), "{got:?}, not {want}");
    };
    near(law(&continuous()), 84.96);
    near(law(&reciprocating()), 21.60 / 3.0);
    near(law(&four_positions()), 21.60 / 3.0);
    // A cycle that does not close has no such law.
    assert_eq!(law(&[Segment { rate: RATE, duration: 0.4 * TURN }]), None);
}

/// Free inertial navigation over some hours, with these errors of the readings; east and north \[m\].
fn navigated(
    surroundings: &Surroundings,
    cycle: &[Segment],
    model: &Model,
    hours: f64,
) -> [f64; 2] {
    const INTERVAL: f64 = 0.1;
    let duration: f64 = cycle.iter().map(|segment| segment.duration).sum();
    #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "a few thousand")]
    let times = (hours * HOUR / duration).ceil() as usize;
    let segments = cycle.repeat(times);
    let motion = TrueMotion {
        station: surroundings.station,
        nav_from_table: surroundings.nav_from_table,
        profile: Profile::new(&segments, None).expect("rates of a cycle"),
    };
    let start = surroundings.nav_from_table * Dcm::<Table, Body>::identity();
    let navigator = || Navigator::at_rest(&surroundings.station, start, VerticalChannel::Held);
    let [mut with, mut without] = [navigator(), navigator()];
    for sample in motion.samples(INTERVAL).take_while(|sample| sample.time < hours * HOUR + 0.01) {
        let Increments { angle, velocity, interval } = sample.increments;
        let now = rins_terms::Instant {
            angle: sample.angle - 0.5 * sample.mean_rate * interval,
            rate: sample.mean_rate,
            ..rins_terms::Instant::default()
        };
        let moment = KinematicState {
            sample: 0,
            interval,
            duration: 1.0,
            mean: now,
            end: now,
            rate: angle.components() / interval,
            force: velocity.components() / interval,
            surroundings: *surroundings,
            track: None,
        };
        let Signals { gyro, accel, .. } = model.signals(&moment);
        with.step(&Increments {
            angle: angle + InFrame::from_components(values(&gyro) * interval),
            velocity: velocity + InFrame::from_components(values(&accel) * interval),
            interval,
        });
        without.step(&sample.increments);
    }
    let [with, without] = [&with, &without].map(|one| one.state().position);
    let site = surroundings.station.site;
    [
        (with.longitude - without.longitude) * site.transverse_radius() * site.latitude.cos(),
        (with.latitude - without.latitude) * site.meridian_radius(),
    ]
}

fn with_errors(part: f64) -> Model {
    let mut model = Model::sensors();
    let mut seed = 0.37_f64;
    for chosen in &mut model.terms {
        let bias =
            [&catalogue::GYRO_BIAS, &catalogue::ACCEL_BIAS].iter().any(|t| t.is(chosen.term));
        let size = match (bias, chosen.term.id.starts_with("gyro")) {
            (true, true) => 0.01 * DEG_PER_HOUR,
            (true, false) => 20.0 * MICRO_G,
            _ => 5.0 * PPM,
        };
        for value in &mut chosen.values {
            // Irregular, between -1 and 1.
            seed = (seed * 7.13 + 0.29).fract();
            *value = part * size * (2.0 * seed - 1.0);
        }
    }
    model
}

/// What is left of strapdown navigation beside the linear model is of second order: half the errors leave a quarter.
#[test]
fn strapdown_navigation_differs_by_the_second_order() {
    const HOURS: f64 = 12.0;
    let tilted = EulerAngles { roll: 20.0 * DEG, pitch: -10.0 * DEG, yaw: 40.0 * DEG };
    for (latitude, attitude, cycle) in [
        (45.0, upright(), continuous()),
        (-20.0, tilted, reciprocating()),
        (60.0, tilted, four_positions()),
    ] {
        let surroundings = surroundings(latitude * DEG, attitude);
        let left = [1.0, 0.5].map(|part| {
            let model = with_errors(part);
            let places = model.places().collect::<Vec<_>>();
            let values: Vec<f64> = model.terms.iter().flat_map(|one| one.values.clone()).collect();
            let none = Model::sensors();
            let service = Service {
                surroundings,
                cycle: &cycle,
                model: &none,
                parameters: &places,
                noise: [0.0; 2],
            };
            let grown = &service.growth(&[HOURS * HOUR]).unwrap()[0];
            let linear = grown.position(&values);
            let full = navigated(&surroundings, &cycle, &model, HOURS);
            let off = (linear[0] - full[0]).hypot(linear[1] - full[1]);
            let size = full[0].hypot(full[1]);
            assert!(size > 1000.0, "{size} m");
            assert!(off < 0.01 * size, "{latitude} deg: {linear:?} m, not {full:?}");
            off
        });
        let ratio = left[0] / left[1];
        // Rounding and the algorithm of the navigator leave less than two meters.
        assert!((3.0..5.0).contains(&ratio) || left[0] < 2.0, "{latitude} deg: {left:?} m");
    }
}

/// Random walks of the angle grow the covariance as many runs of them scatter; and a state at the start as the system says.
#[test]
fn covariance_is_that_of_noise_in_small_steps() {
    let model = Model::sensors();
    let surroundings = surroundings(45.0 * DEG, upright());
    let cycle = continuous();
    let noise = [0.002 * DEG_PER_ROOT_HOUR, 1e-5];
    let service = Service { surroundings, cycle: &cycle, model: &model, parameters: &[], noise };
    let times: Vec<f64> = (1..=240).map(|step| 60.0 * f64::from(step)).collect();
    let grown = service.growth(&times).unwrap();
    // The noise of each minute, as an error of the state at its end, propagated by what an error at the start does.
    let mut sum = nalgebra::SMatrix::<f64, 7, 7>::zeros();
    let first = grown[0].by_noise;
    for after in (0..grown.len()).rev() {
        let by = if after == 0 { nalgebra::SMatrix::identity() } else { grown[after - 1].by_start };
        sum += by * first * by.transpose();
    }
    let last = grown.last().unwrap();
    let covariance = last.covariance(&DMatrix::zeros(0, 0), &nalgebra::SMatrix::zeros());
    let (want, got) = (Growth::radial(&sum), Growth::radial(&covariance));
    assert!((got / want - 1.0).abs() < 1e-6, "{got} m, not {want}");
    // Of the attitude over a minute, nothing but the noise itself.
    let angle = noise[0] * 60.0_f64.sqrt();
    assert!((first[(0, 0)].sqrt() / angle - 1.0).abs() < 1e-3);
    assert!(got > 100.0 && got < 1e5, "{got} m");
}

#[test]
fn bad_input_is_told() {
    let model = Model::sensors();
    let at = |latitude: f64, cycle: &[Segment], times: &[f64]| {
        let surroundings = surroundings(latitude, upright());
        let service =
            Service { surroundings, cycle, model: &model, parameters: &[], noise: [0.0; 2] };
        service.growth(times).map(|grown| grown.len())
    };
    let turning = continuous();
    assert_eq!(at(0.7, &turning, &[0.0, 1.0, 1.0]), Ok(3));
    assert_eq!(at(0.7, &[], &[1.0]), Err(GrowthError::Empty));
    assert_eq!(at(0.7, &turning, &[2.0, 1.0]), Err(GrowthError::Time { time: 1.0 }));
    assert!(matches!(at(0.7, &turning, &[f64::NAN]), Err(GrowthError::Time { .. })));
    assert_eq!(at(FRAC_PI_2, &turning, &[1.0]), Err(GrowthError::Pole));
    let never = [Segment { rate: 0.1, duration: 0.0 }];
    assert!(matches!(at(0.7, &never, &[1.0]), Err(GrowthError::Segment { index: 1, .. })));
}

#[test]
fn exact_start_has_no_error() {
    let model = Model::sensors();
    let places = model.places().collect::<Vec<_>>();
    let surroundings = surroundings(0.7, upright());
    let cycle = reciprocating();
    let service = Service {
        surroundings,
        cycle: &cycle,
        model: &model,
        parameters: &places,
        noise: [1e-6, 1e-5],
    };
    let grown = &service.growth(&[0.0]).unwrap()[0];
    assert_eq!((grown.by_parameter.amax(), grown.by_noise.amax()), (0.0, 0.0));
}
