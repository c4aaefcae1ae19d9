//! Arguments that are given twice.

use std::path::PathBuf;

use clap::error::ErrorKind;
use rins_io::shown;

/// Why rigs cannot be meant if one of them is given twice.
pub(super) fn twice<'a>(rigs: impl Iterator<Item = &'a PathBuf>) -> Option<(ErrorKind, String)> {
    let mut seen = Vec::new();
    for rig in rigs {
        if seen.contains(&rig) {
            return Some((ErrorKind::ValueValidation, format!("{} is given twice", shown(rig))));
        }
        seen.push(rig);
    }
    None
}
