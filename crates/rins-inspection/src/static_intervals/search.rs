//! The search for the static intervals of a recording.

use std::ops::Range;

use nalgebra::Vector3;
use rins_frames::units::DEG_PER_SECOND;

use super::bias::{Piece, turning};
use super::cells::Cells;
use super::interval::{NotStatic, StaticInterval};
use super::noise::{Limits, Noise};
use super::options::StaticOptions;
use super::split::{SIGMAS, coarse_step};
use super::wander::wanders;
use super::{drift, split, table};
use crate::rows::rows_of;
use rins_motion::{Recording, whole};

/// A cell at the end of an interval that differs by this number of sigmas from the mean belongs to the adjacent motion: in a
/// few of a thousand ends a cell is removed by chance.
const END_SIGMAS: f64 = 4.0;

/// The largest part that is removed from an end \[s\].
const LONGEST_END: f64 = 1.0;

/// The motion of a stationary base, below which the ends of intervals are not trimmed \[rad/s\].
const END_RATE: f64 = 0.002 * DEG_PER_SECOND;

/// The same for accelerometers \[m/s²\].
const END_FORCE: f64 = 1e-3;

/// The number of times that the noise is estimated again from the parts of the log.
const NOISE_PASSES: usize = 2;

/// The largest change of velocity of a static IMU in a disturbance \[m/s\], as measured by accelerometers that clip the peaks
/// of a shock: a larger change is a displacement by hand.
const LARGEST_VELOCITY: f64 = 0.2;

/// The longest window over which the direction of gravity is averaged \[s\].
const DIRECTION: f64 = 1.0;

/// The smallest number of windows in a span for the directions of gravity.
const FEWEST_DIRECTIONS: usize = 20;

/// The duration, relative to the shortest interval, below which a candidate is not reported.
const REPORTED: f64 = 0.5;

/// The data of a search for static intervals.
pub(super) struct Search<'r> {
    pub(super) recording: &'r Recording,
    pub(super) options: &'r StaticOptions,
    pub(super) cells: Cells,
    /// The cells in which the table is static, if that is known.
    pub(super) table: Option<Vec<bool>>,
    quiet: Vec<bool>,
    pub(super) noise: Noise,
}

/// A run of cells, and the reason why it is not a static interval.
struct Found {
    /// Its parts, separated by disturbances.
    parts: Vec<Range<usize>>,
    why: Option<NotStatic>,
}

impl<'r> Search<'r> {
    pub(super) fn new(recording: &'r Recording, options: &'r StaticOptions) -> Self {
        let cells = Cells::of(recording, options);
        let table = table::stands(recording, &cells);
        let stand = table.clone().unwrap_or_else(|| vec![true; cells.len()]);
        let quiet = Limits::of(&cells, &stand, options).quiet(&cells, &stand);
        let mut noise = Noise::of(&cells, &rows_of(&quiet));
        if table.is_none() {
            // A slow motion is as quiet as a static interval, but it is not noise.
            for _ in 0..NOISE_PASSES {
                let parts = rows_of(&quiet)
                    .into_iter()
                    .flat_map(|run| split::parts(&cells, run, &noise, options))
                    .collect::<Vec<_>>();
                noise = Noise::of(&cells, &parts);
            }
        }
        Self { recording, options, cells, table, quiet, noise }
    }

    pub(super) fn found(&self) -> Vec<StaticInterval> {
        let mut all: Vec<Found> = Vec::new();
        for run in rows_of(&self.quiet) {
            if self.table.is_some() {
                all.push(Found { parts: vec![run], why: None });
                continue;
            }
            for part in split::parts(&self.cells, run, &self.noise, self.options) {
                let still = self.still(&self.trimmed(part)).into_iter();
                all.extend(still.map(|found| {
                    let why =
                        found.why.or_else(|| wanders(&self.cells, &found.parts[0], self.options));
                    Found { why, ..found }
                }));
            }
        }
        if self.table.is_none() {
            let still: Vec<usize> =
                (0..all.len()).filter(|place| all[*place].why.is_none()).collect();
            let pieces: Vec<Piece> = still.iter().map(|k| self.piece(&all[*k].parts[0])).collect();
            for (place, why) in still.into_iter().zip(turning(&pieces, self.options)) {
                all[place].why = why;
            }
        }
        let all = self.bridged(all);
        all.iter().filter_map(|found| self.interval(found)).collect()
    }

