//! The sources of a crate, parsed.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};

use crate::Result;

/// The Rust files in a folder and its subfolders.
pub(super) fn sources(folder: &Path) -> Result<BTreeMap<PathBuf, syn::File>> {
    let mut files = BTreeMap::new();
    let mut folders = vec![folder.to_path_buf()];
    while let Some(folder) = folders.pop() {
        for entry in fs::read_dir(&folder)? {
            let path = entry?.path();
            if path.is_dir() {
                folders.push(path);
            } else if path.extension().is_some_and(|extension| extension == "rs") {
                let parsed = syn::parse_file(&fs::read_to_string(&path)?);
                let file = parsed.map_err(|e| format!("{}: {e}", path.display()))?;
                files.insert(path, file);
            }
        }
    }
    Ok(files)
}
