//! Runs the paper's experiments and writes, or with `--check` compares, the page of their results.

use std::error::Error;
use std::fs;
use std::path::Path;

use crate::report::{FIGURES, File, Results, Scale, files};
use crate::stale::differences;
use indicatif::{ProgressBar, ProgressStyle};

/// The maximum number of differences that are shown.
const SHOWN: usize = 20;

fn root() -> &'static Path {
    let package = Path::new(env!("CARGO_MANIFEST_DIR"));
    package.ancestors().nth(2).expect("the package lies in crates/ of the workspace")
}

fn made() -> Result<Vec<File>, Box<dyn Error>> {
    let style = ProgressStyle::with_template("{bar:40} {pos}/{len} runs, {elapsed}")?;
    let bar = ProgressBar::new(Scale::FULL.total()).with_style(style);
    let results = Results::compute(Scale::FULL, || bar.inc(1))?;
    bar.finish_and_clear();
    Ok(files(&results))
}

/// Writes the page and its figures.
pub(super) fn write() -> Result<bool, Box<dyn Error>> {
    let files = made()?;
    fs::create_dir_all(root().join(FIGURES))?;
    for File { path, text } in &files {
        fs::write(root().join(path), text)?;
        println!("{path}");
    }
    Ok(true)
}

/// Whether the stored files agree with the present results.
pub(super) fn check() -> Result<bool, Box<dyn Error>> {
    let mut fresh = true;
    for File { path, text } in made()? {
        let kept = fs::read_to_string(root().join(&path)).unwrap_or_default();
        let found = differences(&kept, &text);
        for difference in found.iter().take(SHOWN) {
            println!("{path}: {difference}");
        }
        if found.len() > SHOWN {
            println!("{path}: and {} lines more", found.len() - SHOWN);
        }
        fresh &= found.is_empty();
    }
    if fresh {
        println!("the page and its figures are up to date");
    } else {
        eprintln!("error: the page is old; make it again with `cargo xtask reproduce`");
    }
    Ok(fresh)
}
