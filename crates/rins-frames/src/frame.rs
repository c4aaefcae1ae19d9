//! Frames of reference, and vectors resolved in them.

use core::fmt::Debug;
use core::marker::PhantomData;
use core::ops::{Add, AddAssign, Mul, Neg, Sub, SubAssign};

use nalgebra::{Matrix3, Vector3};

use crate::rotation_vector::cross_matrix;

/// A frame of reference.
///
/// A frame is an empty enum, which has no value:
/// ```compile_fail,E0423
/// let nav = rins_frames::Nav;
/// ```
/// A new frame takes two lines:
/// ```
/// use rins_frames::{Body, Dcm, Frame, InFrame};
/// #[derive(Clone, Copy, Debug, PartialEq, Eq)]
/// enum Camera {}
/// impl Frame for Camera {}
///
/// let camera_from_body = Dcm::<Camera, Body>::about_x(0.0);
/// assert_eq!(camera_from_body * InFrame::new(1.0, 2.0, 3.0), InFrame::new(1.0, 2.0, 3.0));
/// ```
pub trait Frame: Copy + Debug + 'static {}

macro_rules! frames {
    ($($(#[$doc:meta])* $name:ident),* $(,)?) => {$(
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, Eq)]
        pub enum $name {}
        impl Frame for $name {}
    )*};
}

frames! {
    /// `n`: east, north, up at the turntable (wander angle zero).
    Nav,
    /// `s`: the body frame at table angle zero; its z is the spin axis. It does not rotate with the table.
    Table,
    /// `b`: fixed to the IMU: right, front, up; its z is the spin axis.
    Body,
}

/// A vector resolved in frame `F`, in SI units.
///
/// ```
/// use rins_frames::{InFrame, Nav};
/// let (east, north) = (InFrame::<Nav>::new(1.0, 0.0, 0.0), InFrame::<Nav>::new(0.0, 1.0, 0.0));
/// let up = InFrame::<Nav>::new(0.0, 0.0, 1.0);
/// assert_eq!(east.cross(&north), up);
/// assert_eq!((east * 3.0 - north * 4.0).norm(), 5.0);
/// ```
///
/// Vectors of two frames cannot be added:
/// ```compile_fail,E0308
/// use rins_frames::{Body, InFrame, Nav};
/// let sum = InFrame::<Nav>::new(1.0, 0.0, 0.0) + InFrame::<Body>::new(0.0, 1.0, 0.0);
/// ```
/// nor multiplied:
/// ```compile_fail,E0308
/// use rins_frames::{Body, InFrame, Table};
/// let product = InFrame::<Table>::zeros().cross(&InFrame::<Body>::zeros());
/// ```
/// and a frame is assigned to bare numbers explicitly or not at all:
/// ```compile_fail,E0308
/// use rins_frames::{InFrame, Nav};
/// let velocity: InFrame<Nav> = nalgebra::Vector3::new(1.0, 0.0, 0.0);
/// ```
#[derive(Clone, Copy, Debug, PartialEq)]
#[repr(transparent)]
pub struct InFrame<F> {
    pub(crate) components: Vector3<f64>,
    frame: PhantomData<F>,
}

impl<F: Frame> InFrame<F> {
    /// The vector with these components.
    pub const fn new(x: f64, y: f64, z: f64) -> Self {
        Self::from_components(Vector3::new(x, y, z))
    }

    /// The zero vector.
    pub const fn zeros() -> Self {
        Self::new(0.0, 0.0, 0.0)
    }

    /// The vector with these components in `F`: the only conversion from bare numbers.
    pub const fn from_components(components: Vector3<f64>) -> Self {
        Self { components, frame: PhantomData }
    }

    /// The bare components, for a kernel or a state vector: the only conversion to bare numbers.
    pub const fn components(&self) -> &Vector3<f64> {
        &self.components
    }

    /// The cross product `self × other`.
    #[must_use]
    pub fn cross(&self, other: &Self) -> Self {
        Self::from_components(self.components.cross(&other.components))
    }

    /// The scalar product.
    pub fn dot(&self, other: &Self) -> f64 {
        self.components.dot(&other.components)
    }

    /// The Euclidean norm.
    pub fn norm(&self) -> f64 {
        self.components.norm()
    }

    /// The matrix `[v×]`, so that `v.cross_matrix() * w` is `v × w`.
    pub fn cross_matrix(&self) -> Matrix3<f64> {
        cross_matrix(&self.components)
    }
}

impl<F: Frame> Add for InFrame<F> {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self::from_components(self.components + other.components)
    }
}

impl<F: Frame> AddAssign for InFrame<F> {
    fn add_assign(&mut self, other: Self) {
        self.components += other.components;
    }
}

impl<F: Frame> Sub for InFrame<F> {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self::from_components(self.components - other.components)
    }
}

impl<F: Frame> SubAssign for InFrame<F> {
    fn sub_assign(&mut self, other: Self) {
        self.components -= other.components;
    }
}

impl<F: Frame> Neg for InFrame<F> {
    type Output = Self;

    fn neg(self) -> Self {
        Self::from_components(-self.components)
    }
}

impl<F: Frame> Mul<f64> for InFrame<F> {
    type Output = Self;

    fn mul(self, factor: f64) -> Self {
        Self::from_components(self.components * factor)
    }
}
