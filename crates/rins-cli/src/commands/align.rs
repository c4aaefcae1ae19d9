//! `rins align`: attitude from a rest, and what the sensors say of the place.

use std::fmt::Write as _;
use std::ops::Range;
use std::path::Path;

use anyhow::Context;
use nalgebra::Vector3;
use rins_frames::units::{ARCSEC, DEG, DEG_PER_HOUR, MICRO_G};
use rins_frames::{Body, Dcm, EulerAngles, InFrame, Nav, Rates, SignedAxes};
use rins_inspection::StaticIntervals;
use rins_io::Loaded;
use rins_motion::{
    AlignmentError, FineAlignment, FineAlignmentError, GyroFigures, MeanUncertainty, PlaceSeen,
    RestMean, align_finely, level, place_seen, residual,
};
use serde_json::{Value, json};

use crate::commands::check::refuse_mistaken;
use crate::commands::setup::load;
use crate::commands::statics::{
    longest, none_found, only, static_intervals, statics_in_words, statics_json,
};
use crate::outcome::Outcome;
use crate::view::euler_json;
use crate::view::table::aligned;
use rins_io::shown;
use rins_report::{Cell, Column, Item, Report, Section, Table};

/// The 1σ of an azimuth of which nothing is known \[rad\]: that of a uniform one.
pub(crate) const ANY_AZIMUTH: f64 = 1.813_799_364_234_217_8;

/// A bias of which a rest leaves more than this part of the sigma that was assumed is not shown by it.
const SHOWN: f64 = 0.9;

/// A bias of more than so many sigmas of the data sheet is told.
pub(crate) const BEYOND_THE_SHEET: f64 = 4.0;

/// The shortest rest that is aligned on \[s\].
const SHORTEST_REST: f64 = 5.0;

/// An attitude found from a rest.
#[derive(Debug)]
pub(crate) struct Found {
    /// The body's attitude over the rest.
    pub(crate) nav_from_body: Dcm<Nav, Body>,
    /// The 1σ of the error about east, north and up \[rad\]; no third if north was not found.
    pub(crate) sigma: (f64, f64, Option<f64>),
    /// Why north was not found.
    hidden: Option<AlignmentError>,
    /// The samples of the rest.
    pub(crate) span: Range<usize>,
    pub(crate) start: f64,
    mean: RestMean,
    /// What the filter over the rest found; nothing if north was not found.
    fine: Option<FineAlignment>,
    uncertainty: MeanUncertainty,
    place: PlaceSeen,
    /// Measured less predicted: what a bias would look like.
    pub(crate) residual: Rates,
}

impl Found {
    /// Whether the Earth's rotation showed north.
    pub(crate) const fn north_found(&self) -> bool {
        self.hidden.is_none()
    }

    /// Whether the rest shows each gyro's bias, along the sensors' own axes: what it does not show is what was assumed.
    fn bias_shown(&self, own_axes: &SignedAxes) -> [bool; 3] {
        let Some(fine) = self.fine else { return [true; 3] };
        let sigma = own_axes.undo(&fine.gyro_bias_sigma).abs();
        let assumed = own_axes.undo(&fine.gyro_bias_assumed).abs();
        [0, 1, 2].map(|axis| sigma[axis] < SHOWN * assumed[axis])
    }

    /// The 1σ of the Earth's rate \[rad/s\] and of the latitude \[rad\] that the gyros see.
    fn seen_sigma(&self) -> (f64, f64) {
        let level = self.uncertainty.specific_force / self.place.gravity;
        self.fine.map_or((self.uncertainty.angular_rate, self.place.latitude_sigma), |fine| {
            (fine.earth_rate_sigma, fine.latitude_sigma.hypot(level))
        })
    }
}

/// Aligns on the longest rest of a run.
pub(crate) fn found(loaded: &Loaded) -> anyhow::Result<Found> {
    let span = longest(loaded, SHORTEST_REST).ok_or_else(|| {
        anyhow::anyhow!("{}, so there is nothing to align on", none_found(loaded, SHORTEST_REST))
    })?;
    found_over(loaded, span)
}

