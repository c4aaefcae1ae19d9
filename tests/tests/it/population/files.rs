//! The log of a run and its rig file.

use std::fmt::Write as _;
use std::fs;
use std::path::Path;

use nalgebra::Vector3;

use super::imu::{ARCSEC, DEG, DEG_H, MICRO_G, PPM, Triad};
use super::motion::Site;
use super::random::Random;
use super::schedule::Profile;

/// A selection of axes with signs: axis `i` of the target is `sign[i]` times axis `source[i]` of the source.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) struct Axes {
    pub(crate) source: [usize; 3],
    pub(crate) sign: [f64; 3],
}

const NAMES: [&str; 3] = ["x", "y", "z"];

impl Axes {
    pub(crate) const SAME: Self = Self { source: [0, 1, 2], sign: [1.0; 3] };

    /// Any of the 48.
    pub(crate) fn draw(random: &mut Random) -> Self {
        let first = random.below(3);
        let step = 1 + random.below(2);
        let source = [first, (first + step) % 3, (first + 2 * step) % 3];
        Self { source, sign: [(); 3].map(|()| if random.chance(0.5) { 1.0 } else { -1.0 }) }
    }

    /// From the IMU to a table about axis `axis` of the IMU, reversed if `sign` is negative.
    pub(crate) fn spin(axis: usize, sign: f64) -> Self {
        Self { source: [(axis + 1) % 3, (axis + 2) % 3, axis], sign: [1.0, sign, sign] }
    }

    /// From the target back to the source.
    pub(crate) fn back(&self, vector: &Vector3<f64>) -> Vector3<f64> {
        let mut source = Vector3::zeros();
        for axis in 0..3 {
            source[self.source[axis]] = self.sign[axis] * vector[axis];
        }
        source
    }

    pub(crate) fn name(&self, axis: usize) -> String {
        let sign = if self.sign[axis] < 0.0 { "-" } else { "" };
        format!("{sign}{}", NAMES[self.source[axis]])
    }
}

/// The description of the table in a rig file.
#[derive(Clone, Debug)]
pub(crate) enum Reference {
    None,
    /// An encoder with this noise \[rad\].
    Encoder(f64),
    /// The commanded profile.
    Commanded(Profile),
}

/// What a rig file states beside the data sheets.
#[derive(Clone, Debug)]
pub(crate) struct Description {
    pub(crate) site: Site,
    pub(crate) reference: Reference,
    /// The standard deviation of the attitude \[rad\], if it is stated.
    pub(crate) attitude: Option<f64>,
    pub(crate) spin: Axes,
    /// From the columns of the log to the axes of the IMU.
    pub(crate) columns: [Axes; 2],
}

/// Readings in the axes of the IMU, and the angle at the ends of samples.
#[derive(Debug)]
pub(crate) struct Readings {
    pub(crate) interval: f64,
    pub(crate) gyro: Vec<Vector3<f64>>,
    pub(crate) accel: Vec<Vector3<f64>>,
    pub(crate) angle: Vec<f64>,
}

/// Writes NAME.csv and NAME.toml.
pub(crate) fn write(
    folder: &Path,
    name: &str,
    description: &Description,
    triads: [&Triad; 2],
    readings: &Readings,
) {
    let mut log = String::from("t,gx,gy,gz,ax,ay,az,table\n");
    let [gyros, accels] = &description.columns;
    for (sample, (gyro, accel)) in readings.gyro.iter().zip(&readings.accel).enumerate() {
        let time = (sample + 1) as f64 * readings.interval;
        let (gyro, accel) = (gyros.back(gyro) / DEG, accels.back(accel));
        write!(log, "{time:.6}").expect("a string grows");
        for value in gyro.iter().chain(&accel) {
            write!(log, ",{value:.10e}").expect("a string grows");
        }
        writeln!(log, ",{:.9}", readings.angle[sample] / DEG).expect("a string grows");
    }
    fs::write(folder.join(format!("{name}.csv")), log).expect("the folder is writable");
    let rig = rig(name, description, triads);
    fs::write(folder.join(format!("{name}.toml")), rig).expect("the folder is writable");
}

