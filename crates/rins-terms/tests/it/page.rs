//! The book's page of the catalogue is the catalogue's.

use std::fs;
use std::path::Path;

#[test]
fn page_of_the_book_is_up_to_date() {
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/src/terms.md");
    let written = fs::read_to_string(&path).unwrap_or_default();
    assert!(
        written == rins_terms::page(),
        "run `cargo run -p rins-terms --example catalogue_page > docs/src/terms.md`"
    );
}
