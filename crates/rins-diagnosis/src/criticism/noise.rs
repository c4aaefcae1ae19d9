//! Random errors that are not as the data sheet says.

use rins_bayes::ln_tail;
use rins_estimation::{
    Estimate, Fit, Indefinite, Noise, NoiseKnowledge, NoiseParameters, TriadStrengths,
};
use rins_inspection::Repeats;
use rins_terms::{FreeParameter, Term, catalogue};

use crate::case::Case;
use crate::diagnosis::{DiagnosisError, FALSE_ALARMS};
use crate::evidence::survey::RunNoise;
use crate::hypothesis::Process;
use crate::verdict::cause::Cause;

/// White noise that differs from the sheet's by less than this factor is as the sheet says.
const WHITE: f64 = 1.25;

/// Flicker that a sheet states is as it says up to this factor.
const FLICKER: f64 = 2.0;

/// The step, as a logarithm, by which the likelihood's curvature is found.
const STEP: f64 = 0.1;

/// The share of a walk or a jitter that was found, of which a sheet says nothing, that is as good as none.
const AS_GOOD_AS_NONE: f64 = 0.01;

/// The kinds of noise.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Kind {
    /// Of one triad: the gyros, the accelerometers.
    White(usize),
    Flicker(usize),
    Walk(usize),
    /// Of the moments at which the encoder is read.
    Jitter,
}

/// The gyros' strengths, which are the first, or the accelerometers'.
pub(crate) fn triad(strengths: &mut NoiseParameters, which: usize) -> &mut TriadStrengths {
    if which == 0 { &mut strengths.gyro } else { &mut strengths.accel }
}

/// One strength of the noise.
struct Strength {
    term: &'static Term,
    kind: Kind,
}

const STRENGTHS: [Strength; 7] = [
    Strength { term: &catalogue::GYRO_NOISE_LEVEL, kind: Kind::White(0) },
    Strength { term: &catalogue::GYRO_BIAS_INSTABILITY, kind: Kind::Flicker(0) },
    Strength { term: &catalogue::GYRO_RATE_RANDOM_WALK, kind: Kind::Walk(0) },
    Strength { term: &catalogue::ACCEL_NOISE_LEVEL, kind: Kind::White(1) },
    Strength { term: &catalogue::ACCEL_BIAS_INSTABILITY, kind: Kind::Flicker(1) },
    Strength { term: &catalogue::ACCEL_RATE_RANDOM_WALK, kind: Kind::Walk(1) },
    Strength { term: &catalogue::TIMESTAMP_JITTER, kind: Kind::Jitter },
];

impl Kind {
    fn slot(self, strengths: &mut NoiseParameters) -> &mut f64 {
        match self {
            Self::White(which) => &mut triad(strengths, which).white,
            Self::Flicker(which) => &mut triad(strengths, which).flicker,
            Self::Walk(which) => &mut triad(strengths, which).walk,
            Self::Jitter => &mut strengths.jitter,
        }
    }

    fn value(self, strengths: &NoiseParameters) -> f64 {
        *self.slot(&mut { *strengths })
    }

    /// All runs' noise with the strength that was found, with a larger and with a smaller one.
    fn around(self, noise: &[Noise]) -> [RunNoise; 3] {
        let found = self.value(&noise[0].imu);
        [1.0, STEP.exp(), (-STEP).exp()].map(|factor| self.with(noise, factor * found))
    }

    /// All runs' noise with another strength.
    fn with(self, noise: &[Noise], value: f64) -> RunNoise {
        let mut other = noise.to_vec();
        for noise in &mut other {
            *self.slot(&mut noise.imu) = value;
        }
        other
    }
}

