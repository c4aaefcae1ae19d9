//! Named blocks of a state vector.

use nalgebra::{SMatrix, SVector};

/// `LEN` successive elements of a state or measurement vector.
///
/// A layout is a chain of blocks, so that no offset is ever written as a number and a state is added in one line:
///
/// ```
/// use rins_ekf::Block;
/// const ATTITUDE: Block<3> = Block::first();
/// const VELOCITY: Block<2> = ATTITUDE.then();
/// const GYRO_BIAS: Block<3> = VELOCITY.then();
/// const STATES: usize = GYRO_BIAS.end();
/// assert_eq!((VELOCITY.start(), STATES), (3, 8));
/// ```
///
/// A block whose length differs from that of its place does not compile:
/// ```compile_fail,E0308
/// use nalgebra::{SMatrix, Vector2};
/// use rins_ekf::Block;
/// const ATTITUDE: Block<3> = Block::first();
/// let mut state = SMatrix::<f64, 5, 1>::zeros();
/// ATTITUDE.set_in(&mut state, &Vector2::zeros());
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Block<const LEN: usize> {
    start: usize,
}

impl<const LEN: usize> Block<LEN> {
    /// The first block of a layout.
    pub const fn first() -> Self {
        Self { start: 0 }
    }

    /// The block that follows this one.
    #[must_use]
    pub const fn then<const NEXT: usize>(self) -> Block<NEXT> {
        Block { start: self.end() }
    }

    /// The index of the block's first element.
    pub const fn start(self) -> usize {
        self.start
    }

    /// The index after the block's last element.
    pub const fn end(self) -> usize {
        self.start + LEN
    }

    /// The block's elements of `state`.
    ///
    /// # Panics
    /// If the block ends beyond `state`.
    pub fn of<const N: usize>(self, state: &SVector<f64, N>) -> SVector<f64, LEN> {
        state.fixed_rows::<LEN>(self.start).into_owned()
    }

    /// Sets the block's elements of `state`.
    ///
    /// # Panics
    /// If the block ends beyond `state`.
    pub fn set_in<const N: usize>(self, state: &mut SVector<f64, N>, value: &SVector<f64, LEN>) {
        state.fixed_rows_mut::<LEN>(self.start).copy_from(value);
    }

    /// The elements of `matrix` in this block's rows and `columns`' columns.
    ///
    /// # Panics
    /// If a block ends beyond `matrix`.
    pub fn get<const N: usize, const M: usize, const COLS: usize>(
        self,
        columns: Block<COLS>,
        matrix: &SMatrix<f64, N, M>,
    ) -> SMatrix<f64, LEN, COLS> {
        matrix.fixed_view::<LEN, COLS>(self.start, columns.start).into_owned()
    }

    /// Sets the elements of `matrix` in this block's rows and `columns`' columns.
    ///
    /// # Panics
    /// If a block ends beyond `matrix`.
    pub fn set<const N: usize, const M: usize, const COLS: usize>(
        self,
        columns: Block<COLS>,
        matrix: &mut SMatrix<f64, N, M>,
        value: &SMatrix<f64, LEN, COLS>,
    ) {
        matrix.fixed_view_mut::<LEN, COLS>(self.start, columns.start).copy_from(value);
    }

    /// Sets this block's elements on the diagonal of `matrix`, for example to initial variances.
    ///
    /// # Panics
    /// If the block ends beyond `matrix`.
    pub fn set_diagonal<const N: usize>(
        self,
        matrix: &mut SMatrix<f64, N, N>,
        value: &SVector<f64, LEN>,
    ) {
        for (offset, &element) in value.iter().enumerate() {
            let index = self.start + offset;
            matrix[(index, index)] = element;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::{Matrix2x3, Vector2, Vector3};

    const FIRST: Block<2> = Block::first();
    const SECOND: Block<3> = FIRST.then();

    #[test]
    fn a_block_touches_its_own_elements_only() {
        let mut matrix = SMatrix::<f64, 5, 5>::zeros();
        let value = Matrix2x3::new(1.0, 2.0, 3.0, 4.0, 5.0, 6.0);
        FIRST.set(SECOND, &mut matrix, &value);
        assert_eq!(FIRST.get(SECOND, &matrix), value);
        assert_eq!((matrix[(0, 2)], matrix[(1, 4)]), (1.0, 6.0));
        assert_eq!(matrix.iter().filter(|x| x.abs() > 0.0).count(), value.len());

        SECOND.set_diagonal(&mut matrix, &Vector3::new(7.0, 8.0, 9.0));
        assert_eq!(matrix.diagonal().as_slice(), [0.0, 0.0, 7.0, 8.0, 9.0]);
    }

    #[test]
    fn what_was_assigned_is_read_back() {
        let mut state = SVector::<f64, 5>::zeros();
        SECOND.set_in(&mut state, &Vector3::new(1.0, 2.0, 3.0));
        assert_eq!(SECOND.of(&state), Vector3::new(1.0, 2.0, 3.0));
        assert_eq!(FIRST.of(&state), Vector2::zeros());
    }
}
