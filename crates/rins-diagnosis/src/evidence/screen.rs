//! All candidates in one linear pass: the score of each beside the current hypothesis.

use nalgebra::{DMatrix, DVector};
use rayon::prelude::*;
use rins_bayes::{Block, ScaleMixture, log_sum};
use rins_imu::ImuSpec;
use rins_terms::{Term, TermInstance};

use crate::evidence::left::Left;
use crate::evidence::survey::Survey;
use crate::hypothesis::{
    DEPARTURE, Support, by_parameter, free, ln_prior, ln_settings, magnitudes,
    magnitudes_of_departure, supports,
};
use crate::proposal::candidates::Candidate;

/// A candidate whose score is below this one even with its amplitudes at their most likely values is not looked at closely: it
/// neither joins a model nor a credible set.
const LEAST: f64 = -3.0;

/// What the runs say of all candidates beside a hypothesis, with the noise that is most likely for each.
pub(crate) struct Screen<'a> {
    survey: &'a Survey,
    imu: &'a ImuSpec,
    /// How many terms there are to choose from.
    terms: usize,
    /// For each noise: what is left to say, and the logarithm of its probability relative to the most likely one.
    noises: Vec<(Left<'a>, f64)>,
    /// The logarithm of the probability of the runs without any candidate, at the most likely noise.
    pub(crate) base: f64,
}

/// What is left to say of the amplitudes of an effect with one noise.
struct Said {
    information: DMatrix<f64>,
    score: DVector<f64>,
    /// The logarithm of the probability of the noise without the effect, relative to all.
    behind: f64,
    /// An upper bound of the logarithm of the Bayes factor.
    bound: f64,
}

/// The block of some of the amplitudes, summed over the noises; its estimate is that of the most likely one.
fn together(said: &[Said], rows: &[usize], magnitudes: &ScaleMixture) -> Option<Block> {
    let n = rows.len();
    let of = |said: &Said| {
        let information =
            DMatrix::from_fn(n, n, |row, column| said.information[(rows[row], rows[column])]);
        let score = DVector::from_iterator(n, rows.iter().map(|&row| said.score[row]));
        let mut block = Block::of(information, &score, magnitudes);
        block.ln_factor += said.behind;
        block
    };
    let blocks: Vec<Block> = said.iter().map(of).collect();
    let ln_factor = log_sum(blocks.iter().map(|block| block.ln_factor));
    let best = blocks.into_iter().max_by(|a, b| a.ln_factor.total_cmp(&b.ln_factor))?;
    Some(Block { ln_factor, ..best })
}

/// A candidate with its score.
#[derive(Clone, Debug)]
pub(crate) struct Scored {
    /// Which candidate.
    pub(crate) candidate: usize,
    /// The logarithm of the odds against nothing, with the priors of term, settings and support, but for those of something
    /// against nothing.
    pub(crate) score: f64,
    /// The parameters of the most likely support.
    pub(crate) parameters: Vec<usize>,
    /// The largest amplitude, in units of its largest typical magnitude.
    pub(crate) amplitude: f64,
    /// The block of the most likely support.
    pub(crate) block: Block,
}

/// A term in all its shapes.
#[derive(Clone, Debug)]
pub(crate) struct Family {
    /// The term.
    pub(crate) term: &'static Term,
    /// The logarithm of the odds against nothing, summed over all shapes.
    pub(crate) score: f64,
    /// The most likely shape.
    pub(crate) best: Scored,
}