/// Aligns on one rest of a run.
pub(crate) fn found_over(loaded: &Loaded, span: Range<usize>) -> anyhow::Result<Found> {
    let recording = &loaded.recording;
    let mean = RestMean::of(recording, span.clone())
        .ok_or_else(|| anyhow::anyhow!("the rest holds no samples"))?;
    let uncertainty = uncertainty(loaded, &mean);
    let figures = loaded.rig.imu.map(|imu| GyroFigures {
        bias_sigma: imu.gyro.bias_sigma,
        noise_density: imu.gyro.noise_density,
    });
    let spinner = indicatif::ProgressBar::new_spinner().with_message("aligning");
    spinner.enable_steady_tick(std::time::Duration::from_millis(100));
    let aligned = align_finely(recording, span.clone(), &loaded.station, figures.as_ref());
    spinner.finish_and_clear();
    // Without a data sheet, what gravity is off by is the least that the tilt may be off by.
    let gravity_error = mean.rates.specific_force.norm() / loaded.station.gravity - 1.0;
    let levelling = (uncertainty.specific_force / loaded.station.gravity).hypot(gravity_error);
    let (nav_from_body, sigma, fine, hidden) = match aligned {
        Ok(fine) => {
            let sigma = fine.covariance.diagonal().map(f64::sqrt);
            // The filter knows of noise, not of what an accelerometer is off by for good.
            let constant = (accel_sigma(loaded) / loaded.station.gravity).hypot(gravity_error);
            let tilt = |sigma: f64| sigma.hypot(constant);
            (fine.nav_from_body, (tilt(sigma.x), tilt(sigma.y), Some(sigma.z)), Some(fine), None)
        }
        Err(FineAlignmentError::Coarse(hidden @ AlignmentError::NorthNotFound { .. })) => {
            let yaw = loaded.rig.attitude.map_or(0.0, |attitude| attitude.angles.yaw);
            (level(&mean.rates, yaw)?, (levelling, levelling, None), None, Some(hidden))
        }
        // What is too short for the Earth's rate to show is not too short for gravity.
        Err(FineAlignmentError::TooShort { .. }) => {
            let hidden = AlignmentError::NorthNotFound { azimuth_sigma: ANY_AZIMUTH };
            let yaw = loaded.rig.attitude.map_or(0.0, |attitude| attitude.angles.yaw);
            (level(&mean.rates, yaw)?, (levelling, levelling, None), None, Some(hidden))
        }
        Err(error) => return Err(error.into()),
    };
    // The filter tells the rate at the start of the rest, so that up must be that of the start too.
    let seen = fine.map_or(mean.rates, |fine| {
        let up = InFrame::new(0.0, 0.0, mean.rates.specific_force.norm());
        let body_from_nav = fine.nav_from_body.inverse();
        Rates { angular_rate: fine.earth_rate_seen, specific_force: body_from_nav * up }
    });
    Ok(Found {
        nav_from_body,
        sigma,
        hidden,
        start: recording.times[span.start] - recording.increments[span.start].interval,
        place: place_seen(&seen, &uncertainty),
        residual: residual(&seen, nav_from_body, &loaded.station),
        fine,
        span,
        mean,
        uncertainty,
    })
}

/// The scatter of the mean, and with it the data sheet's errors where there is one.
fn uncertainty(loaded: &Loaded, mean: &RestMean) -> MeanUncertainty {
    let scatter = |sigma: Vector3<f64>| sigma.norm() / 3.0_f64.sqrt();
    let gyro = loaded.rig.imu.map_or(0.0, |imu| imu.gyro.bias_sigma);
    MeanUncertainty {
        angular_rate: scatter(mean.angular_rate_sigma).hypot(gyro),
        specific_force: scatter(mean.specific_force_sigma).hypot(accel_sigma(loaded)),
    }
}

/// What the data sheet says a specific force of one g may be off by, for good \[m/s²\].
fn accel_sigma(loaded: &Loaded) -> f64 {
    loaded.rig.imu.map_or(0.0, |imu| {
        let shape = imu.accel.scale_sigma.max(imu.accel.misalignment_sigma);
        imu.accel.bias_sigma.hypot(shape * loaded.station.gravity)
    })
}

