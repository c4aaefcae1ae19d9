//! One pass over the runs tells of all candidates at once how much better each would explain them.

use nalgebra::{Cholesky, DMatrix, DVector};
use rayon::prelude::*;
use rins_estimation::{
    Estimate, Evidence, Fit, Indefinite, Layout, Linear, Noise, Run, linearise_coarsely,
};
use rins_imu::ImuSpec;
use rins_terms::{FreeParameter, TermInstance, catalogue};

use crate::evidence::left::{Left, chosen};
use crate::hypothesis::ABOUT_AXIS;
use crate::proposal::candidates::{Candidate, has_encoder};
use crate::proposal::dead_zone;

/// The prior's information on an effect that has been found, in units of what is usual of it.
const FREE: f64 = 1e-4;

/// A step that tilts the base by less than this part of what it turns it about the table's axis is a slip of the encoder.
const LEAST_ACROSS: f64 = 0.3;

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
    /// Whether an encoder may slip.
    pub(crate) has_encoder: bool,
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
        Ok(Self {
            known,
            terms,
            places,
            said,
            sigmas,
            off,
            least_tilt: 0.0,
            has_encoder: has_encoder(runs),
        })
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
        Self { known, terms: 0, places, said, sigmas, off, least_tilt: 0.0, has_encoder: false }
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
            explained,
            places,
            log_likelihood: -0.5 * squares - log_determinant - log_det,
        })
    }

    /// Whether a shape can have these amplitudes, in SI units.
    pub(crate) fn allows(
        &self,
        shape: &TermInstance,
        parameters: &[usize],
        amplitudes: &DVector<f64>,
    ) -> bool {
        let tilts = shape.term.is(&catalogue::BASE_TILT_STEP);
        let is_rounding = tilts && amplitudes.amax() < self.least_tilt;
        // What turns the base about the table's axis tilts it too; without an encoder it may be the table that turned.
        let across = parameters.iter().zip(amplitudes).filter(|(of, _)| **of != ABOUT_AXIS);
        let tilt = across.fold(0.0_f64, |most, (_, amplitude)| most.max(amplitude.abs()));
        let is_slip = tilts && self.has_encoder && tilt < LEAST_ACROSS * amplitudes.amax();
        let is_as_deep = !dead_zone::is_of_widths(shape)
            || dead_zone::is_as_deep(shape, parameters, amplitudes.as_slice());
        is_as_deep && !is_rounding && !is_slip
    }

    /// The statistic of some places with the noise that makes it largest, and its degrees of freedom; with each noise less than the
    /// most likely one it loses twice the logarithm of their odds.
    pub(crate) fn largest_statistic(&self, places: &[usize]) -> (f64, usize) {
        let left = (0..self.noises()).filter_map(|noise| self.left(noise, &[], &[]));
        let left: Vec<Left<'_>> = left.collect();
        let most = left.iter().map(|left| left.log_likelihood).fold(f64::NEG_INFINITY, f64::max);
        let of = |left: &Left<'_>| {
            let (statistic, dof) = left.statistic(places);
            (statistic + 2.0 * (left.log_likelihood - most), dof)
        };
        left.iter().map(of).max_by(|a, b| a.0.total_cmp(&b.0)).unwrap_or_default()
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
