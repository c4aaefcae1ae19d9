//! Observability of parameters: rank, null space, gauges, and the separability of two effects.
//!
//! Everything follows from the Fisher information of the parameters in units of their priors' sigmas.

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

/// A parameter to be estimated.
#[derive(Clone, Debug, PartialEq)]
pub struct Unknown {
    /// Its full id, such as `gyro.misalignment.xz`.
    pub id: String,
    /// Its id in the model of its run, whose z is the spin axis, whatever axes `id` refers to.
    pub model_id: String,
    /// The run that it belongs to, counted from zero; `None` if it belongs to the IMU, or if there is only one run.
    pub run: Option<usize>,
    /// The unit in which it is displayed.
    pub unit: Unit,
    /// Its prior 1σ, in SI units.
    pub sigma: f64,
}

/// A parameter in a combination with another one.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Alias {
    /// The index of the unknown.
    pub unknown: usize,
    /// The coefficient of this parameter relative to the first one of the combination, in SI units.
    pub coefficient: f64,
    /// Whether it is indistinguishable from the others under this schedule for any amount of noise.
    pub exactly: bool,
}

/// The kind of observability of a parameter.
#[derive(Clone, Debug, PartialEq)]
pub enum Observable {
    /// The parameter itself is observable.
    Alone,
    /// Only the sum of the parameter and its aliases, each times its coefficient, is observable.
    Combination,
    /// The parameter is observable only as a part of the estimates of these unknowns. Of the sums that contain it, that with
    /// its aliases is observable best.
    Part {
        /// The unknowns.
        of: Vec<usize>,
        /// Whether its signature is exactly a sum of theirs.
        exactly: bool,
    },
    /// Unobservable: the data hold less information than the prior even if everything else is known.
    Nothing,
}

/// The observability of one unknown.
#[derive(Clone, Debug, PartialEq)]
pub struct ParameterObservability {
    /// The kind of observability.
    pub shown: Observable,
    /// The other parameters of the observable sum; empty if the parameter is observable alone, or not at all.
    pub aliases: Vec<Alias>,
    /// The 1σ of the parameter, or of the sum with its aliases, from the data alone, in SI units; infinite if unobservable.
    pub data_sigma: f64,
    /// The posterior 1σ of the parameter itself.
    pub sigma: f64,
    /// The gauge that makes the parameter indistinguishable from others under every schedule, if there is one.
    pub gauge: Option<&'static Gauge>,
    /// Whether the parameter itself is observable: the data reduce its prior uncertainty by at least a factor of two.
    pub identifiable: bool,
}

/// The observability of a list of unknowns.
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
/// // b + a/2 is observable with 0.05 (1σ), and neither of them alone.
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
    /// The observability of each unknown.
    pub parameters: Vec<ParameterObservability>,
    /// The rank of the information and the unknowns that represent it.
    pub rank: Rank,
}

/// The fraction of the largest of several coefficients below which a coefficient is omitted.
const SLIGHT: f64 = 0.1;

/// The factor by which the uncertainty of a sum must be smaller than the posterior uncertainty of the parameter itself, for
/// only the sum to count as observable.
const DOMINANT: f64 = 5.0;

/// The fraction of the prior sigma below which the posterior sigma must be, for the parameter to count as observable.
const SEEN: f64 = 0.5;

impl Identifiability {
    /// The observability of `unknowns` under data with this Fisher information in SI units.
    ///
    /// # Panics
    /// If the information has fewer parameters.
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

    /// The place of the unknown of this id, of the IMU or of the first run that has it.
    pub fn find(&self, id: &str) -> Option<usize> {
        self.unknowns.iter().position(|unknown| unknown.id == id)
    }

    /// Sets the observability of a kept unknown: alone, or in a combination.
    fn see_kept(&mut self, place: usize) {
        let (kept, sigma) = (self.rank.kept[place], self.rank.sigmas[place]);
        let shares = self.rank.coefficients.row(place);
        let unit = self.unknowns[kept].sigma;
        let own = self.parameters[kept].sigma / unit;
        let mut beside: Vec<usize> =
            if own > DOMINANT * sigma { (0..shares.len()).collect() } else { Vec::new() };
        beside.sort_by(|&a, &b| shares[b].abs().total_cmp(&shares[a].abs()));
        // The lost unknowns may have any values within their priors. The smallest contributions are omitted as long as they
        // are below the uncertainty from the data.
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

    /// Sets the gauges of the unknowns that are visible in the data.
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

    /// Sets the observability of a lost unknown: the unknowns that represent it.
    fn see_lost(&mut self, place: usize) {
        let Unobservable { unknown, exactly, visible } = self.rank.lost[place];
        if !visible {
            return;
        }
        // The shift of each kept unknown, in its sigmas.
        let shifts: DVector<f64> = DVector::from_iterator(
            self.rank.kept.len(),
            self.rank.coefficients.column(place).iter().zip(&self.rank.sigmas).map(|(c, s)| c / s),
        );
        let best = shifts.icamax();
        let largest = shifts[best].abs();
        // A sum whose uncertainty is comparable with the prior sigma holds no information on the unknown.
        if largest * SEEN < 1.0 {
            return;
        }
        let of: Vec<usize> = (0..shifts.len())
            .filter(|&row| shifts[row].abs() > SLIGHT * largest)
            .map(|row| self.rank.kept[row])
            .collect();
        // The sum in which it is observable best, normalized to its own coefficient.
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

    /// Sets the observable sums of several unknowns that are unobservable themselves.
    ///
    /// `posterior` is the posterior covariance in units of the priors' sigmas.
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
            // An unobservable unknown alone has no such small variance.
            if members.len() < 2 {
                return;
            }
            // The prior variance is one in these units; the information of the data is the remainder.
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

/// The posterior covariance of the parameters, in units of the priors' sigmas.
fn with_prior(scaled: &DMatrix<f64>) -> DMatrix<f64> {
    let identity = DMatrix::identity(scaled.nrows(), scaled.ncols());
    // If it is indefinite by rounding, no information is assumed.
    Cholesky::new(scaled + &identity).map_or(identity, |factor| factor.inverse())
}
