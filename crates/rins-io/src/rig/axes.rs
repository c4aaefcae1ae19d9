//! The assignment of sensor axes to body axes.

use nalgebra::Vector3;
use rins_frames::SignedAxes;

const NAMES: [&str; 3] = ["x", "y", "z"];

/// Three axes selected from three others, each once, with signs.
///
/// `["-y", "x", "z"]` means that body x is minus sensor y, body y is sensor x, and body z is
/// sensor z. A left-handed assignment is allowed, because some sensors have one: accelerometers
/// that report gravity instead of specific force need `["-x", "-y", "-z"]`.
///
/// ```
/// use nalgebra::Vector3;
/// let axes = rins_io::Axes::parse(["-y", "x", "z"]).expect("each axis once");
/// assert_eq!(axes.apply(&Vector3::new(1.0, 2.0, 3.0)), Vector3::new(-2.0, 1.0, 3.0));
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Axes(SignedAxes);

impl Axes {
    /// The identity: the axes unchanged.
    pub const IDENTITY: Self = Self(SignedAxes::IDENTITY);

    /// From front, right, down to right, front, up; it is its own inverse.
    pub(crate) const FRONT_RIGHT_DOWN: Self =
        Self(SignedAxes { source: [1, 0, 2], sign: [1.0, 1.0, -1.0] });

    /// The axes with these three names; `None` unless each of x, y and z occurs once.
    pub fn parse(names: [&str; 3]) -> Option<Self> {
        let mut axes = SignedAxes::IDENTITY;
        for (index, name) in names.into_iter().enumerate() {
            (axes.source[index], axes.sign[index]) = axis(name)?;
        }
        let mut seen = axes.source;
        seen.sort_unstable();
        (seen == [0, 1, 2]).then_some(Self(axes))
    }

    /// The proper rotation that makes the axis `name` the new z; `None` if it is not an axis.
    ///
    /// x, y and z are permuted cyclically until the spin axis is z; for a negative axis, a rotation by
    /// half a turn about the new x follows.
    pub fn spin(name: &str) -> Option<Self> {
        let (source, sign) = axis(name)?;
        let source = [(source + 1) % 3, (source + 2) % 3, source];
        Some(Self(SignedAxes { source, sign: [1.0, sign, sign] }))
    }

    /// The name of the axis that becomes z, as in a rig file; [`Axes::spin`] of it returns these axes, if they are those of a
    /// spin axis.
    pub fn spin_name(&self) -> String {
        let [_, _, spin] = self.names();
        spin
    }

    /// The vector's components along these axes.
    #[must_use]
    pub fn apply(&self, vector: &Vector3<f64>) -> Vector3<f64> {
        self.0.apply(vector)
    }

    /// The inverse assignment.
    #[must_use]
    pub fn inverse(&self) -> Self {
        Self(self.0.inverse())
    }

    /// Each axis as a rig file names it.
    pub fn names(&self) -> [String; 3] {
        let SignedAxes { source, sign } = self.0;
        core::array::from_fn(|row| {
            let sign = if sign[row] < 0.0 { "-" } else { "" };
            format!("{sign}{}", NAMES[source[row]])
        })
    }

    /// The composition: these axes selected from `first` instead of the sensor's axes.
    #[must_use]
    pub fn after(&self, first: &Self) -> Self {
        Self(self.0.after(&first.0))
    }
}

impl From<Axes> for SignedAxes {
    fn from(Axes(axes): Axes) -> Self {
        axes
    }
}

impl From<SignedAxes> for Axes {
    fn from(axes: SignedAxes) -> Self {
        Self(axes)
    }
}

fn axis(name: &str) -> Option<(usize, f64)> {
    let (sign, letter) = match name.strip_prefix('-') {
        Some(letter) => (-1.0, letter),
        None => (1.0, name.strip_prefix('+').unwrap_or(name)),
    };
    let source = NAMES.iter().position(|axis| *axis == letter)?;
    Some((source, sign))
}

#[cfg(test)]
mod tests {
    use super::Axes;
    use nalgebra::{Matrix3, Vector3};
    use rins_testing::assert_close;

    fn matrix(axes: &Axes) -> Matrix3<f64> {
        Matrix3::from_columns(&[
            axes.apply(&Vector3::x()),
            axes.apply(&Vector3::y()),
            axes.apply(&Vector3::z()),
        ])
    }

    #[test]
    fn spin_axes_become_z_by_a_proper_rotation() {
        let vectors = [Vector3::x(), Vector3::y(), Vector3::z()];
        for (name, vector) in ["x", "y", "z"].into_iter().zip(vectors) {
            for (name, vector) in [(name.to_string(), vector), (format!("-{name}"), -vector)] {
                let axes = Axes::spin(&name).unwrap();
                assert_eq!(axes.apply(&vector), Vector3::z(), "{name}");
                assert_eq!(axes.spin_name(), name);
                assert_close!(matrix(&axes).determinant(), 1.0, 1e-15);
            }
        }
        assert_eq!(Axes::spin("z"), Some(Axes::IDENTITY));
    }

    #[test]
    fn one_choice_after_another_is_the_product_of_their_matrices() {
        let first = Axes::parse(["-y", "x", "-z"]).unwrap();
        let second = Axes::parse(["z", "-y", "x"]).unwrap();
        assert_eq!(matrix(&second.after(&first)), matrix(&second) * matrix(&first));
    }

    #[test]
    fn an_inverse_undoes_and_names_are_read() {
        for names in [["-y", "x", "-z"], ["z", "-x", "y"], ["-x", "-z", "y"]] {
            let axes = Axes::parse(names).unwrap();
            assert_eq!(axes.names(), names);
            assert_eq!(axes.inverse().after(&axes), Axes::IDENTITY);
            assert_eq!(axes.after(&axes.inverse()), Axes::IDENTITY);
        }
    }

    #[test]
    fn each_axis_occurs_once() {
        assert_eq!(Axes::parse(["x", "x", "z"]), None);
        assert_eq!(Axes::parse(["x", "y", "w"]), None);
        assert_eq!(Axes::parse(["--x", "y", "z"]), None);
        assert_eq!(Axes::parse(["+x", "y", "z"]), Some(Axes::IDENTITY));
    }
}
