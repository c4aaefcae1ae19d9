//! The drift of the biases between the static intervals of one power cycle.
//!
//! Within an interval the colored noise of the filter represents the drift of a bias. From one interval to another the bias
//! changes by the processes that are slower than an interval, which the filter of an interval cannot represent: the bias of
//! interval `k` is the turn-on bias plus a deviation `d_k`. The deviations have the covariance of these processes over the times
//! of the intervals, and are integrated out.

use nalgebra::{Cholesky, DMatrix, DVector, RowDVector};
use rins_terms::{Model, catalogue};

use crate::colour::Colours;
use crate::layout::Layout;
use crate::linear::Linear;
use crate::noise_parameters::{Noise, TriadStrengths};
use crate::posterior::Evidence;
use crate::run::Run;

/// The static intervals of a power cycle, in the order of time, and the places of their biases.
#[derive(Clone, Debug)]
pub(super) struct Sequence {
    /// The runs.
    runs: Vec<usize>,
    /// The free biases: gyros or accelerometers, and the place among a run's parameters.
    biases: Vec<(Triad, usize)>,
}

#[derive(Clone, Copy, Debug, PartialEq)]
enum Triad {
    Gyro,
    Accel,
}

impl Sequence {
    /// The sequences of runs with at least two intervals.
    pub(super) fn all(runs: &[Run], models: &[Model], free: &[Vec<(usize, usize)>]) -> Vec<Self> {
        let number = |run: usize| runs[run].in_sequence.as_ref().map(|place| place.number);
        let mut sequences: Vec<Self> = Vec::new();
        for run in (0..runs.len()).filter(|&run| number(run).is_some()) {
            let same = |sequence: &&mut Self| runs[sequence.runs[0]].shares_turn_on(&runs[run]);
            match sequences.iter_mut().find(same) {
                Some(sequence) => sequence.runs.push(run),
                None => {
                    let biases = biases(&models[run], &free[run]);
                    sequences.push(Self { runs: vec![run], biases });
                }
            }
        }
        sequences.retain(|sequence| sequence.runs.len() > 1 && !sequence.biases.is_empty());
        for sequence in &mut sequences {
            sequence.runs.sort_by_key(|&run| number(run));
        }
        sequences
    }

    /// The number of deviations.
    fn deviations(&self) -> usize {
        self.runs.len() * self.biases.len()
    }

    /// The Cholesky factor of the covariance of the deviations of one axis; zero if there is no drift.
    fn factor(&self, strengths: &TriadStrengths, linear: &[Linear]) -> DMatrix<f64> {
        let count = self.runs.len();
        let starts: Vec<f64> =
            self.runs.iter().map(|&run| linear[run].track().times()[0]).collect();
        let mean = |of: fn(&Linear) -> f64| {
            self.runs.iter().map(|&run| of(&linear[run])).sum::<f64>() / count as f64
        };
        let (epoch, duration) = (mean(Linear::mean_epoch), mean(Linear::duration));
        let lasting = starts[count - 1] - starts[0] + duration;
        let slow = Colours::of(strengths, epoch, lasting).slower_than(duration);
        let covariance = DMatrix::from_fn(count, count, |row, column| {
            let apart = (starts[row] - starts[column]).abs();
            let since = starts[row].min(starts[column]) - starts[0];
            slow.iter().map(|process| process.covariance(apart, since)).sum::<f64>()
        });
        // A walk is zero at the first interval: its variance there is raised above rounding.
        let least = 1e-12 * covariance.diagonal().max().max(f64::MIN_POSITIVE);
        let covariance = covariance + DMatrix::identity(count, count) * least;
        Cholesky::new(covariance).map_or_else(|| DMatrix::zeros(count, count), Cholesky::unpack)
    }
}

/// The free biases of a model.
fn biases(model: &Model, free: &[(usize, usize)]) -> Vec<(Triad, usize)> {
    let triad = |&(term, _): &(usize, usize)| match model.terms[term].term {
        of if of.is(&catalogue::GYRO_BIAS) => Some(Triad::Gyro),
        of if of.is(&catalogue::ACCEL_BIAS) => Some(Triad::Accel),
        _ => None,
    };
    free.iter().enumerate().filter_map(|(place, at)| Some((triad(at)?, place))).collect()
}

/// The deviations of all sequences as combinations of independent normal variables.
pub(super) struct Deviations<'a> {
    sequences: &'a [Sequence],
    /// For each sequence, the Cholesky factors of the covariance of the deviations of one axis: of gyros and accelerometers.
    factors: Vec<[DMatrix<f64>; 2]>,
    /// The number of joint parameters, after which the variables come.
    parameters: usize,
}