fn rig(name: &str, description: &Description, [gyro, accel]: [&Triad; 2]) -> String {
    let site = &description.site;
    let axes = description.columns.map(|axes| {
        let [x, y, z] = [0, 1, 2].map(|axis| axes.name(axis));
        format!("[\"{x}\", \"{y}\", \"{z}\"]")
    });
    let mut text = format!(
        "[site]\nlatitude = \"{:.9} deg\"\nlongitude = \"11 deg\"\nheight = \"{:.3} m\"\n\n\
         [log]\npath = \"{name}.csv\"\ntime = {{ column = \"t\", unit = \"s\" }}\n\
         gyro = {{ columns = [\"gx\", \"gy\", \"gz\"], unit = \"deg/s\", axes = {} }}\n\
         accel = {{ columns = [\"ax\", \"ay\", \"az\"], unit = \"m/s^2\", axes = {} }}\n",
        site.latitude / DEG,
        site.height,
        axes[0],
        axes[1],
    );
    text.push_str(&table(&description.reference));
    if description.spin != Axes::SAME {
        let _ = writeln!(text, "\n[axis]\nspin = \"{}\"", description.spin.name(2));
    }
    if let Some(sigma) = description.attitude {
        let sigma = sigma / DEG;
        let zero = "\"0 deg\"";
        let _ = write!(
            text,
            "\n[attitude]\nroll = {zero}\npitch = {zero}\nyaw = {zero}\nsigma = \"{sigma} deg\"\n"
        );
    }
    text.push_str(&sheet("gyro", gyro, ["deg/h", "deg/h", "deg/s"], [DEG_H, DEG]));
    text.push_str(&sheet("accel", accel, ["ug", "ug", "m/s^2"], [MICRO_G, 1.0]));
    text
}

/// The last line of `[log]`, or `[table]`.
fn table(reference: &Reference) -> String {
    match reference {
        Reference::None => String::new(),
        Reference::Encoder(noise) => {
            let noise = noise / ARCSEC;
            format!(
                "table_angle = {{ column = \"table\", unit = \"deg\", noise = \"{noise:.4} arcsec\" }}\n"
            )
        }
        Reference::Commanded(profile) => {
            let acceleration = profile.acceleration / DEG;
            let mut text =
                format!("\n[table]\nacceleration = \"{acceleration} deg/s^2\"\nprofile = [\n");
            for [rate, duration] in &profile.rates {
                let rate = rate / DEG;
                let _ = writeln!(
                    text,
                    "    {{ rate = \"{rate} deg/s\", duration = \"{duration} s\" }},"
                );
            }
            text + "]\n"
        }
    }
}

fn sheet(name: &str, triad: &Triad, units: [&str; 3], [unit, reading]: [f64; 2]) -> String {
    let sheet = &triad.sheet;
    let mut text = format!(
        "\n[imu.{name}]\nnoise = \"{:.6} {}/sqrt(Hz)\"\nbias_sigma = \"{:.6} {}\"\n\
         scale_sigma = \"{:.4} ppm\"\nmisalignment_sigma = \"{:.4} arcsec\"\n",
        sheet.noise / unit,
        units[0],
        sheet.bias / unit,
        units[1],
        sheet.scale / PPM,
        sheet.misalignment / ARCSEC,
    );
    if let Some(instability) = sheet.instability {
        let value = instability / unit;
        let _ = writeln!(text, "bias_instability = \"{value:.6} {}\"", units[1]);
    }
    if let Some(walk) = sheet.walk {
        let _ = writeln!(text, "random_walk = \"{:.6} {}/sqrt(h)\"", walk * 60.0 / unit, units[1]);
    }
    if let Some(lsb) = sheet.lsb {
        let _ = writeln!(text, "resolution = \"{:.9} {}\"", lsb / reading, units[2]);
    }
    text
}
