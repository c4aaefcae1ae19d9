//! An alignment as sentences and as rows of a table.

use nalgebra::Vector3;
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR};
use rins_frames::{EulerAngles, SignedAxes};
use rins_io::Loaded;

use super::found::AlignmentSolution;
use crate::log::BEYOND_DATA_SHEET;

/// The own axes of the sensors, as axes of the run.
pub(super) fn own_axes(loaded: &Loaded) -> SignedAxes {
    SignedAxes::from(loaded.rig.spin)
}

pub(super) fn sentences(found: &AlignmentSolution, loaded: &Loaded) -> Vec<String> {
    let angles = found.nav_from_body.euler_angles();
    let from = found.start;
    let to = loaded.recording.times[found.span.end - 1];
    let mut sentences = vec![match found.sigma.2 {
        Some(azimuth) => format!(
            "Over a static interval of {:.0} s the attitude is roll {:.4}, pitch {:.4}, yaw {:.3} deg; 1σ is {:.1}″ in tilt and \
             {:.0}″ in azimuth.",
            to - from,
            angles.roll / DEG,
            angles.pitch / DEG,
            angles.yaw / DEG,
            found.sigma.0.max(found.sigma.1) / ARCSEC,
            azimuth / ARCSEC,
        ),
        None => format!(
            "Over a static interval of {:.0} s the attitude is roll {:.3}, pitch {:.3} deg; the gyros do not show north.",
            to - from,
            angles.roll / DEG,
            angles.pitch / DEG,
        ),
    }];
    if loaded.rig.imu.is_none() {
        sentences.push(
            "The rig gives no data sheet: the sigmas hold the scatter of the readings, but no sensor bias."
                .into(),
        );
    }
    if let (Some(imu), Some(_)) = (loaded.rig.imu, found.fine) {
        let off = found.nav_from_body * found.residual.angular_rate;
        for (axis, direction) in [(1, "north"), (2, "up")] {
            let (off, sheet) = (off.components()[axis].abs(), imu.gyro.bias_sigma);
            if off > BEYOND_DATA_SHEET * sheet {
                sentences.push(format!(
                    "Along {direction} the gyros are off by {:.3} deg/h, {:.0} times the data sheet's bias_sigma, which is not relied on.",
                    off / DEG_PER_HOUR,
                    off / sheet
                ));
            }
        }
    }
    if let Some(hidden) = &found.hidden {
        sentences.push(format!("North was not found: {hidden}."));
    }
    sentences
}

pub(super) fn rows(found: &AlignmentSolution, loaded: &Loaded) -> Vec<Vec<String>> {
    let row = |name: &str, value: String, sigma: String, note: String| {
        vec![name.to_owned(), value, sigma, note]
    };
    let angles = found.nav_from_body.euler_angles();
    let header = loaded.psins_header.map(|header| header.attitude);
    let given = loaded.rig.attitude.map(|attitude| attitude.angles);
    let against = |of: fn(&EulerAngles) -> f64| match (header, given) {
        (Some(header), _) => format!("header of the log: {:.4} deg", of(&header) / DEG),
        (None, Some(given)) => {
            format!("rig file: {:.4} deg (axis frame)", of(&given) / DEG)
        }
        (None, None) => String::new(),
    };
    let degrees = |angle: f64| format!("{:.5} deg", angle / DEG);
    let site = &loaded.station.site;
    let earth_rate = site.earth_rate().norm();
    let place = &found.place;
    let (rate_sigma, latitude_sigma) = found.seen_sigma();
    let mut rows = vec![
        ["quantity", "estimate", "1σ", "reference"].map(String::from).to_vec(),
        row("roll", degrees(angles.roll), degrees(found.sigma.1), against(|angles| angles.roll)),
        row("pitch", degrees(angles.pitch), degrees(found.sigma.0), against(|angles| angles.pitch)),
    ];
    if let Some(sigma) = found.sigma.2 {
        rows.push(row("yaw", degrees(angles.yaw), degrees(sigma), against(|angles| angles.yaw)));
    }
    rows.push(row(
        "gravity",
        format!("{:.5} m/s^2", place.gravity),
        format!("{:.5} m/s^2", found.uncertainty.specific_force),
        format!("site: {:.5} m/s^2", loaded.station.gravity),
    ));
    rows.push(row(
        "apparent Earth rate",
        format!("{:.4} deg/h", place.earth_rate / DEG_PER_HOUR),
        format!("{:.4} deg/h", rate_sigma / DEG_PER_HOUR),
        format!("Earth rate: {:.4} deg/h", earth_rate / DEG_PER_HOUR),
    ));
    if found.hidden.is_none() {
        rows.push(row(
            "apparent latitude",
            degrees(place.latitude),
            degrees(latitude_sigma),
            format!("site: {:.5} deg", site.latitude / DEG),
        ));
    }
    if !found.north_found() {
        // Without north, the residual rates are not a bias.
        return rows;
    }
    let shown = found.bias_shown(&own_axes(loaded));
    let bias_sigma = found.fine.map_or(found.mean.angular_rate_sigma, |fine| fine.gyro_bias_sigma);
    // Biases are listed along the sensors' own axes.
    let own_axes = own_axes(loaded);
    let bias = own_axes.undo(found.residual.angular_rate.components());
    let bias_sigma = own_axes.undo(&Vector3::from(bias_sigma)).abs();
    for (axis, name) in ["gyro bias x", "gyro bias y", "gyro bias z"].into_iter().enumerate() {
        let value = if shown[axis] {
            format!("{:.4} deg/h", bias[axis] / DEG_PER_HOUR)
        } else {
            "not estimated".into()
        };
        let note = if shown[axis] {
            "without its east component, which is absorbed by the azimuth"
        } else {
            "1σ assumed: an east bias is indistinguishable from an azimuth error"
        };
        let sigma = format!("{:.4} deg/h", bias_sigma[axis] / DEG_PER_HOUR);
        rows.push(row(name, value, sigma, note.into()));
    }
    rows
}
