//! What data can tell of parameters: rank, null directions, gauges, and what tells two effects apart.
//!
//! All follows from the Fisher information of the parameters, seen in units of their priors' sigmas.

mod gauge;
mod joint;
mod rank;
mod separation;

#[cfg(test)]
mod tests;

use nalgebra::{Cholesky, DMatrix, DVector, SymmetricEigen};
use rins_terms::Unit;

pub use gauge::{GAUGES, Gauge, gauge_of};
pub use joint::{Joint, JointError, joint};
pub use rank::{EXACT, Rank, Unobservable};
pub use separation::{Direction, Separation, distance, separation};

/// A parameter whose value is sought.
#[derive(Clone, Debug, PartialEq)]
pub struct Unknown {
    /// Its full id, such as `gyro.misalignment.xz`.
    pub id: String,
    /// Its id in its run's model, whose z is the axis of rotation, whatever axes `id` is along.
    pub model_id: String,
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
pub enum Observable {
    /// The parameter itself.
    Alone,
    /// Only the sum of the parameter and of its aliases, each times its coefficient.
    Combination,
    /// Nothing that is not part of what these unknowns stand for; of the sums that it is in, that with its aliases is
    /// told best.
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
pub struct ParameterObservability {
    /// What of it the data tell.
    pub shown: Observable,
    /// What stands beside it in the sum that is told; none if it is told alone, or not at all.
    pub aliases: Vec<Alias>,
    /// Its 1σ, or that of the sum with its aliases, by the data alone, in SI units; infinite if they tell nothing.
    pub data_sigma: f64,
    /// The parameter's own 1σ when what is known beforehand is used too.
    pub sigma: f64,
    /// The gauge that it takes part in and that makes it a part of others under every schedule, if one does.
    pub gauge: Option<&'static Gauge>,
    /// Whether the data tell the parameter itself, and twice better at least than it was known beforehand.
    pub identifiable: bool,
}

/// What data tell of a list of unknowns.
///
/// ```
/// use nalgebra::DMatrix;
/// use rins_estimation::{Identifiability, Observable, Unknown};
/// use rins_terms::Unit;
/// let unknown = |id: &str| Unknown { id: id.into(), model_id: id.into(), run: None, unit: Unit::ONE, sigma: 1.0 };
/// // A hundred readings of a + 2 b, each to 1σ of 1.
/// let information = DMatrix::from_row_slice(2, 2, &[100.0, 200.0, 200.0, 400.0]);
/// let identifiability = Identifiability::of(&information, vec![unknown("a"), unknown("b")]);
/// assert_eq!(identifiability.rank.rank(), 1);
/// // They tell b + a/2 to 0.05, and neither alone.
/// assert_eq!(identifiability.parameters[1].shown, Observable::Combination);
/// assert!((identifiability.parameters[1].aliases[0].coefficient - 0.5).abs() < 1e-12);
/// assert!((identifiability.parameters[1].data_sigma - 0.05).abs() < 1e-12);
/// assert!((identifiability.parameters[0].aliases[0].coefficient - 2.0).abs() < 1e-12);
/// assert!((identifiability.parameters[0].data_sigma - 0.1).abs() < 1e-12);
/// ```
#[derive(Clone, Debug, PartialEq)]
pub struct Identifiability {
    /// The unknowns.
    pub unknowns: Vec<Unknown>,
    /// What is told of each.
    pub parameters: Vec<ParameterObservability>,
    /// How many combinations the data tell, and which unknowns stand for them.
    pub rank: Rank,
}

/// The part of the largest of several shifts below which one is not mentioned.
const SLIGHT: f64 = 0.1;

/// How many times better a sum must be told than the parameter itself, what was known beforehand being used, for only
/// the sum to count as identifiability.
const DOMINANT: f64 = 5.0;

/// The part of what was known beforehand below which data must bring a parameter's sigma, for it to count as identifiability.
const SEEN: f64 = 0.5;

impl Identifiability {
    /// What data with this Fisher information, in SI units, tell of `unknowns`.
    ///
    /// # Panics
    /// If the information is of fewer parameters.
    pub fn of(information: &DMatrix<f64>, unknowns: Vec<Unknown>) -> Self {
        let sigmas: Vec<f64> = unknowns.iter().map(|unknown| unknown.sigma).collect();
        let scaled = scaled(information, &sigmas);
        let rank = Rank::of(&scaled);
        let posterior = with_prior(&scaled);
        let nothing = |(variance, sigma): (&f64, &f64)| ParameterObservability {
            shown: Observable::Nothing,
            aliases: Vec::new(),
            data_sigma: f64::INFINITY,
            sigma: variance.sqrt() * sigma,
            gauge: None,
            identifiable: false,
        };
        let parameters = posterior.diagonal().iter().zip(&sigmas).map(nothing).collect();
        let mut identifiability = Self { unknowns, parameters, rank };
        (0..identifiability.rank.kept.len()).for_each(|place| identifiability.see_kept(place));
        (0..identifiability.rank.lost.len()).for_each(|place| identifiability.see_lost(place));
        identifiability.see_together(&posterior);
        identifiability.name_gauges();
        identifiability
    }

