//! When an IMU is stationary: one search for all that needs static intervals.
//!
//! The search goes from the inside out. The log is cut into cells of a tenth of a second. Cells that scatter no more than
//! the quietest parts of the log form runs; a run is split where its mean rate changes; gravity must keep its direction in
//! the body over each part, and what only the mean rate shows, a turn about the vertical, is judged by the size of biases
//! and by the other parts of the log. Ends are then trimmed to noise, and parts joined over disturbances that leave the
//! attitude as it was.

mod bias;
mod cells;
mod drift;
mod noise;
mod options;
mod split;
mod table;

use std::fmt;
use std::ops::Range;

use nalgebra::Vector3;
use rins_frames::units::{DEG, DEG_PER_SECOND};

pub use options::{SensorFigures, StaticOptions};

use self::bias::{Piece, turning};
use self::cells::Cells;
use self::noise::{Limits, Noise};
use self::split::{SIGMAS, coarse_step};
use crate::recording::Recording;

/// A cell at the end of an interval that is so many sigma off its mean belongs to the motion that follows: of a thousand
/// ends a few lose a cell by chance.
const END_SIGMAS: f64 = 4.0;

/// An end loses so many cells at most \[s\].
const LONGEST_END: f64 = 1.0;

/// What a base does without being moved, below which the ends of intervals are not trimmed \[rad/s\].
const END_RATE: f64 = 0.002 * DEG_PER_SECOND;

/// The same of accelerometers \[m/s²\].
const END_FORCE: f64 = 1e-3;

/// How often the noise is estimated anew from what it splits the log into.
const NOISE_PASSES: usize = 2;

/// A disturbance changes the velocity of a stationary IMU by so much at most \[m/s\], as accelerometers read a knock whose
/// peaks they cut off: more is a hand that slides it.
const LARGEST_VELOCITY: f64 = 0.2;

/// The direction of gravity is judged over so much of a span, at most \[s\].
const DIRECTION: f64 = 1.0;

/// Of a span the direction of gravity is taken in so many windows at least.
const FEWEST_DIRECTIONS: usize = 20;

/// What is shorter than this share of the shortest interval is not reported.
const REPORTED: f64 = 0.5;

/// Why a span is not a static interval.
#[derive(Clone, Copy, Debug, PartialEq)]
#[non_exhaustive]
pub enum NotStatic {
    /// It is short.
    TooShort {
        /// How long it must be \[s\].
        shortest: f64,
    },
    /// Gravity changes its direction in the body.
    GravityTurns {
        /// How far, from one end to the other or the farthest \[rad\].
        angle: f64,
    },
    /// The gyros turn and turn back.
    Rotates {
        /// How far, the mean rate removed \[rad\].
        angle: f64,
    },
    /// The mean rate about the vertical is no bias.
    RateBeyondBias {
        /// The rate \[rad/s\].
        rate: f64,
        /// The largest that is taken for a bias \[rad/s\].
        limit: f64,
        /// Whether the limit follows from the data sheet.
        stated: bool,
    },
    /// The mean rate about the vertical is not that of the other static intervals.
    RateDiffers {
        /// By how much \[rad/s\].
        apart: f64,
        /// By how much it may \[rad/s\].
        allowed: f64,
    },
    /// The table turns.
    TableTurns,
    /// The recording holds no sample of it.
    NoSamples,
}

impl fmt::Display for NotStatic {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let rate = |rate: f64| rate / DEG_PER_SECOND;
        match *self {
            Self::TooShort { shortest } => write!(f, "shorter than {shortest:.1} s"),
            Self::GravityTurns { angle } => {
                write!(f, "moves: gravity turns in the body by {:.2} deg", angle / DEG)
            }
            Self::Rotates { angle } => {
                write!(f, "moves: the gyros, their mean removed, turn by {:.2} deg", angle / DEG)
            }
            Self::RateBeyondBias { rate: seen, limit, stated } => write!(
                f,
                "moves: {:.3} deg/s about the vertical, where {} allows a bias of {:.3} deg/s",
                rate(seen),
                if stated { "bias_sigma" } else { "the assumption made without a bias_sigma" },
                rate(limit)
            ),
            Self::RateDiffers { apart, allowed } => write!(
                f,
                "moves: the rate about the vertical differs from the other static intervals' by {:.4} deg/s, and {:.4} \
                 deg/s are allowed",
                rate(apart),
                rate(allowed)
            ),
            Self::TableTurns => write!(f, "moves: the table turns"),
            Self::NoSamples => write!(f, "holds no samples"),
        }
    }
}

