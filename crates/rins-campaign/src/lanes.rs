//! Runs in SIMD lanes: each lane has the noise of its own run.

use std::ops::Range;

use nalgebra::{Matrix3, Vector3};
use rins_calibration::layout::SPIN_AXIS_ERRORS;
use rins_calibration::{Estimate, MEASUREMENTS, SpinAxisLanes, Start};
use rins_frames::{InFrame, Increments};
use rins_imu::{ImuNoise, ImuNoiseSource, Seed, Span};
use rins_lanes::{Arch, Lane, Real, Simd, Vector, WithSimd};

use crate::cell::Prepared;

/// The common data of the runs of one cell.
type Shared = (Start, ImuNoise, Span);

impl Prepared {
    /// The results of runs in SIMD lanes; `None` for a run that must be computed alone.
    pub(crate) fn run_side_by_side(
        &self,
        shared: &Shared,
        runs: Range<u64>,
    ) -> Vec<Option<Estimate>> {
        Arch::new().dispatch(SideBySide { cell: self, shared, runs })
    }
}

struct SideBySide<'a> {
    cell: &'a Prepared,
    shared: &'a Shared,
    runs: Range<u64>,
}

impl WithSimd for SideBySide<'_> {
    type Output = Vec<Option<Estimate>>;

    #[inline(always)]
    #[expect(clippy::inline_always, reason = "it is compiled with the machine's instructions")]
    fn with_simd<S: Simd>(self, simd: S) -> Self::Output {
        let like = Lane::splat(simd, 0.0);
        let width = like.lanes() as u64;
        let mut found = Vec::new();
        let mut first = self.runs.start;
        while first < self.runs.end {
            let runs = first..(first + width).min(self.runs.end);
            found.extend(group(self.cell, self.shared, like, runs));
            first += width;
        }
        found
    }
}

/// The results of at most as many runs as there are lanes.
#[inline(always)]
#[expect(clippy::inline_always, reason = "it is compiled with the machine's instructions")]
fn group<S: Simd>(
    cell: &Prepared,
    (start, noise, span): &Shared,
    like: Lane<S>,
    runs: Range<u64>,
) -> Vec<Option<Estimate>> {
    let sources = runs.clone().map(|run| noise.source(span, Seed { run, ..cell.scenario.seed }));
    let Ok(mut sources) = sources.collect::<Result<Vec<ImuNoiseSource>, _>>() else {
        return runs.map(|_| None).collect();
    };
    let mut filters = SpinAxisLanes::new(like, &cell.setup, start);
    let mut squares = like;
    // Lanes beyond the last run are computed without noise.
    let still = Increments { angle: InFrame::zeros(), velocity: InFrame::zeros(), interval: 0.0 };
    let mut read = vec![still; like.lanes()];
    let samples = cell.noiseless.len();
    for sample in 0..samples {
        let noiseless = cell.noiseless.increments[sample];
        read.fill(noiseless);
        for (read, source) in read.iter_mut().zip(&mut sources) {
            *read = source.corrupt(&noiseless);
        }
        let (mut angle, mut velocity) = (Vector::zeros(like), Vector::zeros(like));
        for axis in 0..3 {
            angle[axis] = like.each(|lane| read[lane].angle.components()[axis]);
            velocity[axis] = like.each(|lane| read[lane].velocity.components()[axis]);
        }
        let table_rate = cell.noiseless.table_rate.as_ref().map_or(0.0, |rates| rates[sample]);
        let whitened =
            filters.step([&angle, &velocity], noiseless.interval, like.constant(table_rate));
        for nu in whitened {
            squares = squares + nu * nu;
        }
    }
    let plain = filters.is_plain();
    let of_run = |lane: usize| {
        let first = SPIN_AXIS_ERRORS.start();
        let covariance: Matrix3<f64> =
            filters.covariance(lane).fixed_view::<3, 3>(first, first).into_owned();
        let estimate = Estimate {
            value: Vector3::from(filters.estimate().lane(lane)),
            covariance,
            nis_ratio: squares.lane(lane) / (samples * MEASUREMENTS) as f64,
        };
        (plain && estimate.nis_ratio.is_finite()).then_some(estimate)
    };
    (0..sources.len()).map(of_run).collect()
}
