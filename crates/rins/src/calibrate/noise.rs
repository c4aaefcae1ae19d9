//! How strong the noise was found to be, and how the estimate went.

use rins_estimation::Reference;
use rins_frames::units::{ARCSEC, DEG_PER_HOUR, MICRO_G};

use super::certificate::Certificate;
use crate::options::NoiseChoice;
use rins_report::number::figure;
use rins_report::{Cell, Column, Item, Section, Table};

/// The noise in a sentence.
pub(super) fn noise_sentence(certificate: &Certificate) -> String {
    let imu = certificate.fit.noise[0].imu;
    let how = match certificate.noise {
        NoiseChoice::Likely => "Estimated noise",
        NoiseChoice::Given => "Noise of the data sheet",
    };
    let triad = |white: f64, flicker: f64, unit: f64, white_unit: &str, flicker_unit: &str| {
        format!(
            "white noise {} {white_unit} and bias instability {} {flicker_unit}",
            figure(white / unit, 4),
            figure(flicker / unit, 4)
        )
    };
    let base = &certificate.fit.noise[0];
    let sways = if base.sway.iter().any(|sway| *sway > 0.0) {
        let about = base.sway.map(|sway| figure(sway / ARCSEC, 3));
        format!(
            "; base motion: velocity {} mm/s, sway {} arcsec/√s about x, y and z",
            figure(base.velocity * 1e3, 3),
            about.join(", ")
        )
    } else {
        String::new()
    };
    format!(
        "{how}: gyros: {}; accelerometers: {}{sways}.",
        triad(imu.gyro.white, imu.gyro.flicker, DEG_PER_HOUR, "deg/h/√Hz", "deg/h"),
        triad(imu.accel.white, imu.accel.flicker, MICRO_G, "µg/√Hz", "µg")
    )
}

/// Strengths as rows of a table: what was used, and what was given.
fn strengths(certificate: &Certificate) -> Vec<Vec<Cell>> {
    let imu = certificate.fit.noise[0].imu;
    let sheet = &certificate.runs[0].prepared.imu;
    let row = |name: String, found: f64, given: Option<f64>, factor: f64, unit: &str| {
        // What is neither stated nor found is not in the noise model.
        (found > 0.0 || given.is_some()).then(|| {
            vec![
                Cell::text(name),
                Cell::text(figure(found / factor, 3)),
                Cell::text(given.map_or_else(|| "–".into(), |given| figure(given / factor, 3))),
                Cell::text(unit),
            ]
        })
    };
    let mut rows = Vec::new();
    let triads = [
        ("gyro", imu.gyro, &sheet.gyro, DEG_PER_HOUR, "deg/h"),
        ("accelerometer", imu.accel, &sheet.accel, MICRO_G, "µg"),
    ];
    for (name, found, spec, factor, unit) in triads {
        let given = Some(spec.noise_density);
        rows.extend(row(
            format!("{name}, white"),
            found.white,
            given,
            factor,
            &format!("{unit}/√Hz"),
        ));
        rows.extend(row(
            format!("{name}, bias instability"),
            found.flicker,
            spec.bias_instability,
            factor,
            unit,
        ));
        let walk_unit = format!("{unit}/√h");
        rows.extend(row(
            format!("{name}, random walk"),
            found.walk,
            spec.random_walk,
            factor / 60.0,
            &walk_unit,
        ));
    }
    for (run, noise) in certificate.runs.iter().zip(&certificate.fit.noise) {
        let rig = &run.prepared.run.rig;
        let name = |what: &str| format!("{what}, {}", run.prepared.name);
        rows.extend(row(
            name("axis direction noise, 1σ per epoch"),
            noise.wobble,
            Some(rig.wobble),
            ARCSEC,
            "arcsec",
        ));
        if let Reference::Encoder { noise: given } = rig.reference {
            rows.extend(row(
                name("encoder noise, 1σ per reading"),
                noise.encoder,
                Some(given),
                ARCSEC,
                "arcsec",
            ));
        }
        if noise.imu.jitter > 0.0 {
            let moments = name("time jitter of the encoder readings, 1σ");
            rows.extend(row(moments, noise.imu.jitter, None, 1e-6, "µs"));
        }
        let velocity = name("base velocity noise, 1σ");
        rows.extend(row(velocity, noise.velocity, Some(rig.velocity), 1e-3, "mm/s"));
        for (axis, sway) in ["x", "y", "z"].into_iter().zip(noise.sway) {
            if sway > 0.0 {
                let sways = name(&format!("base attitude random walk about {axis}"));
                rows.extend(row(sways, sway, None, ARCSEC, "arcsec/√s"));
            }
        }
    }
    rows
}

/// The noise and the steps of the iteration.
pub(super) fn noise_section(certificate: &Certificate) -> Section {
    let iterations = certificate.fit.iterations.iter().enumerate().map(|(place, iteration)| {
        vec![
            Cell::text((place + 1).to_string()),
            Cell::text(figure(iteration.step, 4)),
            Cell::Number { value: iteration.log_likelihood, decimals: 2 },
        ]
    });
    let intro = match certificate.noise {
        NoiseChoice::Likely => {
            "Restricted maximum likelihood estimates of the noise parameters. The initial values are those of the rig file."
        }
        NoiseChoice::Given => "The noise parameters of the data sheet.",
    };
    Section {
        heading: "Noise and iteration".into(),
        intro: intro.into(),
        items: vec![
            Item::Table(Table {
                caption: "Noise parameters".into(),
                columns: vec![
                    Column::text("noise"),
                    Column::number("estimate"),
                    Column::number("initial value"),
                    Column::text("unit"),
                ],
                rows: strengths(certificate),
            }),
            Item::Table(Table {
                caption: "Iterations".into(),
                columns: vec![
                    Column::number("iteration"),
                    Column::number("largest change [σ]"),
                    Column::number("log-likelihood [nats]"),
                ],
                rows: iterations.collect(),
            }),
        ],
    }
}
