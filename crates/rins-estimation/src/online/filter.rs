//! The filter that takes one sample after the other.

use nalgebra::{DVector, SVector};
use rins_frames::Increments;
use rins_imu::Compensation;
use rins_motion::Recording;
use rins_terms::{FreeParameter, Model, Role};

use super::linearized::{Common, Linearized};
use super::normal::Solution;
use super::setup::{OnlineError, OnlineSetup};
use super::window::{EpochSamples, Held, Smoother};
use crate::evidence::Indefinite;
use crate::fit_error::FitError;
use crate::layout::{MOST_PARAMETERS, attitude_of};
use crate::run::Reference;
use crate::step::SHOWN;

/// The run is linearized again if a parameter has moved by more than this part of the sigma of its prior: what is of second order is
/// then four orders of magnitude smaller than the priors.
const MOVED: f64 = 0.02;

/// The run is not linearized again before it has become longer by this factor.
const LONGER: f64 = 1.2;

/// The largest number of samples that are kept for another linearization: three hours at 100 Hz.
const MOST_KEPT: usize = 1 << 20;

/// At the end, the run is linearized again until no parameter moves by more than this number of sigmas, ...
const CONVERGED: f64 = 1e-3;

/// ... but at most this number of times.
const MOST_ITERATIONS: usize = 20;

/// A sample with the reading of the table.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OnlineSample {
    /// The end of its interval \[s\].
    pub time: f64,
    /// The increments of the IMU.
    pub increments: Increments,
    /// The reading of the reference: the unwrapped table angle at the end of the interval \[rad\], or the mean commanded rate
    /// over it \[rad/s\].
    pub table: Option<f64>,
}

/// The update by an epoch.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct OnlineUpdate {
    /// The end of the epoch \[s\].
    pub time: f64,
    /// The whitened innovation: mean attitude about the three axes of the axis frame, and velocity along them.
    pub innovation: SVector<f64, SHOWN>,
}

/// What was processed.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub(super) struct Totals {
    pub(super) samples: usize,
    pub(super) epochs: usize,
}

/// A filter over the samples of a run, as they come.
///
/// The filter has two stages (‹friedland1969›): one for attitude, velocity and colored noise, with the derivatives of
/// its states by the parameters, and the normal equations of the parameters, to which each whitened innovation adds. Model,
/// measurements, noise and priors are those of the batch solution ([`fit`](crate::fit)) with given noise parameters and
/// [the same epochs](crate::Run::in_epochs_of). The table angle is smoothed over the samples beside an epoch instead of the whole run, so
/// that an epoch is processed 8 to 64 samples after its end.
///
/// All epochs are linearized at one point: with a point for each, as in an extended Kalman filter, directions that are
/// unobservable would gain information from the differences of the points. If the estimate moves away from the point, a second
/// filter processes the run again at the estimate, two epochs for each new one, and takes the place of the first when it has
/// caught up. [`OnlineFilter::finish`] repeats this until the estimate is the point.
///
/// # Examples
/// ```
/// use rins_estimation::{OnlineFilter, OnlineSample, OnlineSetup, Reference, Rig};
/// use rins_frames::{Dcm, InFrame, Increments, Site};
/// use rins_imu::{ImuSpec, TriadSpec};
/// use rins_motion::Station;
/// use rins_terms::Model;
///
/// let station = Station::with_normal_gravity(Site { latitude: 0.6, longitude: 0.0, height: 0.0 });
/// let reference = Reference::Encoder { noise: 1e-5 };
/// let rig = Rig { station, nav_from_table: Dcm::identity(), reference, wobble: 1e-6, velocity: 1e-6 };
/// let sheet = |bias| TriadSpec::white(1e-5, bias, 1e-3, 1e-3);
/// let imu = ImuSpec { gyro: sheet(1e-5), accel: sheet(1e-3) };
/// let mut filter = OnlineFilter::new(OnlineSetup::new(rig, Model::full(), imu, 0.01))?;
/// for sample in 1..=100 {
///     let increments = Increments {
///         angle: InFrame::new(0.0, 0.0, 0.0),
///         velocity: InFrame::new(0.0, 0.0, 0.098),
///         interval: 0.01,
///     };
///     filter.push(&OnlineSample { time: 0.01 * f64::from(sample), increments, table: Some(0.0) })?;
///     let _compensated = filter.compensate(&increments);
/// }
/// let resumed = OnlineFilter::resume(&filter.checkpoint())?;
/// assert_eq!(resumed.estimates(), filter.estimates());
/// # Ok::<(), rins_estimation::OnlineError>(())
/// ```
#[derive(Clone, Debug)]
pub struct OnlineFilter {
    pub(super) common: Common,
    pub(super) parameters: Vec<FreeParameter>,
    /// The places of the attitude of the axis among the parameters, if all three angles are free.
    pub(super) attitude: Option<[usize; 3]>,
    /// The samples that are kept: all, or those of the next epoch and beside it.
    pub(super) kept: Vec<Held>,
    /// The epochs of the samples that are kept.
    pub(super) epochs: Vec<EpochSamples>,
    /// Whether all samples are kept, so that the run can be linearized again.
    pub(super) is_complete: bool,
    /// The first sample after the last gap, and the first sample of the next epoch, as indices of those that are kept.
    pub(super) start: usize,
    pub(super) next: usize,
    pub(super) main: Linearized,
    pub(super) again: Option<Linearized>,
    /// The number of epochs when the latest point of linearization was chosen.
    pub(super) linearized: usize,
    pub(super) solution: Solution,
    /// The model with the estimates as values.
    pub(super) model: Model,
    /// The commanded angle at the last sample \[rad\].
    pub(super) commanded: f64,
    /// The time of the last sample \[s\].
    pub(super) last: Option<f64>,
    pub(super) totals: Totals,
    pub(super) compensation: Compensation,
}