impl<'a> Screen<'a> {
    /// With these of the model's parameters dropped, and these of the candidates' taken into it. `ln_priors` are those of the
    /// noises.
    pub(crate) fn of(
        (survey, imu, terms): (&'a Survey, &'a ImuSpec, usize),
        ln_priors: &[f64],
        dropped: &[usize],
        taken: &[usize],
    ) -> Option<Self> {
        let left: Vec<Left<'_>> = (0..survey.noises())
            .into_par_iter()
            .map(|noise| survey.left(noise, dropped, taken))
            .collect::<Option<_>>()?;
        let of = |(left, prior): (Left<'a>, &f64)| {
            let ln = left.log_likelihood + prior;
            (left, ln)
        };
        let mut noises: Vec<(Left<'_>, f64)> = left.into_iter().zip(ln_priors).map(of).collect();
        let base = log_sum(noises.iter().map(|(_, ln)| *ln));
        for (_, ln) in &mut noises {
            *ln -= base;
        }
        Some(Self { survey, imu, terms, noises, base })
    }

    /// What is left to say of all amplitudes of an effect, for each noise, and an upper bound of the logarithm of their Bayes
    /// factor.
    fn left(&self, places: &[usize]) -> (Vec<Said>, f64) {
        let of = |(left, behind): &(Left<'_>, f64)| {
            let (information, score) = left.block(places);
            if !information.iter().all(|x| x.is_finite()) {
                return None;
            }
            let mut regular = information.clone();
            for place in 0..places.len() {
                regular[(place, place)] += 1e-9 + 1e-9 * information[(place, place)];
            }
            let statistic = regular.cholesky().map(|factor| score.dot(&factor.solve(&score)));
            let bound = behind + 0.5 * statistic.unwrap_or(f64::INFINITY);
            Some(Said { information, score, behind: *behind, bound })
        };
        let mut all: Vec<Said> = self.noises.iter().filter_map(of).collect();
        let bound = all.iter().map(|said| said.bound).fold(f64::NEG_INFINITY, f64::max);
        all.retain(|said| said.bound > LEAST - 9.0);
        (all, bound)
    }

    /// The score of an effect whose parameters are at these places, a list for each; `None` if it is not likely enough to
    /// matter. `ln_settings` is the logarithm of the prior probability of its settings.
    pub(crate) fn scored(
        &self,
        (shape, departs): (&TermInstance, bool),
        own: &[Vec<usize>],
        ln_settings: f64,
        supports: &[Support],
    ) -> Option<(f64, Vec<usize>, Block)> {
        let rare = if departs { DEPARTURE } else { 0.0 };
        let prior = ln_prior(shape.term, self.terms) + ln_settings - rare;
        let (said, bound) = self.left(&own.concat());
        if bound + prior < LEAST {
            return None;
        }
        let firsts: Vec<usize> = own
            .iter()
            .scan(0, |next, places| {
                let first = *next;
                *next += places.len();
                Some(first)
            })
            .collect();
        let mut all = Vec::with_capacity(supports.len());
        let mut best: Option<(f64, &Support, Block)> = None;
        for support in supports {
            let places: Vec<usize> =
                support.parameters.iter().flat_map(|&p| own[p].iter().copied()).collect();
            let magnitudes = if departs {
                magnitudes_of_departure()
            } else {
                magnitudes(shape.term, support.parameters[0], self.imu)
            };
            let rows: Vec<usize> = support
                .parameters
                .iter()
                .flat_map(|&p| firsts[p]..firsts[p] + own[p].len())
                .collect();
            let Some(block) = together(&said, &rows, &magnitudes) else { continue };
            let sigmas = self.survey.sigmas(&places);
            let amplitudes = block.estimate.component_mul(&sigmas);
            if !self.survey.allows(shape, &support.parameters, &amplitudes) {
                continue;
            }
            let score = prior + support.ln_prior + block.ln_factor;
            all.push(score);
            if best.as_ref().is_none_or(|(most, ..)| score > *most) {
                best = Some((score, support, block));
            }
        }
        let (_, support, block) = best?;
        Some((log_sum(all), support.parameters.clone(), block))
    }

    /// The score of a candidate.
    pub(crate) fn candidate(&self, index: usize, candidate: &Candidate) -> Option<Scored> {
        let own = by_parameter(&candidate.chosen, self.survey.of_candidate(index));
        let free = free(&candidate.chosen);
        let mut supports = supports(candidate.chosen.term);
        supports.retain(|one| one.parameters.iter().all(|parameter| free.contains(parameter)));
        let departs = candidate.departs.is_some();
        let (score, parameters, block) =
            self.scored((&candidate.chosen, departs), &own, ln_settings(candidate), &supports)?;
        let amplitude = block.estimate.amax();
        Some(Scored { candidate: index, score, parameters, amplitude, block })
    }

    /// All terms, most likely first.
    pub(crate) fn families(
        &self,
        list: &[Candidate],
        admits: impl Fn(&Candidate) -> bool + Sync,
    ) -> Vec<Family> {
        let scored: Vec<Scored> = list
            .par_iter()
            .enumerate()
            .filter(|(_, candidate)| admits(candidate))
            .filter_map(|(index, candidate)| self.candidate(index, candidate))
            .collect();
        let mut families: Vec<Family> = Vec::new();
        for one in scored {
            let term = list[one.candidate].chosen.term;
            match families.iter_mut().find(|family| family.term.is(term)) {
                Some(family) => {
                    family.score = log_sum([family.score, one.score]);
                    if one.score > family.best.score {
                        family.best = one;
                    }
                }
                None => families.push(Family { term, score: one.score, best: one }),
            }
        }
        families.sort_by(|a, b| b.score.total_cmp(&a.score));
        families
    }
}
