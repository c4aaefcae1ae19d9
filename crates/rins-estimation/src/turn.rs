//! Rotations between static intervals: what the gyros integrate to, beside the attitudes before and after.
//!
//! Over a static interval gravity shows two of the three components of the attitude, and nothing of the gyros' scale errors
//! and misalignments. The rotation from one interval to the next shows these: with the readings compensated, it must lead from
//! the one attitude to the other (tedaldi2014). A stated angle of rotation about the body's z axis shows the scale error of the z
//! gyro even if gravity shows nothing, as on a level table.

use nalgebra::{Cholesky, DMatrix, DVector, Matrix3, RowDVector, Vector3};
use rins_frames::{Dcm, Nav, Table, cross_matrix};
use rins_motion::Recording;
use rins_terms::{Acting, KinematicState, Model, Track, catalogue, compensated, derivatives};

use crate::colour::{Colours, Process};
use crate::layout::{Layout, attitude_of};
use crate::linear::{Linear, with_attitude};
use crate::noise_parameters::Noise;
use crate::posterior::Evidence;
use crate::run::Run;
use crate::sequence::{InSequence, StatedTurn, Turn};

/// The mean square of the residuals in sigmas above which the error of rotations is increased.
const CALM: f64 = 2.25;

/// A rotation, linearized with respect to the joint parameters.
#[derive(Clone, Debug)]
pub(crate) struct LinearTurn {
    /// The run after it.
    to: usize,
    /// The run before it.
    from: usize,
    /// The difference of the attitude afterwards from that to which the readings lead, as a rotation vector in the body \[rad\].
    residual: Vector3<f64>,
    /// Its derivative by the joint parameters.
    slope: DMatrix<f64>,
    /// How long it takes \[s\], and the integral of the magnitude of the rate \[rad\].
    duration: f64,
    path: f64,
    /// The difference of the attitude afterwards from the stated rotation about z \[rad\], and its derivative.
    stated: Option<(StatedTurn, f64, RowDVector<f64>)>,
}

/// The runs, their models and free parameters, and the layout of these.
pub(crate) struct Turning<'a> {
    pub(crate) runs: &'a [Run],
    pub(crate) models: &'a [Model],
    pub(crate) free: &'a [Vec<(usize, usize)>],
    pub(crate) layout: &'a Layout,
}

