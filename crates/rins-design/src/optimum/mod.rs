//! The optimization of a schedule.
//!
//! A schedule of duration `T` has the share `w_i` of each motion `i`: a rate of the table, or a static interval at a table angle, in one
//! orientation of the axis. Its information is `M = M₀ + T Σ w_i M_i`, with that of the prior `M₀` and that of each motion for one second.
//! Parameters are constant and the same in all motions, the attitude of the axis in all motions of one orientation; the runs are of one
//! power-on. The shares that minimize a criterion are an approximate design, with a bound of what is possible in these orientations; they are
//! rounded to a profile that the table can run, whose joint information is evaluated exactly.

mod approximate;
mod criterion;
mod element;
mod motion;
mod mounting;
mod objective;
mod pool;
mod rounding;
mod selection;

use rayon::prelude::*;
use rins_estimation::Joint;
use rins_frames::units::DEG;
use rins_frames::{Dcm, EulerAngles, Nav, SignedAxes, Table};
use rins_motion::{Profile, Segment};
use rins_terms::Model;

pub use self::approximate::ApproximateDesign;
pub use self::criterion::Criterion;
pub use self::element::Element;
pub use self::motion::Motion;
pub use self::objective::{LinearFunction, Objective};
use self::pool::{Orientation, Pool, PoolDesign};
use self::rounding::Short;
use self::selection::Selection;
use crate::error::DesignError;
use crate::limits::Limits;
use crate::pair::information;
use crate::planned::Planned;

/// The tilts of the axis from which the search begins \[deg\].
const TILTS: [f64; 4] = [0.0, 30.0, 60.0, 90.0];

/// The azimuths of a tilted axis relative to the given one \[deg\].
const AZIMUTHS: [f64; 3] = [0.0, 120.0, 240.0];

/// The steps of tilt and azimuth about the best orientations \[deg\].
const FINER: [(f64, f64); 2] = [(15.0, 60.0), (7.5, 30.0)];

/// The loss that a schedule with fewer orientations may have, relative to a variance.
const NEARLY: f64 = 0.03;

/// A schedule that is to be optimized.
#[derive(Clone, Copy, Debug)]
pub struct Optimization<'a> {
    /// The given runs: their IMU, site, table and orientations.
    pub given: &'a [Planned],
    /// The error model.
    pub model: &'a Model,
    /// What the schedule is optimized for.
    pub objective: &'a Objective<'a>,
    /// The limits of the table, and the duration.
    pub limits: &'a Limits,
    /// The possible tilts of the axis \[rad\]; `None` if any from 0 to 90 deg is possible.
    pub tilts: Option<&'a [f64]>,
    /// The possible mountings of the IMU: the axes of a run, whose z is the spin axis, relative to the sensors' own. That of the first
    /// given run if there are none.
    pub mountings: &'a [SignedAxes],
}

/// A run of an optimal schedule.
#[derive(Clone, Debug)]
pub struct OptimalRun {
    /// The plan.
    pub planned: Planned,
    /// Its segments.
    pub segments: Vec<Segment>,
    /// The shares of the motions in the whole schedule, before they were rounded.
    pub shares: Vec<(Motion, f64)>,
}

/// An optimal schedule.
#[derive(Clone, Debug)]
pub struct OptimalSchedule {
    /// Its runs, one in each orientation, all in one power-on.
    pub runs: Vec<OptimalRun>,
    /// Their joint information.
    pub joint: Joint,
    /// The value of the criterion, as [`Criterion::value`].
    pub value: f64,
    /// The value of the approximate design in these orientations.
    pub approximate: f64,
    /// The gap of the approximate design in these orientations.
    pub gap: f64,
    /// The number of candidates, and of their orientations.
    pub candidates: (usize, usize),
}