/// A span that was taken for a static interval or looked like one.
#[derive(Clone, Debug, PartialEq)]
pub struct StaticInterval {
    /// The samples.
    pub span: Range<usize>,
    /// When the first sample's interval starts \[s\].
    pub start: f64,
    /// When the last one's ends \[s\].
    pub end: f64,
    /// Why it is none, if it is none; of a stated interval, what contradicts the statement.
    pub why: Option<NotStatic>,
    /// Whether the user states it.
    pub stated: bool,
    /// The samples in it during which something disturbed the IMU, or nothing was measured; the attitude is the same after
    /// each.
    pub disturbances: Vec<Range<usize>>,
}

impl StaticInterval {
    /// Whether it is used: what is found is static, and what is stated is believed.
    pub const fn used(&self) -> bool {
        self.stated || self.why.is_none()
    }

    /// How long it lasts \[s\].
    pub fn duration(&self) -> f64 {
        self.end - self.start
    }

    /// What a reader must know of it: why it is not used, or what speaks against it or disturbs it.
    pub fn remark(&self) -> Option<String> {
        match (&self.why, self.stated, self.disturbances.len()) {
            (Some(why), true, _) => Some(format!("stated as static, but it {why}")),
            (Some(why), false, _) => Some(why.to_string()),
            (None, _, 0) => None,
            (None, _, count) => Some(format!(
                "bridged over {count} disturbance(s) or gap(s) that leave the attitude unchanged"
            )),
        }
    }
}

/// The static intervals of a recording.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct StaticIntervals {
    /// Those that are used and those that look like one and are none, in order of time.
    pub all: Vec<StaticInterval>,
}

impl StaticIntervals {
    /// Those that the user states or, if none is stated, those that the samples show.
    ///
    /// ```
    /// use rins_frames::{InFrame, Rates};
    /// use rins_motion::{Recording, StaticIntervals, StaticOptions};
    /// let still = Rates { angular_rate: InFrame::new(0.0, 0.0, 0.01), specific_force: InFrame::new(0.0, 0.0, 9.8) };
    /// let turning = Rates { angular_rate: InFrame::new(0.0, 0.0, 0.5), ..still };
    /// let increments = [still, turning].map(|rates| vec![rates.over(0.01); 300]).concat();
    /// let times = (1..=increments.len()).map(|count| 0.01 * count as f64).collect();
    /// let recording = Recording { times, increments, ..Recording::default() };
    /// let found = StaticIntervals::of(&recording, &StaticOptions::default());
    /// assert_eq!(found.spans(2.0), [0..300]);
    /// ```
    pub fn of(recording: &Recording, options: &StaticOptions) -> Self {
        if recording.is_empty() {
            return Self::default();
        }
        let search = Search::new(recording, options);
        let all = if options.stated.is_empty() { search.found() } else { search.stated() };
        Self { all }
    }

    /// Those that are used.
    pub fn used(&self) -> impl Iterator<Item = &StaticInterval> {
        self.all.iter().filter(|interval| interval.used())
    }

    /// The samples of those that are used and last as long as `shortest` \[s\].
    pub fn spans(&self, shortest: f64) -> Vec<Range<usize>> {
        let long = |interval: &&StaticInterval| interval.duration() >= shortest * (1.0 - 1e-9);
        self.used().filter(long).map(|interval| interval.span.clone()).collect()
    }

    /// The longest that is used.
    pub fn longest(&self) -> Option<&StaticInterval> {
        self.used().max_by(|a, b| a.duration().total_cmp(&b.duration()))
    }
}