    /// The place of the unknown of this id, of the IMU or of the first run.
    pub fn find(&self, id: &str) -> Option<usize> {
        self.unknowns.iter().position(|unknown| unknown.id == id)
    }

    /// Of an unknown that is kept: with what it is identifiability.
    fn see_kept(&mut self, place: usize) {
        let (kept, sigma) = (self.rank.kept[place], self.rank.sigmas[place]);
        let shares = self.rank.coefficients.row(place);
        let unit = self.unknowns[kept].sigma;
        let own = self.parameters[kept].sigma / unit;
        let mut beside: Vec<usize> =
            if own > DOMINANT * sigma { (0..shares.len()).collect() } else { Vec::new() };
        beside.sort_by(|&a, &b| shares[b].abs().total_cmp(&shares[a].abs()));
        // What is lost may be anything within its prior: the least of it is left out, as long as that is less than
        // what the data leave open.
        let mut left_out = 0.0;
        while let Some(&least) = beside.last() {
            left_out = f64::hypot(left_out, shares[least]);
            if left_out > sigma {
                break;
            }
            beside.pop();
        }
        let aliases: Vec<Alias> = beside
            .iter()
            .map(|&lost| {
                let Unobservable { unknown, exactly, .. } = self.rank.lost[lost];
                let coefficient = shares[lost] * unit / self.unknowns[unknown].sigma;
                Alias { unknown, coefficient, exactly }
            })
            .collect();
        let seen = &mut self.parameters[kept];
        seen.data_sigma = sigma * unit;
        seen.identifiable = aliases.is_empty() && own < SEEN;
        seen.shown = if aliases.is_empty() { Observable::Alone } else { Observable::Combination };
        seen.aliases = aliases;
    }

    /// Names what no schedule would tell, of what the data show at all.
    fn name_gauges(&mut self) {
        let shown = self
            .unknowns
            .iter()
            .zip(&self.parameters)
            .filter(|(_, s)| s.shown != Observable::Nothing);
        let shown: Vec<&str> = shown.map(|(unknown, _)| unknown.model_id.as_str()).collect();
        for gauge in GAUGES.iter().filter(|gauge| gauge.is_open(&shown)) {
            let of_gauge =
                |lost: &&Unobservable| gauge.holds(&self.unknowns[lost.unknown].model_id);
            for lost in self.rank.lost.iter().filter(of_gauge) {
                self.parameters[lost.unknown].gauge.get_or_insert(gauge);
            }
        }
    }

