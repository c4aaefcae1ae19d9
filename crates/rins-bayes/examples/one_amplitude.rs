//! How strong an effect has to be before the data prefer it to none.
#![expect(clippy::print_stdout, reason = "an example prints")]

use nalgebra::{DMatrix, DVector};
use rins_bayes::{Block, ScaleMixture};

fn main() {
    let prior = ScaleMixture::between(0.1, 10.0);
    println!("estimate / sigma   ln Bayes factor");
    for sigmas in [0.0, 1.0, 2.0, 3.0, 4.0, 6.0, 8.0] {
        let score = DVector::from_element(1, sigmas);
        let block = Block::of(DMatrix::from_element(1, 1, 1.0), &score, &prior);
        println!("{sigmas:16} {:17.2}", block.ln_factor);
    }
}
