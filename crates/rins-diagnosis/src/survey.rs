//! One pass over the runs tells of all candidates at once how much better each would explain them.

use std::borrow::Cow;

use nalgebra::{Cholesky, DMatrix, DVector};
use rayon::prelude::*;
use rins_estimation::{
    Estimate, Evidence, Fit, Indefinite, Layout, Linear, Noise, Run, linearise_coarsely,
};
use rins_imu::ImuSpec;
use rins_terms::FreeParameter;

use crate::candidates::Candidate;
use crate::dead_zone;

/// The prior's information on an effect that has been found, in units of what is usual of it.
const FREE: f64 = 1e-4;

/// The noise of every run.
pub(crate) type RunNoise = Vec<Noise>;

/// What runs say of a fitted model's parameters and of all candidates', for several strengths of the noise.
pub(crate) struct Survey {
    /// How many parameters are the model's; the candidates' come after them.
    known: usize,
    /// How many terms are the model's.
    terms: usize,
    /// Of every term, first the model's and then the candidates', the places of its parameters: a list for each of the
    /// term's own, since several runs may each have one.
    places: Vec<Vec<Vec<usize>>>,
    /// The information on all parameters in units of their priors' sigmas, the score, and twice the cost of
    /// the noise: for each strength of it.
    said: Vec<Said>,
    /// The 1σ that is expected of every parameter, in SI units.
    sigmas: Vec<f64>,
    /// How far each of the model's parameters is from what was expected of it, in sigmas.
    off: DVector<f64>,
    /// A tilt of the base by less is what the gyros' rounding does \[rad\].
    pub(crate) least_tilt: f64,
}

struct Said {
    information: DMatrix<f64>,
    score: DVector<f64>,
    square: f64,
    log_determinant: f64,
}

/// What is said along one direction when the model's parameters are estimated.
pub(crate) struct Slope {
    /// The information on how far to go.
    pub(crate) information: f64,
    /// The derivative of the log-likelihood.
    pub(crate) score: f64,
    /// How far the model's parameters follow, in SI units.
    pub(crate) shift: DVector<f64>,
}

/// What is left to say of parameters when others have been estimated, or set to nothing.
///
/// Few of the products of thousands of candidates' parameters are ever asked for: each block is made when it is.
pub(crate) struct Left<'a> {
    /// The information on all parameters, in units of the priors' sigmas.
    information: &'a DMatrix<f64>,
    /// What the estimated ones explain of it: `L⁻¹ A`, where `A` are their products with what is left, and `L Lᵀ` those with
    /// each other.
    explained: Cow<'a, DMatrix<f64>>,
    /// The derivative of the log-likelihood by all that is left.
    pub(crate) score: DVector<f64>,
    /// The places that are left.
    places: Cow<'a, [usize]>,
    /// The logarithm of the probability of the data, but for a constant, if none of what is left is there.
    pub(crate) log_likelihood: f64,
}

impl Survey {
    /// What `runs` say about the estimates in `fit`, for each of `noises`.
    ///
    /// # Errors
    /// [`Indefinite`] if a noise makes no covariance.
    pub(crate) fn of(
        runs: &[Run],
        fit: &Fit,
        imu: &ImuSpec,
        candidates: &[Candidate],
        noises: &[RunNoise],
    ) -> Result<Self, Indefinite> {
        let mut free = Vec::new();
        let mut linear: Vec<Linear> = Vec::new();
        for (run, model) in runs.iter().zip(&fit.models) {
            let mut model = model.clone();
            for chosen in model.terms.iter_mut().filter(|chosen| dead_zone::is_true(chosen)) {
                // Its slope does not lead to nothing, which is where an effect goes that is dropped.
                *chosen = dead_zone::linear(chosen);
            }
            model.terms.extend(candidates.iter().map(|candidate| candidate.chosen.clone()));
            free = model.free(imu);
            let columns: Vec<(usize, usize)> = free.iter().map(|f| (f.term, f.parameter)).collect();
            linear.push(linearise_coarsely(run, &model, &columns));
        }
        let known_free = free.iter().filter(|f| f.term < fit.model().terms.len()).count();
        let layout =
            Places::of(&free, known_free, runs, fit.model().terms.len() + candidates.len());
        let known = layout.known;
        let off = DVector::from_fn(known, |place, _| {
            let estimate = &fit.parameters[place];
            let of = &fit.model().terms[estimate.parameter.term];
            let nothing = if dead_zone::is_true(of) { 0.0 } else { estimate.expected };
            (estimate.value - nothing) / estimate.parameter.sigma
        });
        let said = noises
            .par_iter()
            .map(|noise| {
                let mut sum = Evidence::none(layout.sigmas.len());
                for ((linear, noise), places) in linear.iter().zip(noise).zip(&layout.of_runs) {
                    sum.add(&Evidence::of(linear, noise)?, places, &vec![1.0; places.len()]);
                }
                Ok(Said::of(&sum, &layout.sigmas))
            })
            .collect::<Result<Vec<Said>, Indefinite>>()?;
        let terms = fit.model().terms.len();
        let Places { of_terms: places, sigmas, .. } = layout;
        Ok(Self { known, terms, places, said, sigmas, off, least_tilt: 0.0 })
    }

