//! Scale factors of the raw counts of IMUs behind a NovAtel receiver.

use rins_frames::units::{ARCSEC, DEG, STANDARD_GRAVITY};

use super::log_spec::Reading;

/// One foot \[m\].
const FOOT: f64 = 0.3048;

/// Two to the power of −`digits`.
fn bit(digits: i32) -> f64 {
    2.0_f64.powi(-digits)
}

/// The IMUs with known scale factors.
pub(super) const IMUS: [&str; 15] = [
    "HG1700-AG11",
    "HG1700-AG17",
    "HG1700-AG58",
    "HG1700-AG62",
    "HG1900",
    "HG1930",
    "HG4930",
    "LN200",
    "FSAS",
    "ISA-100C",
    "uIMU",
    "KVH1750",
    "ADIS16488",
    "STIM300",
    "EG320N",
];

/// The IMU of this type number in RAWIMUX and RAWIMUSX messages; `None` if its counts are not known.
///
/// ‹novatel-oem7›, table "IMU Type".
pub(crate) fn of_type(number: u32) -> Option<&'static str> {
    let name = match number {
        1 => "HG1700-AG11",
        4 => "HG1700-AG17",
        5 | 27 => "HG1900",
        8 => "LN200",
        11 => "HG1700-AG58",
        12 => "HG1700-AG62",
        13 => "FSAS",
        20 | 28 => "HG1930",
        26 => "ISA-100C",
        31 => "ADIS16488",
        32 => "STIM300",
        33 => "KVH1750",
        41 => "EG320N",
        52 => "uIMU",
        58 => "HG4930",
        _ => return None,
    };
    Some(name)
}

/// The scales of the gyro and accelerometer counts of an IMU; `None` if they are unknown.
///
/// ‹novatel-oem7›, table "Raw IMU Scale Factors". Counts are increments of angle and velocity over a sample, except
/// for Epson IMUs, whose counts are mean rate and specific force.
pub(super) fn counts(imu: &str) -> Option<(Reading, Reading)> {
    let increments =
        |angle, velocity| Some((Reading::Increment(angle), Reading::Increment(velocity)));
    match imu {
        "HG1700-AG11" | "HG1700-AG58" | "HG1900" | "HG1930" => increments(bit(33), bit(27) * FOOT),
        "HG1700-AG17" | "HG1700-AG62" => increments(bit(33), bit(26) * FOOT),
        "HG4930" => increments(bit(33), bit(29)),
        "LN200" => increments(bit(19), bit(14)),
        "FSAS" => increments(0.1 * bit(8) * ARCSEC, 0.05 * bit(15)),
        "ISA-100C" | "uIMU" => increments(1e-9, 2e-8),
        "KVH1750" => increments(0.1 / (3600.0 * 256.0), 0.05 * bit(15)),
        "ADIS16488" => increments(720.0 * bit(31) * DEG, 200.0 * bit(31)),
        "STIM300" => increments(bit(21) * DEG, bit(22)),
        "EG320N" => Some((
            Reading::Rate(0.008 * bit(16) * DEG),
            Reading::Rate(0.2 * bit(16) * 1e-3 * STANDARD_GRAVITY),
        )),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::{IMUS, Reading, counts};
    use rins_testing::assert_close;

    #[test]
    fn every_type_is_one_of_the_list() {
        let known: Vec<_> = (0..100).filter_map(super::of_type).collect();
        assert!(known.iter().all(|name| IMUS.contains(name)) && known.len() > 15, "{known:?}");
        assert_eq!((super::of_type(26), super::of_type(0)), (Some("ISA-100C"), None));
    }

    #[test]
    fn every_imu_that_is_listed_has_its_counts() {
        for imu in IMUS {
            assert!(counts(imu).is_some(), "{imu}");
        }
        assert_eq!(counts("HG1700"), None);
    }

    /// Constants of the GearBox decoder, given there with 21 digits.
    #[test]
    fn counts_are_those_of_another_decoder() {
        // Its foot is longer than the international foot by 2 ppm.
        const FOOT: f64 = 3e-6;
        let increments = |imu| match counts(imu) {
            Some((Reading::Increment(angle), Reading::Increment(velocity))) => (angle, velocity),
            other => panic!("{imu}: {other:?}"),
        };
        let (angle, velocity) = increments("HG1700-AG58");
        assert_close!(angle, 1.164_153_218_269_348_1e-10, 1e-24);
        assert_close!(velocity, 2.270_941_507_816_314_7e-9, 2e-9 * FOOT);
        assert_close!(increments("HG1700-AG62").1, 4.541_883_015_632_629e-9, 4e-9 * FOOT);
        assert_close!(increments("FSAS").1, 1.525_878_906_25e-6, 1e-20);
        assert_close!(increments("LN200").0, 1.907_348_632_812_5e-6, 1e-20);
        assert_close!(increments("LN200").1, 6.103_515_625e-5, 1e-19);
    }
}
