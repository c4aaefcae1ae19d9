//! The paper's twelve states with a commanded rate, for one run or several in parallel.

use nalgebra::SMatrix;
use rins_frames::{Body, Dcm, Table};
use rins_lanes::{Real, Vector};

use crate::filter::Start;
use crate::kernel::{Kernel, Reading, Sample, SpinAxisErrors};
use crate::layout::PAPER_STATES;
use crate::setup::Setup;

/// The paper's filter of twelve states, eqs. (10)-(21), in closed-loop form, for as many runs as `T` has lanes: the
/// [`crate::SpinAxisFilter`] of a Monte Carlo campaign.
///
/// The arithmetic is the same without the attitude of the axis frame, which only angle measurements need. A run whose
/// innovation covariance is not positive definite is NaN from then on. The update is always the plain one: [`Self::is_plain`]
/// states whether its precision was sufficient.
#[derive(Clone, Copy, Debug)]
pub struct SpinAxisLanes<T> {
    kernel: Kernel<T, SpinAxisErrors, PAPER_STATES>,
    plain: bool,
}

impl<T: Real> SpinAxisLanes<T> {
    /// Filters with the same initial state and a stationary base, for as many runs as `like` has lanes.
    pub fn new(like: T, setup: &Setup, start: &Start) -> Self {
        let nav_from_table = start.nav_from_table;
        let nav_from_body = nav_from_table * Dcm::<Table, Body>::about_z(start.angle);
        let p = start.covariance(setup);
        let attitudes = [nav_from_body.matrix(), nav_from_table.matrix()];
        let kernel = Kernel::at_rest(like, setup, attitudes, |row, column| p[(row, column)]);
        Self { kernel, plain: true }
    }

    /// Processes one sample of each run, over a common interval \[s\], with the mean commanded table rate over it \[rad/s\];
    /// returns the whitened innovations.
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

    /// Whether no measurement was so precise that the plain update lost digits of the covariance, in all runs.
    pub const fn is_plain(&self) -> bool {
        self.plain
    }

    /// The current estimate of `M_xz`, `M_yz` \[rad\] and `S_z`.
    pub const fn estimate(&self) -> &Vector<T> {
        &self.kernel.estimate
    }

    /// The covariance of one run's states, in the order of [`crate::layout`].
    pub fn covariance(&self, run: usize) -> SMatrix<f64, PAPER_STATES, PAPER_STATES> {
        SMatrix::from_fn(|row, column| self.kernel.covariance.get(row, column).lane(run))
    }

    /// The computed velocities, whose true value is zero \[m/s\].
    pub const fn velocity(&self) -> &Vector<T> {
        &self.kernel.mechanisation.velocity
    }
}