    /// The parts over which gravity has a constant direction, and those over which it has not.
    fn still(&self, run: &Range<usize>) -> Vec<Found> {
        if run.is_empty() {
            return Vec::new();
        }
        let duration = self.cells.duration(run);
        let window = (duration / FEWEST_DIRECTIONS as f64).min(DIRECTION);
        let size = whole(window * run.len() as f64 / duration);
        let windows: Vec<Range<usize>> = (run.start..run.end)
            .step_by(size)
            .map(|start| start..(start + size).min(run.end))
            .filter(|window| window.len() == size || run.len() < size)
            .collect();
        let forces: Vec<Vector3<f64>> =
            windows.iter().map(|window| self.cells.force(window)).collect();
        let lasting = duration * size as f64 / run.len() as f64;
        let parts = drift::parts(&forces, lasting, self.options.largest_sway);
        let span = |part: &Range<usize>| {
            let end = windows[part.end - 1].end;
            // The last window may be short and was omitted.
            windows[part.start].start..if part.end == windows.len() { run.end } else { end }
        };
        let mut found: Vec<Found> =
            parts.iter().map(|part| Found { parts: vec![span(part)], why: None }).collect();
        // A rotation so slow that its parts appear static, with successive attitudes, is not a static interval either.
        if found.len() > 1 {
            for one in &mut found {
                one.why = self.drifts(&one.parts[0]);
            }
        }
        if found.is_empty() {
            let angle = self
                .cells
                .up(&(run.start..run.start + size))
                .angle(&self.cells.up(&(run.end - size..run.end)));
            found.push(Found {
                parts: vec![run.clone()],
                why: Some(NotStatic::GravityTurns { angle }),
            });
        }
        found
    }

    /// Whether the direction of gravity at the end of a span differs from that at its start.
    fn drifts(&self, run: &Range<usize>) -> Option<NotStatic> {
        let quarter = (run.len() / 4).max(1);
        let (first, last) = (run.start..run.start + quarter, run.end - quarter..run.end);
        let angle = self.cells.up(&first).angle(&self.cells.up(&last));
        let force = self.cells.force(run).norm().max(1e-9);
        let noise = SIGMAS * self.noise.force(self.cells.duration(&first)) * 2.0_f64.sqrt() / force;
        (angle > self.options.largest_sway + noise).then_some(NotStatic::GravityTurns { angle })
    }

    /// A part without the motion before and after that its ends contain.
    fn trimmed(&self, part: Range<usize>) -> Range<usize> {
        let cells = &self.cells;
        // An end is at most a second or a quarter long, and the cells behind it are the static reference.
        let second = whole(LONGEST_END * part.len() as f64 / cells.duration(&part));
        let reach = second.min(part.len() / 4);
        let behind = (3 * reach).min(part.len() - reach);
        if reach == 0 {
            return part;
        }
        let off = |cell: usize, inner: &Range<usize>| self.is_off(&(cell..cell + 1), inner);
        let (mut start, mut end) = (part.start, part.end);
        // There is no motion before and after a log.
        if part.start > 0 {
            let inner = part.start + reach..part.start + behind;
            let last = (part.start..inner.start).rev().find(|cell| off(*cell, &inner));
            start = last.map_or(start, |last| last + 1);
            // The mean over several cells detects a motion that begins too slowly for a single one.
            while (start + 1..=inner.start).any(|end| self.is_off(&(start..end), &inner)) {
                start += 1;
            }
        }
        if part.end < cells.len() {
            let inner = part.end - behind..part.end - reach;
            let first = (inner.end..part.end).find(|cell| off(*cell, &inner));
            end = first.unwrap_or(end);
            while (inner.end..end).any(|start| self.is_off(&(start..end), &inner)) {
                end -= 1;
            }
        }
        start..end
    }

    /// Whether the means over `some` cells differ from those over `stationary` ones.
    fn is_off(&self, some: &Range<usize>, stationary: &Range<usize>) -> bool {
        let cells = &self.cells;
        let rate = cells.rate(some) - cells.rate(stationary);
        let force = cells.force(some) - cells.force(stationary);
        let sigma = |of: &[Vector3<f64>]| {
            let [some, stationary] =
                [some, stationary].map(|range| self.noise.of_mean(of, cells.duration(range)));
            some.zip_map(&stationary, f64::hypot) * END_SIGMAS
        };
        let (gyro, accel) = (sigma(&self.noise.gyro), sigma(&self.noise.accel));
        (0..3).any(|axis| {
            rate[axis].abs() > gyro[axis] + END_RATE + cells.gyro_step[axis]
                || force[axis].abs() > accel[axis] + END_FORCE + cells.accel_step[axis]
        })
    }

    pub(super) fn piece(&self, part: &Range<usize>) -> Piece {
        let duration = self.cells.duration(part);
        let step: f64 = (0..3).map(|axis| coarse_step(&self.cells, &self.noise, axis)).sum();
        Piece {
            duration,
            rate: self.cells.rate(part),
            uncertainty: SIGMAS * self.noise.rate(duration)
                + self.options.largest_sway / duration
                + step,
            up: self.cells.up(part),
        }
    }

