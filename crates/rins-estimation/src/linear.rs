//! A run made linear: how each epoch's readings follow from attitude, velocity and the parameters.

use std::ops::Range;

use nalgebra::{Matrix3, Matrix3xX, Vector3};
use rayon::prelude::*;
use rins_frames::{Dcm, InFrame, Table};
use rins_terms::{Chosen, Dual64, Model, Signals, Surroundings, Track, derivatives, values};

use crate::path;
use crate::run::{Reference, Run};
use crate::space::SHOWN;
use crate::sway::Sway;

/// Epochs are a thousandth of the run, but not shorter or longer than this \[s\].
const EPOCH: (f64, f64) = (0.1, 0.5);

/// A thread makes at least as many columns.
const FEWEST_COLUMNS: usize = 32;

/// A stretch of samples, taken as one.
///
/// Over it `φ`, the attitude error of the reference path, `C~ = (I - φ×) C`, and `v`, the velocity, both in the
/// axis frame, go from `φ`, `v` to `φ + gain_φ`, `v + (φ × F) Δ + gain_v`, but for the Earth's turning of `φ`,
/// which every gain holds too; what is observed are
/// the mean of `φ` over the readings within and the velocity at the end. Every gain has one
/// column of what was read beyond the model, and one a parameter: the derivative by it.
#[derive(Clone, Debug)]
pub(crate) struct Epoch {
    /// The first sample, and the first of the next epoch.
    pub(crate) samples: (usize, usize),
    /// How long \[s\].
    pub(crate) duration: f64,
    /// Whether samples are missing before it, so that nothing is known of φ and v.
    pub(crate) fresh: bool,
    /// Whether it plays no part: time goes by, and nothing is shown.
    pub(crate) left_out: bool,
    /// What φ gains over the epoch, and to the mean of its readings; what v gains.
    pub(crate) attitude: Matrix3xX<f64>,
    pub(crate) mean_attitude: Matrix3xX<f64>,
    pub(crate) velocity: Matrix3xX<f64>,
    /// What the mean reading is predicted to be beyond that of φ, less what it was.
    pub(crate) reading: Matrix3xX<f64>,
    /// The integral of `C_b^s`, its mean over the readings, and its integral's integral \[s\], \[s\], \[s²\].
    pub(crate) turned: Matrix3<f64>,
    pub(crate) mean_turned: Matrix3<f64>,
    pub(crate) twice_turned: Matrix3<f64>,
}

/// A run, linear in the parameters that a model estimates.
#[derive(Clone, Debug)]
pub struct Linear {
    pub(crate) epochs: Vec<Epoch>,
    /// The specific force in the axis frame \[m/s²\].
    pub(crate) force: Vector3<f64>,
    /// The Earth's rate in the axis frame \[rad/s\].
    pub(crate) earth_rate: Vector3<f64>,
    /// How many parameters are estimated.
    pub(crate) parameters: usize,
    pub(crate) reference: Reference,
    /// Which switching-on the run belongs to, if not to one of its own.
    pub(crate) turn_on: Option<usize>,
    /// The way of the table about which it is linear.
    pub(crate) track: Track,
}

/// The attitude of the axis frame with what `model` has for its error, and the model without that.
///
/// The one parameter that is not small enough for its square to be left out is taken along exactly.
pub(crate) fn with_attitude(run: &Run, model: &Model) -> (Surroundings, Model) {
    let mut rest = model.clone();
    let mut nav_from_table = run.rig.nav_from_table;
    for chosen in &mut rest.terms {
        if chosen.term.id == "axis.attitude" {
            let tilt = InFrame::<Table>::new(chosen.values[0], chosen.values[1], chosen.values[2]);
            nav_from_table =
                nav_from_table * Dcm::<Table, Table>::from_rotation_vector(tilt.components());
            chosen.values.fill(0.0);
        }
    }
    (Surroundings::new(run.rig.station, nav_from_table), rest)
}

