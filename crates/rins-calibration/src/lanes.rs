//! The paper's twelve states against a commanded rate, for one run or several side by side.

use nalgebra::SMatrix;
use rins_frames::{Body, Dcm, Table};
use rins_lanes::{Real, Vector};

use crate::filter::Start;
use crate::kernel::{Kernel, Reading, Sample, SpinAxisErrors};
use crate::layout::PAPER_STATES;
use crate::setup::Setup;

/// The paper's filter of twelve states, eqs. (10)-(21), closed loop, for as many runs as `T` has
/// lanes: a campaign's [`crate::SpinAxisFilter`].
///
/// It is the same arithmetic, without the axis frame's attitude, which only readings of an angle need.
/// A run of which an innovation covariance is not positive definite is not a number from then on, and
/// the update is the plain one throughout: [`Self::is_plain`] says whether that was right.
#[derive(Clone, Copy, Debug)]
pub struct SpinAxisLanes<T> {
    kernel: Kernel<T, SpinAxisErrors, PAPER_STATES>,
    plain: bool,
}

impl<T: Real> SpinAxisLanes<T> {
    /// Filters that start alike, with the base at rest, for the runs that `like` has a number of.
    pub fn new(like: T, setup: &Setup, start: &Start) -> Self {
        let nav_from_table = start.nav_from_table;
        let nav_from_body = nav_from_table * Dcm::<Table, Body>::about_z(start.angle);
        let p = start.covariance(setup);
        let attitudes = [nav_from_body.matrix(), nav_from_table.matrix()];
        let kernel = Kernel::at_rest(like, setup, attitudes, |row, column| p[(row, column)]);
        Self { kernel, plain: true }
    }

    /// Takes in one sample of each run, over an interval \[s\] that they share, and the mean rate
    /// that the table was told to make over it \[rad/s\]; returns the whitened innovations.
    #[inline(always)]
    pub fn step(
        &mut self,
        [angle, velocity]: [&Vector<T>; 2],
        interval: f64,
        table_rate: T,
    ) -> [T; 6] {
        let sample = Sample { angle: *angle, velocity: *velocity, interval };
        let (found, plain) = self.kernel.step(&sample, &Reading::Rate(table_rate));
        self.plain &= plain;
        found.whitened
    }

    /// Whether no run was ever told anything so precise that the plain update lost digits of its
    /// covariance.
    pub const fn is_plain(&self) -> bool {
        self.plain
    }

    /// `M_xz`, `M_yz` \[rad\] and `S_z` as estimated so far.
    pub const fn estimate(&self) -> &Vector<T> {
        &self.kernel.estimate
    }

    /// The covariance of one run's states, in the order of [`crate::layout`].
    pub fn covariance(&self, run: usize) -> SMatrix<f64, PAPER_STATES, PAPER_STATES> {
        SMatrix::from_fn(|row, column| self.kernel.covariance.get(row, column).lane(run))
    }

    /// How far the navigated velocities are from zero \[m/s\].
    pub const fn velocity(&self) -> &Vector<T> {
        &self.kernel.mechanisation.velocity
    }
}
