//! Atomic output of results.

use std::ffi::{OsStr, OsString};
use std::fs::{self, File};
use std::io::{self, BufWriter, Write};
use std::path::Path;

use tempfile::{Builder, TempDir};

use crate::error::{IoError, OutputProblem};
use crate::inputs;
use crate::unfinished::{Unfinished, undisturbed};

/// Whether existing files or folders may be replaced.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Overwrite {
    /// No.
    Refuse,
    /// Yes, if it is a regular file, or a folder that contains only results of rins; but not a protected input
    /// ([`protect_inputs`](crate::protect_inputs)).
    Force,
}

/// A folder with any of these files is a result of rins.
const MARKS: [&str; 2] = ["result.json", "truth.json"];

/// Further files that a folder of rins results may contain.
const NAMES: [&str; 11] = [
    "result.json",
    "report.html",
    "run.csv",
    "rig.toml",
    "truth.json",
    "calibration.toml",
    "extended-calibration.toml",
    "extended-model.toml",
    "model.toml",
    "scenario.toml",
    "log.csv",
];

/// Writes the file at `path` atomically.
///
/// `write` fills a temporary file beside it, which is synchronized with the disk and then renamed,
/// so that at any time either the old file or the complete new one exists.
///
/// # Errors
/// [`IoError::Output`] if an existing file must not be replaced, [`IoError::File`] on a system
/// error, or the error of `write`. Nothing has then changed.
pub fn write_file(
    path: &Path,
    overwrite: Overwrite,
    write: impl FnOnce(&mut (dyn Write + Send)) -> Result<(), IoError>,
) -> Result<(), IoError> {
    let (parent, name) = split(path)?;
    ensure_replaceable(path, overwrite)?;
    let failed = || IoError::file("write", path);
    let (_unfinished, temporary) =
        Unfinished::make(|| builder(&hidden(name), 0o666).tempfile_in(parent)).map_err(failed())?;
    let mut buffered = BufWriter::new(temporary);
    write(&mut buffered)?;
    let temporary = buffered.into_inner().map_err(|error| failed()(error.into_error()))?;
    temporary.as_file().sync_all().map_err(failed())?;
    undisturbed(|| match overwrite {
        Overwrite::Force => temporary.persist(path).map(drop),
        Overwrite::Refuse => temporary.persist_noclobber(path).map(drop),
    })
    .map_err(|error| match error.error.kind() {
        io::ErrorKind::AlreadyExists => refuse(path, OutputProblem::Exists),
        _ => failed()(error.error),
    })?;
    synchronise(parent).map_err(failed())
}

/// Writes files that belong together into one folder, each atomically.
///
/// `fill` receives a temporary folder beside them, into which it writes files of the same names. They
/// are synchronized with the disk, and renamed one after the other.
///
/// # Errors
/// [`IoError::Output`] if an existing file must not be replaced, [`IoError::File`] on a system
/// error, or the error of `fill`. Nothing has then changed, unless the system error occurs
/// between two renames.
pub fn write_files(
    paths: &[&Path],
    overwrite: Overwrite,
    fill: impl FnOnce(&Path) -> Result<(), IoError>,
) -> Result<(), IoError> {
    let Some((first, _)) = paths.split_first() else { return Ok(()) };
    let (parent, name) = split(first)?;
    for path in paths {
        ensure_replaceable(path, overwrite)?;
    }
    let failed = |path: &Path| IoError::file("write", path);
    let (_unfinished, staging) =
        Unfinished::make(|| builder(&hidden(name), 0o777).tempdir_in(parent))
            .map_err(failed(first))?;
    fill(staging.path()).map_err(|error| placed(error, staging.path(), parent))?;
    synchronise_all(staging.path()).map_err(failed(first))?;
    undisturbed(|| {
        paths.iter().try_for_each(|path| {
            // A file that was created in the meantime is not replaced either.
            ensure_replaceable(path, overwrite)?;
            let staged = staging.path().join(split(path)?.1);
            fs::rename(staged, path).map_err(failed(path))
        })
    })?;
    synchronise(parent).map_err(failed(first))
}

/// A folder for intermediate files beside an output, which is removed when this value is dropped, and on an interrupt.
#[derive(Debug)]
pub struct IntermediateFolder {
    folder: TempDir,
    _unfinished: Unfinished,
}

