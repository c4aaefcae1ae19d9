//! Readings in steps, so coarse that their rounding is a part of the noise.

use rins_estimation::{Fit, NoiseParameters, Run};
use rins_inspection::{QuantizationGrid, QuantizationGrids};
use rins_terms::{Term, catalogue};

use crate::case::Case;
use crate::criticism::noise::{estimate, triad};
use crate::criticism::residuals::{ABOUT_AXIS, residuals};
use crate::criticism::structure::Structure;
use crate::criticism::unexplained::Unexplained;
use crate::verdict::cause::Cause;

/// Steps are told of that add more than this part to the variance of white noise in a sample: 0.8 of its sigma.
const TOLD: f64 = 0.05;

/// Steps are coarse that add more than this: noise does not make all of them alike.
const COARSE: f64 = 0.25;

/// Steps are as a sheet states if they are no higher than so many times what it does.
const AS_STATED: f64 = 1.1;

/// The effects of either triad.
const TERMS: [&Term; 2] = [&catalogue::GYRO_QUANTISATION, &catalogue::ACCEL_QUANTISATION];

/// The quantity in which that of an encoder shows.
const SHOWN_ABOUT_AXIS: &str = "attitude.z";

/// What the quantities begin with in which the rounding of either triad shows.
const SHOWN: [[&str; 2]; 2] = [["attitude", "gyro"], ["velocity", "accel"]];

/// The steps of some runs.
#[derive(Clone, Debug, Default)]
pub(crate) struct Rounding {
    /// Of each run those of either triad: of its coarsest sensor.
    runs: Vec<[Option<Steps>; 2]>,
    /// Of each run whether its encoder is coarse beside its noise.
    encoders: Vec<bool>,
}

/// A sensor that reads in steps.
#[derive(Clone, Copy, Debug)]
struct Steps {
    combs: QuantizationGrids,
    /// Their height, as a rate or a force.
    height: f64,
    /// The same over a sample: as an angle or a velocity.
    of_sample: f64,
    /// The root density of white noise that is as strong as their rounding.
    white: f64,
    /// Whether they are coarse.
    coarse: bool,
}

impl Rounding {
    /// The steps of all sensors that are told of, beside the noise that a sheet states.
    pub(crate) fn of(runs: &[Run], sheet: NoiseParameters) -> Self {
        let of_run = |run: &Run| {
            let combs = QuantizationGrids::of(&run.recording);
            let interval = run.recording.mean_interval();
            [0, 1].map(|which| {
                let stated = triad(&mut { sheet }, which).white;
                let steps = (3 * which..3 * which + 3).filter_map(|channel| {
                    let QuantizationGrids { increments, rates } = combs[channel];
                    let of_increments = increments.map(|comb| comb.step / interval);
                    let height = of_increments.or(rates.map(|comb| comb.step))?;
                    let white = height * (interval / 12.0).sqrt();
                    let adds = (white / stated).powi(2);
                    let coarse = adds > COARSE;
                    let combs = combs[channel];
                    let of_sample = height * interval;
                    (adds > TOLD).then_some(Steps { combs, height, of_sample, white, coarse })
                });
                steps.max_by(|a, b| a.white.total_cmp(&b.white))
            })
        };
        Self {
            runs: runs.iter().map(of_run).collect(),
            encoders: runs.iter().map(|run| run.angle_steps.is_some()).collect(),
        }
    }

    /// Whether a sensor's triad reads in coarse steps in a run, or the encoder that it is seen against: the rounding of a
    /// reading that hardly changes is no noise, and makes lines and outliers that are not there.
    pub(crate) fn is_coarse(&self, run: usize, channel: usize) -> bool {
        if channel == ABOUT_AXIS && self.encoders.get(run).is_some_and(|&coarse| coarse) {
            return true;
        }
        let steps = self.runs.get(run).and_then(|run| run[channel / 3]);
        steps.is_some_and(|steps| steps.coarse)
    }

    /// The root density of white noise that is as strong as the rounding of a triad, of all runs' the strongest.
    pub(crate) fn white(&self, which: usize) -> f64 {
        let of = self.runs.iter().filter_map(|run| run[which].map(|steps| steps.white));
        of.fold(0.0, f64::max)
    }

    /// The coarse step of the gyros as an angle \[rad\], of all runs' the largest, by which they are out for as long as a reading
    /// stands; nothing if they read finely.
    pub(crate) fn angle(&self) -> f64 {
        let of_gyros = self.runs.iter().filter_map(|run| run[0]);
        of_gyros.filter(|steps| steps.coarse).map(|steps| steps.of_sample).fold(0.0, f64::max)
    }

