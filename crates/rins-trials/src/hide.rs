//! How strong a hidden effect is, and which rivals the schedule tells from it.

use nalgebra::{DMatrix, DVector, SymmetricEigen};
use rand::RngExt;
use rand_distr::{Distribution, StandardNormal};
use rins_blind::{Random, record};
use rins_estimation::Run;
use rins_terms::{SettingKind, Term, TermInstance, catalogue};
use serde::{Deserialize, Serialize};

use crate::catalogue::{alike, hidden, is_hideable, rivals};
use crate::laboratory::{Laboratory, log_uniform};
use crate::stand::{ExtraInformation, Stand, StandError};

/// How many widths of a dead zone are tried, and how near one has to come to what was meant.
const MOST_WIDTHS: usize = 16;
const AS_MEANT: f64 = 0.01;

/// An effect is at most so many times as large as it usually is.
const LARGEST: f64 = 3.0;

/// A rival is at most so many times as large as it usually is.
const RIVAL: f64 = 30.0;

/// A rival beside which so many sigmas are left is told apart without a doubt.
const TOLD: f64 = 8.0;

/// An effect that was hidden.
#[derive(Clone, Debug, PartialEq, Serialize, Deserialize)]
pub struct Hidden {
    /// Its id.
    pub id: String,
    /// How many times the Cramér-Rao bound it was meant to be.
    pub meant: f64,
    /// How many times it is, found from the run itself: the root of the squares that it adds.
    pub strength: f64,
    /// In how many directions the run shows it.
    pub dof: usize,
    /// Its parameters in SI units.
    pub parameters: Vec<f64>,
    /// Their 1σ where nothing else is unknown but the baseline.
    pub bounds: Vec<f64>,
    /// How large they usually are at most.
    pub usual: Vec<f64>,
    /// Its settings in SI units.
    pub settings: Vec<f64>,
    /// What would be left of it beside each rival, in sigmas, the least first; those only beside which less than
    /// half is left, or less than eight.
    pub confusable: Vec<(String, f64)>,
}

/// What is known of a laboratory's run before anything is hidden in it.
pub(crate) struct Ground {
    pub(crate) laboratory: Laboratory,
    pub(crate) stand: Stand,
    pub(crate) plain: Run,
    pub(crate) duration: f64,
}

impl Ground {
    pub(crate) fn of(laboratory: Laboratory) -> Result<Self, StandError> {
        let stand = Stand::of(&laboratory.experiment, &laboratory.known);
        let interval = laboratory.experiment.interval;
        let plain = stand.run(&record(&quiet(&laboratory)), interval)?;
        let duration = laboratory.experiment.drive.duration();
        Ok(Self { laboratory, stand, plain, duration })
    }

    /// Any effect, `meant` times its bound strong in a random direction, if the run can show one so strong
    /// that is not out of all proportion.
    pub(crate) fn effect(
        &self,
        term: &'static Term,
        meant: f64,
        random: &mut Random,
    ) -> Result<Option<(TermInstance, Hidden)>, StandError> {
        let mut chosen = self.shaped(term, random);
        let told = self.stand.told(&self.plain, std::slice::from_ref(&chosen))?;
        let Some((values, dof)) = sized(&told, meant, random) else { return Ok(None) };
        let mut bounds = bounds(&told);
        chosen.values = values;
        if is_nonlinear(term) {
            let Some(wide) = self.widened(&chosen, meant)? else { return Ok(None) };
            chosen = wide;
            bounds = self::bounds(&self.stand.told(&self.plain, std::slice::from_ref(&chosen))?);
        }
        let run = self.with(&chosen)?;
        let strength = self.strength(&run)?;
        let confusable = self.confusable(&chosen, &run, strength)?;
        let record = Hidden {
            id: term.id.into(),
            meant,
            strength,
            dof,
            parameters: chosen.values.clone(),
            bounds,
            usual: told.scale.clone(),
            settings: chosen.settings.clone(),
            confusable,
        };
        Ok(Some((chosen, record)))
    }

    /// A dead zone, all its widths so many times as wide that it is `meant` sigmas strong: how its strength grows with
    /// them depends on the rates that fall into it. None if it is out of all proportion then, or strong at once.
    fn widened(&self, zone: &TermInstance, meant: f64) -> Result<Option<TermInstance>, StandError> {
        let usual = |(width, p): (&f64, &rins_terms::Parameter)| {
            *width < LARGEST * p.range(&self.stand.imu).1
        };
        let [mut times, mut narrow, mut wide] = [1.0, 0.0, f64::INFINITY];
        for _ in 0..MOST_WIDTHS {
            let mut tried = zone.clone();
            tried.values.iter_mut().for_each(|width| *width = width.abs() * times);
            if !tried.values.iter().zip(zone.term.parameters).all(usual) {
                return Ok(None);
            }
            let strength = self.strength(&self.with(&tried)?)?;
            if (strength / meant - 1.0).abs() < AS_MEANT {
                return Ok(Some(tried));
            }
            *(if strength < meant { &mut narrow } else { &mut wide }) = times;
            // About with the square, if that is between what is too narrow and what is too wide.
            let next = times * (meant / strength).sqrt();
            let inside = narrow < next && next < wide;
            times = if inside { next } else { f64::midpoint(narrow, wide.min(2.0 * times)) };
        }
        Ok(None)
    }

    /// The run without noise, with an effect.
    fn with(&self, chosen: &TermInstance) -> Result<Run, StandError> {
        let mut quiet = quiet(&self.laboratory);
        quiet.effects.push(hidden(chosen));
        self.stand.run(&record(&quiet), quiet.interval)
    }