/// Makes a run linear about the values that `model` has.
///
/// `free` lists the parameters that are estimated, each as term and place within it.
pub fn linearise(run: &Run, model: &Model, free: &[(usize, usize)]) -> Linear {
    let (surroundings, model) = with_attitude(run, model);
    let recording = &run.recording;
    let duration = recording.times[recording.len() - 1] - recording.times[0];
    let length = (duration / 1000.0).clamp(EPOCH.0, EPOCH.1);
    let interval = duration / (recording.len() - 1) as f64;
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a ratio of positive durations, at most the number of samples"
    )]
    let block = ((length / interval).round() as usize).max(1);
    let track = path::track(run, surroundings, block);
    let readings = path::readings(run);
    let build = |free: &[(usize, usize)]| {
        let mut build = Build::new(run, &model, free, readings.as_deref(), block);
        for (sample, moment) in track.moments().enumerate() {
            build.sample(sample, &moment);
        }
        build.epochs
    };
    let columns = free.len().div_ceil(rayon::current_num_threads()).max(FEWEST_COLUMNS);
    let parts: Vec<Vec<Epoch>> = free.par_chunks(columns).map(build).collect();
    let mut epochs = parts.into_iter().reduce(beside).unwrap_or_else(|| build(&[]));
    leave_out(&mut epochs, &run.left_out);
    Linear {
        epochs,
        force: surroundings.specific_force,
        earth_rate: surroundings.earth_rate,
        parameters: free.len(),
        reference: run.rig.reference,
        turn_on: run.turn_on,
        track,
    }
}

/// Marks the epochs that hold any of these samples, and those that follow them.
fn leave_out(epochs: &mut [Epoch], spans: &[Range<usize>]) {
    let mut before = false;
    for epoch in epochs {
        let (first, end) = epoch.samples;
        epoch.left_out = spans.iter().any(|span| span.start < end && first < span.end);
        epoch.fresh |= before;
        before = epoch.left_out;
    }
}

/// Epochs with the columns of both; the first column, that of the residuals, is the same.
fn beside(mut one: Vec<Epoch>, other: Vec<Epoch>) -> Vec<Epoch> {
    for (epoch, other) in one.iter_mut().zip(other) {
        for (to, from) in [
            (&mut epoch.attitude, other.attitude),
            (&mut epoch.mean_attitude, other.mean_attitude),
            (&mut epoch.velocity, other.velocity),
            (&mut epoch.reading, other.reading),
        ] {
            to.extend(from.column_iter().skip(1));
        }
    }
    one
}

/// Epochs in the making.
struct Build<'a> {
    run: &'a Run,
    /// The terms that do anything: hundreds may stand by to be tried.
    present: Model,
    /// Of each column the term, and its parameters with a derivative by one of them.
    columns: Vec<(&'a Chosen, Vec<Dual64>)>,
    readings: Option<&'a [f64]>,
    sway: Option<Sway>,
    block: usize,
    /// What turns a difference in readings into one in what was true, `(I + [S, M])⁻¹`, of gyros and accelerometers.
    inverse_gains: [Matrix3<f64>; 2],
    epochs: Vec<Epoch>,
    now: Option<Epoch>,
}

impl<'a> Build<'a> {
    fn new(
        run: &'a Run,
        model: &'a Model,
        free: &'a [(usize, usize)],
        readings: Option<&'a [f64]>,
        block: usize,
    ) -> Self {
        let triads = model.split().0;
        let inverse_gains = [triads.gyro.matrix, triads.accel.matrix]
            .map(|matrix| (Matrix3::identity() + matrix).try_inverse().unwrap_or_default());
        let mut present = model.clone();
        present.terms.retain(|chosen| chosen.values.iter().any(|value| *value != 0.0));
        let sway = Sway::of(run);
        let column = |&(term, parameter): &(usize, usize)| {
            let chosen = &model.terms[term];
            let mut duals: Vec<Dual64> =
                chosen.values.iter().map(|&value| Dual64::from_re(value)).collect();
            duals[parameter].eps = 1.0;
            (chosen, duals)
        };
        Self {
            run,
            present,
            columns: free.iter().map(column).collect(),
            readings,
            sway,
            block,
            inverse_gains,
            epochs: Vec::new(),
            now: None,
        }
    }