impl Optimization<'_> {
    /// The schedule that optimizes the objective. `at` hears the number of candidates whenever it has increased.
    ///
    /// # Errors
    /// [`DesignError::NothingFits`] if no profile is within the limits, [`DesignError::Undetermined`] if no motion determines the objective,
    /// and all errors of [`information`].
    pub fn run(&self, mut at: impl FnMut(usize)) -> Result<OptimalSchedule, DesignError> {
        let Self { given, model, objective, limits, .. } = *self;
        let given_axes = [given[0].axes()];
        let mountings = if self.mountings.is_empty() { &given_axes } else { self.mountings };
        let mut pool = Pool::new(&given[0], model, limits, mountings);
        pool.add(self.orientations(mountings.len()))?;
        at(pool.candidates());
        let mut selection = Selection::new(objective, limits, &pool)?;
        if self.tilts.is_none() && limits.directions > 1 {
            for (tilt, azimuth) in FINER {
                let chosen = selection.design.orientations.iter();
                let around: Vec<_> = chosen
                    .flat_map(|&place| {
                        let Orientation { attitude, mounting } = pool.orientations[place];
                        around(attitude, tilt * DEG, azimuth * DEG)
                            .into_iter()
                            .map(move |attitude| Orientation { attitude, mounting })
                    })
                    .filter(|orientation| self.is_readable(orientation.attitude))
                    .collect();
                pool.add(around)?;
                at(pool.candidates());
                selection.improve(&pool)?;
            }
        }
        let mut best: Option<OptimalSchedule> = None;
        for design in selection.alternatives(&pool)? {
            for short in [Short::LeftOut, Short::Extended] {
                let Some(schedule) = self.simplified(&pool, &design, short)? else { continue };
                let better = |best: &OptimalSchedule| {
                    selection.criterion.efficiency(best.value, schedule.value) < 1.0 - NEARLY
                };
                if best.as_ref().is_none_or(better) {
                    best = Some(schedule);
                }
            }
        }
        best.ok_or(DesignError::NothingFits)
    }

    /// The orientations from which the search begins, in this number of mountings.
    fn orientations(&self, mountings: usize) -> Vec<Orientation> {
        let attitudes = self.attitudes();
        let of = |mounting: usize| {
            attitudes.iter().map(move |&attitude| Orientation { attitude, mounting })
        };
        (0..mountings).flat_map(of).collect()
    }

    /// The attitudes of the axis from which the search begins.
    fn attitudes(&self) -> Vec<Dcm<Nav, Table>> {
        let given = self.given.iter().map(Planned::nav_from_table);
        if self.tilts.is_none() && self.limits.directions == 1 {
            return given.take(1).collect();
        }
        let yaw = self.given[0].nav_from_table().euler_angles().yaw;
        let tilts = match self.tilts {
            Some(tilts) => tilts.to_vec(),
            None => TILTS.map(|tilt| tilt * DEG).to_vec(),
        };
        let all = tilts.into_iter().flat_map(|tilt| {
            let azimuths = if tilt == 0.0 { &AZIMUTHS[..1] } else { &AZIMUTHS[..] };
            azimuths.iter().map(move |azimuth| tilted(tilt, yaw + azimuth * DEG))
        });
        let given = if self.tilts.is_none() { given.collect() } else { Vec::new() };
        given.into_iter().chain(all).filter(|attitude| self.is_readable(*attitude)).collect()
    }

    /// Whether the table angle is observable.
    fn is_readable(&self, attitude: Dcm<Nav, Table>) -> bool {
        self.given[0].has_table_reading() || attitude.matrix()[(2, 2)].abs() < 0.9998
    }

    /// The design as runs, without the motions that cost more time than they are worth: rotations between static intervals tell something, too.
    fn simplified(
        &self,
        pool: &Pool<'_>,
        design: &PoolDesign,
        short: Short,
    ) -> Result<Option<OptimalSchedule>, DesignError> {
        let Some(mut best) = self.rounded(pool, design, short)? else { return Ok(None) };
        let mut design = design.clone();
        loop {
            let trials: Vec<PoolDesign> = design.without_a_motion().collect();
            let schedules = trials
                .par_iter()
                .map(|trial| self.rounded(pool, trial, short))
                .collect::<Result<Vec<_>, DesignError>>()?;
            let found = trials.into_iter().zip(schedules);
            let found = found.filter_map(|(trial, schedule)| Some((trial, schedule?)));
            match found.min_by(|(_, a), (_, b)| a.value.total_cmp(&b.value)) {
                Some((trial, schedule)) if schedule.value < best.value => {
                    (design, best) = (trial, schedule);
                }
                _ => return Ok(Some(best)),
            }
        }
    }

    /// The design as runs; `None` if a run has too little time for any motion.
    fn rounded(
        &self,
        pool: &Pool<'_>,
        design: &PoolDesign,
        short: Short,
    ) -> Result<Option<OptimalSchedule>, DesignError> {
        let Self { given, model, objective, limits, .. } = *self;
        let mut runs = Vec::new();
        let mut left = limits.duration;
        for (&place, shares) in design.orientations.iter().zip(&design.shares) {
            let whole = pool::whole(shares);
            let is_last = runs.len() + 1 == design.orientations.len();
            let duration =
                if is_last { left } else { (whole * limits.duration * 10.0).round() / 10.0 };
            left -= duration;
            let Some(segments) = rounding::segments(shares, duration, limits, short) else {
                return Ok(None);
            };
            let profile = Profile::new(&segments, Some(limits.acceleration))?;
            let Orientation { attitude, mounting } = pool.orientations[place];
            let axes = pool.axes(mounting);
            let planned = given[0].moved(profile, attitude).with_axes(axes).since(0);
            let shares = shares.iter().copied().filter(|(_, share)| *share > 1e-4).collect();
            runs.push(OptimalRun { planned, segments, shares });
        }
        let plans: Vec<Planned> = runs.iter().map(|run| run.planned.clone()).collect();
        let joint = information(&plans, model)?;
        let value = value(objective, &joint).ok_or(DesignError::Undetermined)?;
        Ok(Some(OptimalSchedule {
            runs,
            joint,
            value,
            approximate: design.design.value,
            gap: design.design.gap,
            candidates: (pool.candidates(), pool.orientations.len()),
        }))
    }
}

