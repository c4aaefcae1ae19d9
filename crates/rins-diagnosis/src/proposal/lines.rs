//! Lines that are faster than an epoch, sample by sample.

use rins_bayes::ln_tail;
use rins_estimation::{Fit, Run};
use rins_terms::{SettingKind, TermInstance, catalogue};

use crate::case::Case;
use crate::criticism::noise::estimate;
use crate::criticism::residuals::{ABOUT_AXIS, beyond, in_axis_frame};
use crate::criticism::structure::CHANNELS;
use crate::diagnosis::FALSE_ALARMS;
use crate::proposal::sinusoid::{Series, Sinusoid, sinusoid};
use crate::proposal::spectrum::{Peak, Spectrum, highest};
use crate::verdict::cause::{Cause, Rival};

/// A line of a sensor and a sway of the base are distinguished if their log-odds differ by more than this: the less probable one has less
/// than 2 %.
const RIVALS: f64 = 4.0;

/// The part of the false alarms that fast lines may cause: they are one effect of many.
const SHARE: f64 = 0.1;

/// A run hardly tells lines apart that differ by fewer cycles over it.
const BESIDE: f64 = 4.0;

/// The most fast lines that are looked for in a run.
const MOST: usize = 4;

/// A table moves at a line's frequency if a sine of its rate raises the likelihood by so many e-folds.
const MOVES: f64 = 12.0;

/// Where a line is looked for: on each sensor, and on the base.
const PLACES: f64 = CHANNELS as f64 + 1.0;

/// A line that is faster than an epoch, with its amplitudes.
pub(crate) type FastLine = (TermInstance, Cause);

impl Case<'_> {
    /// Lines that are faster than an epoch shows, with their amplitudes.
    pub(crate) fn fast_lines(&self, fit: &Fit) -> Vec<FastLine> {
        let tests = (PLACES * self.runs.len() as f64).ln();
        let mut found: Vec<FastLine> = Vec::new();
        for (run, recorded) in self.runs.iter().enumerate() {
            let earlier = found.len();
            let mut model = fit.models[run].clone();
            while found.len() < earlier + MOST {
                let track = fit.linear[run].track();
                let mut of_sensors = beyond(recorded, track, &model);
                // Rounding makes lines that are not there.
                for (channel, values) in of_sensors.iter_mut().enumerate() {
                    if self.rounding.is_coarse(run, channel) {
                        values.fill(0.0);
                    }
                }
                let readings = Readings {
                    of_sensors,
                    run: recorded,
                    slowest: 0.5 / fit.linear[run].mean_epoch(),
                };
                let of_base = in_axis_frame(track, &readings.of_sensors);
                let Some(line) = readings.strongest(&of_base) else { break };
                let ln_p = line.peak.ln_p + tests;
                if ln_p > (SHARE * FALSE_ALARMS).ln() {
                    break;
                }
                let Some((chosen, cause)) = readings.named(&line, &of_base, run, ln_p) else {
                    break;
                };
                // What stands beside it is seen when it is gone.
                model.terms.push(chosen.clone());
                found.push((chosen, cause));
            }
        }
        found.sort_by(|a, b| a.1.ln_p.total_cmp(&b.1.ln_p));
        found
    }

    /// Those of some effects that are lines faster than an epoch shows, with their amplitudes in each run, and the others, which
    /// are those too that have no amplitude by themselves.
    pub(crate) fn supposed_lines(
        &self,
        fit: &Fit,
        supposed: &[TermInstance],
    ) -> (Vec<FastLine>, Vec<TermInstance>) {
        let slowest = |run: usize| 0.5 / fit.linear[run].mean_epoch();
        let fast = |one: &TermInstance| {
            let frequency = one.setting(SettingKind::Frequency)?;
            let is_fast = (0..self.runs.len()).all(|run| frequency > slowest(run));
            place_of(one).filter(|_| is_fast).map(|place| (place, frequency))
        };
        let mut readings = Vec::new();
        if supposed.iter().any(|one| fast(one).is_some()) {
            for (run, recorded) in self.runs.iter().enumerate() {
                let track = fit.linear[run].track();
                let of_sensors = beyond(recorded, track, &fit.models[run]);
                let of_base = in_axis_frame(track, &of_sensors);
                let of_run = Readings { of_sensors, run: recorded, slowest: slowest(run) };
                readings.push((of_run, of_base));
            }
        }
        let (mut found, mut others) = (Vec::new(), Vec::new());
        for one in supposed {
            let measured = fast(one).and_then(|(place, frequency)| {
                let of_run = |(run, (readings, of_base)): (usize, &(Readings<'_>, _))| {
                    let peak = Peak { frequency, ratio: 0.0, ln_p: 0.0 };
                    let line = Line { place, peak, rival: None };
                    let (chosen, cause) = readings.named(&line, of_base, run, 0.0)?;
                    let ln_p = ln_tail(2.0 * cause.gain, cause.dof);
                    Some((chosen, Cause { ln_p, ..cause }))
                };
                readings.iter().enumerate().map(of_run).collect::<Option<Vec<FastLine>>>()
            });
            match measured {
                Some(lines) => found.extend(lines),
                None => others.push(one.clone()),
            }
        }
        (found, others)
    }

    /// These lines, those first at whose frequency the table moves: what is wrong about its motion, a delay or a lever arm,
    /// is a line there too.
    pub(crate) fn by_motion(&self, fit: &Fit, lines: Vec<FastLine>) -> [Vec<FastLine>; 2] {
        if lines.is_empty() {
            return Default::default();
        }
        let runs = self.runs.iter().zip(&fit.linear);
        let motions: Vec<Motion<'_>> = runs
            .map(|(run, linear)| {
                let rates = linear.track().moments().map(|at| at.mean.rate).collect();
                Motion::of(run, rates, linear.mean_epoch())
            })
            .collect();
        let is_of_motion =
            |(line, _): &FastLine| motions.iter().any(|motion| motion.is_at(line.settings[0]));
        lines.into_iter().partition(is_of_motion).into()
    }

    /// Those of some fast lines that would be found beside what else a model holds by now.
    pub(crate) fn still_there(&self, fit: &Fit, lines: &[FastLine]) -> Vec<FastLine> {
        let mut without = fit.clone();
        for model in &mut without.models {
            // Another may do no more than take back a line that is none.
            model.terms.retain(|term| !lines.iter().any(|(line, _)| self.is_beside(line, term)));
        }
        let again = if lines.is_empty() { Vec::new() } else { self.fast_lines(&without) };
        let is_there = |(line, _): &&FastLine| {
            again.iter().any(|(other, _)| {
                let apart = other.settings[0] - line.settings[0];
                let alike = other.term.is(line.term) && other.settings[1..] == line.settings[1..];
                alike && apart.abs() * self.duration() < 1.0
            })
        };
        lines.iter().filter(is_there).cloned().collect()
    }

    /// Whether a run hardly tells one line from another.
    fn is_beside(&self, line: &TermInstance, other: &TermInstance) -> bool {
        other.term.is(line.term)
            && other.settings[1..] == line.settings[1..]
            && (other.settings[0] - line.settings[0]).abs() * self.duration() < BESIDE
    }
}

