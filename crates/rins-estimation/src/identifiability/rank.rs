//! The rank of the information, and the unknowns that are lost in combinations.

use nalgebra::{Cholesky, DMatrix};

/// The smallest fraction of an unknown's information that is not shared with others, for it to count as distinguishable: the
/// squared sine of the angle between its signature and theirs.
///
/// The approximation that a vector which rotates with the table is constant over a sample causes about 1e-12, rounding less;
/// the most similar pair that is distinguishable physically, the latencies of encoder and gyros, has 1e-10.
pub const EXACT: f64 = 1e-11;

/// The information, in units of the prior, below which the data add less than the prior.
const KNOWN: f64 = 1.0;

/// A choice of unknowns that represent all observable combinations.
///
/// Unknowns are kept in the order of their remaining information, as long as that exceeds the information of the prior. The
/// signature of each other unknown is, apart from a weaker remainder, a sum of the signatures of those kept, each times a
/// coefficient. Numbers are in units of the priors' sigmas.
#[derive(Clone, Debug, PartialEq)]
pub struct Rank {
    /// The kept unknowns in the order of decreasing information.
    pub kept: Vec<usize>,
    /// The others.
    pub lost: Vec<Unobservable>,
    /// The coefficient of each lost unknown (column) in the estimate of each kept one (row).
    pub coefficients: DMatrix<f64>,
    /// The 1σ of each kept unknown with all lost ones at zero.
    pub sigmas: Vec<f64>,
    /// The smallest unshared fraction of information among the unknowns that are distinguishable, however weakly.
    pub least_told: f64,
    /// The largest unshared fraction among the indistinguishable ones: far below `least_told` if the rank is clear.
    pub most_null: f64,
}

/// An unknown that is represented by those kept.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unobservable {
    /// The index of the unknown.
    pub unknown: usize,
    /// Whether its signature is exactly a sum of other signatures, and not only within the uncertainty of the data.
    pub exactly: bool,
    /// Whether the data would hold more information on it than its prior if everything else were known.
    pub visible: bool,
}

impl Rank {
    /// The rank of information in units of the priors.
    pub(super) fn of(information: &DMatrix<f64>) -> Self {
        let mut elimination = Elimination::new(information);
        while let Some(next) = elimination.next(KNOWN) {
            elimination.keep(next);
        }
        let kept = elimination.kept.clone();
        while let Some(next) = elimination.next(0.0) {
            elimination.keep(next);
        }
        let lost: Vec<Unobservable> = (0..information.nrows())
            .filter(|unknown| !kept.contains(unknown))
            .map(|unknown| Unobservable {
                unknown,
                exactly: !elimination.is_kept[unknown],
                visible: information[(unknown, unknown)] >= KNOWN,
            })
            .collect();
        let lost_places: Vec<usize> = lost.iter().map(|lost| lost.unknown).collect();
        let block = |columns: &[usize]| {
            DMatrix::from_fn(kept.len(), columns.len(), |row, column| {
                information[(kept[row], columns[column])]
            })
        };
        let (coefficients, sigmas) = solved(&block(&kept), &block(&lost_places));
        let null = lost.iter().filter(|lost| lost.exactly);
        let most_null = null.map(|lost| elimination.own(lost.unknown)).fold(0.0, f64::max);
        Self { kept, lost, coefficients, sigmas, least_told: elimination.least, most_null }
    }

    /// The number of observable combinations, however weakly.
    pub fn rank(&self) -> usize {
        self.kept.len() + self.lost.iter().filter(|lost| !lost.exactly).count()
    }
}

/// The inverse of the kept block times the lost block, and the square roots of the inverse's diagonal.
fn solved(kept: &DMatrix<f64>, lost: &DMatrix<f64>) -> (DMatrix<f64>, Vec<f64>) {
    // Signatures are normalized: their sizes differ by orders of magnitude.
    let size: Vec<f64> = kept.diagonal().iter().map(|x| x.sqrt()).collect();
    let unit = DMatrix::from_fn(size.len(), size.len(), |row, column| {
        kept[(row, column)] / (size[row] * size[column])
    });
    let right =
        DMatrix::from_fn(size.len(), lost.ncols(), |row, column| lost[(row, column)] / size[row]);
    let factor = Cholesky::new(unit).expect("what is kept has a part of its own each");
    let mut coefficients = factor.solve(&right);
    for (mut row, size) in coefficients.row_iter_mut().zip(&size) {
        row /= *size;
    }
    let inverse = factor.inverse();
    let sigmas = inverse.diagonal().iter().zip(&size).map(|(x, size)| x.sqrt() / size).collect();
    (coefficients, sigmas)
}

/// Cholesky elimination with pivoting by the remaining information.
struct Elimination {
    /// The remaining information, and the original diagonal.
    left: DMatrix<f64>,
    whole: Vec<f64>,
    kept: Vec<usize>,
    is_kept: Vec<bool>,
    least: f64,
}

impl Elimination {
    fn new(information: &DMatrix<f64>) -> Self {
        Self {
            left: information.clone(),
            whole: information.diagonal().iter().copied().collect(),
            kept: Vec::new(),
            is_kept: vec![false; information.nrows()],
            least: 1.0,
        }
    }

    /// The fraction of an unknown's information that is not shared with those kept.
    fn own(&self, place: usize) -> f64 {
        if self.whole[place] > 0.0 { self.left[(place, place)] / self.whole[place] } else { 0.0 }
    }

    /// The unknown with the most information left, of those that have at least this amount.
    fn next(&self, least: f64) -> Option<usize> {
        (0..self.whole.len())
            .filter(|&place| {
                !self.is_kept[place]
                    && self.own(place) > EXACT
                    && self.left[(place, place)] >= least
            })
            .max_by(|&a, &b| self.left[(a, a)].total_cmp(&self.left[(b, b)]))
    }

    fn keep(&mut self, place: usize) {
        self.least = self.least.min(self.own(place));
        self.kept.push(place);
        self.is_kept[place] = true;
        let column = self.left.column(place) / self.left[(place, place)].sqrt();
        self.left.ger(-1.0, &column, &column, 1.0);
    }
}