impl Case<'_> {
    /// The strengths that were found where the sheet says otherwise, or where it says nothing and they are beyond what
    /// is usual.
    ///
    /// What is left unexplained is in the noise that was found, so that no level can be told then; what the sheet says
    /// nothing of was asked for by itself.
    pub(crate) fn noise_causes(
        &self,
        after: &Fit,
        is_all_explained: bool,
    ) -> Result<Vec<Cause>, DiagnosisError> {
        let NoiseKnowledge::Likely(sought) = self.knowledge else { return Ok(Vec::new()) };
        let mut causes = Vec::new();
        for strength in &STRENGTHS {
            let found = strength.kind.value(&after.noise[0].imu);
            let is_white = matches!(strength.kind, Kind::White(_));
            let said = strength.kind.value(&self.sheet);
            let asked = said == 0.0 && strength.kind.value(&sought) > 0.0;
            let usual = strength.term.parameters[0].range(self.imu).1;
            let (as_said, limit) = match (strength.kind, said > 0.0) {
                (Kind::White(_), _) => (said, WHITE),
                (_, true) => (said, FLICKER),
                (Kind::Flicker(_), false) => (usual, 1.0),
                (Kind::Walk(_) | Kind::Jitter, false) => (AS_GOOD_AS_NONE * found, 1.0),
            };
            let as_said = match strength.kind {
                // Rounding comes to what the sheet says, as far as it is white.
                Kind::White(which) => {
                    found.clamp(as_said, as_said.hypot(self.rounding.white(which)))
                }
                _ => as_said,
            };
            let ratio = (found / as_said).ln();
            let strange = if is_white { ratio.abs() } else { ratio } > limit.ln();
            if !strange || !ratio.is_finite() || !(is_all_explained || asked) {
                continue;
            }
            let around = strength.kind.around(&after.noise);
            let [here, above, below] = self.likelihoods(after, &around)?;
            let anew = asked.then(|| self.gain_over(after, strength)).flatten();
            let gain = match anew {
                Some(gain) => gain,
                None => here - self.as_said(after, strength, as_said)?,
            };
            let statistic = 2.0 * gain;
            let ln_p = ln_tail(statistic.max(0.0), 1) + (STRENGTHS.len() as f64).ln();
            if ln_p > FALSE_ALARMS.ln() {
                continue;
            }
            let sigma = found * relative_sigma([here, above, below]);
            // White noise is told as an excess over the sheet's, flicker as what comes to the sheet's.
            let (value, sigma) = if is_white {
                (found / said - 1.0, sigma / said)
            } else {
                ((found * found - said * said).sqrt(), sigma)
            };
            causes.push(Cause {
                term: strength.term,
                settings: Vec::new(),
                sought: None,
                parameters: vec![estimate(strength.term, 0, None, value, sigma)],
                ln_p,
                dof: 1,
                gain,
                rivals: Vec::new(),
            });
        }
        Ok(causes)
    }

    /// The strength of a noise process that a fit has, and its 1σ.
    pub(crate) fn strength(&self, fit: &Fit, process: Process) -> Result<Estimate, Indefinite> {
        let kind = match process {
            Process::GyroWalk => Kind::Walk(0),
            Process::AccelWalk => Kind::Walk(1),
            Process::Jitter => Kind::Jitter,
        };
        let sigma = relative_sigma(self.likelihoods(fit, &kind.around(&fit.noise))?);
        let value = kind.value(&fit.noise[0].imu);
        Ok(estimate(process.term(), 0, None, value, value * sigma))
    }

    /// The logarithm of the data's probability with a strength as the sheet says. Of white noise the likeliest of some: a base may
    /// sway instead of the gyros being noisy, and flicker was found too strong if it stands for the white noise.
    fn as_said(&self, after: &Fit, strength: &Strength, said: f64) -> Result<f64, Indefinite> {
        let stated = strength.kind.with(&after.noise, said);
        let Kind::White(which) = strength.kind else {
            let [stated] = self.likelihoods(after, &[stated])?;
            return Ok(stated);
        };
        let flicker = Kind::Flicker(which);
        let steady = flicker.with(&stated, flicker.value(&self.sheet));
        if which != 0 {
            let [stated, steady] = self.likelihoods(after, &[stated, steady])?;
            return Ok(stated.max(steady));
        }
        let found = strength.kind.value(&after.noise[0].imu);
        let mut swaying = stated.clone();
        sway(&mut swaying, found * found - said * said);
        let [stated, steady, swaying] = self.likelihoods(after, &[stated, steady, swaying])?;
        Ok(stated.max(steady).max(swaying))
    }

    /// How much more likely a fit is than one without this strength, all others being found anew, as a logarithm: what a walk
    /// does, flicker does nearly as well. None if nothing fits without it.
    fn gain_over(&self, after: &Fit, strength: &Strength) -> Option<f64> {
        let mut sought = self.knowledge.sheet();
        let mut near = after.clone();
        for strengths in near.noise.iter_mut().map(|noise| &mut noise.imu).chain([&mut sought]) {
            *strength.kind.slot(strengths) = 0.0;
        }
        let without = Case { knowledge: NoiseKnowledge::Likely(sought), ..*self };
        let fitted = without.fit_near(&near, self.causes_in(after)).ok()?;
        Some(after.log_likelihood - fitted.log_likelihood)
    }

    /// The logarithm of the data's probability with each of some noises.
    fn likelihoods<const N: usize>(
        &self,
        after: &Fit,
        noises: &[RunNoise; N],
    ) -> Result<[f64; N], Indefinite> {
        let survey = self.survey(after, &[], noises)?;
        let of =
            |noise| survey.left(noise, &[], &[]).map_or(f64::NEG_INFINITY, |l| l.log_likelihood);
        Ok(std::array::from_fn(of))
    }
}

/// The relative 1σ of a strength from the logarithms of the data's probability at it, above and below.
fn relative_sigma([here, above, below]: [f64; 3]) -> f64 {
    let curvature = (2.0 * here - above - below) / (STEP * STEP);
    curvature.max(1e-6).sqrt().recip()
}

/// Has a base that nothing reads stray by so much more, or less: about its axes that looks like the gyros' own noise.
fn sway(noise: &mut [Noise], square: f64) {
    for sway in noise.iter_mut().flat_map(|noise| &mut noise.sway).filter(|sway| **sway > 0.0) {
        *sway = (*sway * *sway + square).max(0.0).sqrt();
    }
}

/// Samples that are stuck, as they were found in a log of so many.
pub fn stuck(repeats: &Repeats, run: usize, samples: usize) -> Cause {
    let term = &catalogue::STUCK_SAMPLES;
    let (count, all) = (repeats.samples as f64, samples as f64);
    // At least so many where so few are expected: Chernoff's bound of a Poisson distribution.
    let expected = repeats.by_chance.max(f64::MIN_POSITIVE);
    let ln_p = count - expected - count * (count / expected).ln();
    let share = count / all;
    let sigma = share / (repeats.rows as f64).sqrt();
    Cause {
        term,
        settings: vec![count / repeats.rows as f64],
        sought: None,
        parameters: vec![estimate(term, 0, Some(run), share, sigma)],
        ln_p: ln_p.min(0.0),
        dof: 1,
        gain: -ln_p.min(0.0),
        rivals: Vec::new(),
    }
}

/// A figure that was found beside the fit.
pub(crate) fn estimate(
    term: &'static Term,
    place: usize,
    run: Option<usize>,
    value: f64,
    sigma: f64,
) -> Estimate {
    let parameter = &term.parameters[place];
    let free = FreeParameter {
        id: format!("{}.{}", term.id, parameter.name),
        unit: parameter.unit,
        owner: term.owner,
        term: 0,
        parameter: place,
        sigma: f64::INFINITY,
    };
    Estimate { parameter: free, run, expected: 0.0, value, sigma }
}
