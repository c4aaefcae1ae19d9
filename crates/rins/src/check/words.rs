//! Suspicions as sentences.

use std::f64::consts::FRAC_PI_2;

use rins_frames::units::{DEG, DEG_PER_HOUR};
use rins_frames::{EARTH_RATE, SignedAxes};
use rins_inspection::{Correction, Suspicion};

/// The maximum number of listed corrections with the same effect.
pub(super) const TOLD: usize = 4;

const AXES: [&str; 3] = ["x", "y", "z"];

/// A suspicion as a sentence.
pub(crate) fn suspicion_in_words(suspicion: &Suspicion) -> String {
    let because = |cause: &Option<String>| {
        cause.as_ref().map_or_else(
            || "no single unit mistake explains it; check units, scale and axes".to_owned(),
            |cause| format!("that is as if {cause}"),
        )
    };
    let seen = match suspicion {
        Suspicion::Gravity { seen, expected, cause } => format!(
            "the specific force is {seen:.5} m/s^2 where gravity is {expected:.5}: {}",
            because(cause)
        ),
        Suspicion::SpinScale { ratio, cause } => {
            format!(
                "the gyro about the axis of rotation measures {ratio:.5} of the table's rotation: {}",
                because(cause)
            )
        }
        Suspicion::Triads { gyro, accel } => format!(
            "an accelerometer follows the table's rate (correlation {accel:.3}) and no gyro does ({gyro:.3} at most): \
             the columns of gyro and accel are exchanged"
        ),
        Suspicion::TurningTriads { gyro, accel } => format!(
            "while the table turns, {:.0} % of what the gyros show stands across its axis and {:.1} % of what the \
             accelerometers show, as if that were gravity: the columns of gyro and accel are exchanged",
            gyro * 100.0,
            accel * 100.0
        ),
        Suspicion::SpinAxis { channel, ratio } => format!(
            "{channel} measures {ratio:.4} of the table's rotation and the gyro about [axis] spin does not: the axes are exchanged; set `axes` \
             under [log] gyro, or [axis] spin"
        ),
        Suspicion::SpinProfile { apart, time } => format!(
            "the rotation by the gyro about the axis of rotation and that of the table differ by {:.2} deg within the ten seconds before {time:.1} s: the \
             table moved differently, or at another time, than stated; check the profile's start, its acceleration, or \
             the encoder",
            apart / DEG
        ),
        Suspicion::StuckChannel { channel } => {
            format!("{channel} repeats one reading throughout: not connected?")
        }
        Suspicion::Sticks { channel, rows, count, time } => format!(
            "{channel} sticks: it repeats one reading for long in {rows} row(s) of samples, the longest of {count} from \
             {time:.3} s on: take the lines out of the log"
        ),
        Suspicion::Spike { channel, count, time, reading } => format!(
            "{channel} has {count} spike(s) of a single sample, the largest at {time:.3} s with {}: take the lines out \
             of the log",
            reading_in_words(channel, *reading)
        ),
        Suspicion::Saturated { channel, count, time, range } => format!(
            "{channel} reads as much as it can or more, {} by its data sheet, {count} time(s), first at {time:.3} s: it \
             is saturated, or the unit or the range is wrong",
            reading_in_words(channel, *range)
        ),
        Suspicion::FlatTop { channel, count, time, reading } => format!(
            "{channel} repeats its extreme reading of {} {count} times in a row from {time:.3} s: it is saturated, or \
             not connected then",
            reading_in_words(channel, *reading)
        ),
        Suspicion::Level { off, limit, .. } => format!(
            "the specific force is {:.2} deg off the vertical that [attitude] and the table's angle have, where \
             {:.2} deg is the most to expect",
            off / DEG,
            limit / DEG
        ),
        Suspicion::EarthRate { off, limit, .. } => format!(
            "the mean rate is {:.2} deg/h off the Earth's by [attitude], [site] and the table's angle, where \
             {:.2} deg/h is the most to expect",
            off / DEG_PER_HOUR,
            limit / DEG_PER_HOUR
        ),
        Suspicion::Latitude { seen, expected, .. } => format!(
            "the static Earth rate and gravity are those of latitude {:.2} deg where [site] has {:.2} deg (a gyro bias of \
             {:.2} deg/h or more would explain it too)",
            seen / DEG,
            expected / DEG,
            EARTH_RATE * (seen - expected).abs().min(FRAC_PI_2).sin() / DEG_PER_HOUR
        ),
        Suspicion::Handedness { ratio, correlation, .. } => format!(
            "turning moves the specific force in the body by {ratio:.2} of what the gyros say (correlation \
             {correlation:.2}) where 1.00 is right"
        ),
        other => format!("{other:?}"),
    };
    let by_direction = matches!(
        suspicion,
        Suspicion::Level { .. }
            | Suspicion::EarthRate { .. }
            | Suspicion::Latitude { .. }
            | Suspicion::Handedness { .. }
    );
    if by_direction { format!("{seen}: {}", corrections(suspicion.corrections())) } else { seen }
}