/// How a table moved in a run.
struct Motion<'a> {
    run: &'a Run,
    rates: Vec<f64>,
    spectrum: Option<Spectrum>,
    middles: Vec<Option<f64>>,
}

impl<'a> Motion<'a> {
    fn of(run: &'a Run, rates: Vec<f64>, epoch: f64) -> Self {
        let spectrum = Spectrum::of(&rates, run.recording.mean_interval(), 0.5 / epoch);
        Self { run, rates, spectrum, middles: middles(run) }
    }

    /// Whether it moved at a frequency \[Hz\].
    fn is_at(&self, frequency: f64) -> bool {
        let Some(spectrum) = &self.spectrum else { return false };
        let series = Series { values: &self.rates, noise: spectrum.noise_at(frequency) };
        let interval = self.run.recording.mean_interval();
        let sine = sinusoid(&[series], &self.middles, interval, frequency);
        sine.is_some_and(|sine| sine.gain > MOVES)
    }
}

/// What a line is of.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Place {
    /// The sensors of this axis of the body.
    Axis(usize),
    /// The base, which sways.
    Base,
}

/// A line that stands over the noise.
struct Line {
    place: Place,
    peak: Peak,
    /// What it may be as well, with the logarithm of the odds.
    rival: Option<(Place, f64)>,
}

/// What the sensors of a run read beyond a model.
struct Readings<'a> {
    of_sensors: [Vec<f64>; CHANNELS],
    run: &'a Run,
    /// The lowest frequency of which an epoch shows nothing \[Hz\].
    slowest: f64,
}

