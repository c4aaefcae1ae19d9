//! What causes gain on data that played no part in estimating them.

use std::ops::Range;

use nalgebra::DVector;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64;
use rins_estimation::{
    EpochPrediction, Fit, FitError, Indefinite, Layout, Linear, NoiseKnowledge, ParameterPosterior,
    Run, fit, fit_approximately,
};
use rins_imu::ImuSpec;
use rins_terms::{Model, NotUndone, Owner, Role};

use crate::generic::is_generic;
use crate::prediction::drift::{Drift, drifts};
use crate::prediction::spans::{Held, fastest, held_out};

/// Of fewer blocks no interval can be told.
const FEWEST_BLOCKS: usize = 4;

/// How often the blocks are drawn anew.
const DRAWS: usize = 4000;

/// What is left of an interval on each side: 95 % are within.
const TAIL: f64 = 0.025;

/// The misfit of a prediction that is called consistent, relative to that of a correct model: the mean NIS may be larger by this
/// part, which a wrong noise density of 10 % causes.
const CONSISTENT: f64 = 0.2;

/// How well a model predicts the held-out data.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct PredictiveScore {
    /// The logarithm of the probability density of all that was held out \[nats\].
    pub log_score: f64,
    /// The mean normalised innovation squared of an epoch; `nis_dof` if the model is right.
    pub nis_mean: f64,
    /// The number of measurements in an epoch.
    pub nis_dof: usize,
}

impl PredictiveScore {
    /// Whether the innovations are as large as predicted: an absolute check, which a comparison of two models is not.
    pub fn is_consistent(&self) -> bool {
        self.nis_mean < (1.0 + CONSISTENT) * self.nis_dof as f64
    }

    /// How much larger the mean NIS is than that of a correct model.
    fn misfit(&self) -> f64 {
        (self.nis_mean - self.nis_dof as f64).max(0.0)
    }
}

/// What came of it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GainVerdict {
    /// The extended model predicts better, not by chance, and either its innovations are as large as predicted or most of the
    /// misfit of the given model is gone.
    Improved,
    /// It does not.
    NoImprovement,
}

/// What causes gain on data that played no part.
#[derive(Clone, Debug, PartialEq)]
pub struct Gain {
    /// The samples that were held out, run by run.
    pub spans: Vec<Vec<Range<usize>>>,
    /// How many they are.
    pub samples: usize,
    /// How many revolutions, or pieces of a rest, they make.
    pub blocks: usize,
    /// The model as it was given.
    pub before: PredictiveScore,
    /// The model with the causes.
    pub after: PredictiveScore,
    /// Between what the rise of the log score is with 95 % probability, as the blocks scatter \[nats\].
    pub interval: (f64, f64),
    /// How far free inertial navigation drifts.
    pub drifts: Vec<Drift>,
    /// What came of it.
    pub verdict: GainVerdict,
}

