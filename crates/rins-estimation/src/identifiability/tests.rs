//! Observability of the errors of an IMU on a tilted table under several schedules.

use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, DEG_PER_SECOND, MICRO_G, PPM};
use rins_frames::{EulerAngles, Site};
use rins_imu::{ImuNoise, ImuSpec, NoiseModel, Seed, TriadSpec};
use rins_motion::{Profile, Segment, Station};
use rins_simulation::{Encoder, Scenario, TableRecord, simulate};
use rins_terms::{Model, TermInstance, catalogue};
use rins_testing::assert_close;

use super::*;
use crate::fit::fit;
use crate::noise_parameters::{NoiseKnowledge, NoiseParameters};
use crate::run::{Reference, Rig, Run};

const IMU: ImuSpec = ImuSpec {
    gyro: TriadSpec::white(0.02 * DEG_PER_HOUR, 0.1 * DEG_PER_HOUR, 500.0 * PPM, 120.0 * ARCSEC),
    accel: TriadSpec::white(30.0 * MICRO_G, 200.0 * MICRO_G, 300.0 * PPM, 60.0 * ARCSEC),
};

/// A run with these rates [deg/s] and durations [s] on an axis with this tilt and azimuth [deg].
fn run(rates: &[(f64, f64)], tilt: f64, azimuth: f64) -> Run {
    let site = Site { latitude: 45.0 * DEG, longitude: 9.0 * DEG, height: 100.0 };
    let station = Station::with_normal_gravity(site);
    let segments: Vec<Segment> = rates
        .iter()
        .map(|&(rate, duration)| Segment { rate: rate * DEG_PER_SECOND, duration })
        .collect();
    let profile = Profile::new(&segments, None).unwrap();
    let nav_from_table = EulerAngles { roll: 0.0, pitch: tilt * DEG, yaw: azimuth * DEG }.dcm();
    let scenario = Scenario::perfect(station, nav_from_table, profile, 0.02);
    let rig = Rig {
        station,
        nav_from_table,
        reference: Reference::Encoder { noise: ARCSEC },
        wobble: 1e-3 * ARCSEC,
        velocity: 1e-6,
    };
    Run::new(rig, simulate(&scenario).unwrap().recording).unwrap()
}

fn model(ids: &[&str]) -> Model {
    let term = |id: &&str| TermInstance::new(catalogue::term(id).unwrap()).estimated();
    Model { terms: ids.iter().map(term).collect() }
}

/// The observability of the spin axis errors, biases, attitude and mounting.
fn of_baseline(rates: &[(f64, f64)]) -> Identifiability {
    let baseline = model(&["gyro.bias", "accel.bias", "axis.attitude", "mounting"])
        .with(TermInstance::new(&catalogue::GYRO_SCALE).estimating(&["z"]))
        .with(TermInstance::new(&catalogue::GYRO_MISALIGNMENT).estimating(&["xz", "yz"]));
    let run = run(rates, 25.0, 0.0);
    joint(&[run], &baseline, &IMU, &NoiseParameters::of(&IMU)).unwrap().identifiability()
}

#[test]
fn one_rate_tells_three_combinations_less_than_there_are_unknowns() {
    let identifiability = of_baseline(&[(10.0, 360.0)]);
    assert_eq!(identifiability.rank.rank() + 3, identifiability.unknowns.len());
    // A clear case: rounding is far below the weakest observable combination.
    assert!(
        identifiability.rank.most_null < 1e-4 * identifiability.rank.least_told,
        "{:?}",
        identifiability.rank
    );
    // Without the mounting, which limits the misalignments more than a bias does:
    let spin = model(&["gyro.bias", "accel.bias", "axis.attitude"])
        .with(TermInstance::new(&catalogue::GYRO_SCALE).estimating(&["z"]))
        .with(TermInstance::new(&catalogue::GYRO_MISALIGNMENT).estimating(&["xz", "yz"]));
    let run = run(&[(10.0, 360.0)], 25.0, 0.0);
    let identifiability =
        joint(&[run], &spin, &IMU, &NoiseParameters::of(&IMU)).unwrap().identifiability();
    assert_eq!(identifiability.rank.rank() + 3, identifiability.unknowns.len());
    // b + (S, M) ω with ω of the table and the Earth: the combination is S + b/ω.
    // The axis is tilted to the south.
    let earth = 7.292115e-5 * ((45.0 - 25.0) * DEG).sin();
    let rate = 10.0 * DEG_PER_SECOND + earth;
    for (kept, lost) in [
        ("gyro.scale.z", "gyro.bias.z"),
        ("gyro.misalignment.xz", "gyro.bias.x"),
        ("gyro.misalignment.yz", "gyro.bias.y"),
    ] {
        let (kept, lost) =
            (identifiability.find(kept).unwrap(), identifiability.find(lost).unwrap());
        assert_eq!(identifiability.parameters[kept].shown, Observable::Combination);
        let aliases = &identifiability.parameters[kept].aliases;
        assert_eq!(aliases.len(), 1);
        assert_eq!((aliases[0].unknown, aliases[0].exactly), (lost, true));
        assert_close!(aliases[0].coefficient * rate, 1.0, 1e-6);
        assert_eq!(
            identifiability.parameters[lost].shown,
            Observable::Part { of: vec![kept], exactly: true }
        );
        // The other unknown is observable in the same sum, with an uncertainty scaled by its coefficient.
        assert_eq!(identifiability.parameters[lost].aliases[0].unknown, kept);
        assert_close!(identifiability.parameters[lost].aliases[0].coefficient / rate, 1.0, 1e-6);
        assert_close!(
            identifiability.parameters[lost].data_sigma
                / identifiability.parameters[kept].data_sigma
                / rate,
            1.0,
            1e-6
        );
        assert!(
            !identifiability.parameters[kept].identifiable
                && !identifiability.parameters[lost].identifiable
        );
    }
}

