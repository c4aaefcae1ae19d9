//! Random errors that are not as the data sheet says.

use rins_estimation::{
    Estimate, Fit, Indefinite, Noise, NoiseKnowledge, Strengths, TriadStrengths,
};
use rins_motion::Repeats;
use rins_terms::{Free, Term, catalogue};

use crate::case::Case;
use crate::diagnosis::{Cause, FALSE_ALARMS};
use crate::probability::ln_tail;
use crate::survey::{RunNoise, Survey};

/// White noise that differs from the sheet's by less than this factor is as the sheet says.
const WHITE: f64 = 1.25;

/// Flicker that a sheet states is as it says up to this factor.
const FLICKER: f64 = 2.0;

/// The step, as a logarithm, by which the likelihood's curvature is found.
const STEP: f64 = 0.1;

/// The share of a walk that was found, of which a sheet says nothing, that is as good as none.
const NO_WALK: f64 = 0.01;

/// The colours of noise.
#[derive(Clone, Copy, PartialEq, Eq)]
enum Colour {
    White,
    Flicker,
    Walk,
}

/// The gyros' strengths, which are the first, or the accelerometers'.
pub(crate) fn triad(strengths: &mut Strengths, which: usize) -> &mut TriadStrengths {
    if which == 0 { &mut strengths.gyro } else { &mut strengths.accel }
}

/// A strength of one triad.
struct Strength {
    term: &'static Term,
    /// Which triad: the gyros, the accelerometers.
    triad: usize,
    colour: Colour,
}

const STRENGTHS: [Strength; 6] = [
    Strength { term: &catalogue::GYRO_NOISE_LEVEL, triad: 0, colour: Colour::White },
    Strength { term: &catalogue::GYRO_BIAS_INSTABILITY, triad: 0, colour: Colour::Flicker },
    Strength { term: &catalogue::GYRO_RATE_RANDOM_WALK, triad: 0, colour: Colour::Walk },
    Strength { term: &catalogue::ACCEL_NOISE_LEVEL, triad: 1, colour: Colour::White },
    Strength { term: &catalogue::ACCEL_BIAS_INSTABILITY, triad: 1, colour: Colour::Flicker },
    Strength { term: &catalogue::ACCEL_RATE_RANDOM_WALK, triad: 1, colour: Colour::Walk },
];

impl Strength {
    fn slot<'a>(&self, strengths: &'a mut Strengths) -> &'a mut f64 {
        let triad = triad(strengths, self.triad);
        match self.colour {
            Colour::White => &mut triad.white,
            Colour::Flicker => &mut triad.flicker,
            Colour::Walk => &mut triad.walk,
        }
    }

    fn value(&self, strengths: &Strengths) -> f64 {
        *self.slot(&mut { *strengths })
    }

    /// All runs' noise with another strength.
    fn with(&self, noise: &[Noise], value: f64) -> RunNoise {
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
    /// What is left unexplained is in the noise that was found, so that no level can be told then; a walk that the sheet
    /// says nothing of was asked for by itself.
    pub(crate) fn noise_causes(
        &self,
        after: &Fit,
        is_all_explained: bool,
    ) -> Result<Vec<Cause>, Indefinite> {
        let NoiseKnowledge::Likely(sheet) = self.knowledge else { return Ok(Vec::new()) };
        let mut causes = Vec::new();
        for strength in &STRENGTHS {
            let found = strength.value(&after.noise[0].imu);
            let is_white = strength.colour == Colour::White;
            let asked = strength.colour == Colour::Walk && self.walks[strength.triad];
            // Where a walk was asked for, the sheet's is where its search began.
            let said = if asked { 0.0 } else { strength.value(&sheet) };
            let usual = strength.term.parameters[0].range(self.imu).1;
            let (as_said, limit) = match (strength.colour, said > 0.0) {
                (Colour::White, _) => (said, WHITE),
                (_, true) => (said, FLICKER),
                (Colour::Flicker, false) => (usual, 1.0),
                (Colour::Walk, false) => (NO_WALK * found, 1.0),
            };
            let ratio = (found / as_said).ln();
            let strange = if is_white { ratio.abs() } else { ratio } > limit.ln();
            if !strange || !ratio.is_finite() || !(is_all_explained || asked) {
                continue;
            }
            let [here, there, above, below] = self.likelihoods(
                after,
                strength,
                [found, as_said, found * STEP.exp(), found * (-STEP).exp()],
            )?;
            let statistic = 2.0 * (here - there);
            let ln_p = ln_tail(statistic.max(0.0), 1) + (STRENGTHS.len() as f64).ln();
            if ln_p > FALSE_ALARMS.ln() {
                continue;
            }
            let curvature = (2.0 * here - above - below) / (STEP * STEP);
            let sigma = found * curvature.max(1e-6).sqrt().recip();
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
                gain: 0.5 * statistic,
                rivals: Vec::new(),
            });
        }
        Ok(causes)
    }

    /// The logarithm of the data's probability with each of four strengths.
    fn likelihoods(
        &self,
        after: &Fit,
        strength: &Strength,
        values: [f64; 4],
    ) -> Result<[f64; 4], Indefinite> {
        let noises = values.map(|value| strength.with(&after.noise, value));
        let survey = Survey::of(self.runs, after, self.imu, &[], &noises)?;
        let of =
            |noise| survey.left(noise, &[], &[]).map_or(f64::NEG_INFINITY, |l| l.log_likelihood);
        Ok([0, 1, 2, 3].map(of))
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
    let free = Free {
        id: format!("{}.{}", term.id, parameter.name),
        unit: parameter.unit,
        owner: term.owner,
        term: 0,
        parameter: place,
        sigma: f64::INFINITY,
    };
    Estimate { parameter: free, run, expected: 0.0, value, sigma }
}
