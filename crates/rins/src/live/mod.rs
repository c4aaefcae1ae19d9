//! Calibration of a log while it is written.

mod checkpoint;
mod outcome;
mod parameter;
mod result;

use std::path::Path;

use anyhow::Context;
use rins_calibration::CalibrationError;
use rins_estimation::{OnlineFilter, OnlineSample, OnlineSetup};
use rins_frames::SignedAxes;
use rins_io::{InputFile, LiveLog, Loaded, Rig, shown};
use rins_motion::Recording;
use rins_report::number::{decimal, estimate as written};
use rins_terms::{Model, Role};

pub use self::parameter::LiveParameterResult;
use self::parameter::parameters;
pub use self::result::LiveResult;
use crate::basis::BasisResult;
use crate::error::Result;
use crate::log::Log;
use crate::options::{ModelChoice, NamedModel, NoiseChoice};
use crate::preparation::{EstimationProblem, Prepared};

/// The time from which the attitude of the axis and the checks of units, signs and axes are derived, unless another is stated
/// \[s\].
const START: f64 = 10.0;

/// The largest number of parameters in a line.
const IN_A_LINE: usize = 4;

/// What a live calibration is asked for.
#[derive(Clone, Debug)]
pub struct LiveOptions {
    /// The model: that of all of eq. (1), or that of a model file.
    pub model: ModelChoice,
    /// The expected duration of the run \[s\]; the duration of an epoch follows from it as for a finished run. By default an epoch lasts
    /// 0.1 s.
    pub duration: Option<f64>,
    /// The duration of the samples at the start from which the attitude of the axis is found, unless it is stated, and which are
    /// checked for mistakes of units, signs and axes \[s\].
    pub start: f64,
}

impl Default for LiveOptions {
    fn default() -> Self {
        Self { model: ModelChoice::Full, duration: None, start: START }
    }
}

/// Why the log of a live calibration ended.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub enum LiveEnd {
    /// Its source was closed.
    #[default]
    Closed,
    /// No row came for a time.
    Idle,
    /// The user interrupted it.
    Interrupted,
}

/// The calibration of a log while it is written: bytes in, estimates out.
///
/// ```
/// use rins::live::{LiveCalibration, LiveEnd, LiveOptions};
/// use rins::Outcome;
/// let folder = tempfile::tempdir()?;
/// let log = rins::demo::log(folder.path())?;
/// let mut live = LiveCalibration::new(&log.loaded.rig.path, None, LiveOptions::default())?;
/// for part in std::fs::read(&log.loaded.rig.log.path)?.chunks(1 << 16) {
///     live.feed(part)?;
/// }
/// let outcome = live.end(LiveEnd::Closed)?;
/// let scale = outcome.result().parameters.into_iter().find(|one| one.id == "gyro.scale.z").unwrap();
/// assert!(scale.identified);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug)]
pub struct LiveCalibration {
    name: String,
    model: String,
    options: LiveOptions,
    log: LiveLog,
    /// The samples before the filter exists.
    start: Recording,
    /// Their duration \[s\].
    duration: f64,
    /// The duration of these samples from which the filter is prepared \[s\].
    needed: f64,
    filter: Option<OnlineFilter>,
    /// The samples up to this time have been processed before \[s\].
    resumed: Option<f64>,
    axes: SignedAxes,
    /// The ids of the parameters of which the model states what is known.
    stated: Vec<String>,
    notes: Vec<String>,
    basis: BasisResult,
}

/// A live calibration at its end.
#[derive(Debug)]
pub struct LiveOutcome {
    pub(crate) name: String,
    pub(crate) model: String,
    pub(crate) filter: OnlineFilter,
    pub(crate) axes: SignedAxes,
    pub(crate) stated: Vec<String>,
    pub(crate) end: LiveEnd,
    pub(crate) notes: Vec<String>,
    pub(crate) basis: BasisResult,
}

