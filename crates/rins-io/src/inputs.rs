//! Input files: regular files only, and protected from being overwritten on request.

use std::fs::{self, File, FileType, Metadata};
use std::io;
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

/// The files that were read since the start of the protection; `None` without protection.
static INPUTS: Mutex<Option<Vec<PathBuf>>> = Mutex::new(None);

fn inputs() -> MutexGuard<'static, Option<Vec<PathBuf>>> {
    // The list of paths is valid even if a thread panicked while it held the lock.
    INPUTS.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Protects every file that is read from now on: overwriting it, or replacing the folder that contains it, is refused.
///
/// It is for a program that reads, computes and writes once. Inputs are protected as long as the returned value lives.
pub fn protect_inputs() -> ProtectedInputs {
    inputs().get_or_insert_default();
    ProtectedInputs(())
}

/// The protection of inputs, which ends when it is dropped; see [`protect_inputs`].
#[derive(Debug)]
#[must_use = "inputs are protected as long as this lives"]
pub struct ProtectedInputs(());

impl Drop for ProtectedInputs {
    fn drop(&mut self) {
        *inputs() = None;
    }
}

/// Opens an input file, which is protected from then on ([`protect_inputs`]).
///
/// # Errors
/// System errors, and anything but a regular file: reading from a pipe without a writer would block forever.
pub fn open(path: &Path) -> io::Result<File> {
    if let Some(kind) = special(fs::metadata(path)?.file_type()) {
        let problem = format!("is {kind}, expected a regular file");
        return Err(io::Error::new(io::ErrorKind::InvalidInput, problem));
    }
    let file = File::open(path)?;
    if let Some(read) = inputs().as_mut() {
        read.push(path.canonicalize()?);
    }
    Ok(file)
}

/// The type of a file that is neither a regular file nor a folder.
pub(crate) fn special(kind: FileType) -> Option<&'static str> {
    if kind.is_file() || kind.is_dir() {
        return None;
    }
    if kind.is_symlink() {
        return Some("a symbolic link");
    }
    #[cfg(unix)]
    {
        use std::os::unix::fs::FileTypeExt;
        if kind.is_fifo() {
            return Some("a pipe");
        }
        if kind.is_socket() {
            return Some("a socket");
        }
        if kind.is_block_device() || kind.is_char_device() {
            return Some("a device");
        }
    }
    Some("not a regular file")
}

/// Whether this file is an input, under whatever name.
pub(crate) fn is_input(path: &Path) -> bool {
    let inputs = inputs();
    let Some(read) = inputs.as_ref().filter(|read| !read.is_empty()) else { return false };
    let own = path.canonicalize().ok();
    let same = |other: &PathBuf| own.as_ref() == Some(other) || is_linked(path, other);
    read.iter().any(same)
}

/// Whether both paths refer to one file.
#[cfg(unix)]
fn is_linked(one: &Path, other: &Path) -> bool {
    use std::os::unix::fs::MetadataExt;
    let of = |data: Metadata| (data.dev(), data.ino());
    fs::metadata(one).map(of).ok().is_some_and(|one| fs::metadata(other).map(of).ok() == Some(one))
}

/// Whether both paths refer to one file, which cannot be determined on this system.
#[cfg(not(unix))]
fn is_linked(_: &Path, _: &Path) -> bool {
    false
}
