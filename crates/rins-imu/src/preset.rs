//! Data sheets of common sensors and of grades of IMUs, for users who have none.

use rins_frames::units::{
    DEG, DEG_PER_HOUR, DEG_PER_ROOT_HOUR, DEG_PER_SECOND, MICRO_G, MILLI_G, PPM,
};

use crate::spec::{ImuSpec, TriadSpec};

/// A data sheet with a name.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Preset {
    /// Its name, such as `mems-consumer` or `MPU-9250`.
    pub name: &'static str,
    /// The values. Limits of a data sheet (±) are taken as 1σ.
    pub imu: ImuSpec,
    /// The source of the values.
    pub source: &'static str,
}

const PERCENT: f64 = 0.01;
const MILLIRADIAN: f64 = 1e-3;

/// The grades of IMUs, from the widest data sheet to the narrowest.
///
/// They are meant to be wide: an estimate takes little from a wide prior, and is wrong with a narrow one.
pub static GRADES: [Preset; 4] = [
    Preset {
        name: "mems-consumer",
        imu: ImuSpec {
            gyro: TriadSpec::white(0.01 * DEG_PER_SECOND, 5.0 * DEG_PER_SECOND, 3.0 * PERCENT, DEG),
            accel: TriadSpec::white(300.0 * MICRO_G, 60.0 * MILLI_G, 3.0 * PERCENT, DEG),
        },
        source: "the limits of uncalibrated sensors of phones and hobby boards, such as the MPU-9250",
    },
    Preset {
        name: "mems-tactical",
        imu: ImuSpec {
            gyro: TriadSpec::white(
                0.2 * DEG_PER_ROOT_HOUR,
                250.0 * DEG_PER_HOUR,
                1000.0 * PPM,
                MILLIRADIAN,
            ),
            accel: TriadSpec::white(120.0 * MICRO_G, 5.0 * MILLI_G, 1000.0 * PPM, MILLIRADIAN),
        },
        source: "calibrated MEMS IMUs, such as the STIM300",
    },
    Preset {
        name: "fog",
        imu: ImuSpec {
            gyro: TriadSpec::white(
                0.02 * DEG_PER_ROOT_HOUR,
                2.0 * DEG_PER_HOUR,
                500.0 * PPM,
                MILLIRADIAN,
            ),
            accel: TriadSpec::white(50.0 * MICRO_G, 2.0 * MILLI_G, 500.0 * PPM, MILLIRADIAN),
        },
        source: "fiber-optic gyros and quartz accelerometers of tactical and short-term navigation grade",
    },
    Preset {
        name: "rlg",
        imu: ImuSpec {
            gyro: TriadSpec::white(
                0.005 * DEG_PER_ROOT_HOUR,
                0.05 * DEG_PER_HOUR,
                50.0 * PPM,
                0.3 * MILLIRADIAN,
            ),
            accel: TriadSpec::white(20.0 * MICRO_G, 0.3 * MILLI_G, 300.0 * PPM, 0.3 * MILLIRADIAN),
        },
        source: "ring laser gyros and quartz accelerometers of navigation grade",
    },
];

/// Sensors with a published data sheet.
pub static SENSORS: [Preset; 3] = [
    Preset {
        name: "MPU-6050",
        imu: ImuSpec {
            gyro: TriadSpec::white(
                0.005 * DEG_PER_SECOND,
                20.0 * DEG_PER_SECOND,
                3.0 * PERCENT,
                2.0 * PERCENT,
            ),
            accel: TriadSpec::white(400.0 * MICRO_G, 80.0 * MILLI_G, 3.0 * PERCENT, 2.0 * PERCENT),
        },
        source: "InvenSense PS-MPU-6000A-00, revision 3.4, sections 6.1 and 6.2",
    },
    Preset {
        name: "MPU-9250",
        imu: ImuSpec {
            gyro: TriadSpec::white(
                0.01 * DEG_PER_SECOND,
                5.0 * DEG_PER_SECOND,
                3.0 * PERCENT,
                2.0 * PERCENT,
            ),
            accel: TriadSpec::white(300.0 * MICRO_G, 80.0 * MILLI_G, 3.0 * PERCENT, 2.0 * PERCENT),
        },
        source: "InvenSense PS-MPU-9250A-01, revision 1.0, sections 3.1 and 3.2",
    },
    Preset {
        name: "STIM300",
        imu: ImuSpec {
            gyro: TriadSpec::white(
                0.15 * DEG_PER_ROOT_HOUR,
                250.0 * DEG_PER_HOUR,
                500.0 * PPM,
                MILLIRADIAN,
            ),
            accel: TriadSpec::white(
                // 0.06 m/s/√h.
                1e-3,
                2.0 * MILLI_G,
                300.0 * PPM,
                MILLIRADIAN,
            ),
        },
        source: "Sensonor TS1524, with accelerometers of 10 g",
    },
];

impl Preset {
    /// The grade or sensor of this name, in upper or lower case.
    ///
    /// ```
    /// let fog = rins_imu::Preset::named("FOG").expect("a grade");
    /// assert!(fog.imu.gyro.bias_sigma < rins_imu::GRADES[0].imu.gyro.bias_sigma);
    /// assert_eq!(rins_imu::Preset::named("gyrocompass"), None);
    /// ```
    pub fn named(name: &str) -> Option<&'static Self> {
        GRADES.iter().chain(&SENSORS).find(|preset| preset.name.eq_ignore_ascii_case(name))
    }

    /// The names of all.
    pub fn names() -> impl Iterator<Item = &'static str> {
        GRADES.iter().chain(&SENSORS).map(|preset| preset.name)
    }
}

#[cfg(test)]
mod tests {
    use super::{GRADES, Preset};

    #[test]
    fn each_grade_is_narrower_than_the_one_before() {
        for pair in GRADES.windows(2) {
            for (wide, narrow) in
                [(pair[0].imu.gyro, pair[1].imu.gyro), (pair[0].imu.accel, pair[1].imu.accel)]
            {
                assert!(narrow.noise_density < wide.noise_density, "{}", pair[1].name);
                assert!(narrow.bias_sigma < wide.bias_sigma, "{}", pair[1].name);
                assert!(narrow.scale_sigma < wide.scale_sigma, "{}", pair[1].name);
                assert!(narrow.misalignment_sigma <= wide.misalignment_sigma, "{}", pair[1].name);
            }
        }
    }

    #[test]
    fn each_name_is_found_once() {
        let mut names: Vec<String> = Preset::names().map(str::to_lowercase).collect();
        assert!(names.iter().all(|name| Preset::named(name).is_some()));
        let all = names.len();
        names.sort();
        names.dedup();
        assert_eq!(names.len(), all);
    }
}