#[test]
fn a_reversal_rates_or_dwells_tell_all_of_the_baseline() {
    let mut dwells = Vec::new();
    for _ in 0..8 {
        dwells.extend([(0.0, 40.0), (10.0, 4.5)]);
    }
    let ladder: Vec<(f64, f64)> =
        [10.0, -10.0, 20.0, -20.0, 5.0, -5.0].map(|rate| (rate, 60.0)).to_vec();
    for rates in [vec![(10.0, 180.0), (-10.0, 180.0)], ladder, dwells] {
        let identifiability = of_baseline(&rates);
        assert!(identifiability.rank.lost.is_empty(), "{rates:?}: {:?}", identifiability.rank);
        assert!(
            identifiability
                .parameters
                .iter()
                .all(|seen| seen.identifiable && seen.shown == Observable::Alone)
        );
    }
}

/// White noise over 180 s in each direction determines the uncertainty of the mean of both, and of half of their difference.
#[test]
fn predicted_sigmas_are_those_of_means_of_white_noise() {
    let identifiability = of_baseline(&[(10.0, 180.0), (-10.0, 180.0)]);
    let mean = 0.02 * DEG_PER_HOUR / 360.0_f64.sqrt();
    let sigma = |id: &str| identifiability.parameters[identifiability.find(id).unwrap()].data_sigma;
    assert_close!(sigma("gyro.bias.x") / mean, 1.0, 0.02);
    // An encoder of 1 arcsec adds a little uncertainty at the ends of a run of gyro z.
    assert_close!(sigma("gyro.scale.z") * 10.0 * DEG_PER_SECOND / mean, 1.04, 0.04);
}

#[test]
fn gauges_stay_lost_under_a_rich_schedule() {
    let rates = [(0.0, 20.0), (10.0, 40.0), (-10.0, 40.0), (20.0, 20.0), (-20.0, 20.0)];
    let runs = [(25.0, 0.0), (60.0, 120.0), (85.0, 240.0)]
        .map(|(tilt, azimuth)| run(&rates, tilt, azimuth));
    let full = Model::full();
    let more = model(&["mounting", "encoder.zero", "wrong_gravity"]);
    let model = Model { terms: full.terms.into_iter().chain(more.terms).collect() };
    let identifiability =
        joint(&runs, &model, &IMU, &NoiseParameters::of(&IMU)).unwrap().identifiability();
    let named = |name: &str| {
        identifiability
            .parameters
            .iter()
            .filter(|seen| seen.gauge.is_some_and(|gauge| gauge.name == name))
            .count()
    };
    // The rank is clear: the unshared fractions of unobservable unknowns are below a millionth, including the effect of the
    // Earth's rate on attitudes within an epoch.
    assert!(
        identifiability.rank.most_null < 5e-12 && identifiability.rank.least_told > 1e-9,
        "{:?}",
        identifiability.rank
    );
    // One for each run, and the others once: about x and about y.
    assert_eq!(named("the zero of the table angle"), 3);
    assert_eq!(named("the body axes about the spin axis"), 1);
    assert_eq!(named("the mounting of the IMU on the table about x"), 1);
    assert_eq!(named("the mounting of the IMU on the table about y"), 1);
    // The other parameters of the sensors are observable.
    let told_well = ["gyro.scale.z", "gyro.bias.x"];
    assert!(
        told_well
            .iter()
            .all(|id| identifiability.parameters[identifiability.find(id).unwrap()].identifiable)
    );
}