    /// The root of the squares that the effect in a run adds to what the baseline leaves.
    fn strength(&self, run: &Run) -> Result<f64, StandError> {
        Ok(self.stand.told(run, &[])?.square.max(0.0).sqrt())
    }

    /// An effect with random settings.
    fn shaped(&self, term: &'static Term, random: &mut Random) -> TermInstance {
        let mut chosen = TermInstance::new(term).estimated();
        for setting in term.settings {
            let value = match setting.kind {
                SettingKind::Time => self.duration * (0.1 + 0.8 * random.random::<f64>()),
                SettingKind::TimeConstant => self.duration * log_uniform(random, 0.02, 0.4),
                // Slow enough for an epoch of the estimator to show it: its strength is told by that.
                SettingKind::Frequency => log_uniform(random, 0.02, 0.8),
                SettingKind::Axis => f64::from(random.random_range(1..=3_u8)),
                SettingKind::Exponent => 0.5 * 6_f64.powf(random.random()),
                SettingKind::Order if setting.within.0 < 0.0 => {
                    [-4.0, -3.0, -2.0, -1.0, 2.0, 3.0, 4.0, 5.0, 7.0, 12.0]
                        [random.random_range(0..10)]
                }
                SettingKind::Order => f64::from(random.random_range(2..=12_u8)),
                _ => setting.default,
            };
            chosen = chosen.with_setting(setting.kind, value);
        }
        if is_nonlinear(term) {
            // Its square counts: it is looked at where it is as wide as usual.
            let wide = |p: &rins_terms::Parameter| p.range(&self.stand.imu).1;
            chosen.values = term.parameters.iter().map(wide).collect();
        }
        chosen
    }

    /// What is left of an effect in a run beside each other one.
    fn confusable(
        &self,
        chosen: &TermInstance,
        run: &Run,
        strength: f64,
    ) -> Result<Vec<(String, f64)>, StandError> {
        let mut others = rivals(self.duration);
        others.extend(alike(chosen));
        others.retain(|rival| !rival.term.is(chosen.term));
        let told = self.stand.told(run, &others)?;
        let mut least: Vec<(String, f64)> = Vec::new();
        for (number, rival) in others.iter().enumerate() {
            let left = (told.square - explained(&told, number)).max(0.0).sqrt();
            match least.iter_mut().find(|(id, _)| id == rival.term.id) {
                Some((_, known)) => *known = known.min(left),
                None => least.push((rival.term.id.into(), left)),
            }
        }
        least.retain(|(_, left)| *left < TOLD || *left < 0.5 * strength);
        least.sort_by(|a, b| a.1.total_cmp(&b.1));
        Ok(least)
    }
}

/// The experiment without any noise and without the table's imperfections.
pub(crate) fn quiet(laboratory: &Laboratory) -> rins_blind::Experiment {
    let mut quiet = laboratory.experiment.clone();
    for sensors in [&mut quiet.gyro, &mut quiet.accel] {
        sensors.noise = rins_blind::Noise::default();
        sensors.rounding = None;
    }
    quiet.encoder = rins_blind::Encoder { noise: 0.0, resolution: 0.0 };
    quiet.effects.clear();
    quiet
}

/// Parameters `meant` sigmas off zero in a random direction of those in which that is not out of all proportion,
/// in SI units, and how many such directions there are.
fn sized(told: &ExtraInformation, meant: f64, random: &mut Random) -> Option<(Vec<f64>, usize)> {
    let SymmetricEigen { eigenvalues, eigenvectors } =
        SymmetricEigen::new(told.information.clone());
    let shown: Vec<usize> = (0..eigenvalues.len())
        .filter(|&place| eigenvalues[place] > (meant / LARGEST).powi(2))
        .collect();
    if shown.is_empty() {
        return None;
    }
    let along: Vec<f64> = shown.iter().map(|_| StandardNormal.sample(random)).collect();
    let length = along.iter().map(|x| x * x).sum::<f64>().sqrt();
    let mut values = DVector::zeros(eigenvalues.len());
    for (&place, part) in shown.iter().zip(&along) {
        let sigmas = meant * part / length;
        values += eigenvectors.column(place) * (sigmas / eigenvalues[place].sqrt());
    }
    let values = values.iter().zip(&told.scale).map(|(value, scale)| value * scale).collect();
    Some((values, shown.len()))
}

/// The 1σ of each parameter of the first term beyond the baseline, within its usual size.
fn bounds(told: &ExtraInformation) -> Vec<f64> {
    let n = told.information.nrows();
    let sum = &told.information + DMatrix::identity(n, n);
    let Some(factor) = sum.cholesky() else { return told.scale.clone() };
    let covariance = factor.inverse();
    covariance.diagonal().iter().zip(&told.scale).map(|(v, scale)| v.sqrt() * scale).collect()
}

/// By how much the squares fall where term `rival` is free.
pub(crate) fn explained(told: &ExtraInformation, rival: usize) -> f64 {
    let places = told.places(rival);
    let (start, size) = (places.start, places.len());
    let mut information = told.information.view((start, start), (size, size)).into_owned();
    let score = told.score.rows(start, size).into_owned();
    for place in 0..information.nrows() {
        information[(place, place)] += RIVAL.powi(-2);
    }
    information.cholesky().map_or(0.0, |factor| score.dot(&factor.solve(&score)))
}

/// Whether an effect is the one that is not linear in its parameters.
fn is_nonlinear(term: &Term) -> bool {
    term.is(&catalogue::GYRO_DEAD_ZONE)
}

/// The effects that may be hidden.
pub(crate) fn hideable() -> Vec<&'static Term> {
    catalogue::CATALOGUE.iter().copied().filter(|term| is_hideable(term)).collect()
}