/// The axes of a run among the sensors' own.
fn own_axes(loaded: &Loaded) -> SignedAxes {
    SignedAxes::from(loaded.rig.spin)
}

pub(crate) fn run(rig: &Path) -> anyhow::Result<Outcome> {
    let loaded = load(rig)?;
    refuse_mistaken(&loaded)?;
    let found = found(&loaded).with_context(|| shown(&loaded.rig.log.path))?;
    let rows = rows(&found, &loaded);
    let title = format!("Alignment of {}", shown(rig));
    let statics = static_intervals(&loaded);
    let mut sentences = sentences(&found, &loaded);
    sentences.extend(statics_in_words(&statics, &loaded.rig));
    let mut text = format!("{title}\n");
    for sentence in &sentences {
        let _ = writeln!(text, "  {sentence}");
    }
    text.push('\n');
    text.push_str(&aligned(&rows));
    let report = Report {
        title,
        subtitle: format!("rins align: {}", shown(&loaded.rig.log.path)),
        summary: sentences,
        sections: vec![Section {
            heading: "What was found".into(),
            intro: String::new(),
            items: vec![Item::Table(table(&rows))],
        }],
    };
    Ok(Outcome {
        json: json(&found, &loaded, rig, &statics),
        text,
        report: Some(report),
        ..Outcome::default()
    }
    .of_log(&loaded))
}

/// The rows of the result as a table of the report.
pub(crate) fn table(rows: &[Vec<String>]) -> Table {
    let mut rows = rows.iter();
    let head = rows.next().cloned().unwrap_or_default();
    let last = head.len().saturating_sub(1);
    let columns = head.into_iter().enumerate().map(|(place, name)| {
        if place == 0 || place == last { Column::text(name) } else { Column::number(name) }
    });
    Table {
        caption: String::new(),
        columns: columns.collect(),
        rows: rows.map(|row| row.iter().map(Cell::text).collect()).collect(),
    }
}