/// The value of an objective for the joint information of runs, as [`Criterion::value`]; `None` if they leave it undetermined.
pub fn value(objective: &Objective<'_>, joint: &Joint) -> Option<f64> {
    let (criterion, prior) = objective.criterion(&joint.unknowns);
    let mut information = joint.information();
    for (place, prior) in prior.iter().enumerate() {
        information[(place, place)] += prior;
    }
    criterion.value(&information)
}

/// The attitude of an axis with this tilt and azimuth \[rad\].
fn tilted(tilt: f64, yaw: f64) -> Dcm<Nav, Table> {
    EulerAngles { roll: 0.0, pitch: tilt, yaw }.dcm()
}

/// Orientations at this distance in tilt and in azimuth.
fn around(attitude: Dcm<Nav, Table>, by: f64, azimuth: f64) -> Vec<Dcm<Nav, Table>> {
    let axis = attitude.matrix().column(2).into_owned();
    let tilt = axis.z.clamp(-1.0, 1.0).acos();
    // With roll zero and a yaw ψ, the axis leans along (sin ψ, -cos ψ).
    let yaw = if tilt < 1e-6 { attitude.euler_angles().yaw } else { axis.x.atan2(-axis.y) };
    let within = |tilt: f64| (-1e-9..=90.0 * DEG + 1e-9).contains(&tilt);
    let tilts = [tilt - by, tilt + by].into_iter().filter(|tilt| within(*tilt));
    let mut all: Vec<_> = tilts.map(|tilt| tilted(tilt.max(0.0), yaw)).collect();
    if tilt > 1e-6 {
        all.extend([yaw - azimuth, yaw + azimuth].map(|yaw| tilted(tilt, yaw)));
    }
    all
}
