//! The separability of two effects: how much weaker one is known if the other is estimated too.

use nalgebra::{DMatrix, DVector, SymmetricEigen};

/// The least part of a direction's information that is not shared with the other effect: a separation cost of thirty thousand.
const SAME: f64 = 1e-9;

/// A direction in the parameters of one effect, compared with the other effect.
#[derive(Clone, Debug, PartialEq)]
pub struct Direction {
    /// The separation cost, `1/sin` of the angle between the signatures of the two effects: the factor by which the sigma
    /// increases if the other effect is estimated too. Infinite if the signatures are equal.
    pub kappa: f64,
    /// The direction in the first effect's parameters, in units of their priors, the largest of them one.
    pub along: DVector<f64>,
    /// The significance of an effect of this size if the other is absent, in sigmas.
    pub detection: f64,
    /// Its significance if any amount of the other may be present, in sigmas.
    pub separation: f64,
}

/// The separability of two effects; all other parameters are estimated too.
#[derive(Clone, Debug, PartialEq)]
pub struct Separation {
    /// The directions of the first effect that have a counterpart in the second, the most alike first.
    pub directions: Vec<Direction>,
    /// How many directions of the first effect, and of the second, the nuisances absorb.
    pub absorbed: [usize; 2],
}

impl Separation {
    /// The cost in the worst direction; infinite if all of an effect is absorbed by the nuisances.
    pub fn kappa(&self) -> f64 {
        self.directions.first().map_or(f64::INFINITY, |direction| direction.kappa)
    }
}

/// The separability of the unknowns `first` and `second`; all others of `information` are nuisance parameters.
///
/// `information` is in units of the prior sigmas. It contains the priors of the nuisance parameters already.
pub fn separation(information: &DMatrix<f64>, first: &[usize], second: &[usize]) -> Separation {
    let both: Vec<usize> = first.iter().chain(second).copied().collect();
    let left = without_nuisances(information, &both);
    let n = first.len();
    let whole: Vec<f64> = both.iter().map(|&place| information[(place, place)]).collect();
    let block = |from: usize, size: usize| left.view((from, from), (size, size)).into_owned();
    let one = Whitener::of(&block(0, n), &whole[..n]);
    let other = Whitener::of(&block(n, second.len()), &whole[n..]);
    let absorbed = [n - one.matrix.ncols(), second.len() - other.matrix.ncols()];
    if one.matrix.is_empty() || other.matrix.is_empty() {
        return Separation { directions: Vec::new(), absorbed };
    }
    let across = left.view((0, n), (n, second.len()));
    let across = one.matrix.transpose() * across * &other.matrix;
    let alike = SymmetricEigen::new(&across * across.transpose());
    let mut directions: Vec<Direction> = (0..one.matrix.ncols())
        .map(|column| {
            let cosine = alike.eigenvalues[column].clamp(0.0, 1.0);
            let own = if 1.0 - cosine > SAME { 1.0 - cosine } else { 0.0 };
            let unit = &one.matrix * alike.eigenvectors.column(column);
            // A unit of it has a significance of one sigma.
            let size = unit.amax();
            let detection = 1.0 / size;
            Direction {
                kappa: own.sqrt().recip(),
                along: unit / size,
                detection,
                separation: detection * own.sqrt(),
            }
        })
        .collect();
    directions.sort_by(|a, b| b.kappa.total_cmp(&a.kappa));
    directions.truncate(other.matrix.ncols());
    Separation { directions, absorbed }
}

/// The significance in sigmas of an effect of the unknowns `first`, of the size `along` in units of the priors, if any amount
/// of `second` and of all other unknowns of `information` may be present.
pub fn distance(information: &DMatrix<f64>, first: &[usize], along: &DVector<f64>) -> f64 {
    let left = without_nuisances(information, first);
    (along.transpose() * left * along)[(0, 0)].max(0.0).sqrt()
}

/// The marginal information on `wanted`; all others are estimated too.
fn without_nuisances(information: &DMatrix<f64>, wanted: &[usize]) -> DMatrix<f64> {
    let mut left = information.clone();
    let mut nuisances: Vec<usize> =
        (0..information.nrows()).filter(|place| !wanted.contains(place)).collect();
    let whole = information.diagonal();
    // The parameter with the largest unshared fraction is eliminated first.
    loop {
        let own = |place: &usize| left[(*place, *place)] / whole[*place];
        let told = |place: &&usize| whole[**place] > 0.0 && own(place) > super::EXACT;
        let next = nuisances.iter().enumerate().filter(|(_, place)| told(place));
        let Some((index, &place)) = next.max_by(|a, b| own(a.1).total_cmp(&own(b.1))) else {
            break;
        };
        nuisances.swap_remove(index);
        let column = left.column(place) / left[(place, place)].sqrt();
        left.ger(-1.0, &column, &column, 1.0);
    }
    DMatrix::from_fn(wanted.len(), wanted.len(), |row, column| {
        0.5 * (left[(wanted[row], wanted[column])] + left[(wanted[column], wanted[row])])
    })
}

/// The distinguishable directions of an effect, each with a significance of one sigma.
struct Whitener {
    matrix: DMatrix<f64>,
}

impl Whitener {
    /// Whitens the remaining information on the parameters of an effect; `whole` is the original diagonal.
    fn of(left: &DMatrix<f64>, whole: &[f64]) -> Self {
        let size = DVector::from_iterator(
            whole.len(),
            whole.iter().map(|x| x.max(f64::MIN_POSITIVE).sqrt()),
        );
        let unit = DMatrix::from_fn(whole.len(), whole.len(), |row, column| {
            left[(row, column)] / (size[row] * size[column])
        });
        let own = SymmetricEigen::new(unit);
        let told: Vec<usize> =
            (0..whole.len()).filter(|&place| own.eigenvalues[place] > SAME).collect();
        let matrix = DMatrix::from_fn(whole.len(), told.len(), |row, column| {
            let eigen = told[column];
            own.eigenvectors[(row, eigen)] / own.eigenvalues[eigen].sqrt() / size[row]
        });
        Self { matrix }
    }
}