/// What an interval is searched in.
struct Search<'r> {
    recording: &'r Recording,
    options: &'r StaticOptions,
    cells: Cells,
    /// Which cells the table stands in, if that is known.
    table: Option<Vec<bool>>,
    quiet: Vec<bool>,
    noise: Noise,
}

/// A run of cells, and why it is no static interval.
struct Found {
    /// Its parts, between which it was disturbed.
    parts: Vec<Range<usize>>,
    why: Option<NotStatic>,
}

impl<'r> Search<'r> {
    fn new(recording: &'r Recording, options: &'r StaticOptions) -> Self {
        let cells = Cells::of(recording, options);
        let table = table::stands(recording, &cells);
        let stand = table.clone().unwrap_or_else(|| vec![true; cells.len()]);
        let quiet = Limits::of(&cells, &stand, options).quiet(&cells, &stand);
        let mut noise = Noise::of(&cells, &runs(&quiet));
        if table.is_none() {
            // What moves slowly is as quiet as what is static; it is no noise.
            for _ in 0..NOISE_PASSES {
                let parts = runs(&quiet)
                    .into_iter()
                    .flat_map(|run| split::parts(&cells, run, &noise, options))
                    .collect::<Vec<_>>();
                noise = Noise::of(&cells, &parts);
            }
        }
        Self { recording, options, cells, table, quiet, noise }
    }