    fn sample(&mut self, sample: usize, moment: &rins_terms::Moment) {
        let recording = &self.run.recording;
        let measured = &recording.increments[sample];
        let interval = measured.interval;
        // More than half a sample missing: the table's motion in between is not known.
        let gap =
            sample > 0 && recording.times[sample] - recording.times[sample - 1] > 1.5 * interval;
        if gap {
            self.close(sample);
        }
        let columns = self.columns.len() + 1;
        let epoch =
            self.now.get_or_insert_with(|| Epoch::empty(sample, gap || sample == 0, columns));

        let (sin, cos) = moment.mean.angle.sin_cos();
        let mut table_from_body = Matrix3::new(cos, -sin, 0.0, sin, cos, 0.0, 0.0, 0.0, 1.0);
        let predicted = self.present.signals(moment);
        let around = &moment.surroundings;
        let rates = measured.rates();
        let mut gyro = rates.angular_rate.components() - moment.rate;
        let mut accel = rates.specific_force.components() - moment.force;
        let reading = self.readings.map_or(0.0, |readings| readings[sample] - moment.end.angle);
        let mut of_axis = Vector3::z() * (predicted.angle.re - reading) - values(&predicted.tilt);
        if let Some(sway) = &self.sway {
            let [middle, end] = &sway.attitudes[sample];
            gyro = sway.mean_rate - middle.inverse() * around.earth_rate;
            accel = rates.specific_force.components() - middle.inverse() * around.specific_force;
            of_axis += end.scaled_axis();
            table_from_body = *middle.matrix();
        }
        let [of_gyros, of_accels] = self.inverse_gains.map(|inverse| table_from_body * inverse);
        gyro -= values(&predicted.gyro);
        accel -= values(&predicted.accel);
        let rates =
            Rates { attitude: of_gyros * gyro, velocity: of_accels * accel, reading: of_axis };
        epoch.add(0, &rates, around, interval);
        for (column, (chosen, duals)) in self.columns.iter().enumerate() {
            let mut by = Signals::default();
            chosen.term.act(duals, &chosen.settings, moment, &mut by);
            let rates = Rates {
                attitude: -(of_gyros * derivatives(&by.gyro)),
                velocity: -(of_accels * derivatives(&by.accel)),
                reading: Vector3::z() * by.angle.eps - derivatives(&by.tilt),
            };
            epoch.add(column + 1, &rates, around, interval);
        }
        epoch.twice_turned += (epoch.turned + table_from_body * (0.5 * interval)) * interval;
        epoch.turned += table_from_body * interval;
        epoch.mean_turned += epoch.turned;
        epoch.mean_attitude += &epoch.attitude;
        epoch.duration += interval;
        if sample + 1 - epoch.samples.0 >= self.block || sample + 1 == recording.len() {
            self.close(sample + 1);
        }
    }

    /// Ends the epoch before sample `end`.
    fn close(&mut self, end: usize) {
        let Some(mut epoch) = self.now.take() else { return };
        epoch.samples.1 = end;
        let count = (end - epoch.samples.0) as f64;
        epoch.mean_attitude /= count;
        epoch.mean_turned /= count;
        epoch.reading /= count;
        self.epochs.push(epoch);
    }
}

/// What one sample adds to one column: rates of φ and v, and what a reading differs by.
struct Rates {
    attitude: Vector3<f64>,
    velocity: Vector3<f64>,
    reading: Vector3<f64>,
}

impl Epoch {
    fn empty(first: usize, fresh: bool, columns: usize) -> Self {
        let none = Matrix3xX::zeros(columns);
        Self {
            samples: (first, first),
            duration: 0.0,
            fresh,
            left_out: false,
            attitude: none.clone(),
            mean_attitude: none.clone(),
            velocity: none.clone(),
            reading: none,
            turned: Matrix3::zeros(),
            mean_turned: Matrix3::zeros(),
            twice_turned: Matrix3::zeros(),
        }
    }

