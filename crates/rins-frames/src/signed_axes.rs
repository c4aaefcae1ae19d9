//! Permutations of axes with signs.

use nalgebra::{Matrix3, Vector3};

/// Three axes selected from three others, each once, with signs.
///
/// Component `i` along these axes is `sign[i]` times component `source[i]` along the others.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct SignedAxes {
    /// The index of the selected component, 0 to 2.
    pub source: [usize; 3],
    /// 1 or -1.
    pub sign: [f64; 3],
}

impl SignedAxes {
    /// The identity: the axes unchanged.
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

    /// The matrix that gives components along these axes.
    #[must_use]
    pub fn matrix(&self) -> Matrix3<f64> {
        Matrix3::from_columns(
            &[Vector3::x(), Vector3::y(), Vector3::z()].map(|unit| self.apply(&unit)),
        )
    }

    /// The inverse permutation.
    #[must_use]
    pub fn inverse(&self) -> Self {
        let mut inverse = *self;
        for row in 0..3 {
            inverse.source[self.source[row]] = row;
            inverse.sign[self.source[row]] = self.sign[row];
        }
        inverse
    }

    /// The composition: these axes selected from those of `first`.
    #[must_use]
    pub fn after(&self, first: &Self) -> Self {
        let source = self.source.map(|index| first.source[index]);
        let sign = core::array::from_fn(|row| self.sign[row] * first.sign[self.source[row]]);
        Self { source, sign }
    }

    /// The number of axes with a negative sign.
    pub fn flips(&self) -> usize {
        self.sign.iter().filter(|sign| **sign < 0.0).count()
    }

    /// The number of axes that keep their position.
    pub fn kept(&self) -> usize {
        (0..3).filter(|&axis| self.source[axis] == axis).count()
    }

    /// All 48 permutations with signs.
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