impl Readings<'_> {
    fn spectrum(&self, series: &[f64]) -> Option<Spectrum> {
        Spectrum::of(series, self.run.recording.mean_interval(), self.slowest)
    }

    /// The most significant line of a sensor, or of the base.
    ///
    /// What sways with the base is one line of the gyros across the axis in the axis frame, and two in the body of a table
    /// that turns; what is in the body is it the other way. The frame in which both gyros show more has it, and the body if
    /// they show the same: a table that stands still does not tell.
    fn strongest(&self, of_base: &[Vec<f64>; 2]) -> Option<Line> {
        let spectra = self.of_sensors.each_ref().map(|series| self.spectrum(series));
        let together = |[x, y]: [&Option<Spectrum>; 2]| highest(&[x.as_ref()?, y.as_ref()?]);
        let [x, y] = of_base.each_ref().map(|series| self.spectrum(series));
        let base = together([&x, &y]);
        let body = together([&spectra[0], &spectra[1]]);
        let more = base.as_ref().zip(body).map(|(base, body)| base.ratio - body.ratio);
        let mut lines: Vec<Line> = Vec::new();
        for (channel, spectrum) in spectra.iter().enumerate() {
            let Some(peak) = spectrum.as_ref().and_then(|one| highest(&[one])) else { continue };
            let across = channel < 2;
            if across && more.is_some_and(|more| more > RIVALS) {
                continue;
            }
            let near = |more: &f64| across && *more > -RIVALS;
            let rival = more.filter(near).map(|more| (Place::Base, more.min(0.0)));
            lines.push(Line { place: Place::Axis(channel % 3), peak, rival });
        }
        if let Some(peak) = base.filter(|_| more.is_some_and(|more| more > RIVALS)) {
            lines.push(Line { place: Place::Base, peak, rival: None });
        }
        lines.into_iter().min_by(|a, b| a.peak.ln_p.total_cmp(&b.peak.ln_p))
    }

    /// A line as its effect, with all that has its frequency there.
    fn named(
        &self,
        line: &Line,
        of_base: &[Vec<f64>; 2],
        run: usize,
        ln_p: f64,
    ) -> Option<FastLine> {
        let frequency = line.peak.frequency;
        let shown = match line.place {
            // The gyro about the axis is the same in the body and in the axis frame.
            Place::Base => vec![&of_base[0], &of_base[1], &self.of_sensors[ABOUT_AXIS]],
            Place::Axis(axis) => vec![&self.of_sensors[axis], &self.of_sensors[3 + axis]],
        };
        // A sensor of which nothing is known has no noise.
        let with_noise = |(which, values): (usize, &&Vec<f64>)| {
            Some((which, self.spectrum(values)?.noise_at(frequency)))
        };
        let known: Vec<(usize, f64)> = shown.iter().enumerate().filter_map(with_noise).collect();
        let series: Vec<Series<'_>> =
            known.iter().map(|&(which, noise)| Series { values: shown[which], noise }).collect();
        let fitted =
            sinusoid(&series, &middles(self.run), self.run.recording.mean_interval(), frequency)?;
        let mut chosen = effect(line.place, fitted.frequency);
        let mut parameters = Vec::new();
        for (&(which, _), amplitudes) in known.iter().zip(amplitudes(line.place, &fitted)) {
            for (place, (value, sigma)) in (2 * which..).zip(amplitudes) {
                chosen.values[place] = value;
                parameters.push(estimate(chosen.term, place, Some(run), value, sigma));
            }
        }
        let rival = line.rival.map(|(place, odds)| {
            let other = effect(place, fitted.frequency);
            Rival { term: other.term, settings: other.settings, odds }
        });
        let cause = Cause {
            term: chosen.term,
            settings: chosen.settings.clone(),
            sought: Some((0, fitted.sigma)),
            dof: parameters.len(),
            parameters,
            ln_p,
            gain: fitted.gain,
            rivals: rival.into_iter().collect(),
        };
        Some((chosen, cause))
    }
}

/// The middle of each sample since the run's start \[s\]; none where one is held for others.
fn middles(run: &Run) -> Vec<Option<f64>> {
    let recording = &run.recording;
    let start = recording.times[0] - recording.increments[0].interval;
    let longest = recording.longest_interval();
    let samples = recording.times.iter().zip(&recording.increments);
    let middle = samples.map(|(time, sample)| {
        (sample.interval <= longest).then_some(time - 0.5 * sample.interval - start)
    });
    middle.collect()
}

/// Where an effect is a line.
fn place_of(line: &TermInstance) -> Option<Place> {
    if line.term.is(&catalogue::BASE_SWAY) {
        return Some(Place::Base);
    }
    let axis = line.setting(SettingKind::Axis)?;
    [1.0, 2.0, 3.0].iter().position(|other| (axis - other).abs() < 0.5).map(Place::Axis)
}

/// The effect that a line is.
fn effect(place: Place, frequency: f64) -> TermInstance {
    match place {
        Place::Base => {
            TermInstance::new(&catalogue::BASE_SWAY).with_setting(SettingKind::Frequency, frequency)
        }
        Place::Axis(axis) => TermInstance::new(&catalogue::INTERFERENCE_LINE)
            .with_setting(SettingKind::Frequency, frequency)
            .with_setting(SettingKind::Axis, [1.0, 2.0, 3.0][axis]),
    }
}

/// The effect's own amplitudes: gyros show the rate at which a base sways, `2πf (s cos - c sin)`.
fn amplitudes(place: Place, fitted: &Sinusoid) -> Vec<[(f64, f64); 2]> {
    let per_rate = (std::f64::consts::TAU * fitted.frequency).recip();
    let of_pair = |&[cos, sin]: &[(f64, f64); 2]| match place {
        Place::Axis(_) => [cos, sin],
        Place::Base => {
            [(-sin.0 * per_rate, sin.1 * per_rate), (cos.0 * per_rate, cos.1 * per_rate)]
        }
    };
    fitted.amplitudes.iter().map(of_pair).collect()
}