    /// One more sample of one column.
    fn add(&mut self, column: usize, rates: &Rates, around: &Surroundings, interval: f64) {
        let mut attitude = self.attitude.column_mut(column);
        let before = attitude.clone_owned();
        // φ' = -E × φ + rate, over a sample too short for the square of its turn to count.
        let turning = around.earth_rate.cross(&(before + rates.attitude * (0.5 * interval)));
        attitude += (rates.attitude - turning) * interval;
        let middle = (before + attitude.clone_owned()) * 0.5;
        let mut velocity = self.velocity.column_mut(column);
        velocity += (rates.velocity + middle.cross(&around.specific_force)) * interval;
        let mut reading = self.reading.column_mut(column);
        reading += rates.reading;
    }

    /// How many readings the mean is of.
    pub(crate) fn count(&self) -> f64 {
        (self.samples.1 - self.samples.0) as f64
    }
}

impl Linear {
    /// How many epochs the run has.
    pub fn epochs(&self) -> usize {
        self.epochs.len()
    }

    /// The way of the table about which it is linear.
    pub fn track(&self) -> &Track {
        &self.track
    }

    /// The samples of each epoch.
    pub fn samples(&self) -> impl Iterator<Item = Range<usize>> {
        self.epochs.iter().map(|epoch| epoch.samples.0..epoch.samples.1)
    }

    /// When each epoch ends \[s\].
    pub fn ends(&self) -> Vec<f64> {
        let times = self.track.times();
        self.epochs.iter().map(|epoch| times[epoch.samples.1 - 1]).collect()
    }

    /// Whether the readings show the angle about the axis.
    pub(crate) fn shows_angle(&self) -> bool {
        self.reference != Reference::Gravity
    }

    /// How many figures an epoch shows.
    pub fn shown(&self) -> usize {
        if self.shows_angle() { SHOWN } else { SHOWN - 1 }
    }

    /// The table angle in the middle of each epoch \[rad\], and its mean rate over it \[rad/s\].
    pub fn motion(&self) -> Vec<(f64, f64)> {
        let angles = self.track.angles();
        let of = |epoch: &Epoch| {
            let (first, end) = (angles[epoch.samples.0], angles[epoch.samples.1]);
            (0.5 * (first + end), (end - first) / epoch.duration)
        };
        self.epochs.iter().map(of).collect()
    }

    /// The same with parameters more: of each of `parameters`, one that acts in the epochs of group 1 only, and so on up
    /// to group `last`.
    ///
    /// # Panics
    /// If there is not a group for every epoch.
    #[must_use]
    pub fn in_groups(&self, parameters: &[usize], groups: &[usize], last: usize) -> Self {
        assert_eq!(groups.len(), self.epochs.len(), "a group for every epoch");
        let mut apart = self.clone();
        for (epoch, &group) in apart.epochs.iter_mut().zip(groups) {
            for matrix in [
                &mut epoch.attitude,
                &mut epoch.mean_attitude,
                &mut epoch.velocity,
                &mut epoch.reading,
            ] {
                for of in 1..=last {
                    for parameter in parameters {
                        let column = matrix.column(parameter + 1).into_owned();
                        matrix.extend([if of == group { column } else { Vector3::zeros() }]);
                    }
                }
            }
        }
        apart.parameters += parameters.len() * last;
        apart
    }

    /// The mean length of an epoch \[s\].
    pub fn mean_epoch(&self) -> f64 {
        let total: f64 = self.epochs.iter().map(|epoch| epoch.duration).sum();
        total / self.epochs.len() as f64
    }

    /// How long the samples cover \[s\].
    pub(crate) fn duration(&self) -> f64 {
        self.epochs.iter().map(|epoch| epoch.duration).sum()
    }
}