    /// What one run says of what comes after the `known` parameters, in units of these `scales`; the known ones are estimated
    /// from this run alone.
    pub(crate) fn of_evidence(
        evidence: &Evidence,
        known: &[&Estimate],
        scales: impl Iterator<Item = f64>,
    ) -> Self {
        let of_known = known.iter().map(|estimate| estimate.parameter.sigma);
        let sigmas: Vec<f64> = of_known.chain(scales).collect();
        let off = known.iter().map(|known| (known.value - known.expected) / known.parameter.sigma);
        let off = DVector::from_iterator(known.len(), off);
        let said = vec![Said::of(evidence, &sigmas)];
        let (known, places) = (known.len(), Vec::new());
        Self { known, terms: 0, places, said, sigmas, off, least_tilt: 0.0 }
    }

    /// The survey of the first so many noises, which this one then lacks.
    pub(crate) fn split_off(&mut self, noises: usize) -> Self {
        let rest = self.said.split_off(noises.min(self.said.len()));
        Self {
            said: std::mem::replace(&mut self.said, rest),
            places: self.places.clone(),
            sigmas: self.sigmas.clone(),
            off: self.off.clone(),
            ..*self
        }
    }

    /// How many strengths of the noise there are.
    pub(crate) const fn noises(&self) -> usize {
        self.said.len()
    }

    /// The 1σ that is expected of what stands at these places, in SI units.
    pub(crate) fn sigmas(&self, places: &[usize]) -> DVector<f64> {
        DVector::from_iterator(places.len(), places.iter().map(|&place| self.sigmas[place]))
    }

    /// The places of the parameters of one of the model's terms.
    pub(crate) fn of_term(&self, term: usize) -> &[Vec<usize>] {
        &self.places[term]
    }

    /// The places of a candidate's parameters.
    pub(crate) fn of_candidate(&self, candidate: usize) -> &[Vec<usize>] {
        &self.places[self.terms + candidate]
    }

    /// What is left to say of the candidates and of `dropped`, parameters of the model that are set to what was
    /// expected of them, when all others of the model have been estimated, and the candidates' parameters `taken` too.
    ///
    /// None if the information on these is not finite.
    pub(crate) fn left(
        &self,
        noise: usize,
        dropped: &[usize],
        taken: &[usize],
    ) -> Option<Left<'_>> {
        let Said { information, score, square, log_determinant } = &self.said[noise];
        let kept: Vec<usize> = (0..self.known)
            .filter(|place| !dropped.contains(place))
            .chain(taken.iter().copied())
            .collect();
        let all = information.ncols();
        let places: Vec<usize> = dropped.iter().copied().chain(self.known..all).collect();
        // To the point where the dropped are what was expected.
        let mut shift = DVector::zeros(all);
        for &place in dropped {
            shift[place] = -self.off[place];
        }
        let moved = information * &shift;
        let square = square - 2.0 * score.dot(&shift) + shift.dot(&moved);
        let score = score - moved;
        let mut corner = chosen(information, &kept, &kept);
        let candidate = |place: usize| place >= self.known;
        for (index, &place) in kept.iter().enumerate() {
            // Nothing holds back an effect that has been found.
            corner[(index, index)] += if candidate(place) { FREE } else { 1.0 };
        }
        let off = |&place: &usize| if candidate(place) { 0.0 } else { self.off[place] };
        let off = DVector::from_iterator(kept.len(), kept.iter().map(off));
        let pulled = DVector::from_iterator(kept.len(), kept.iter().map(|&p| score[p])) - &off;
        let factor = Cholesky::new(corner)?.unpack();
        let whitened = factor.solve_lower_triangular(&pulled)?;
        let explained = factor.solve_lower_triangular(&chosen(information, &kept, &places))?;
        let rest = DVector::from_iterator(places.len(), places.iter().map(|&place| score[place]));
        let log_det: f64 = factor.diagonal().iter().map(|x| x.ln()).sum();
        let squares = square + off.norm_squared() - whitened.norm_squared();
        Some(Left {
            information,
            score: rest - explained.tr_mul(&whitened),
            explained: Cow::Owned(explained),
            places: Cow::Owned(places),
            log_likelihood: -0.5 * squares - log_determinant - log_det,
        })
    }

    /// What is said along a direction in which candidates' parameters change, each so much in SI units, with the
    /// first of the noises.
    ///
    /// None if the information on the model's parameters is not finite.
    pub(crate) fn along(&self, direction: &[(usize, f64)]) -> Option<Slope> {
        let Said { information, score, .. } = self.said.first()?;
        let known: Vec<usize> = (0..self.known).collect();
        let mut way = DVector::zeros(information.ncols());
        for &(place, change) in direction {
            way[place] += change / self.sigmas[place];
        }
        let seen = information * &way;
        let across = seen.rows(0, self.known).into_owned();
        let corner =
            chosen(information, &known, &known) + DMatrix::identity(self.known, self.known);
        let followed = Cholesky::new(corner)?.solve(&across);
        let pulled = score.rows(0, self.known) - &self.off;
        let scale = DVector::from_column_slice(&self.sigmas[..self.known]);
        Some(Slope {
            information: way.dot(&seen) - across.dot(&followed),
            score: way.dot(score) - followed.dot(&pulled),
            shift: -followed.component_mul(&scale),
        })
    }
}

