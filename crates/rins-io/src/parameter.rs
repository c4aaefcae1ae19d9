//! The twelve numbers of a triad's errors by name and unit, as in files and results.

use rins_frames::units::{ARCSEC, DEG_PER_HOUR, MICRO_G, PPM};
use rins_imu::{ImuError, TriadError};

use crate::error::IoError;
use crate::quantity::{Kind, kinds};
use crate::section::{Section, such_as};

/// A number of an [`ImuError`], or its standard deviation.
#[derive(Clone, Debug, PartialEq)]
pub struct Parameter {
    /// Its name, such as `gyro.misalignment.xz`: the fraction of a rate about z that gyro x measures.
    pub id: String,
    /// Its value in [`Parameter::unit`].
    pub value: f64,
    /// Biases are in `deg/h` and `ug`, scales in `ppm`, misalignments in `arcsec`.
    pub unit: &'static str,
}

/// The rows and columns of the misalignments, in their order in files.
const MISALIGNMENTS: [(&str, usize, usize); 6] =
    [("xy", 0, 1), ("xz", 0, 2), ("yx", 1, 0), ("yz", 1, 2), ("zx", 2, 0), ("zy", 2, 1)];

const AXES: [&str; 3] = ["x", "y", "z"];

/// The keys and units of one triad.
pub(crate) struct TriadKeys {
    name: &'static str,
    bias: &'static Kind,
    bias_sigma: &'static Kind,
    bias_unit: (&'static str, f64),
}

pub(crate) const GYRO: TriadKeys = TriadKeys {
    name: "gyro",
    bias: &kinds::GYRO_BIAS,
    bias_sigma: &kinds::GYRO_BIAS_SIGMA,
    bias_unit: ("deg/h", DEG_PER_HOUR),
};

pub(crate) const ACCEL: TriadKeys = TriadKeys {
    name: "accel",
    bias: &kinds::ACCEL_BIAS,
    bias_sigma: &kinds::ACCEL_BIAS_SIGMA,
    bias_unit: ("ug", MICRO_G),
};

const SCALE_UNIT: (&str, f64) = ("ppm", PPM);
const MISALIGNMENT_UNIT: (&str, f64) = ("arcsec", ARCSEC);

/// The 24 numbers of `error`: first the gyros', then the accelerometers'.
///
/// ```
/// use rins_imu::{Axis, ImuError, TriadError};
/// let gyro = TriadError::default().with_scale(Axis::Z, 300e-6);
/// let parameters = rins_io::parameters(&ImuError { gyro, ..ImuError::default() });
/// assert_eq!(parameters.len(), 24);
/// assert_eq!((parameters[5].id.as_str(), parameters[5].unit), ("gyro.scale.z", "ppm"));
/// assert!((parameters[5].value - 300.0).abs() < 1e-12);
/// ```
pub fn parameters(error: &ImuError) -> Vec<Parameter> {
    let mut parameters = Vec::with_capacity(24);
    for (keys, triad) in [(&GYRO, &error.gyro), (&ACCEL, &error.accel)] {
        let mut push = |kind: &str, place: &str, value: f64, (unit, factor)| {
            let id = format!("{}.{kind}.{place}", keys.name);
            parameters.push(Parameter { id, value: value / factor, unit });
        };
        for (axis, name) in AXES.into_iter().enumerate() {
            push("bias", name, triad.bias[axis], keys.bias_unit);
        }
        for (axis, name) in AXES.into_iter().enumerate() {
            push("scale", name, triad.matrix[(axis, axis)], SCALE_UNIT);
        }
        for (name, row, column) in MISALIGNMENTS {
            push("misalignment", name, triad.matrix[(row, column)], MISALIGNMENT_UNIT);
        }
    }
    parameters
}

/// The treatment of a number that a file omits.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum LeftOut {
    /// It is zero.
    Zero,
    /// The file is refused.
    Refused,
}

/// The keys of a triad.
pub(crate) const KEYS: [&str; 3] = ["bias", "scale", "misalignment"];

/// Reads the keys of a triad from its section.
pub(crate) fn read(
    section: &Section<'_>,
    keys: &TriadKeys,
    left_out: LeftOut,
) -> Result<TriadError, IoError> {
    let mut triad = TriadError::default();
    let three = |key: &str, kind: &Kind| match section.triple(key, kind)? {
        None if left_out == LeftOut::Refused => {
            let expected = format!("three quantities such as [{0:?}, {0:?}, {0:?}]", kind.example);
            Err(section.missing(key, expected))
        }
        three => Ok(three.unwrap_or_default()),
    };
    triad.bias = three("bias", keys.bias)?.into();
    let scale = three("scale", &kinds::RATIO)?;
    for (axis, scale) in scale.into_iter().enumerate() {
        triad.matrix[(axis, axis)] = scale;
    }
    let names = MISALIGNMENTS.map(|(name, ..)| name);
    let table = section.inline("misalignment", &names)?;
    if table.is_none() && left_out == LeftOut::Refused {
        return Err(section.missing("misalignment", "the keys xy, xz, yx, yz, zx and zy"));
    }
    for (table, (name, row, column)) in
        table.iter().flat_map(|table| MISALIGNMENTS.map(|place| (table, place)))
    {
        let angle = table.quantity(name, &kinds::SMALL_ANGLE)?;
        if angle.is_none() && left_out == LeftOut::Refused {
            return Err(table.missing(name, such_as(&kinds::SMALL_ANGLE)));
        }
        triad.matrix[(row, column)] = angle.unwrap_or(0.0);
    }
    Ok(triad)
}

/// The standard deviations in a section with their ids, in the order of
/// [`parameters`].
pub(crate) fn read_sigmas(section: &Section<'_>) -> Result<Vec<Parameter>, IoError> {
    let mut sigmas = Vec::new();
    for keys in [&GYRO, &ACCEL] {
        let Some(triad) = section.inline(keys.name, &KEYS)? else { continue };
        let mut read = |group: &str, places: &[&str], kind: &Kind, (unit, factor)| {
            let Some(table) = triad.inline(group, places)? else { return Ok(()) };
            for place in places {
                if let Some(sigma) = table.quantity(place, kind)? {
                    let id = format!("{}.{group}.{place}", keys.name);
                    sigmas.push(Parameter { id, value: sigma / factor, unit });
                }
            }
            Ok::<(), IoError>(())
        };
        read("bias", &AXES, keys.bias_sigma, keys.bias_unit)?;
        read("scale", &AXES, &kinds::RATIO_SIGMA, SCALE_UNIT)?;
        let places = MISALIGNMENTS.map(|(name, ..)| name);
        read("misalignment", &places, &kinds::ANGLE_SIGMA, MISALIGNMENT_UNIT)?;
    }
    Ok(sigmas)
}

/// The keys of a triad as TOML.
pub(crate) fn written(triad: &TriadError, keys: &TriadKeys) -> String {
    let quantity =
        |value: f64, (unit, factor): (&str, f64)| format!("\"{} {unit}\"", value / factor);
    let three = |values: [f64; 3], unit| values.map(|value| quantity(value, unit)).join(", ");
    let bias = three(triad.bias.into(), keys.bias_unit);
    let scale = three(triad.matrix.diagonal().into(), SCALE_UNIT);
    let misalignment = MISALIGNMENTS.map(|(name, row, column)| {
        format!("{name} = {}", quantity(triad.matrix[(row, column)], MISALIGNMENT_UNIT))
    });
    let misalignment = misalignment.join(", ");
    format!("bias = [{bias}]\nscale = [{scale}]\nmisalignment = {{ {misalignment} }}\n")
}