impl LiveOutcome {
    /// The filter at its end.
    pub const fn filter(&self) -> &OnlineFilter {
        &self.filter
    }
}

impl LiveCalibration {
    /// A calibration of the log of a rig file, before its first byte. Messages name the log by its path, or by `source` if it is
    /// something else.
    ///
    /// # Errors
    /// If the rig file cannot be read or has an invalid value, or if its log cannot be read while it is written.
    pub fn new(rig: &Path, source: Option<&Path>, options: LiveOptions) -> Result<Self> {
        Ok(Self::opened(rig, source, options)?)
    }

    fn opened(path: &Path, source: Option<&Path>, options: LiveOptions) -> anyhow::Result<Self> {
        let rig = Rig::read(path)?;
        anyhow::ensure!(
            options.model != ModelChoice::Paper12,
            "the paper's filter takes a finished log; full takes a live one"
        );
        let basis = BasisResult::of_rig(&rig, vec![InputFile::of(path)?]);
        let axes = rig.spin.into();
        let source = source.unwrap_or(&rig.log.path).to_path_buf();
        let named = NamedModel::of(&options.model, &rig.spin)?;
        Ok(Self {
            name: shown(path),
            stated: stated(&named.model),
            model: named.name,
            log: LiveLog::new(rig, &source)?,
            needed: options.start,
            options,
            start: Recording::default(),
            duration: 0.0,
            filter: None,
            resumed: None,
            axes,
            notes: Vec::new(),
            basis,
        })
    }

    /// Takes the next bytes of the log, and returns the number of samples that they complete.
    ///
    /// # Errors
    /// If a row cannot be read, with its line; the samples before it have been processed. If units, signs or axes are mistaken, or
    /// the filter failed.
    pub fn feed(&mut self, bytes: &[u8]) -> Result<usize> {
        let recording = self.log.feed(bytes)?;
        Ok(self.take(&recording)?)
    }

    fn take(&mut self, recording: &Recording) -> anyhow::Result<usize> {
        let count = recording.len();
        // The filter is prepared from the same samples however the bytes are divided.
        let mut first = 0;
        while self.filter.is_none() && first < count {
            let mut end = first;
            while self.duration < self.needed && end < count {
                self.duration += recording.increments[end].interval;
                end += 1;
            }
            append(&mut self.start, recording.slice(first, end));
            first = end;
            if self.duration < self.needed {
                break;
            }
            let start = self.start.clone();
            match self.begin() {
                Err(error) if is_static_so_far(&error) => {
                    (self.start, self.needed) = (start, 2.0 * self.needed);
                }
                begun => begun?,
            }
        }
        self.push(recording, first)?;
        Ok(count)
    }

    /// Prepares the filter from the samples at the start, and processes them.
    fn begin(&mut self) -> anyhow::Result<()> {
        let start = std::mem::take(&mut self.start);
        let loaded = Loaded::of_live(&self.log, start.clone())?;
        let log = Log { name: self.name.clone(), loaded, inputs: Vec::new() };
        let named = NamedModel::of(&self.options.model, &self.log.rig().spin)?;
        let prepared = Prepared::of(log, NoiseChoice::Given)?;
        let problem = EstimationProblem::of(vec![prepared], named, NoiseChoice::Given)?;
        let EstimationProblem { runs, model, remarks, .. } = problem;
        let prepared = &runs[0];
        let interval = self.log.nominal_interval().unwrap_or_else(|| start.mean_interval());
        let mut setup = OnlineSetup::new(prepared.run.rig, model, prepared.imu, interval);
        setup.angle_steps = prepared.run.angle_steps;
        if let Some(duration) = self.options.duration {
            setup = setup.lasting(duration);
        }
        self.notes = remarks;
        let assumptions = &prepared.basis.assumptions;
        self.basis = self.basis.clone().assuming(assumptions.iter().cloned());
        self.filter = Some(OnlineFilter::new(setup)?);
        self.push(&start, 0)
    }

