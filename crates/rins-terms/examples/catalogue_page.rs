//! The catalogue as the book shows it.
//!
//! `cargo run -p rins-terms --example catalogue_page > docs/src/terms.md`
#![expect(clippy::print_stdout, reason = "an example prints")]

fn main() {
    print!("{}", rins_terms::page());
}