impl Turning<'_> {
    /// The rotations between those of the runs that are neighbors in time. One whose readings the model cannot compensate is
    /// left out.
    pub(crate) fn linear(&self) -> Vec<LinearTurn> {
        let of = |to: usize| {
            let InSequence { number, turn } = self.runs[to].in_sequence.as_ref()?;
            let before = |run: &Run| {
                let earlier = run.in_sequence.as_ref().map(|place| place.number + 1);
                earlier == Some(*number) && run.shares_turn_on(&self.runs[to])
            };
            self.between(self.runs.iter().position(before)?, to, turn.as_ref()?)
        };
        (0..self.runs.len()).filter_map(of).collect()
    }

    fn between(&self, from: usize, to: usize, turn: &Turn) -> Option<LinearTurn> {
        let (before, _) = with_attitude(&self.runs[from], &self.models[from]);
        let (after, model) = with_attitude(&self.runs[to], &self.models[to]);
        let earth_rate = self.runs[to].rig.station.site.earth_rate();
        let recording = compensated(&model, after, &turn.recording).ok()?;
        let angles: Vec<f64> = about_z(&recording);
        let intervals: Vec<f64> =
            recording.increments.iter().map(|sample| sample.interval).collect();
        let duration = intervals.iter().sum();
        let track = Track::new(
            after,
            recording.times.clone(),
            intervals,
            angles,
            recording.temperature.clone(),
        );
        let columns: Vec<usize> = (0..self.free[to].len())
            .filter(|&column| !is_placement(&model, self.free[to][column].0))
            .collect();
        let free: Vec<(usize, usize)> =
            columns.iter().map(|&column| self.free[to][column]).collect();
        let acting = Acting::by(&model, &track, &free);
        let gain = (Matrix3::identity() + model.split().0.gyro.matrix).try_inverse()?;
        // The derivatives along the axes of the body before.
        let mut slopes = vec![Vector3::<f64>::zeros(); columns.len()];
        let mut turned = Dcm::<Table, Table>::identity();
        let mut moments = track.moments();
        let mut path = 0.0;
        for sample in &recording.increments {
            let moment: KinematicState = moments.advance()?.feeling(sample);
            let angle = *sample.angle.components();
            path += angle.norm();
            let middle = turned * Dcm::<Table, Table>::from_rotation_vector(&(0.5 * angle));
            for (slope, acting) in slopes.iter_mut().zip(&acting) {
                let signals = Acting::together(acting, &moment);
                *slope += middle.matrix() * (gain * derivatives(&signals.gyro)) * sample.interval;
            }
            turned = turned * Dcm::from_rotation_vector(&angle);
        }
        // The Earth turns n with respect to inertial space, to which the gyros refer.
        let of_earth =
            Dcm::<Nav, Nav>::from_rotation_vector(&(-earth_rate.components() * duration));
        let expected = of_earth * before.nav_from_table * turned;
        let residual = (expected.inverse() * after.nav_from_table).rotation_vector();
        let to_after = inverse_left_jacobian(&residual) * turned.matrix().transpose();
        let mut slope = DMatrix::zeros(3, self.layout.all.len());
        for (&column, own) in columns.iter().zip(&slopes) {
            let place = self.layout.places[to][column];
            let sign = self.layout.signs[to][column];
            let mut at = slope.column_mut(place);
            at += to_after * own * sign;
        }
        self.add_attitude(&mut slope, to, &inverse_left_jacobian(&-residual));
        self.add_attitude(&mut slope, from, &-to_after);
        let stated = turn.stated.map(|stated| {
            let expected = before.nav_from_table * Dcm::<Table, Table>::about_z(stated.angle);
            let off = (expected.inverse() * after.nav_from_table).rotation_vector().z;
            let mut slope = DMatrix::zeros(3, self.layout.all.len());
            self.add_attitude(&mut slope, to, &Matrix3::identity());
            let back =
                (after.nav_from_table.inverse() * before.nav_from_table).matrix().into_owned();
            self.add_attitude(&mut slope, from, &-back);
            (stated, off, slope.row(2).into_owned())
        });
        Some(LinearTurn { to, from, residual, slope, duration, path, stated })
    }

    /// Adds a multiple of the rotation by the attitude of a run to a derivative, if that attitude is free.
    fn add_attitude(&self, slope: &mut DMatrix<f64>, run: usize, factor: &Matrix3<f64>) {
        let places = attitude_of(&self.models[run], &self.free[run], &self.layout.places[run]);
        for (axis, place) in places.into_iter().flatten().enumerate() {
            let mut at = slope.column_mut(place);
            at += factor.column(axis);
        }
    }
}

/// The derivative of the rotation vector of `exp(δ) exp(ρ)` by `δ` at zero; at `-ρ`, that of `exp(ρ) exp(δ)`.
fn inverse_left_jacobian(vector: &Vector3<f64>) -> Matrix3<f64> {
    let cross = cross_matrix(vector);
    Matrix3::identity() - 0.5 * cross + cross * cross / 12.0
}

/// The angle about z before the first sample and at the end of each \[rad\].
fn about_z(recording: &Recording) -> Vec<f64> {
    let mut angle = 0.0;
    let ends = recording.increments.iter().map(|sample| {
        angle += sample.angle.components().z;
        angle
    });
    std::iter::once(0.0).chain(ends).collect()
}

/// Whether a term is the attitude of a run or its azimuth, which act on no reading of a rotation in the hand.
fn is_placement(model: &Model, term: usize) -> bool {
    let chosen = model.terms[term].term;
    chosen.is(&catalogue::AXIS_ATTITUDE) || chosen.is(&catalogue::AXIS_AZIMUTH)
}