impl OnlineFilter {
    /// A filter before the first sample.
    ///
    /// # Errors
    /// [`OnlineError`] if the setup has no table reading, a term whose effect depends on the history of the run, no free parameter or
    /// too many, or a quantity that is not positive.
    pub fn new(mut setup: OnlineSetup) -> Result<Self, OnlineError> {
        setup.refuse()?;
        let parameters = setup.model.free(&setup.imu);
        match parameters.len() {
            0 => return Err(FitError::NothingFree.into()),
            1..=MOST_PARAMETERS => {}
            parameters => {
                let most = MOST_PARAMETERS;
                return Err(FitError::ManyParameters { parameters, most }.into());
            }
        }
        for parameter in &parameters {
            let roles = &mut setup.model.terms[parameter.term].roles;
            roles[parameter.parameter] = Role::Within(parameter.sigma);
        }
        let model = setup.model.clone();
        let free: Vec<(usize, usize)> =
            parameters.iter().map(|free| (free.term, free.parameter)).collect();
        let all: Vec<usize> = (0..free.len()).collect();
        let sigmas: Vec<f64> = parameters.iter().map(|free| free.sigma).collect();
        let common = Common {
            smoother: Smoother::of(&setup),
            expected: free.iter().map(|&(term, place)| model.terms[term].values[place]).collect(),
            sigmas: sigmas.clone(),
            free,
            setup,
        };
        Ok(Self {
            attitude: attitude_of(&model, &common.free, &all),
            kept: Vec::new(),
            epochs: Vec::new(),
            is_complete: true,
            start: 0,
            next: 0,
            main: Linearized::new(&common, model.clone()),
            again: None,
            linearized: 0,
            solution: Solution { step: DVector::zeros(sigmas.len()), sigmas: sigmas.into() },
            commanded: 0.0,
            last: None,
            totals: Totals::default(),
            compensation: model.split().0.compensation()?,
            common,
            parameters,
            model,
        })
    }

    /// Takes a sample. The result is the update by the latest epoch, if the sample completed one.
    ///
    /// # Errors
    /// [`OnlineError`] if the sample is not valid, which changes nothing, or [`OnlineError::Indefinite`] if the filter
    /// failed and must not be used further.
    pub fn push(&mut self, sample: &OnlineSample) -> Result<Option<OnlineUpdate>, OnlineError> {
        let OnlineSample { time, increments, table } = *sample;
        let table = table.ok_or(OnlineError::NoReading { time })?;
        let interval = increments.interval;
        let triads = [increments.angle.components(), increments.velocity.components()];
        let mut numbers = triads.into_iter().flatten().chain([&table, &time, &interval]);
        if !numbers.all(|number| number.is_finite()) || interval <= 0.0 {
            return Err(OnlineError::NotFinite { time, interval });
        }
        if let Some(before) = self.last.filter(|before| *before >= time) {
            return Err(OnlineError::TimeNotIncreasing { before, now: time });
        }
        let mut update = None;
        if self.last.is_some_and(|last| time - last > Recording::GAP * interval) {
            update = self.flush()?;
            self.start = self.kept.len();
        }
        let reading = match self.common.setup.rig.reference {
            Reference::Command { .. } => {
                self.commanded += table * self.last.map_or(interval, |last| time - last);
                self.commanded
            }
            _ => table,
        };
        self.last = Some(time);
        self.totals.samples += 1;
        self.kept.push(Held { time, increments, reading });
        let count = self.common.setup.epoch;
        if self.kept.len() - self.next >= count + self.common.smoother.beside {
            update = Some(self.process(count)?);
        }
        // Two epochs at the new point for each at the old one, at other samples than these.
        let since = (self.kept.len() - self.next).saturating_sub(self.common.smoother.beside);
        let due = [count / 3, 2 * count / 3].into_iter().filter(|due| *due == since).count();
        self.catch_up(due)?;
        Ok(update)
    }