#[test]
fn members_of_gauges_are_parameters_of_their_terms() {
    for (term, name) in GAUGES.iter().flat_map(|gauge| gauge.members).copied().flatten() {
        assert!(term.parameters.iter().any(|p| p.name == *name), "{}.{name}", term.id);
        let id = format!("{}.{name}", term.id);
        assert!(GAUGES.iter().any(|gauge| gauge.holds(&id)), "{id}");
    }
    assert!(!GAUGES.iter().any(|gauge| gauge.holds("gyro.scale.z") || gauge.holds("mounting")));
}

/// Each gauge is a direction among its own parameters that is unobservable under a rich schedule.
#[test]
fn gauges_are_null_directions() {
    let rates = [(0.0, 10.0), (10.0, 40.0), (-10.0, 40.0), (20.0, 20.0)];
    let runs = [(25.0, 0.0), (60.0, 120.0)].map(|(tilt, azimuth)| run(&rates, tilt, azimuth));
    for gauge in GAUGES {
        let mut model = Model::default();
        for (term, name) in gauge.members.iter().map(|member| member[0]) {
            let found = model.terms.iter_mut().find(|chosen| chosen.term.is(term));
            match found {
                Some(chosen) => *chosen = chosen.clone().estimating(&[name]),
                None => model.terms.push(TermInstance::new(term).estimating(&[name])),
            }
        }
        let joint = joint(&runs, &model, &IMU, &NoiseParameters::of(&IMU)).unwrap();
        let information = &joint.evidence.information;
        let size = information.diagonal().map(f64::sqrt);
        let unit = information.component_div(&(&size * size.transpose()));
        let least = SymmetricEigen::new(unit).eigenvalues.min();
        // The effect of a latency is a derivative, and that of a rate is calculated by differences.
        let within = if gauge.name == "the origin of time" { 1e-7 } else { EXACT };
        assert!(least < within, "{}: {least}", gauge.name);
    }
}

/// The information of a schedule on the baseline, the g-sensitivity of gyro z perpendicular to the axis and the eccentricity
/// of the encoder, in units of the priors, and the places of the latter two.
fn of_one_per_turn(rates: &[(f64, f64)]) -> (DMatrix<f64>, Vec<usize>, Vec<usize>) {
    let model = model(&["gyro.bias", "accel.bias", "axis.attitude", "mounting"])
        .with(TermInstance::new(&catalogue::GYRO_SCALE).estimating(&["z"]))
        .with(TermInstance::new(&catalogue::GYRO_G_SENSITIVITY).estimating(&["zx", "zy"]))
        .with(TermInstance::new(&catalogue::ENCODER_ECCENTRICITY).estimated());
    let joint = joint(&[run(rates, 25.0, 0.0)], &model, &IMU, &NoiseParameters::of(&IMU)).unwrap();
    let n = joint.unknowns.len();
    (joint.information(), vec![n - 4, n - 3], vec![n - 2, n - 1])
}

#[test]
fn two_harmonics_that_differ_in_sign_separate_by_the_closed_form() {
    let (information, first, second) = of_one_per_turn(&[(10.0, 360.0)]);
    // Only the accelerometers distinguish them, for which the error of the encoder is one of phase.
    let constant = separation(&information, &first, &second).kappa();
    assert!((80.0..150.0).contains(&constant), "{constant}");
    for (forward, back) in [(5.0, 5.0), (9.0, 3.0)] {
        let turns = [(10.0, 36.0 * forward), (-10.0, 36.0 * back)];
        let (information, first, second) = of_one_per_turn(&turns);
        // s √(4 Nf Nr / (Nf + Nr)) for a signal with a significance of s √(Nf + Nr).
        let expected = (forward + back) / (2.0 * f64::sqrt(forward * back));
        let identifiability = separation(&information, &first, &second);
        assert_eq!((identifiability.directions.len(), identifiability.absorbed), (2, [0, 0]));
        for direction in &identifiability.directions {
            // Bias and scale error absorb a little of three revolutions.
            assert_close!(direction.kappa, expected, 0.03);
            let apart = distance(&information, &first, &direction.along);
            assert_close!(apart, direction.separation, 1e-6 * direction.separation);
        }
    }
}