    /// The same with static parts joined over disturbances that leave the attitude unchanged.
    fn bridged(&self, all: Vec<Found>) -> Vec<Found> {
        let mut joined: Vec<Found> = Vec::new();
        for found in all {
            match joined.last_mut() {
                Some(last) if self.is_disturbance(last, &found) => last.parts.extend(found.parts),
                _ => joined.push(found),
            }
        }
        for found in &mut joined {
            self.strip(found);
        }
        joined
    }

    /// Removes short parts at the ends of joined parts if their means differ: a motion that begins or ends slowly resembles a
    /// disturbance and a static part.
    fn strip(&self, found: &mut Found) {
        let cells = &self.cells;
        let Some(main) = found.parts.iter().max_by_key(|part| part.len()).cloned() else { return };
        let short = |part: &Range<usize>| cells.duration(part) < LONGEST_END && *part != main;
        let most = 10 * cells.window;
        while let Some(last) = found.parts.last()
            && last.end < cells.len()
            && short(last)
            && self.is_off(last, &(main.end.saturating_sub(most).max(main.start)..main.end))
        {
            found.parts.pop();
        }
        while let Some(first) = found.parts.first()
            && first.start > 0
            && short(first)
            && self.is_off(first, &(main.start..(main.start + most).min(main.end)))
        {
            found.parts.remove(0);
        }
    }

    /// Whether the IMU was disturbed between two spans and is at the same attitude afterwards.
    fn is_disturbance(&self, before: &Found, after: &Found) -> bool {
        if before.why.is_some() || after.why.is_some() {
            return false;
        }
        let cells = &self.cells;
        let [Some(first), Some(last), Some(next)] =
            [before.parts.first(), before.parts.last(), after.parts.first()]
        else {
            return false;
        };
        let gap = last.end..next.start;
        let lasting = cells.duration(&gap);
        let stands = self
            .table
            .as_ref()
            .is_none_or(|table| gap.clone().all(|cell| table[cell] || cells.cells[cell].gap));
        if !stands || lasting > self.options.longest_disturbance {
            return false;
        }
        // The mean over nearby cells, because a bias drifts.
        let near = |part: &Range<usize>, at_end: bool| {
            let size = part.len().min(10 * cells.window);
            if at_end { part.end - size..part.end } else { part.start..part.start + size }
        };
        let (last, next) = (near(last, true), near(next, false));
        let rate = (cells.rate(&last) + cells.rate(&next)) / 2.0;
        let force = (cells.force(&last) + cells.force(&next)) / 2.0;
        let [angle, velocity] = cells.excursion(&gap, rate, force);
        let known = cells.duration(&last).min(cells.duration(&next));
        let by_noise =
            SIGMAS * (self.noise.rate(known) * lasting + self.noise.rate(lasting) * lasting);
        let sway = self.options.largest_sway;
        let first = near(first, false);
        let up = |part: &Range<usize>| {
            let noise = SIGMAS * self.noise.force(cells.duration(part)) / force.norm().max(1e-9);
            (cells.up(part), noise)
        };
        let (up_first, noise_first) = up(&first);
        let (up_next, noise_next) = up(&next);
        angle <= sway + by_noise
            && velocity <= LARGEST_VELOCITY + force.norm() * sway * lasting
            && up_first.angle(&up_next) <= sway + noise_first + noise_next
    }

    fn interval(&self, found: &Found) -> Option<StaticInterval> {
        let (first, last) = (found.parts.first()?, found.parts.last()?);
        let run = first.start..last.end;
        let shortest = self.options.shortest;
        let lasting = self.cells.duration(&run);
        let short = lasting < shortest * (1.0 - 1e-9);
        if lasting < REPORTED * shortest || short && found.why.is_some() {
            return None;
        }
        let disturbances = found
            .parts
            .windows(2)
            .filter(|pair| pair[0].end < pair[1].start)
            .map(|pair| self.cells.samples(&(pair[0].end..pair[1].start)))
            .collect();
        let why = found.why.or_else(|| short.then_some(NotStatic::TooShort { shortest }));
        Some(self.of_samples(self.cells.samples(&run), why, false, disturbances))
    }

    pub(super) fn of_samples(
        &self,
        span: Range<usize>,
        why: Option<NotStatic>,
        stated: bool,
        disturbances: Vec<Range<usize>>,
    ) -> StaticInterval {
        let recording = self.recording;
        let first = recording.increments[span.start].interval;
        let start = recording.times[span.start] - first;
        // If a log starts at zero, so does the interval, regardless of the rounding of its times.
        let start = if start.abs() < 1e-6 * first { 0.0 } else { start };
        let end = recording.times[span.end - 1];
        StaticInterval { span, start, end, why, stated, disturbances }
    }
}
