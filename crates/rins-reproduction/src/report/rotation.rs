//! Attitude errors of a static and a rotating IMU: one figure and a table.

use std::fmt::Write;

use rins_frames::units::ARCSEC;

use super::chart::{Axis, Mark, Panel, Scale, Series, svg};
use super::figures::series;
use super::number::{Table, significant};
use super::results::Results;
use crate::rotation::{AttitudeHistory, GyroErrors, Motion};

/// The maximum number of points of a curve.
const POINTS: usize = 120;

fn history(results: &Results, motion: Motion, errors: GyroErrors) -> Option<&AttitudeHistory> {
    results.histories.iter().find(|one| one.motion == motion && one.errors == errors)
}

pub(super) fn section(results: &Results) -> String {
    let mut out = String::new();
    out.push_str(
        "## Static and rotating {#static-and-rotating}\n\n\
         \"Single axis rotational inertial navigation system can restrain divergence of attitude error\", while \"gyro drift on the spin axis \
         still diverge[s]\": the \
         gyros of Table 2 at Table 4's attitude, without noise, static and at 10 °/s, navigated freely for 360 s with perfect \
         accelerometers. Attitude errors are given in the axis frame: x and y across the spin axis, z along it. The figure shows the \
         largest error so far: a bounded error is a plateau, a drift a straight line.\n\n\
         ![Largest attitude error so far about each axis, static and rotating](figures/static-and-rotating.svg)\n\n",
    );
    let mut table = Table::new(&[
        "motion",
        "gyro errors in the data",
        "largest x [″]>",
        "y [″]>",
        "z [″]>",
        "at 360 s: x [″]>",
        "y [″]>",
        "z [″]>",
    ]);
    for one in &results.histories {
        let motion = match one.motion {
            Motion::Static => "static",
            Motion::Rotating => "rotating",
        };
        let errors = match one.errors {
            GyroErrors::Biases => "biases",
            GyroErrors::AllButSpinAxis => "all but the spin-axis errors",
            GyroErrors::All => "all of Table 2",
        };
        let (largest, end) = (one.largest() / ARCSEC, one.end() / ARCSEC);
        let mut cells = vec![motion.to_owned(), errors.to_owned()];
        cells.extend([largest.x, largest.y, largest.z].map(|error| significant(error, 2)));
        cells.extend([end.x, end.y, end.z].map(|error| significant(error, 2)));
        table.row(&cells);
    }
    out.push_str(&table.finish());
    let [fixed, _] = largest(results, Motion::Static, GyroErrors::All);
    let [raw, _] = largest(results, Motion::Rotating, GyroErrors::All);
    let [across, along] = restrained(results);
    let _ = write!(
        out,
        "Both statements hold for all but the spin-axis errors: across the axis, rotation divides the largest error of 360 s by {}, along the axis it \
         changes nothing. They leave out what rotation adds. The misalignments $M_{{xz}}$ and $M_{{yz}}$ of 60″ swing the level by up to {}″, {} times the \
         static error of the same time, and $S_z$ turns the table's rate into a drift {} times that of the static IMU. \
         Rotation at one rate and in one direction restrains the attitude error only once the spin-axis errors are compensated.\n\n",
        significant(across, 2),
        significant(raw, 2),
        significant(raw / fixed, 2),
        significant(along, 2),
    );
    out
}

/// The largest error across the axis and along it \[arcsec\].
fn largest(results: &Results, motion: Motion, errors: GyroErrors) -> [f64; 2] {
    history(results, motion, errors).map_or([f64::NAN; 2], |one| {
        let largest = one.largest() / ARCSEC;
        [largest.xy().max(), largest.z]
    })
}

/// The factor by which rotation reduces the largest error across the axis if the spin-axis errors are compensated, and
/// the factor by which it increases that along the axis if they are not.
pub(super) fn restrained(results: &Results) -> [f64; 2] {
    let [fixed, static_along] = largest(results, Motion::Static, GyroErrors::All);
    let [modulated, _] = largest(results, Motion::Rotating, GyroErrors::AllButSpinAxis);
    let [_, along] = largest(results, Motion::Rotating, GyroErrors::All);
    [fixed / modulated, along / static_along]
}

/// The running maximum of the error about each axis, against time.
pub(super) fn figure(results: &Results) -> String {
    let curves = [
        (Motion::Static, GyroErrors::All, "static", Mark::Line, 3),
        (
            Motion::Rotating,
            GyroErrors::AllButSpinAxis,
            "rotating, spin-axis errors removed",
            Mark::Dash,
            0,
        ),
        (Motion::Rotating, GyroErrors::All, "rotating, all gyro errors", Mark::Line, 1),
    ];
    let panels: Vec<Panel> = ["x, across the axis", "y, across the axis", "z, along the axis"]
        .into_iter()
        .enumerate()
        .map(|(axis, title)| {
            let curve = |(motion, errors, label, mark, colour)| {
                let points = history(results, motion, errors)
                    .map(|one| thinned(&one.largest_so_far(), axis))
                    .unwrap_or_default();
                series(Some(label), mark, colour, points)
            };
            Panel {
                title,
                x: Axis::new("time [s]", Scale::Logarithmic, (1.0, 360.0)),
                y: Axis::new("largest error so far [arcsec]", Scale::Logarithmic, (0.01, 1e4)),
                series: curves.into_iter().map(curve).collect::<Vec<Series>>(),
            }
        })
        .collect();
    svg("Attitude errors of one IMU static and rotating, about each axis of the table", &panels)
}

/// Points evenly spaced in the logarithm of time, from one second on \[s, arcsec\].
fn thinned(points: &[(f64, nalgebra::Vector3<f64>)], axis: usize) -> Vec<(f64, f64)> {
    let last = points.last().map_or(1.0, |point| point.0);
    let mut places: Vec<usize> = (0..=POINTS)
        .map(|count| last.powf(count as f64 / POINTS as f64))
        .map(|time| points.partition_point(|point| point.0 < time - 1e-9))
        .filter(|place| *place < points.len())
        .collect();
    places.dedup();
    places.into_iter().map(|place| (points[place].0, points[place].1[axis] / ARCSEC)).collect()
}
