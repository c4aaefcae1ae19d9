//! How many combinations of unknowns data tell, and which unknowns are lost in them.

use nalgebra::{Cholesky, DMatrix};

/// The part of an unknown's information that must be its own for it not to be the same as others: the squared sine of
/// the angle between its signature and theirs.
///
/// Taking a vector that turns with the table as constant over a sample leaves some 1e-12 of it, rounding less; the
/// closest pair that physics tells apart at all, the encoder's delay and the gyros', has 1e-10.
pub const EXACT: f64 = 1e-11;

/// Information, in units of the prior, below which the data tell less than was known beforehand.
const KNOWN: f64 = 1.0;

/// A choice of unknowns that stand for all combinations that data tell.
///
/// Those that are best seen are kept first, as long as the data tell more of them than was known beforehand. What
/// the others do to the data is, but for something fainter, the sum of what those kept do, each times
/// a coefficient. Numbers are in units of the priors' sigmas.
#[derive(Clone, Debug, PartialEq)]
pub struct Rank {
    /// The unknowns that are kept, the best seen first.
    pub kept: Vec<usize>,
    /// The others.
    pub lost: Vec<Unobservable>,
    /// Of each that is kept (row) how much one of each that is lost (column) amounts to.
    pub coefficients: DMatrix<f64>,
    /// The 1σ of each that is kept, with all that is lost at zero.
    pub sigmas: Vec<f64>,
    /// The least part of its information that one of those told has for itself, however faintly.
    pub least_told: f64,
    /// The largest such part of those that are not told: far below the former if the rank is clear.
    pub most_null: f64,
}

/// An unknown that those kept stand for.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Unobservable {
    /// Which.
    pub unknown: usize,
    /// Whether what it does is the sum of what others do exactly, and not only to within what the data show.
    pub exactly: bool,
    /// Whether the data, all else known, would tell more of it than was known beforehand.
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

    /// How many combinations the data tell, however faintly.
    pub fn rank(&self) -> usize {
        self.kept.len() + self.lost.iter().filter(|lost| !lost.exactly).count()
    }
}

/// The kept block's inverse times the block of what is lost, and the square roots of the inverse's diagonal.
fn solved(kept: &DMatrix<f64>, lost: &DMatrix<f64>) -> (DMatrix<f64>, Vec<f64>) {
    // Signatures of unit length: their sizes are apart by orders of magnitude.
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

/// Cholesky's elimination that takes what is best seen first.
struct Elimination {
    /// The information that is left, and that which there was.
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

    /// The part of an unknown's information that those kept have not.
    fn own(&self, place: usize) -> f64 {
        if self.whole[place] > 0.0 { self.left[(place, place)] / self.whole[place] } else { 0.0 }
    }

    /// The best seen of those that have at least so much information left.
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