impl Said {
    fn of(evidence: &Evidence, sigmas: &[f64]) -> Self {
        let scale = DVector::from_column_slice(sigmas);
        Self {
            information: DMatrix::from_fn(sigmas.len(), sigmas.len(), |row, column| {
                evidence.information[(row, column)] * scale[row] * scale[column]
            }),
            score: evidence.score.component_mul(&scale),
            square: evidence.square,
            log_determinant: evidence.log_determinant,
        }
    }
}

impl Left<'_> {
    /// The same of other data.
    pub(crate) fn with_score(&self, score: DVector<f64>) -> Left<'_> {
        Left {
            information: self.information,
            explained: Cow::Borrowed(&self.explained),
            score,
            places: Cow::Borrowed(&self.places),
            log_likelihood: 0.0,
        }
    }

    /// The information on all that is left.
    pub(crate) fn all(&self) -> DMatrix<f64> {
        let all = chosen(self.information, &self.places, &self.places);
        all - self.explained.tr_mul(&*self.explained)
    }

    /// Information and score of some of the places that are left.
    pub(crate) fn block(&self, places: &[usize]) -> (DMatrix<f64>, DVector<f64>) {
        let (own, places): (Vec<usize>, Vec<usize>) =
            places.iter().filter_map(|&place| Some((self.position(place)?, place))).unzip();
        let score = DVector::from_iterator(own.len(), own.iter().map(|&place| self.score[place]));
        let information = DMatrix::from_fn(own.len(), own.len(), |row, column| {
            let explained =
                self.explained.column(own[row]).dot(&self.explained.column(own[column]));
            self.information[(places[row], places[column])] - explained
        });
        (information, score)
    }

    /// The estimate of some of the places that are left, in units of the priors' sigmas, and by how much the
    /// squares fall with it. None if they are not shown.
    pub(crate) fn estimate(&self, places: &[usize]) -> Option<(DVector<f64>, f64)> {
        let (information, score) = self.block(places);
        let estimate = Cholesky::new(information)?.solve(&score);
        let statistic = estimate.dot(&score);
        Some((estimate, statistic))
    }

    /// The candidates' places go on without gaps to the last; before them are those that were dropped.
    fn position(&self, place: usize) -> Option<usize> {
        let by_end = self
            .places
            .last()
            .and_then(|last| last.checked_sub(place))
            .and_then(|from_end| self.places.len().checked_sub(1 + from_end));
        by_end
            .filter(|&at| self.places[at] == place)
            .or_else(|| self.places.iter().position(|p| *p == place))
    }
}

fn chosen(matrix: &DMatrix<f64>, rows: &[usize], columns: &[usize]) -> DMatrix<f64> {
    DMatrix::from_fn(rows.len(), columns.len(), |row, column| matrix[(rows[row], columns[column])])
}

/// Where all parameters stand: the model's as a fit has them, then the candidates'.
struct Places {
    known: usize,
    of_runs: Vec<Vec<usize>>,
    of_terms: Vec<Vec<Vec<usize>>>,
    sigmas: Vec<f64>,
}

impl Places {
    fn of(free: &[FreeParameter], known_free: usize, runs: &[Run], terms: usize) -> Self {
        let (model, candidates) = free.split_at(known_free);
        let (first, second) = (Layout::of(model, runs), Layout::of(candidates, runs));
        let known = first.all.len();
        let mut of_terms = vec![Vec::new(); terms];
        for (index, parameter) in free.iter().enumerate() {
            let mut places: Vec<usize> = (0..runs.len())
                .map(|run| match index.checked_sub(known_free) {
                    None => first.places[run][index],
                    Some(index) => known + second.places[run][index],
                })
                .collect();
            places.sort_unstable();
            places.dedup();
            of_terms[parameter.term].push(places);
        }
        let of_run = |run: usize| {
            let beyond = second.places[run].iter().map(|place| known + place);
            first.places[run].iter().copied().chain(beyond).collect()
        };
        let sigmas = |layout: &Layout| -> Vec<f64> {
            layout.all.iter().map(|(free, _)| free.sigma).collect()
        };
        Self {
            known,
            of_runs: (0..runs.len()).map(of_run).collect(),
            of_terms,
            sigmas: [sigmas(&first), sigmas(&second)].concat(),
        }
    }
}