impl IntermediateFolder {
    /// Creates it beside the file `output`, whose disk has room for the output.
    ///
    /// # Errors
    /// [`IoError::File`] on a system error.
    pub fn beside(output: &Path) -> Result<Self, IoError> {
        let (parent, name) = split(output)?;
        let (unfinished, folder) =
            Unfinished::make(|| builder(&hidden(name), 0o700).tempdir_in(parent))
                .map_err(IoError::file("write", output))?;
        Ok(Self { folder, _unfinished: unfinished })
    }

    /// Its path.
    pub fn path(&self) -> &Path {
        self.folder.path()
    }
}

/// Refuses a destination that must not be replaced; a long computation calls it before it starts.
///
/// # Errors
/// [`IoError::Output`] if an existing file must not be replaced.
pub fn ensure_replaceable(path: &Path, overwrite: Overwrite) -> Result<(), IoError> {
    match fs::symlink_metadata(path) {
        Ok(found) if found.is_dir() => {
            let (found, expected) = ("a folder", "a file");
            Err(refuse(path, OutputProblem::WrongType { found, expected }))
        }
        Ok(_) if overwrite == Overwrite::Refuse => Err(refuse(path, OutputProblem::Exists)),
        Ok(found) => match inputs::special(found.file_type()) {
            Some(found) => {
                let expected = "a regular file";
                Err(refuse(path, OutputProblem::WrongType { found, expected }))
            }
            None if inputs::is_input(path) => Err(refuse(path, OutputProblem::IsInput)),
            None => Ok(()),
        },
        Err(_) => Ok(()),
    }
}

/// Writes the folder at `path` atomically.
///
/// `fill` writes files into a temporary folder beside it, whose path it receives. They are
/// synchronized with the disk, and the folder is renamed. An existing empty folder is
/// filled. With [`Overwrite::Force`] a folder that contains a result of rins, and nothing else, is
/// replaced: the old folder is kept under a hidden name until the new one is in its place.
///
/// # Errors
/// [`IoError::Output`] if an existing folder must not be replaced, [`IoError::File`] on a
/// system error, or the error of `fill`. Nothing has then changed.
pub fn write_folder(
    path: &Path,
    overwrite: Overwrite,
    fill: impl FnOnce(&Path) -> Result<(), IoError>,
) -> Result<(), IoError> {
    let (parent, name) = split(path)?;
    let old = replaceable(path, overwrite)?;
    let failed = || IoError::file("write", path);
    let (_unfinished, staging) =
        Unfinished::make(|| builder(&hidden(name), 0o777).tempdir_in(parent)).map_err(failed())?;
    fill(staging.path()).map_err(|error| placed(error, staging.path(), path))?;
    synchronise_all(staging.path()).map_err(failed())?;
    if old {
        let (_replaced, aside) =
            Unfinished::make(|| builder(&hidden(name), 0o777).tempdir_in(parent))
                .map_err(failed())?;
        undisturbed(|| exchange(staging.path(), path, aside))
            .map_err(|error| overtaken(path, error))?;
    } else {
        undisturbed(|| fs::rename(staging.path(), path)).map_err(|error| overtaken(path, error))?;
    }
    // It has been renamed, so nothing is left to be removed.
    let _renamed = staging.keep();
    synchronise(parent).map_err(failed())
}

/// The error of a rename that failed although the destination was checked before.
fn overtaken(path: &Path, error: io::Error) -> IoError {
    match error.kind() {
        io::ErrorKind::DirectoryNotEmpty
        | io::ErrorKind::AlreadyExists
        | io::ErrorKind::NotADirectory
        | io::ErrorKind::NotFound => refuse(path, OutputProblem::Overtaken),
        _ => IoError::file("write", path)(error),
    }
}

/// Moves a new folder to the place of an old one, which is moved aside and removed with the returned folder.
fn exchange(new: &Path, place: &Path, aside: TempDir) -> io::Result<TempDir> {
    fs::rename(place, aside.path())?;
    match fs::rename(new, place) {
        Ok(()) => Ok(aside),
        Err(error) => {
            // The old result is worth more than the temporary folder: it is moved back, or
            // stays under its hidden name.
            fs::rename(aside.keep(), place)?;
            Err(error)
        }
    }
}

