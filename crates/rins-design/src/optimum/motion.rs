//! The motions that a schedule consists of, and the information of each for one second.

use std::f64::consts::TAU;
use std::ops::Range;

use nalgebra::{DMatrix, SymmetricEigen};
use rayon::prelude::*;
use rins_estimation::Joint;
use rins_frames::{Dcm, Nav, SignedAxes, Table};
use rins_motion::{Profile, Segment};
use rins_terms::Model;

use crate::error::DesignError;
use crate::limits::{Limits, transit};
use crate::pair::information;
use crate::planned::Planned;

/// A motion of the table in one orientation of its axis.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Motion {
    /// Rotation at a rate \[rad/s\].
    Rotation(f64),
    /// A static interval at a table angle \[rad\].
    Dwell(f64),
}

/// The rates relative to the largest.
const RATES: [f64; 4] = [1.0, -1.0, 0.5, -0.5];

/// The number of table angles for static intervals.
const DWELLS: u8 = 8;

/// The part of a motion before its information is counted \[s\]: attitude and table angle are known then, as where it follows another.
const BEFORE: Range<f64> = 20.0..150.0;

/// The same in time constants after which the gyro knows the angle of the table better than the encoder does.
const SETTLED: f64 = 5.0;

/// The longest part of a motion whose information is counted \[s\].
const LONGEST: f64 = 720.0;

/// The part of a static interval whose information is counted \[s\].
const DWELL: f64 = 10.0;

impl Motion {
    /// All motions of a table with these limits.
    pub(super) fn all(limits: &Limits) -> Vec<Self> {
        let rotations = RATES.into_iter().map(|part| Self::Rotation(part * limits.rate));
        let angle = |place: u8| TAU * f64::from(place) / f64::from(DWELLS);
        rotations.chain((0..DWELLS).map(|place| Self::Dwell(angle(place)))).collect()
    }

    /// The segments before the counted part of this motion, and its counted part.
    fn segments(self, limits: &Limits, lead: f64) -> (Vec<Segment>, Segment) {
        match self {
            Self::Rotation(rate) => {
                let before = rate.abs() / limits.acceleration + lead;
                // Whole revolutions: harmonics of the table angle average out.
                let revolution = TAU / rate.abs();
                let duration = (revolution * (BEFORE.start / revolution).ceil()).min(LONGEST);
                (vec![Segment { rate, duration: before }], Segment { rate, duration })
            }
            Self::Dwell(angle) => {
                let mut before = transit(angle, limits);
                before.push(Segment {
                    rate: 0.0,
                    duration: lead + limits.rate / limits.acceleration,
                });
                (before, Segment { rate: 0.0, duration: DWELL })
            }
        }
    }
}

/// The information of each motion of an axis with this attitude for one second, in units of the priors; of `n` parameters each.
///
/// The models are along the axes of the run. The information is that of the counted part after the part before, so that what a start costs is not in it.
///
/// # Errors
/// As of [`information`].
pub(super) fn informations(
    given: &Planned,
    limits: &Limits,
    pieces: &[(Dcm<Nav, Table>, &Model, Motion)],
) -> Result<Vec<DMatrix<f64>>, DesignError> {
    let lead = (SETTLED * given.time_constant()).clamp(BEFORE.start, BEFORE.end);
    pieces
        .par_iter()
        .map(|&(attitude, model, motion)| {
            let (mut segments, counted) = motion.segments(limits, lead);
            let of = |segments: &[Segment]| -> Result<Joint, DesignError> {
                let profile = Profile::new(segments, Some(limits.acceleration))?;
                let planned = given.moved(profile, attitude).with_axes(SignedAxes::IDENTITY);
                information(&[planned.sampled_coarsely()], model)
            };
            let before = of(&segments)?.information();
            segments.push(counted);
            let whole = of(&segments)?.information();
            Ok(positive(&((whole - before) / counted.duration)))
        })
        .collect()
}

/// The nearest positive semidefinite matrix: a difference of two informations is one up to rounding.
fn positive(matrix: &DMatrix<f64>) -> DMatrix<f64> {
    let own = SymmetricEigen::new(0.5 * (matrix + matrix.transpose()));
    let values = own.eigenvalues.map(|value| value.max(0.0));
    &own.eigenvectors * DMatrix::from_diagonal(&values) * own.eigenvectors.transpose()
}
