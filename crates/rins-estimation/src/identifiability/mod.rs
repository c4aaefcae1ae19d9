//! What data can tell of parameters: rank, null directions, gauges, and what tells two effects apart.
//!
//! All follows from the Fisher information of the parameters, seen in units of their priors' sigmas.

mod gauge;
mod joint;
mod rank;
mod separation;

#[cfg(test)]
mod tests;

use nalgebra::{Cholesky, DMatrix, DVector};
use rins_terms::Unit;

pub use gauge::{GAUGES, Gauge, gauge_of};
pub use joint::{Joint, JointError, joint};
pub use rank::{EXACT, Lost, Rank};
pub use separation::{Direction, Separation, distance, separation};

/// A parameter whose value is sought.
#[derive(Clone, Debug, PartialEq)]
pub struct Unknown {
    /// Its full id, such as `gyro.misalignment.xz`.
    pub id: String,
    /// The run that it belongs to, counted from zero; none if to the IMU, or if there is one run only.
    pub run: Option<usize>,
    /// The unit in which it is shown.
    pub unit: Unit,
    /// The 1σ to which it is known beforehand, in SI units.
    pub sigma: f64,
}

/// A parameter that stands in a combination with another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alias {
    /// Which unknown.
    pub unknown: usize,
    /// How much of the combination's first parameter one of it amounts to, in SI units.
    pub coefficient: f64,
    /// Whether no data of this schedule, however good, would tell it from the others.
    pub exactly: bool,
}

/// What data tell of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum Shown {
    /// The parameter itself.
    Alone,
    /// Only the sum of the parameter and of others, each times its coefficient.
    Combination(Vec<Alias>),
    /// Nothing of its own: it is part of what these unknowns stand for.
    Part {
        /// The unknowns.
        of: Vec<usize>,
        /// Whether that holds exactly.
        exactly: bool,
    },
    /// Less than was known beforehand, even if all else were known.
    Nothing,
}

/// One unknown in the light of the data.
#[derive(Clone, Debug, PartialEq)]
pub struct Seen {
    /// What of it the data tell.
    pub shown: Shown,
    /// Its 1σ, or that of its combination, by the data alone, in SI units; infinite if they tell nothing.
    pub data_sigma: f64,
    /// The parameter's own 1σ when what is known beforehand is used too.
    pub sigma: f64,
    /// The gauge that makes it a part of others under every schedule, if one does.
    pub gauge: Option<&'static Gauge>,
    /// Whether the data tell the parameter itself, and better than it was known beforehand.
    pub identifiable: bool,
}

/// What data tell of a list of unknowns.
///
/// ```
/// use nalgebra::DMatrix;
/// use rins_estimation::{Identifiability, Shown, Unknown};
/// use rins_terms::Unit;
/// let unknown = |id: &str| Unknown { id: id.into(), run: None, unit: Unit::ONE, sigma: 1.0 };
/// // A hundred readings of a + 2 b, each to 1σ of 1.
/// let information = DMatrix::from_row_slice(2, 2, &[100.0, 200.0, 200.0, 400.0]);
/// let told = Identifiability::of(&information, vec![unknown("a"), unknown("b")]);
/// assert_eq!(told.rank.rank(), 1);
/// // They tell b + a/2 to 0.05, and neither alone.
/// let Shown::Combination(aliases) = &told.seen[1].shown else { panic!() };
/// assert!((aliases[0].coefficient - 0.5).abs() < 1e-12);
/// assert!((told.seen[1].data_sigma - 0.05).abs() < 1e-12);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Identifiability {
    /// The unknowns.
    pub unknowns: Vec<Unknown>,
    /// What is told of each.
    pub seen: Vec<Seen>,
    /// How many combinations the data tell, and which unknowns stand for them.
    pub rank: Rank,
}

/// The part of the largest of several shares below which one is not mentioned.
const SLIGHT: f64 = 0.1;

/// How many times its own sigma what is faintly told must be able to shift a parameter, to be named beside it.
const DOMINANT: f64 = 3.0;