    /// Whether something that is left is what coarse steps do: how much their rounding scatters depends on how fast a
    /// reading goes over them.
    pub(crate) fn explains(&self, left: &Unexplained) -> bool {
        let scatters = matches!(
            left.structure,
            Structure::Spread(_) | Structure::Noisier(_) | Structure::Tails
        );
        let shows = |which: usize| SHOWN[which].iter().any(|of| left.channel.starts_with(of));
        let about_axis = left.channel == SHOWN_ABOUT_AXIS && self.is_coarse(left.run, ABOUT_AXIS);
        scatters
            && (about_axis
                || (0..2).any(|which| shows(which) && self.is_coarse(left.run, 3 * which)))
    }
}

impl Case<'_> {
    /// The quantisation of either triad, where it is told of: of the first run that shows it.
    pub(crate) fn quantisation(&self, after: &Fit) -> Vec<Cause> {
        let of_triad = |which: usize| {
            let mut runs = self.rounding.runs.iter().enumerate();
            let (run, steps) = runs.find_map(|(run, of)| Some((run, of[which]?)))?;
            // What the sheet states is nothing that the model lacks.
            let stated = [self.imu.gyro.resolution, self.imu.accel.resolution][which];
            if stated.is_some_and(|stated| steps.height < AS_STATED * stated) {
                return None;
            }
            let (place, comb) = match steps.combs {
                QuantizationGrids { increments: Some(increments), rates: Some(rates) } => {
                    // About the axis, the encoder's noise is a difference too.
                    let shown = [0..ABOUT_AXIS, 3..6][which].clone();
                    let residuals = residuals(&self.runs[run], after, run);
                    let carried = residuals[shown].iter().any(|one| is_carried(one, steps.height));
                    if carried { (0, increments) } else { (1, rates) }
                }
                QuantizationGrids { increments: Some(increments), .. } => (0, increments),
                QuantizationGrids { rates, .. } => (1, rates?),
            };
            Some(cause(TERMS[which], place, &comb))
        };
        (0..2).filter_map(of_triad).collect()
    }
}

fn cause(term: &'static Term, place: usize, comb: &QuantizationGrid) -> Cause {
    Cause {
        term,
        settings: Vec::new(),
        sought: None,
        parameters: vec![estimate(term, place, None, comb.step, comb.sigma)],
        ln_p: comb.ln_p,
        dof: 1,
        gain: -comb.ln_p,
        rivals: Vec::new(),
    }
}

/// Whether what a sample is off by, of steps of this height, is made good by the next.
///
/// Fourth differences, in which nothing is left of what is slow, are as large of white noise whether of neighbours or of
/// every other sample. Rounding that is carried on is itself the difference of white errors, of a twelfth of a squared step
/// each: 252 of them against 140.
fn is_carried(residuals: &[f64], height: f64) -> bool {
    let fourth = |by: usize| {
        let squares = residuals.windows(4 * by + 1).map(|some| {
            let at = |place: usize| some[place * by];
            (at(0) - 4.0 * at(1) + 6.0 * at(2) - 4.0 * at(3) + at(4)).powi(2)
        });
        squares.sum::<f64>() / (residuals.len() - 4 * by) as f64
    };
    fourth(1) - fourth(2) > 0.5 * (252.0 - 140.0) / 12.0 * height * height
}

#[cfg(test)]
mod tests {
    use super::*;
    use rand::SeedableRng;
    use rand_distr::{Distribution, StandardNormal};
    use rand_pcg::Pcg64;

    /// What rounding leaves of noise that is half as strong as a step, carried on or not.
    fn rounded(carries: bool) -> Vec<f64> {
        let mut rest = 0.0;
        let random = Pcg64::seed_from_u64(1);
        let of = |white: f64| {
            let reading: f64 = 0.5 * white;
            let rounded = (reading + rest).round();
            if carries {
                rest += reading - rounded;
            }
            rounded
        };
        let white = StandardNormal.sample_iter(random).take(20_000);
        white.map(of).collect()
    }

    #[test]
    fn rest_that_is_carried_on_is_told_from_one_that_is_lost() {
        assert!(is_carried(&rounded(true), 1.0));
        assert!(!is_carried(&rounded(false), 1.0));
    }
}