/// The evidence of rotations, with the noise of the run after each.
///
/// `wide` gives the derivative of a rotation by `parameters` parameters.
pub(crate) fn evidence(
    turns: &[LinearTurn],
    (linear, noise): (&[Linear], &[Noise]),
    parameters: usize,
    wide: impl Fn(&LinearTurn) -> DMatrix<f64>,
) -> Evidence {
    let mut sum = Evidence::none(parameters);
    for turn in turns {
        let variance = turn.variance(&linear[turn.to], &noise[turn.to]);
        let slope = wide(turn) / variance.sqrt();
        let residual = turn.residual / variance.sqrt();
        sum.information += slope.transpose() * &slope;
        sum.score -= slope.transpose() * residual;
        sum.square += residual.norm_squared();
        sum.figures += 3;
        sum.log_determinant += 1.5 * variance.ln();
    }
    add_stated(&mut sum, turns, noise);
    sum
}

/// Increases the error of rotations to the level of their residuals if these are larger: gyros that the model does not describe
/// would otherwise vary the attitudes against gravity.
pub(crate) fn calm(turns: &[LinearTurn], linear: &[Linear], noise: &mut [Noise]) {
    let count = 3.0 * turns.len().max(1) as f64;
    let square = |turn: &LinearTurn| {
        turn.residual.norm_squared() / turn.variance(&linear[turn.to], &noise[turn.to])
    };
    if turns.iter().map(square).sum::<f64>() / count <= CALM {
        return;
    }
    let relative: f64 =
        turns.iter().map(|turn| turn.residual.norm_squared() / turn.path.powi(2)).sum();
    let level = (relative / count).sqrt();
    for noise in noise {
        noise.turn = noise.turn.max(level);
    }
}

/// Adds the evidence of the stated angles. The reading between two rotations is an error of both.
fn add_stated(sum: &mut Evidence, turns: &[LinearTurn], noise: &[Noise]) {
    let stated: Vec<_> =
        turns.iter().filter_map(|turn| Some((turn, turn.stated.as_ref()?))).collect();
    if stated.is_empty() {
        return;
    }
    let count = stated.len();
    let covariance = DMatrix::from_fn(count, count, |row, column| {
        let ((one, (of_one, ..)), (other, (of_other, ..))) = (stated[row], stated[column]);
        match () {
            () if row == column => {
                let placed = 2.0 * noise[one.to].wobble.powi(2);
                of_one.sigma.powi(2) + 2.0 * of_one.mark.powi(2) + placed
            }
            () if one.to == other.from || one.from == other.to => -of_one.mark * of_other.mark,
            () => 0.0,
        }
    });
    let Some(factor) = Cholesky::new(covariance).map(Cholesky::unpack) else { return };
    let residual = DVector::from_iterator(count, stated.iter().map(|(_, (_, off, _))| *off));
    let rows: Vec<RowDVector<f64>> = stated
        .iter()
        .map(|(_, (.., slope))| slope.clone().resize_horizontally(sum.score.len(), 0.0))
        .collect();
    let slope = DMatrix::from_rows(&rows);
    let (Some(slope), Some(residual)) =
        (factor.solve_lower_triangular(&slope), factor.solve_lower_triangular(&residual))
    else {
        return;
    };
    sum.information += slope.transpose() * &slope;
    sum.score -= slope.transpose() * &residual;
    sum.square += residual.norm_squared();
    sum.figures += count;
    sum.log_determinant += factor.diagonal().iter().map(|x| x.ln()).sum::<f64>();
}

impl LinearTurn {
    /// The derivative of the residual by the joint parameters.
    pub(crate) fn slope(&self) -> &DMatrix<f64> {
        &self.slope
    }

    /// The run before and the run after.
    pub(crate) fn runs(&self) -> [usize; 2] {
        [self.from, self.to]
    }

    /// The variance of each component of the residual: white noise and bias instability of the gyros, the placement before and
    /// after, and what is in proportion to the rotation.
    fn variance(&self, linear: &Linear, noise: &Noise) -> f64 {
        let gyro = Colours::of(&noise.imu.gyro, linear.mean_epoch(), linear.duration());
        let of_bias: f64 = gyro.processes.iter().map(Process::initial_variance).sum();
        let white = noise.imu.gyro.white.powi(2) + gyro.white;
        white * self.duration
            + of_bias * self.duration.powi(2)
            + 2.0 * noise.wobble.powi(2)
            + (noise.turn * self.path).powi(2)
    }
}