fn reading_in_words(channel: &str, reading: f64) -> String {
    if channel.starts_with("gyro") {
        format!("{:.6} deg/s", reading / DEG)
    } else {
        format!("{reading:.6} m/s^2")
    }
}

/// The possible corrections, the most likely first.
fn corrections(corrections: &[Correction]) -> String {
    let mut words: Vec<String> = corrections.iter().take(TOLD).map(correction_in_words).collect();
    if corrections.len() > TOLD {
        words.push(format!("{} more explain it as well", corrections.len() - TOLD));
    }
    match corrections.len() {
        0 => "no single sign or exchange of axes explains it; check `axes`, [attitude] and [site]"
            .into(),
        1 => format!("that is as if {}", words[0]),
        _ => format!("that is as if {}; this log does not distinguish them", words.join(", or ")),
    }
}

fn correction_in_words(correction: &Correction) -> String {
    match correction {
        Correction::Gyro(axes) => axes_in_words(&["gyro"], axes),
        Correction::Accel(axes) => axes_in_words(&["accel"], axes),
        Correction::Imu(axes) => axes_in_words(&["gyro", "accel"], axes),
        Correction::RollAndPitch => "roll and pitch were exchanged in [attitude]".into(),
        Correction::RollSign => "the sign of [attitude] roll were wrong".into(),
        Correction::PitchSign => "the sign of [attitude] pitch were wrong".into(),
        Correction::YawSign => "the sign of [attitude] yaw were wrong".into(),
        Correction::LatitudeSign => "the sign of [site] latitude were wrong".into(),
        Correction::TableSense => "the table's angle were counted the other way".into(),
        Correction::GyroAndTableSense(axes) => format!(
            "the table's angle were counted the other way and {}",
            axes_in_words(&["gyro"], axes)
        ),
        other => format!("{other:?}"),
    }
}

fn axes_in_words(triads: &[&str], axes: &SignedAxes) -> String {
    let list = |chosen: &dyn Fn(usize) -> bool| {
        let named = |triad: &&str| {
            (0..3)
                .filter(|&axis| chosen(axis))
                .map(|axis| format!("{triad}.{}", AXES[axis]))
                .collect()
        };
        let channels: Vec<String> =
            triads.iter().flat_map(|triad| -> Vec<String> { named(triad) }).collect();
        channels.join(" and ")
    };
    let moved = |axis: usize| axes.source[axis] != axis;
    match (axes.kept(), axes.flips()) {
        (3, _) => format!("{} had the wrong sign", list(&|axis| axes.sign[axis] < 0.0)),
        (1, 0) => format!("{} were exchanged", list(&moved)),
        _ => {
            let sensor: Vec<String> = (0..3)
                .map(|axis| {
                    let sign = if axes.sign[axis] < 0.0 { "-" } else { "" };
                    format!("{sign}{}", AXES[axes.source[axis]])
                })
                .collect();
            format!(
                "what is read as {} x, y, z had to be taken as ({})",
                triads.join(" and "),
                sensor.join(", ")
            )
        }
    }
}