/// Why a gain could not be measured.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum GainError {
    /// Nothing, or too little, can be held out.
    #[error(
        "{blocks} revolutions or pieces of 10 s can be held out; {FEWEST_BLOCKS} are needed. Held out is the last 30 % of \
         each segment of constant or of varying rate, in whole revolutions or pieces of 10 s"
    )]
    TooLittle {
        /// How many revolutions or pieces of a rest.
        blocks: usize,
    },
    /// The runs are about different axes of the IMU.
    #[error("the runs have different spin axes")]
    SeveralAxes,
    /// What was found at one rate cannot be tried at another.
    #[error("the table rotates at one rate only")]
    OneRate,
    /// A model cannot be fitted to the rest.
    #[error("the model cannot be fitted to the data that are not held out")]
    Fit(#[from] FitError),
    /// The held-out data cannot be foretold.
    #[error("the held-out data cannot be predicted")]
    EpochPrediction(#[from] Indefinite),
    /// The errors that were found cannot be undone.
    #[error("the causes cannot be compensated")]
    NotUndone(#[from] NotUndone),
}

impl Gain {
    /// By how much the log score rises \[nats\].
    pub fn rise(&self) -> f64 {
        self.after.log_score - self.before.log_score
    }

    /// What the causes in `after` gain over the model in `before`, on the last 30 % of every stretch of constant rate of
    /// the runs from which both were estimated.
    ///
    /// Both models are estimated anew from the rest. Which causes there are was found with all the data; how large they
    /// are is found without those held out.
    ///
    /// # Errors
    /// [`GainError`] if too little can be held out, or a model does not fit the rest.
    pub fn within(
        runs: &[Run],
        (before, after): (&Fit, &Fit),
        imu: &ImuSpec,
        knowledge: NoiseKnowledge,
    ) -> Result<Self, GainError> {
        Self::of((runs, &ends(runs)), [before, after].map(anew), imu, knowledge)
    }

    /// The same where all stretches at the fastest rate are held out: whether what was found at slower rates holds there.
    ///
    /// # Errors
    /// [`GainError`] if there is one rate only, too little is at the fastest, or a model does not fit the rest.
    pub fn at_the_fastest_rate(
        runs: &[Run],
        (before, after): (&Fit, &Fit),
        imu: &ImuSpec,
        knowledge: NoiseKnowledge,
    ) -> Result<Self, GainError> {
        let held: Vec<Vec<Held>> = runs.iter().map(fastest).collect();
        if held.iter().all(Vec::is_empty) {
            return Err(GainError::OneRate);
        }
        Self::of((runs, &held), [before, after].map(anew), imu, knowledge)
    }

    /// The same on `others`, runs that played no part at all. What the causes say of the sensors is held as it was found in
    /// `runs`. All else is estimated from those and from the first 70 % of the others' every stretch: one run seldom shows
    /// all errors of an IMU, and those that it does not show would be wrong in another attitude.
    ///
    /// # Errors
    /// [`GainError`] if too little can be held out, or a model does not fit the rest.
    pub fn on(
        others: &[Run],
        runs: &[Run],
        (before, after): (&Fit, &Fit),
        imu: &ImuSpec,
        knowledge: NoiseKnowledge,
    ) -> Result<Self, GainError> {
        let given = before.model().terms.len();
        let models = [(None, as_expected(before)), (None, with_causes_held(after, given))];
        let all = [runs, others].concat();
        let none = vec![Vec::new(); runs.len()];
        let held = [none, ends(others)].concat();
        let gain = Self::of((&all, &held), models, imu, knowledge)?;
        Ok(Self { spans: gain.spans[runs.len()..].to_vec(), ..gain })
    }

    fn of(
        (runs, held): (&[Run], &[Vec<Held>]),
        [(near_before, before), (near_after, after)]: [(Option<&Fit>, Model); 2],
        imu: &ImuSpec,
        knowledge: NoiseKnowledge,
    ) -> Result<Self, GainError> {
        if runs.iter().any(|run| run.axes != runs[0].axes) {
            return Err(GainError::SeveralAxes);
        }
        let blocks = held.iter().flatten().map(|held| held.blocks.len()).sum();
        if blocks < FEWEST_BLOCKS {
            return Err(GainError::TooLittle { blocks });
        }
        let spans: Vec<Vec<Range<usize>>> = held
            .iter()
            .map(|of_run| of_run.iter().map(|held| held.span.clone()).collect())
            .collect();
        let rest: Vec<Run> =
            runs.iter().zip(&spans).map(|(r, s)| r.clone().leaving_out(s.clone())).collect();
        let fitted = |near: Option<&Fit>, model: &Model| {
            let mut fit = match near {
                Some(near) => fit_approximately(near, &rest, model, imu, knowledge),
                None => fit(&rest, model, imu, knowledge, |_| ()),
            }?;
            fit.linear = fit.linear.into_iter().map(Linear::with_all).collect();
            Ok::<_, FitError>(fit)
        };
        let first = fitted(near_before, &before)?;
        // A model may have nothing more than another sort of noise.
        let noise = |near: Option<&'_ Fit>| near.map(|near| near.noise.clone());
        let alike = before == after && noise(near_before) == noise(near_after);
        let second = if alike { first.clone() } else { fitted(near_after, &after)? };
        let scores = [scored(runs, held, &first, imu)?, scored(runs, held, &second, imu)?];
        let rises: Vec<f64> =
            scores[0].blocks.iter().zip(&scores[1].blocks).map(|(a, b)| b - a).collect();
        let interval = interval(&rises);
        let drifts = drifts(runs, &spans, [&first, &second])?;
        let samples = spans.iter().flatten().map(Range::len).sum();
        let [before, after] = scores.map(|score| score.foresight);
        let explains = after.is_consistent() || after.misfit() < 0.5 * before.misfit();
        let verdict = if interval.0 > 0.0 && explains {
            GainVerdict::Improved
        } else {
            GainVerdict::NoImprovement
        };
        Ok(Self { spans, samples, blocks, before, after, interval, drifts, verdict })
    }
}

/// The last of every stretch of each run.
fn ends(runs: &[Run]) -> Vec<Vec<Held>> {
    runs.iter().map(held_out).collect()
}

/// What to estimate anew, and beside which fit.
fn anew(fit: &Fit) -> (Option<&Fit>, Model) {
    (Some(fit), as_expected(fit))
}

/// A model with all it estimates where it was expected, and no better known than it was.
fn as_expected(fit: &Fit) -> Model {
    let mut model = fit.model().clone();
    take_back(&mut model, fit);
    without_nameless(model)
}

/// Takes every estimate back to what was expected.
fn take_back(model: &mut Model, fit: &Fit) {
    for estimate in fit.parameters.iter().filter(|estimate| estimate.run.is_none_or(|run| run == 0))
    {
        let at = &estimate.parameter;
        model.terms[at.term].values[at.parameter] = estimate.expected;
        model.terms[at.term].roles[at.parameter] = Role::Within(at.sigma);
    }
}

/// A disturbance without a name foretells nothing.
fn without_nameless(mut model: Model) -> Model {
    model.terms.retain(|chosen| !is_generic(chosen.term));
    model
}

/// The same with what belongs to the sensors held as it was found, of all terms but the first, which were `given`.
fn with_causes_held(fit: &Fit, given: usize) -> Model {
    let mut model = fit.model().clone();
    take_back(&mut model, fit);
    let of_sensors = fit.parameters.iter().filter(|e| e.parameter.owner == Owner::Sensor);
    for estimate in of_sensors.filter(|estimate| estimate.parameter.term >= given) {
        let at = &estimate.parameter;
        model.terms[at.term].values[at.parameter] = estimate.value;
        model.terms[at.term].roles[at.parameter] = Role::Held;
    }
    without_nameless(model)
}

/// How well the whole was foretold, and each block.
struct Scores {
    foresight: PredictiveScore,
    blocks: Vec<f64>,
}

/// How well a fit to the rest foretells what was held out: every epoch from all before it, and from parameters known as
/// well as the rest tells them, and then this epoch.
fn scored(
    runs: &[Run],
    held: &[Vec<Held>],
    fit: &Fit,
    imu: &ImuSpec,
) -> Result<Scores, Indefinite> {
    let places = Layout::of(&fit.model().free(imu), runs).places;
    let offset = DVector::zeros(fit.parameters.len());
    let mut known = ParameterPosterior::new(offset, fit.covariance.clone());
    let mut blocks = Vec::new();
    let (mut log_score, mut square, mut epochs) = (0.0, 0.0, 0_usize);
    for (((linear, noise), places), held) in
        fit.linear.iter().zip(&fit.noise).zip(&places).zip(held)
    {
        let within: Vec<&Range<usize>> = held.iter().flat_map(|held| &held.blocks).collect();
        let block_of = |samples: &Range<usize>| {
            within.iter().position(|block| block.start <= samples.start && samples.end <= block.end)
        };
        let told = known.predict(linear, noise, places, |samples| block_of(samples).is_some())?;
        let mut sums = vec![0.0; within.len()];
        for EpochPrediction { samples, innovation, log_density } in &told {
            if let Some(block) = block_of(samples) {
                sums[block] += log_density;
            }
            square += innovation.norm_squared();
        }
        epochs += told.len();
        log_score += sums.iter().sum::<f64>();
        blocks.extend(sums);
    }
    let nis_mean = square / epochs.max(1) as f64;
    let nis_dof = fit.linear.iter().map(Linear::shown).max().unwrap_or(0);
    Ok(Scores { foresight: PredictiveScore { log_score, nis_mean, nis_dof }, blocks })
}

/// Between what the sum is with 95 % probability, if blocks are drawn again from those there are.
fn interval(blocks: &[f64]) -> (f64, f64) {
    let mut random = Pcg64::seed_from_u64(1);
    let mut sums: Vec<f64> = (0..DRAWS)
        .map(|_| blocks.iter().map(|_| blocks[random.random_range(0..blocks.len())]).sum())
        .collect();
    sums.sort_by(f64::total_cmp);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "a share of the number of draws"
    )]
    let tail = (TAIL * DRAWS as f64) as usize;
    (sums[tail], sums[DRAWS - 1 - tail])
}