    /// Ends the run: processes the samples that are in no epoch yet, and repeats the linearization until the estimate does not
    /// change.
    ///
    /// # Errors
    /// [`OnlineError::Indefinite`] if the filter failed.
    pub fn finish(mut self) -> Result<Self, OnlineError> {
        self.flush()?;
        for _ in 0..MOST_ITERATIONS {
            let moved = self.solution.step.component_div(&self.solution.sigmas).amax();
            if !self.is_complete || moved < CONVERGED {
                break;
            }
            self.again = Some(Linearized::new(&self.common, self.model.clone()));
            self.catch_up(usize::MAX)?;
        }
        Ok(self)
    }

    fn flush(&mut self) -> Result<Option<OnlineUpdate>, Indefinite> {
        let mut update = None;
        while self.next < self.kept.len() {
            update = Some(self.process(self.common.setup.epoch.min(self.kept.len() - self.next))?);
        }
        Ok(update)
    }

    /// Processes an epoch of the next `count` samples.
    fn process(&mut self, count: usize) -> Result<OnlineUpdate, Indefinite> {
        let end = self.next + count;
        let last = self.kept.len().min(end + self.common.smoother.beside);
        let samples = EpochSamples { start: self.start, first: self.next, end, last };
        let time = self.kept[end - 1].time;
        self.main.process(&self.common, &self.kept, samples)?;
        self.next = end;
        if self.is_complete {
            self.epochs.push(samples);
        }
        let innovation = self.main.innovation(&self.solution.step);
        self.totals.epochs += 1;
        self.update()?;
        let is_longer = self.main.epochs as f64 > LONGER * self.linearized as f64;
        if self.is_complete && self.again.is_none() && is_longer && self.has_moved() {
            self.linearized = self.main.epochs;
            self.again = Some(Linearized::new(&self.common, self.model.clone()));
        }
        self.forget();
        Ok(OnlineUpdate { time, innovation })
    }

    /// Whether the estimate is far from the point of linearization.
    fn has_moved(&self) -> bool {
        let moved = self.solution.step.iter().zip(&self.common.sigmas);
        moved.into_iter().any(|(step, sigma)| step.abs() > MOVED * sigma)
    }

    /// Processes at most this number of epochs at the new point of linearization.
    fn catch_up(&mut self, most: usize) -> Result<(), Indefinite> {
        let Some(mut again) = self.again.take_if(|_| most > 0) else { return Ok(()) };
        let epochs = self.epochs[again.epochs..].iter().take(most);
        for &samples in epochs {
            again.process(&self.common, &self.kept, samples)?;
        }
        if again.epochs < self.epochs.len() {
            self.again = Some(again);
            return Ok(());
        }
        self.main = again;
        self.update()
    }

    /// Drops the samples that are not needed any more, if the run is too long for another linearization.
    fn forget(&mut self) {
        if self.is_complete && self.kept.len() > MOST_KEPT && self.again.is_none() {
            self.is_complete = false;
            self.epochs = Vec::new();
        }
        let unused = self.next.saturating_sub(self.common.smoother.beside);
        if !self.is_complete && unused > 0 {
            self.kept.drain(..unused);
            self.next -= unused;
            self.start = self.start.saturating_sub(unused);
        }
    }

    /// Solves the normal equations.
    pub(super) fn update(&mut self) -> Result<(), Indefinite> {
        let failed = Indefinite { epoch: self.totals.epochs };
        self.solution = self.main.solve(&self.common).ok_or(failed)?;
        self.take_solution();
        Ok(())
    }
}