fn sentences(found: &Found, loaded: &Loaded) -> Vec<String> {
    let angles = found.nav_from_body.euler_angles();
    let from = found.start;
    let to = loaded.recording.times[found.span.end - 1];
    let mut sentences = vec![match found.sigma.2 {
        Some(azimuth) => format!(
            "Over {:.0} s of rest the body stands at roll {:.4}, pitch {:.4}, yaw {:.3} deg, level to {:.1}″ and in azimuth to \
             {:.0}″ (1σ).",
            to - from,
            angles.roll / DEG,
            angles.pitch / DEG,
            angles.yaw / DEG,
            found.sigma.0.max(found.sigma.1) / ARCSEC,
            azimuth / ARCSEC,
        ),
        None => format!(
            "Over {:.0} s of rest the body stands at roll {:.3}, pitch {:.3} deg; the gyros do not show north.",
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
            if off > BEYOND_THE_SHEET * sheet {
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

fn rows(found: &Found, loaded: &Loaded) -> Vec<Vec<String>> {
    let row = |name: &str, value: String, sigma: String, note: String| {
        vec![name.to_owned(), value, sigma, note]
    };
    let angles = found.nav_from_body.euler_angles();
    let header = loaded.psins_header.map(|header| header.attitude);
    let given = loaded.rig.attitude.map(|attitude| attitude.angles);
    let against = |of: fn(&EulerAngles) -> f64| match (header, given) {
        (Some(header), _) => format!("the log's header says {:.4} deg", of(&header) / DEG),
        (None, Some(given)) => {
            format!("the rig says {:.4} deg (of the axis frame)", of(&given) / DEG)
        }
        (None, None) => String::new(),
    };
    let degrees = |angle: f64| format!("{:.5} deg", angle / DEG);
    let site = &loaded.station.site;
    let earth_rate = site.earth_rate().norm();
    let place = &found.place;
    let (rate_sigma, latitude_sigma) = found.seen_sigma();
    let mut rows = vec![
        ["quantity", "found", "1 sigma", "to compare with"].map(String::from).to_vec(),
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
        format!("the station has {:.5} m/s^2", loaded.station.gravity),
    ));
    rows.push(row(
        "apparent Earth rate",
        format!("{:.4} deg/h", place.earth_rate / DEG_PER_HOUR),
        format!("{:.4} deg/h", rate_sigma / DEG_PER_HOUR),
        format!("the Earth turns at {:.4} deg/h", earth_rate / DEG_PER_HOUR),
    ));
    if found.hidden.is_none() {
        rows.push(row(
            "apparent latitude",
            degrees(place.latitude),
            degrees(latitude_sigma),
            format!("the station lies at {:.5} deg", site.latitude / DEG),
        ));
    }
    if !found.north_found() {
        // Without north what is left of the rates is no bias.
        return rows;
    }
    let shown = found.bias_shown(&own_axes(loaded));
    let bias_sigma = found.fine.map_or(found.mean.angular_rate_sigma, |fine| fine.gyro_bias_sigma);
    // Biases are the sensors', along their own axes.
    let own_axes = own_axes(loaded);
    let bias = own_axes.undo(found.residual.angular_rate.components());
    let bias_sigma = own_axes.undo(&Vector3::from(bias_sigma)).abs();
    for (axis, name) in ["gyro bias x", "gyro bias y", "gyro bias z"].into_iter().enumerate() {
        let value = if shown[axis] {
            format!("{:.4} deg/h", bias[axis] / DEG_PER_HOUR)
        } else {
            "not shown".into()
        };
        let note = if shown[axis] {
            "less what lies along east, which the azimuth holds"
        } else {
            "assumed: along east it is azimuth"
        };
        let sigma = format!("{:.4} deg/h", bias_sigma[axis] / DEG_PER_HOUR);
        rows.push(row(name, value, sigma, note.into()));
    }
    rows
}

fn json(found: &Found, loaded: &Loaded, rig: &Path, statics: &StaticIntervals) -> Value {
    let angles = found.nav_from_body.euler_angles();
    let (east, north, up) = found.sigma;
    let place = &found.place;
    let (rate_sigma, latitude_sigma) = found.seen_sigma();
    let own_axes = own_axes(loaded);
    let bias = own_axes.undo(found.residual.angular_rate.components()) / DEG_PER_HOUR;
    let bias_sigma =
        found.fine.map(|fine| own_axes.undo(&fine.gyro_bias_sigma).abs() / DEG_PER_HOUR);
    let accel = own_axes.undo(found.residual.specific_force.components()) / MICRO_G;
    let site = &loaded.station.site;
    json!({
        "schema": 1,
        "command": "align",
        "rig": shown(rig),
        "rest_s": [found.start, loaded.recording.times[found.span.end - 1]],
        "static_intervals": statics_json(statics, only(&found.span)),
        "attitude_deg": {
            "roll": angles.roll / DEG,
            "pitch": angles.pitch / DEG,
            "yaw": up.map(|_| angles.yaw / DEG),
        },
        "sigma_deg": {"east": east / DEG, "north": north / DEG, "up": up.map(|up| up / DEG)},
        "seen": {
            "gravity_m_s2": place.gravity,
            "earth_rate_deg_h": place.earth_rate / DEG_PER_HOUR,
            "latitude_deg": up.map(|_| place.latitude / DEG),
            "latitude_sigma_deg": up.map(|_| latitude_sigma / DEG),
            "earth_rate_sigma_deg_h": rate_sigma / DEG_PER_HOUR,
        },
        "expected": {
            "gravity_m_s2": loaded.station.gravity,
            "earth_rate_deg_h": site.earth_rate().norm() / DEG_PER_HOUR,
            "latitude_deg": site.latitude / DEG,
        },
        "gyro_bias_found_deg_h": up.map(|_| bias.as_slice()),
        "gyro_bias_sigma_deg_h": bias_sigma.as_ref().map(Vector3::as_slice),
        "gyro_bias_shown": bias_sigma.map(|_| found.bias_shown(&own_axes)),
        "accel_bias_found_ug": accel.as_slice(),
        "header_attitude_deg": loaded.psins_header.map(|header| euler_json(&header.attitude)),
    })
}