#[test]
fn one_signature_under_two_names_is_never_told_apart() {
    let model = model(&["gyro.bias", "accel.bias", "axis.attitude"])
        .with(TermInstance::new(&catalogue::GYRO_SCALE).estimating(&["z"]))
        .with(TermInstance::new(&catalogue::GYRO_BIAS_RAMP).estimating(&["z"]))
        .with(TermInstance::new(&catalogue::GYRO_SCALE_RAMP).estimated());
    let kappa = |rates: &[(f64, f64)]| {
        let run = run(rates, 25.0, 0.0);
        let joint = joint(&[run], &model, &IMU, &NoiseParameters::of(&IMU)).unwrap();
        let n = joint.unknowns.len();
        separation(&joint.information(), &[n - 2], &[n - 1]).kappa()
    };
    assert!(kappa(&[(10.0, 120.0)]).is_infinite());
    assert_close!(kappa(&[(10.0, 180.0), (-10.0, 180.0)]), 1.0, 0.1);
    // An effect absorbed by a bias has no direction left.
    let (information, ..) = of_one_per_turn(&[(10.0, 60.0)]);
    let doubled = |place: usize| if place < 3 { place } else { 0 };
    let copied = DMatrix::from_fn(4, 4, |r, c| information[(doubled(r), doubled(c))]);
    let absorbed = separation(&copied, &[3], &[1]);
    assert!(absorbed.kappa().is_infinite());
    assert_eq!(absorbed.absorbed, [1, 0]);
}

/// In simulations with noise, the separation of two effects is as predicted.
///
/// The increase of the sum of squares of a fit without the first effect, relative to a fit with both, is χ² with two degrees
/// of freedom; its noncentrality is the squared separation in sigmas.
#[test]
fn simulated_runs_tell_two_effects_apart_as_predicted() {
    const RUNS: u64 = 12;
    let rates = [(10.0, 45.0), (-10.0, 45.0)];
    let second = model(&["gyro.bias", "accel.bias", "axis.attitude", "mounting"])
        .with(TermInstance::new(&catalogue::GYRO_SCALE).estimating(&["z"]))
        .with(TermInstance::new(&catalogue::GYRO_MISALIGNMENT).estimating(&["xz", "yz"]))
        .with(TermInstance::new(&catalogue::ENCODER_ECCENTRICITY).estimated());
    let both = second
        .clone()
        .with(TermInstance::new(&catalogue::GYRO_G_SENSITIVITY).estimating(&["zx", "zy"]));
    let planned = run(&rates, 25.0, 0.0);
    let joint =
        joint(std::slice::from_ref(&planned), &both, &IMU, &NoiseParameters::of(&IMU)).unwrap();
    let n = joint.unknowns.len();
    let (of_first, of_second) = ([n - 2, n - 1], [n - 4, n - 3]);
    let mut information = joint.information();
    (0..n - 4).for_each(|place| information[(place, place)] += 1.0);
    let direction = separation(&information, &of_first, &of_second).directions.remove(0);
    let size: Vec<f64> =
        direction.along.iter().map(|part| part * joint.unknowns[n - 1].sigma).collect();
    let mut g_sensitivity = TermInstance::new(&catalogue::GYRO_G_SENSITIVITY);
    g_sensitivity.values[6..8].copy_from_slice(&size);
    let eccentricity = TermInstance::new(&catalogue::ENCODER_ECCENTRICITY)
        .with_values(&[3.0 * ARCSEC, -4.0 * ARCSEC]);
    let gain: f64 = (0..RUNS)
        .map(|seed| {
            let segments =
                rates.map(|(rate, duration)| Segment { rate: rate * DEG_PER_SECOND, duration });
            let mut scenario = Scenario::perfect(
                planned.rig.station,
                planned.rig.nav_from_table,
                Profile::new(&segments, None).unwrap(),
                0.02,
            );
            scenario.effects = Model { terms: vec![g_sensitivity.clone(), eccentricity.clone()] };
            scenario.noise = Some(ImuNoise {
                gyro: NoiseModel::from(&IMU.gyro),
                accel: NoiseModel::from(&IMU.accel),
            });
            scenario.table = TableRecord::Angle(Encoder { noise: ARCSEC, ..Encoder::default() });
            scenario.seed = Seed::new(seed);
            let recording = simulate(&scenario).unwrap().recording;
            let run = [Run::new(planned.rig, recording).unwrap()];
            let left = |model: &Model| {
                fit(&run, model, &IMU, NoiseKnowledge::Given(NoiseParameters::of(&IMU)), |_| {})
                    .unwrap()
                    .evidence
                    .square
            };
            left(&second) - left(&both)
        })
        .sum();
    let apart = (gain / RUNS as f64 - 2.0).sqrt();
    assert_close!(apart / direction.separation, 1.0, 0.2);
}
