//! Axes that are others, or the opposite of others.

use nalgebra::{Matrix3, Vector3};

/// Three axes picked from three others, each once, with signs.
///
/// Corrected component `i` is `sign[i]` times component `source[i]` as it is read now.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SignedAxes {
    /// Which component, 0 to 2.
    pub source: [usize; 3],
    /// 1 or -1.
    pub sign: [f64; 3],
}

impl SignedAxes {
    /// The axes as they are.
    pub const IDENTITY: Self = Self { source: [0, 1, 2], sign: [1.0; 3] };

    /// The vector's components along these axes.
    #[must_use]
    pub fn apply(&self, vector: &Vector3<f64>) -> Vector3<f64> {
        Vector3::from_fn(|row, _| self.sign[row] * vector[self.source[row]])
    }

    /// The vector whose components along these axes are `vector`'s.
    #[must_use]
    pub fn undo(&self, vector: &Vector3<f64>) -> Vector3<f64> {
        self.inverse().apply(vector)
    }

    /// The matrix that makes components along these axes.
    #[must_use]
    pub fn matrix(&self) -> Matrix3<f64> {
        Matrix3::from_columns(
            &[Vector3::x(), Vector3::y(), Vector3::z()].map(|unit| self.apply(&unit)),
        )
    }

    /// The axes by which what these have mixed up is as it was.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let mut inverse = *self;
        for row in 0..3 {
            inverse.source[self.source[row]] = row;
            inverse.sign[self.source[row]] = self.sign[row];
        }
        inverse
    }

    /// These axes picked from those that `first` picks.
    #[must_use]
    pub fn after(&self, first: &Self) -> Self {
        let source = self.source.map(|index| first.source[index]);
        let sign = core::array::from_fn(|row| self.sign[row] * first.sign[self.source[row]]);
        Self { source, sign }
    }

    /// How many of the axes' signs are changed.
    pub fn flips(&self) -> usize {
        self.sign.iter().filter(|sign| **sign < 0.0).count()
    }

    /// How many axes stay in their place.
    pub fn kept(&self) -> usize {
        (0..3).filter(|&axis| self.source[axis] == axis).count()
    }

    /// All 48.
    pub fn all() -> impl Iterator<Item = Self> {
        const ORDERS: [[usize; 3]; 6] =
            [[0, 1, 2], [1, 0, 2], [0, 2, 1], [2, 1, 0], [1, 2, 0], [2, 0, 1]];
        ORDERS.into_iter().flat_map(|source| {
            (0..8_u8).map(move |bits| {
                let sign =
                    core::array::from_fn(|axis| if bits >> axis & 1 == 1 { -1.0 } else { 1.0 });
                Self { source, sign }
            })
        })
    }
}