impl<'a> Deviations<'a> {
    pub(super) fn new(
        sequences: &'a [Sequence],
        linear: &[Linear],
        noise: &[Noise],
        parameters: usize,
    ) -> Self {
        let of = |sequence: &Sequence| {
            let imu = &noise[sequence.runs[0]].imu;
            [&imu.gyro, &imu.accel].map(|strengths| sequence.factor(strengths, linear))
        };
        Self { sequences, factors: sequences.iter().map(of).collect(), parameters }
    }

    /// The number of joint parameters and variables.
    pub(super) fn len(&self) -> usize {
        self.parameters + self.sequences.iter().map(Sequence::deviations).sum::<usize>()
    }

    /// For a run, each of its biases with the variables that its deviation consists of: place of the bias among the run's
    /// parameters, place of the first variable, and the coefficients of that and of the following ones.
    fn of_run(&self, run: usize) -> Vec<(usize, usize, RowDVector<f64>)> {
        let mut first = self.parameters;
        for (sequence, factors) in self.sequences.iter().zip(&self.factors) {
            let count = sequence.runs.len();
            if let Some(row) = sequence.runs.iter().position(|&one| one == run) {
                let of = |(axis, &(triad, bias)): (usize, &(Triad, usize))| {
                    let factor = &factors[usize::from(triad == Triad::Accel)];
                    (bias, first + axis * count, factor.row(row).into_owned())
                };
                return sequence.biases.iter().enumerate().map(of).collect();
            }
            first += sequence.deviations();
        }
        Vec::new()
    }

    /// Adds what a run shows of the variables, and of them with the joint parameters.
    pub(super) fn add_run(
        &self,
        to: &mut Evidence,
        of_run: &Evidence,
        run: usize,
        layout: &Layout,
    ) {
        let deviations = self.of_run(run);
        for (bias, first, coefficients) in &deviations {
            for (step, coefficient) in coefficients.iter().enumerate().filter(|(_, c)| **c != 0.0) {
                let variable = first + step;
                to.score[variable] += coefficient * of_run.score[*bias];
                let places = layout.places[run].iter().zip(&layout.signs[run]).enumerate();
                for (row, (&place, sign)) in places {
                    let shared = sign * coefficient * of_run.information[(row, *bias)];
                    to.information[(place, variable)] += shared;
                    to.information[(variable, place)] += shared;
                }
                for (other_bias, other_first, others) in &deviations {
                    let between = coefficient * of_run.information[(*bias, *other_bias)];
                    for (other_step, other) in others.iter().enumerate() {
                        to.information[(variable, other_first + other_step)] += between * other;
                    }
                }
            }
        }
    }

    /// The derivative of a rotation between two runs by the joint parameters and the variables: its bias is the mean of those
    /// before and after.
    pub(super) fn widened(
        &self,
        slope: &DMatrix<f64>,
        runs: [usize; 2],
        layout: &Layout,
    ) -> DMatrix<f64> {
        let mut wide = slope.clone().resize_horizontally(self.len(), 0.0);
        for run in runs {
            for (bias, first, coefficients) in self.of_run(run) {
                let by_bias =
                    slope.column(layout.places[run][bias]) * (0.5 * layout.signs[run][bias]);
                for (step, coefficient) in coefficients.iter().enumerate() {
                    let mut at = wide.column_mut(first + step);
                    at += &by_bias * *coefficient;
                }
            }
        }
        wide
    }

    /// The evidence on the joint parameters, with the variables integrated out.
    pub(super) fn integrated_out(&self, evidence: &Evidence) -> Option<Evidence> {
        let kept: Vec<usize> = (0..self.parameters).collect();
        let variables = self.parameters..self.len();
        let others: Vec<(usize, f64, f64)> = variables.map(|place| (place, 1.0, 0.0)).collect();
        evidence.marginal(&kept, &others)
    }

    /// The deviations of the biases of a run at the maximum of the evidence, as additions to its parameters, if the joint
    /// parameters are those of the linearization.
    pub(super) fn estimated(&self, evidence: &Evidence, runs: &[usize]) -> Vec<Vec<f64>> {
        let variables = self.len() - self.parameters;
        let first = self.parameters;
        let information = evidence.information.view((first, first), (variables, variables))
            + DMatrix::identity(variables, variables);
        let solved = Cholesky::new(information.into_owned())
            .map(|factor| factor.solve(&evidence.score.rows(first, variables)));
        let mean = solved.unwrap_or_else(|| DVector::zeros(variables));
        let of = |(run, &parameters): (usize, &usize)| {
            let mut moved = vec![0.0; parameters];
            for (bias, from, coefficients) in self.of_run(run) {
                let own = mean.rows(from - first, coefficients.len());
                moved[bias] = (coefficients * own)[(0, 0)];
            }
            moved
        };
        runs.iter().enumerate().map(of).collect()
    }
}