    fn found(&self) -> Vec<StaticInterval> {
        let mut all: Vec<Found> = Vec::new();
        for run in runs(&self.quiet) {
            if self.table.is_some() {
                all.push(Found { parts: vec![run], why: None });
                continue;
            }
            for part in split::parts(&self.cells, run, &self.noise, self.options) {
                all.extend(self.still(&self.trimmed(part)));
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

    /// The parts over which gravity keeps its direction, and those over which it does not.
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
            // The last window may be short and was left out.
            windows[part.start].start..if part.end == windows.len() { run.end } else { end }
        };
        let mut found: Vec<Found> =
            parts.iter().map(|part| Found { parts: vec![span(part)], why: None }).collect();
        // What turns so slowly that its parts are still, each a little further, is no static interval either.
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

    /// Whether gravity is elsewhere at the end of a span than at its start.
    fn drifts(&self, run: &Range<usize>) -> Option<NotStatic> {
        let quarter = (run.len() / 4).max(1);
        let (first, last) = (run.start..run.start + quarter, run.end - quarter..run.end);
        let angle = self.cells.up(&first).angle(&self.cells.up(&last));
        let force = self.cells.force(run).norm().max(1e-9);
        let noise = SIGMAS * self.noise.force(self.cells.duration(&first)) * 2.0_f64.sqrt() / force;
        (angle > self.options.largest_sway + noise).then_some(NotStatic::GravityTurns { angle })
    }

    /// A part less what its ends share with the motion before and after.
    fn trimmed(&self, part: Range<usize>) -> Range<usize> {
        let cells = &self.cells;
        // An end reaches in by a second or a quarter, and what lies behind it says what is stationary.
        let second = whole(LONGEST_END * part.len() as f64 / cells.duration(&part));
        let reach = second.min(part.len() / 4);
        let behind = (3 * reach).min(part.len() - reach);
        if reach == 0 {
            return part;
        }
        let off = |cell: usize, inner: &Range<usize>| self.is_off(&(cell..cell + 1), inner);
        let (mut start, mut end) = (part.start, part.end);
        // Nothing moves before and after a log.
        if part.start > 0 {
            let inner = part.start + reach..part.start + behind;
            let last = (part.start..inner.start).rev().find(|cell| off(*cell, &inner));
            start = last.map_or(start, |last| last + 1);
            // Several cells together show a motion that begins too gently for one.
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

    /// Whether the means over some cells are not those over others that are stationary.
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

    fn piece(&self, part: &Range<usize>) -> Piece {
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

    /// Takes off short parts at the ends of what was joined if their means differ: a motion that begins or ends gently
    /// looks like a disturbance and what follows it.
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

    /// Whether between two spans the IMU was disturbed, and is where it was.
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
        // The mean over what is near, for a bias drifts.
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

    fn of_samples(
        &self,
        span: Range<usize>,
        why: Option<NotStatic>,
        stated: bool,
        disturbances: Vec<Range<usize>>,
    ) -> StaticInterval {
        let recording = self.recording;
        let first = recording.increments[span.start].interval;
        let start = recording.times[span.start] - first;
        // Where a log starts at zero, so does the interval, whatever the rounding of its times.
        let start = if start.abs() < 1e-6 * first { 0.0 } else { start };
        let end = recording.times[span.end - 1];
        StaticInterval { span, start, end, why, stated, disturbances }
    }

    /// The intervals that the user states, and what contradicts them.
    fn stated(&self) -> Vec<StaticInterval> {
        let recording = self.recording;
        let slack = 0.5 * self.cells.interval;
        let stated = self.options.stated.iter().map(|&[from, to]| {
            let times = recording.times.iter().zip(&recording.increments);
            let inside =
                |time: f64, interval: f64| time - interval >= from - slack && time <= to + slack;
            let mut samples = times
                .enumerate()
                .filter(|(_, (time, sample))| inside(**time, sample.interval))
                .map(|(index, _)| index);
            let Some(first) = samples.next() else {
                let why = Some(NotStatic::NoSamples);
                return StaticInterval {
                    span: 0..0,
                    start: from,
                    end: to,
                    why,
                    stated: false,
                    disturbances: Vec::new(),
                };
            };
            let span = first..samples.next_back().unwrap_or(first) + 1;
            let why = self.contradiction(&span);
            self.of_samples(span, why, true, Vec::new())
        });
        stated.collect()
    }

    /// What shows that a span is not static.
    fn contradiction(&self, span: &Range<usize>) -> Option<NotStatic> {
        let cells = &self.cells;
        let inside = |cell: usize| {
            let samples = &cells.cells[cell].span;
            samples.start >= span.start && samples.end <= span.end
        };
        let first = (0..cells.len()).find(|cell| inside(*cell))?;
        let end = (first..cells.len()).take_while(|cell| inside(*cell)).last()? + 1;
        let run = first..end;
        if self.table.as_ref().is_some_and(|table| !table[run.clone()].iter().all(|stands| *stands))
        {
            return Some(NotStatic::TableTurns);
        }
        let lasting = cells.duration(&run);
        let sway = self.options.largest_sway;
        let [angle, _] = cells.excursion(&run, cells.rate(&run), cells.force(&run));
        if angle > sway + SIGMAS * self.noise.rate(lasting) * lasting {
            return Some(NotStatic::Rotates { angle });
        }
        let size = (2 * cells.window).min(run.len());
        let start = cells.up(&(run.start..run.start + size));
        let noise = SIGMAS * self.noise.force(cells.duration(&(run.start..run.start + size)))
            / cells.force(&run).norm().max(1e-9);
        let angle = (run.start..=run.end - size)
            .map(|at| cells.up(&(at..at + size)).angle(&start))
            .fold(0.0, f64::max);
        if angle > sway + 2.0 * noise {
            return Some(NotStatic::GravityTurns { angle });
        }
        if self.table.is_some() {
            return None;
        }
        turning(&[self.piece(&run)], self.options).pop().flatten()
    }
}

/// The runs of true.
fn runs(flags: &[bool]) -> Vec<Range<usize>> {
    let mut runs: Vec<Range<usize>> = Vec::new();
    for (index, _) in flags.iter().enumerate().filter(|(_, flag)| **flag) {
        match runs.last_mut() {
            Some(run) if run.end == index => run.end = index + 1,
            _ => runs.push(index..index + 1),
        }
    }
    runs
}

/// A ratio of positive durations as a whole number, one at least.
fn whole(ratio: f64) -> usize {
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "it is positive, and at most the number of samples"
    )]
    let whole = ratio.round() as usize;
    whole.max(1)
}