    /// Processes the samples from number `first` on.
    fn push(&mut self, recording: &Recording, first: usize) -> anyhow::Result<()> {
        let Some(filter) = &mut self.filter else { return Ok(()) };
        let reading = recording.table_angle.as_ref().or(recording.table_rate.as_ref());
        for (sample, (&time, &increments)) in
            recording.times.iter().zip(&recording.increments).enumerate().skip(first)
        {
            if self.resumed.is_some_and(|resumed| time <= resumed) {
                continue;
            }
            let table = reading.map(|reading| reading[sample]);
            filter.push(&OnlineSample { time, increments, table })?;
        }
        Ok(())
    }

    /// The filter, once the samples at the start are there.
    pub const fn filter(&self) -> Option<&OnlineFilter> {
        self.filter.as_ref()
    }

    /// The estimates so far, once the samples at the start are there.
    pub fn parameters(&self) -> Option<Vec<LiveParameterResult>> {
        self.filter.as_ref().map(|filter| parameters(filter, &self.axes))
    }

    /// The state in a line: the time, the number of identified parameters, and those of them whose sigmas are smallest relative to
    /// their priors.
    pub fn line(&self) -> String {
        let Some(filter) = &self.filter else {
            return format!("{} samples of the start", self.start.len());
        };
        let all = parameters(filter, &self.axes);
        let mut identified: Vec<&LiveParameterResult> =
            all.iter().filter(|one| one.identified).collect();
        identified.sort_by(|a, b| (a.sigma / a.prior_sigma).total_cmp(&(b.sigma / b.prior_sigma)));
        let told = identified.iter().take(IN_A_LINE).map(|one| {
            let (value, sigma) = written(one.value, one.sigma);
            format!("  {} {value} ± {sigma} {}", one.id, one.unit)
        });
        format!(
            "{:>9} s  {} of {} identified{}",
            decimal(filter.time().unwrap_or_default(), 1),
            identified.len(),
            all.len(),
            told.collect::<String>()
        )
    }

    /// Ends the calibration with the rows that are there.
    ///
    /// # Errors
    /// If the last rows cannot be read, or if there are too few.
    pub fn end(mut self, end: LiveEnd) -> Result<LiveOutcome> {
        let recording = self.log.end()?;
        self.take(&recording)?;
        if self.filter.is_none() {
            self.begin()?;
        }
        Ok(self.ended(end)?)
    }

    fn ended(self, end: LiveEnd) -> anyhow::Result<LiveOutcome> {
        let Self { name, model, filter, axes, stated, notes, basis, .. } = self;
        let filter = filter.context("the log has no samples")?.finish()?;
        Ok(LiveOutcome { name, model, filter, axes, stated, end, notes, basis })
    }
}

/// The ids of the parameters of which a model states what is known.
fn stated(model: &Model) -> Vec<String> {
    let is_stated = |(term, parameter): (usize, usize)| {
        matches!(model.terms[term].roles[parameter], Role::Within(_))
    };
    let all = model.ids().zip(model.places());
    all.filter(|(_, place)| is_stated(*place)).map(|(id, _)| id).collect()
}

/// Whether the attitude of the axis needs samples of a rotation that has not begun yet.
fn is_static_so_far(error: &anyhow::Error) -> bool {
    use CalibrationError::{NoTurn, TooShort};
    matches!(error.downcast_ref(), Some(TooShort { .. } | NoTurn { .. }))
}

/// Appends samples to a recording.
fn append(to: &mut Recording, more: Recording) {
    to.times.extend(more.times);
    to.increments.extend(more.increments);
    let lists = [(&mut to.table_angle, more.table_angle), (&mut to.table_rate, more.table_rate)];
    for (to, more) in lists {
        if let Some(more) = more {
            to.get_or_insert_default().extend(more);
        }
    }
}
