//! The folder that a laboratory delivers: a log and its rig file, without the truth.

use std::f64::consts::PI;
use std::fmt::Write as _;
use std::fs;
use std::io;
use std::path::Path;

use crate::experiment::{Known, SensorsKnown};
use crate::run::Log;

const DEGREE: f64 = PI / 180.0;
const ARCSECOND: f64 = DEGREE / 3600.0;
const DEGREE_PER_HOUR: f64 = DEGREE / 3600.0;
const MICRO_G: f64 = 9.80665e-6;

/// Writes `run.csv` and `rig.toml` into `folder`, which exists.
///
/// # Errors
/// If they cannot be written.
pub fn write(folder: &Path, log: &Log, known: &Known, interval: f64) -> io::Result<()> {
    fs::write(folder.join("run.csv"), csv(log))?;
    fs::write(folder.join("rig.toml"), rig(known, interval))
}

fn csv(log: &Log) -> String {
    let mut text = String::from("t,gx,gy,gz,ax,ay,az,table,temp\n");
    for sample in 0..log.times.len() {
        let (g, a) = (log.gyro[sample], log.accel[sample]);
        // Writing to a string cannot fail.
        let _ = writeln!(
            text,
            "{:.4},{:.9e},{:.9e},{:.9e},{:.9e},{:.9e},{:.9e},{:.10},{:.3}",
            log.times[sample],
            g.x,
            g.y,
            g.z,
            a.x,
            a.y,
            a.z,
            log.angles[sample],
            log.temperature[sample]
        );
    }
    text
}

fn rig(known: &Known, interval: f64) -> String {
    let [roll, pitch, yaw] = known.attitude.map(|angle| angle / DEGREE);
    let mut text = format!(
        r#"[site]
latitude = "{latitude:.9} deg"
longitude = "0 deg"
height = "0 m"
gravity = "{gravity:.9} m/s^2"

[log]
path = "run.csv"
rate = "{rate} Hz"
time = {{ column = "t", unit = "s" }}
gyro = {{ columns = ["gx", "gy", "gz"], unit = "rad/s" }}
accel = {{ columns = ["ax", "ay", "az"], unit = "m/s^2" }}
table_angle = {{ column = "table", unit = "rad", noise = "{encoder:.4} arcsec" }}
temperature = {{ column = "temp", unit = "degC" }}

[attitude]
roll = "{roll:.9} deg"
pitch = "{pitch:.9} deg"
yaw = "{yaw:.9} deg"
sigma = "{sigma:.4} deg"
"#,
        latitude = known.place.latitude / DEGREE,
        gravity = known.place.gravity,
        rate = (1.0 / interval).round(),
        encoder = known.encoder_noise / ARCSECOND,
        sigma = known.attitude_sigma / DEGREE,
    );
    if let Some(wobble) = known.wobble {
        let _ = write!(text, "\n[table]\nwobble = \"{:.5} arcsec\"\n", wobble / ARCSECOND);
    }
    text.push_str(&sheet("gyro", &known.gyro, "deg/h", DEGREE_PER_HOUR));
    text.push_str(&sheet("accel", &known.accel, "ug", MICRO_G));
    text
}

fn sheet(name: &str, of: &SensorsKnown, unit: &str, factor: f64) -> String {
    format!(
        r#"
[imu.{name}]
noise = "{noise:.6} {unit}/sqrt(Hz)"
bias_sigma = "{bias:.6} {unit}"
scale_sigma = "{scale:.4} ppm"
misalignment_sigma = "{misalignment:.4} arcsec"
"#,
        noise = of.noise / factor,
        bias = of.bias / factor,
        scale = of.scale / 1e-6,
        misalignment = of.misalignment / ARCSECOND,
    )
}