    /// Of an unknown that is lost: what stands for it.
    fn see_lost(&mut self, place: usize) {
        let Unobservable { unknown, exactly, visible } = self.rank.lost[place];
        if !visible {
            return;
        }
        // By how many of its sigmas each of those kept is shifted.
        let shifts: DVector<f64> = DVector::from_iterator(
            self.rank.kept.len(),
            self.rank.coefficients.column(place).iter().zip(&self.rank.sigmas).map(|(c, s)| c / s),
        );
        let best = shifts.icamax();
        let largest = shifts[best].abs();
        // A sum that is told hardly better than this part of it was known tells nothing of it.
        if largest * SEEN < 1.0 {
            return;
        }
        let of: Vec<usize> = (0..shifts.len())
            .filter(|&row| shifts[row].abs() > SLIGHT * largest)
            .map(|row| self.rank.kept[row])
            .collect();
        // The sum in which it is told best, put so that it counts once itself.
        let kept = self.rank.kept[best];
        let own = self.rank.coefficients[(best, place)] * self.unknowns[kept].sigma
            / self.unknowns[unknown].sigma;
        let beside = self.parameters[kept].aliases.iter().filter(|alias| alias.unknown != unknown);
        let rest = beside.map(|alias| Alias { coefficient: alias.coefficient / own, ..*alias });
        let aliases = std::iter::once(Alias { unknown: kept, coefficient: 1.0 / own, exactly })
            .chain(rest)
            .collect();
        let data_sigma = self.parameters[kept].data_sigma / own.abs();
        let seen = &mut self.parameters[unknown];
        (seen.aliases, seen.data_sigma) = (aliases, data_sigma);
        seen.shown = Observable::Part { of, exactly };
    }

    /// Of unknowns that are not observable by themselves: the sums of several that are.
    ///
    /// `posterior` is the covariance with the priors, in units of their sigmas.
    fn see_together(&mut self, posterior: &DMatrix<f64>) {
        loop {
            let left = self.unobservable();
            if left.len() < 2 {
                return;
            }
            let own = DMatrix::from_fn(left.len(), left.len(), |row, column| {
                posterior[(left[row], left[column])]
            });
            let own = SymmetricEigen::new(own);
            let best = own.eigenvalues.imin();
            let variance = own.eigenvalues[best];
            if variance.is_nan() || variance >= SEEN * SEEN {
                return;
            }
            let shares = own.eigenvectors.column(best);
            let largest = shares.amax();
            let members: Vec<usize> =
                (0..left.len()).filter(|&row| shares[row].abs() > SLIGHT * largest).collect();
            // An unknown that is not observable has no such variance alone.
            if members.len() < 2 {
                return;
            }
            // Known beforehand to 1 in these units: the data add the rest.
            let data_sigma = (variance / (1.0 - variance)).max(0.0).sqrt();
            let leading = left[shares.icamax()];
            for &row in &members {
                let (unknown, unit) = (left[row], self.unknowns[left[row]].sigma);
                let share = |row: usize| shares[row] / self.unknowns[left[row]].sigma;
                let others = members.iter().filter(|&&other| other != row);
                let aliases = others
                    .map(|&other| Alias {
                        unknown: left[other],
                        coefficient: share(other) / share(row),
                        exactly: false,
                    })
                    .collect();
                let seen = &mut self.parameters[unknown];
                seen.aliases = aliases;
                seen.data_sigma = data_sigma * unit / shares[row].abs();
                seen.shown = if unknown == leading {
                    Observable::Combination
                } else {
                    Observable::Part { of: vec![leading], exactly: false }
                };
            }
        }
    }
}

/// Information in units of the priors' sigmas.
fn scaled(information: &DMatrix<f64>, sigmas: &[f64]) -> DMatrix<f64> {
    DMatrix::from_fn(sigmas.len(), sigmas.len(), |row, column| {
        let mean = 0.5 * (information[(row, column)] + information[(column, row)]);
        mean * sigmas[row] * sigmas[column]
    })
}

/// The covariance of the parameters, data and priors together, in units of the priors' sigmas.
fn with_prior(scaled: &DMatrix<f64>) -> DMatrix<f64> {
    let identity = DMatrix::identity(scaled.nrows(), scaled.ncols());
    // Where rounding made it indefinite nothing is claimed.
    Cholesky::new(scaled + &identity).map_or(identity, |factor| factor.inverse())
}