/// Refuses a destination to which [`write_folder`] would not write; a long computation calls it before it starts.
///
/// # Errors
/// [`IoError::Output`] if an existing folder must not be replaced, [`IoError::File`] on a system error.
pub fn ensure_replaceable_folder(path: &Path, overwrite: Overwrite) -> Result<(), IoError> {
    split(path)?;
    replaceable(path, overwrite).map(drop)
}

/// Whether there is a folder that will be replaced.
fn replaceable(path: &Path, overwrite: Overwrite) -> Result<bool, IoError> {
    let found = match fs::symlink_metadata(path) {
        Ok(found) => found,
        Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(false),
        Err(error) => return Err(IoError::file("write", path)(error)),
    };
    if !found.is_dir() {
        let found = inputs::special(found.file_type()).unwrap_or("a file");
        return Err(refuse(path, OutputProblem::WrongType { found, expected: "a folder" }));
    }
    let (mut names, mut input) = (Vec::new(), None);
    for entry in fs::read_dir(path).map_err(IoError::file("read", path))? {
        let entry = entry.map_err(IoError::file("read", path))?;
        let ours = entry.file_type().is_ok_and(|kind| kind.is_file());
        let name = entry.file_name().to_string_lossy().into_owned();
        if inputs::is_input(&entry.path()) {
            input = Some(name.clone());
        }
        names.push((name, ours));
    }
    names.sort();
    if names.is_empty() {
        return Ok(false);
    }
    if overwrite == Overwrite::Refuse {
        return Err(refuse(path, OutputProblem::Exists));
    }
    if !names.iter().any(|(name, is_file)| *is_file && MARKS.contains(&name.as_str())) {
        return Err(refuse(path, OutputProblem::NotOurs));
    }
    if let Some(entry) = input {
        return Err(refuse(path, OutputProblem::HoldsInput { entry }));
    }
    match names.into_iter().find(|(name, is_file)| !is_file || !NAMES.contains(&name.as_str())) {
        Some((entry, _)) => Err(refuse(path, OutputProblem::HoldsMore { entry })),
        None => Ok(true),
    }
}

/// Converts an error about a file in the temporary folder to one about its destination.
fn placed(error: IoError, staging: &Path, destination: &Path) -> IoError {
    match error {
        IoError::File { action, path, source } => {
            let path =
                path.strip_prefix(staging).map_or(path.clone(), |name| destination.join(name));
            IoError::File { action, path, source }
        }
        other => other,
    }
}

fn refuse(path: &Path, problem: OutputProblem) -> IoError {
    IoError::Output { path: path.into(), problem }
}

/// The parent folder of `path`, and its name there.
fn split(path: &Path) -> Result<(&Path, &OsStr), IoError> {
    let name = path.file_name().ok_or_else(|| refuse(path, OutputProblem::NoName))?;
    let parent = path.parent().filter(|parent| !parent.as_os_str().is_empty());
    Ok((parent.unwrap_or(Path::new(".")), name))
}

fn hidden(name: &OsStr) -> OsString {
    let mut hidden = OsStr::new(".").to_os_string();
    hidden.push(name);
    hidden.push(".");
    hidden
}

/// A builder of temporary files and folders with the usual permissions: `mode` masked by the
/// umask of the process.
fn builder(prefix: &OsStr, mode: u32) -> Builder<'_, 'static> {
    let mut builder = Builder::new();
    builder.prefix(prefix);
    #[cfg(unix)]
    builder.permissions(std::os::unix::fs::PermissionsExt::from_mode(mode));
    #[cfg(not(unix))]
    let _ = mode;
    builder
}

fn synchronise_all(folder: &Path) -> io::Result<()> {
    for entry in fs::read_dir(folder)? {
        let entry = entry?;
        if entry.file_type()?.is_dir() {
            synchronise_all(&entry.path())?;
        } else {
            File::open(entry.path())?.sync_all()?;
        }
    }
    synchronise(folder)
}

/// Synchronizes a folder's list of names with the disk, if the system supports that.
fn synchronise(folder: &Path) -> io::Result<()> {
    if cfg!(unix) { File::open(folder)?.sync_all() } else { Ok(()) }
}