impl Identifiability {
    /// What data with this Fisher information, in SI units, tell of `unknowns`.
    ///
    /// # Panics
    /// If the information is of fewer parameters.
    pub fn of(information: &DMatrix<f64>, unknowns: Vec<Unknown>) -> Self {
        let sigmas: Vec<f64> = unknowns.iter().map(|unknown| unknown.sigma).collect();
        let scaled = scaled(information, &sigmas);
        let rank = Rank::of(&scaled);
        let own = with_prior(&scaled);
        let nothing = |(own, sigma): (&f64, &f64)| Seen {
            shown: Shown::Nothing,
            data_sigma: f64::INFINITY,
            sigma: own * sigma,
            gauge: None,
            identifiable: false,
        };
        let mut told =
            Self { seen: own.iter().zip(&sigmas).map(nothing).collect(), unknowns, rank };
        (0..told.rank.kept.len()).for_each(|place| told.see_kept(place));
        (0..told.rank.lost.len()).for_each(|place| told.see_lost(place));
        told
    }

    /// The place of the unknown of this id, of the IMU or of the first run.
    pub fn find(&self, id: &str) -> Option<usize> {
        self.unknowns.iter().position(|unknown| unknown.id == id)
    }

    /// Of an unknown that is kept: with what it is told.
    fn see_kept(&mut self, place: usize) {
        let (kept, sigma) = (self.rank.kept[place], self.rank.sigmas[place]);
        let shares = self.rank.coefficients.row(place);
        // What is lost may be anything within its prior: is that more than what the data leave open?
        let hidden = shares.norm();
        let least = SLIGHT * hidden.max(sigma);
        let alias = |(lost, share): (&Lost, &f64)| Alias {
            unknown: lost.unknown,
            coefficient: share * self.unknowns[kept].sigma / self.unknowns[lost.unknown].sigma,
            exactly: lost.exactly,
        };
        let aliases: Vec<Alias> = self
            .rank
            .lost
            .iter()
            .zip(&shares)
            .filter(|(lost, share)| {
                share.abs() > least && (lost.exactly || hidden > DOMINANT * sigma)
            })
            .map(alias)
            .collect();
        let seen = &mut self.seen[kept];
        seen.data_sigma = sigma * self.unknowns[kept].sigma;
        seen.identifiable = aliases.is_empty() && sigma < 1.0;
        seen.shown = if aliases.is_empty() { Shown::Alone } else { Shown::Combination(aliases) };
    }

    /// Of an unknown that is lost: what stands for it.
    fn see_lost(&mut self, place: usize) {
        let Lost { unknown, exactly, visible } = self.rank.lost[place];
        if !visible {
            return;
        }
        // By how many of its sigmas each of those kept is shifted.
        let shifts: DVector<f64> = DVector::from_iterator(
            self.rank.kept.len(),
            self.rank.coefficients.column(place).iter().zip(&self.rank.sigmas).map(|(c, s)| c / s),
        );
        let largest = shifts.amax();
        let of: Vec<usize> = (0..shifts.len())
            .filter(|&row| shifts[row].abs() > SLIGHT * largest)
            .map(|row| self.rank.kept[row])
            .collect();
        let ids = of.iter().chain([&unknown]).map(|&place| self.unknowns[place].id.as_str());
        self.seen[unknown].gauge = gauge_of(&ids.collect::<Vec<_>>());
        self.seen[unknown].shown = Shown::Part { of, exactly };
    }
}

/// Information in units of the priors' sigmas.
fn scaled(information: &DMatrix<f64>, sigmas: &[f64]) -> DMatrix<f64> {
    DMatrix::from_fn(sigmas.len(), sigmas.len(), |row, column| {
        let mean = 0.5 * (information[(row, column)] + information[(column, row)]);
        mean * sigmas[row] * sigmas[column]
    })
}

/// Each parameter's 1σ, data and prior together, in units of the prior's.
fn with_prior(scaled: &DMatrix<f64>) -> Vec<f64> {
    let sum = scaled + DMatrix::identity(scaled.nrows(), scaled.ncols());
    match Cholesky::new(sum) {
        Some(factor) => factor.inverse().diagonal().iter().map(|x| x.sqrt()).collect(),
        // Rounding made it indefinite: nothing is claimed.
        None => vec![1.0; scaled.nrows()],
    }
}
