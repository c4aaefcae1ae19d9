//! The filter's sigmas in both forms, compared with arithmetic of 200 bits.

use nalgebra::{Matrix3, RowSVector};
use rins_ekf::congruence;
use rins_frames::units::DEG;
use rins_frames::{EulerAngles, Site};
use rins_imu::{ImuSpec, TriadSpec};
use rins_motion::{Profile, Segment, Station, TrueMotion};
use rins_testing::LongCovariance;

use super::*;
use crate::filter::{Form, Reference, SpinAxisFilter, TableReading};
use crate::kernel::{Reading, Sample};
use crate::setup::TableSpec;

const INTERVAL: f64 = 0.1;
const STEPS: usize = 80;

/// The tolerance of a sigma.
const SIX_DIGITS: f64 = 1e-6;

const AXIS_SIGMA: f64 = 1e-2;

/// The table measurement of a run.
#[derive(Clone, Copy)]
enum Table {
    Angle,
    Rate,
    /// A rate after a static interval, in which the gyros' errors along the spin axis are hardly observable.
    RateAfterRest,
}

fn motion(table: Table) -> TrueMotion {
    let site = Site { latitude: 34.25 * DEG, longitude: 0.0, height: 400.0 };
    let angles = EulerAngles { roll: 0.5, pitch: 0.3, yaw: 0.7 };
    let rest = Segment { rate: 0.0, duration: 0.3 };
    let turn = Segment { rate: 20.0 * DEG, duration: 10.0 };
    let segments = if let Table::RateAfterRest = table { [rest, turn] } else { [turn, rest] };
    TrueMotion {
        station: Station::with_normal_gravity(site),
        nav_from_table: angles.dcm(),
        profile: Profile::new(&segments, None).unwrap(),
    }
}

/// A rig whose table readings are `root` times as precise as the prior of the axis, or whose gyros are that much more precise
/// than the prior of their misalignments.
fn rig(motion: &TrueMotion, root: f64) -> (Setup, Start) {
    let triad = |noise_density, misalignment_sigma| {
        TriadSpec::white(noise_density, 0.0, misalignment_sigma, misalignment_sigma)
    };
    let read = AXIS_SIGMA / root;
    let table = TableSpec { angle_noise: read, wobble: 2.0 * read, rate_noise: 0.0, latency: 0.0 };
    let gyro = triad(1e-6, 1e-5 * root);
    let setup = Setup {
        station: motion.station,
        axis: None,
        table,
        imu: ImuSpec { gyro, accel: triad(3e-4, 1e-3) },
        velocity_noise: 1e-4,
    };
    let start = Start {
        nav_from_table: motion.nav_from_table,
        axis_covariance: Matrix3::from_diagonal_element(AXIS_SIGMA * AXIS_SIGMA),
        angle: 0.0,
        angle_source: AngleSource::Read,
    };
    (setup, start)
}

/// The largest relative error of a sigma at the end of a run, and the forms after its first and last samples.
fn worst(root: f64, table: Table) -> Result<(f64, [Form; 2]), UpdateError> {
    let motion = motion(table);
    let (setup, mut start) = rig(&motion, root);
    if let Table::Rate | Table::RateAfterRest = table {
        // A commanded rate is as precise as the gyros, and the axis is known with sufficient precision.
        start.angle_source = AngleSource::Defined;
        start.axis_covariance *= 1e-8;
    }
    let mut filter = SpinAxisFilter::new(setup, &start);
    let (by, variances) = start.sources(&setup).unwrap();
    let mut long = LongCovariance::of_sources(&by, &variances.into());
    let mut forms = Vec::new();
    let mut rows = SMatrix::<f64, MEASUREMENTS, STATES>::zeros();
    for sample in motion.samples(INTERVAL).take(STEPS) {
        let increments = sample.increments;
        let mut kernel = *filter.kernel();
        let (interval, means) = kernel.navigate(&Sample {
            angle: Vector::from(*increments.angle.components()),
            velocity: Vector::from(*increments.velocity.components()),
            interval: INTERVAL,
        });
        let (phi, by, variances) = kernel.dense_transition(&interval, &means);
        long.predict(&phi, &congruence(&by, &SMatrix::from_diagonal(&variances)));
        let (reading, table) = match table {
            Table::Angle => {
                let (sin, cos) = sample.angle.sin_cos();
                (Reading::Angle([sin, cos]), TableReading::Angle(sample.angle))
            }
            Table::Rate | Table::RateAfterRest => {
                (Reading::Rate(sample.mean_rate), TableReading::Rate(sample.mean_rate))
            }
        };
        let comparison = kernel.compare(&interval, &reading);
        let off = kernel.mechanisation.velocity;
        let measurement = comparison.measurement(&off, setup.velocity_noise);
        let cross = measurement.cross.unwrap_or_else(SMatrix::zeros);
        long.update(&measurement.matrix, &measurement.noise, &cross);
        rows = measurement.matrix;
        filter.step(&increments, &Reference::fixed(table))?;
        forms.push(filter.form());
    }
    let mut worst = 0.0_f64;
    let mut compare = |combination: &RowSVector<f64, STATES>| {
        let got = filter.variance_of(combination);
        let error = (got / long.variance_of(combination)).sqrt() - 1.0;
        worst = worst.max(if error.is_nan() { f64::INFINITY } else { error.abs() });
    };
    for state in 0..STATES {
        compare(&RowSVector::from_fn(|_, j| if j == state { 1.0 } else { 0.0 }));
    }
    for row in 0..MEASUREMENTS {
        compare(&rows.row(row).into_owned());
    }
    Ok((worst, [forms[0], forms[STEPS - 1]]))
}

#[test]
fn sigmas_keep_six_digits_in_the_form_that_the_rule_takes() {
    for table in [Table::Angle, Table::Rate] {
        for decades in [0, 2, 4, 6, 8, 10, 12, 14, 16] {
            let (error, forms) = worst(10_f64.powf(0.5 * f64::from(decades)), table).unwrap();
            assert!(error < SIX_DIGITS, "{error:e} at {decades} decades, {forms:?}");
            let form = if decades < 7 { Form::Plain } else { Form::Factorised };
            assert_eq!(forms, [form; 2], "at {decades} decades");
        }
    }
}

#[test]
fn factors_take_over_where_they_are_first_needed() {
    let (error, forms) = worst(3e4, Table::RateAfterRest).unwrap();
    assert!(error < SIX_DIGITS, "{error:e}");
    assert_eq!(forms, [Form::Plain, Form::Factorised]);
}

#[test]
fn what_not_even_factors_hold_is_refused() {
    for decades in [18, 22, 26, 30] {
        let error = worst(10_f64.powf(0.5 * f64::from(decades)), Table::Angle).unwrap_err();
        assert!(matches!(error, UpdateError::Unresolved { .. }), "{error}");
    }
}
