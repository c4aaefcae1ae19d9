//! What is being written, so that an interrupt leaves nothing of it.

use std::fs;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The temporary files and folders of what is being written.
static UNFINISHED: Mutex<Vec<PathBuf>> = Mutex::new(Vec::new());

fn unfinished() -> MutexGuard<'static, Vec<PathBuf>> {
    // A list of paths is whole whatever happened to who held it.
    UNFINISHED.lock().unwrap_or_else(PoisonError::into_inner)
}

/// A temporary file or folder that is removed by [`abandon`] as long as this lives.
pub(crate) struct Unfinished(PathBuf);

impl Unfinished {
    pub(crate) fn new(path: &Path) -> Self {
        unfinished().push(path.into());
        Self(path.into())
    }
}

impl Drop for Unfinished {
    fn drop(&mut self) {
        unfinished().retain(|path| *path != self.0);
    }
}

/// Puts what is finished in its place, before an interrupt or not at all.
pub(crate) fn undisturbed<T>(place: impl FnOnce() -> T) -> T {
    let _held = unfinished();
    place()
}

/// The end of all that is being written; see [`abandon`].
#[derive(Debug)]
#[must_use = "what is being written goes on when this is dropped"]
pub struct Abandoned {
    _held: MutexGuard<'static, Vec<PathBuf>>,
}

/// Removes whatever is being written but not in its place yet, for a program that is about to end.
///
/// As long as the returned value lives, nothing is put in its place any more: who tries waits.
pub fn abandon() -> Abandoned {
    let held = unfinished();
    for path in held.iter() {
        // What cannot be removed stays under its hidden name.
        let _ = if path.is_dir() { fs::remove_dir_all(path) } else { fs::remove_file(path) };
    }
    Abandoned { _held: held }
}
