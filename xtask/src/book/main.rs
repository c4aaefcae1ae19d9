//! Builds the book from `docs/` into `target/book`, and checks its equations and links.
#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a command line program prints")]

use std::error::Error;
use std::fs;
use std::path::Path;
use std::process::ExitCode;

use mdbook_driver::MDBook;

use crate::equations::Equations;

mod equations;
mod links;

/// The result of a step.
type Result<T, E = Box<dyn Error>> = std::result::Result<T, E>;

fn main() -> ExitCode {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    let root = package.parent().expect("xtask/ lies in the workspace");
    match build(root) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("error: {error}");
            ExitCode::FAILURE
        }
    }
}

fn build(root: &Path) -> Result<()> {
    let docs = root.join("docs");
    let pages = root.join("target/book");
    let mut book = MDBook::load(&docs).map_err(|error| format!("{error:#}"))?;
    book.config.build.build_dir.clone_from(&pages);
    book.with_preprocessor(Equations::default());
    book.build().map_err(|error| format!("{error:#}"))?;
    copy_fonts(&docs.join("katex/fonts"), &pages.join("katex/fonts"))?;
    let count = links::check(&pages)?;
    println!("{count} pages in {}", pages.display());
    Ok(())
}

/// Copies the fonts to the style sheet of the equations, which refers to them by relative paths.
fn copy_fonts(from: &Path, to: &Path) -> Result<()> {
    fs::create_dir_all(to)?;
    for font in fs::read_dir(from)? {
        let font = font?;
        fs::copy(font.path(), to.join(font.file_name()))?;
    }
    Ok(())
}
