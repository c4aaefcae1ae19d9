//! Common functions of the workspace tests: location of the `rins` command and of measured data.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;
use std::time::SystemTime;

/// The `rins` command, built with the profile of the tests unless it is newer than all its sources.
///
/// # Panics
/// If it cannot be built.
pub fn rins() -> Command {
    static BINARY: OnceLock<PathBuf> = OnceLock::new();
    let binary = BINARY.get_or_init(|| {
        let test = std::env::current_exe().expect("a test knows where it is");
        let folder = test.ancestors().nth(2).expect("a test lies in <target>/<profile>/deps");
        let binary = folder.join(format!("rins{}", std::env::consts::EXE_SUFFIX));
        if is_current(&binary) {
            // Building one package again, with the features of that package only, would take as long as building the workspace.
            return binary;
        }
        let mut build = Command::new(env!("CARGO"));
        build.args(["build", "--quiet", "--package", "rins-cli"]).current_dir(workspace());
        if folder.ends_with("release") {
            build.arg("--release");
        }
        assert!(build.status().expect("cargo runs").success(), "rins-cli does not build");
        binary
    });
    Command::new(binary)
}

/// Whether a program is newer than every file of the workspace's crates.
fn is_current(binary: &Path) -> bool {
    let Some(built) = modified(binary) else { return false };
    let root = workspace();
    let locked = [root.join("Cargo.toml"), root.join("Cargo.lock")];
    let mut newest = locked.iter().filter_map(|path| modified(path)).max();
    let mut folders = vec![root.join("crates")];
    while let Some(folder) = folders.pop() {
        let Ok(entries) = fs::read_dir(folder) else { return false };
        for path in entries.filter_map(|entry| Some(entry.ok()?.path())) {
            if path.is_dir() {
                folders.push(path);
            } else {
                newest = newest.max(modified(&path));
            }
        }
    }
    newest.is_some_and(|newest| built > newest)
}

fn modified(path: &Path) -> Option<SystemTime> {
    fs::metadata(path).ok()?.modified().ok()
}

/// Runs `rins` with these arguments.
///
/// # Panics
/// If it cannot be started.
pub fn run<S: AsRef<std::ffi::OsStr>>(arguments: impl IntoIterator<Item = S>) -> Output {
    rins().args(arguments).output().expect("rins starts")
}

/// The root of the workspace.
///
/// # Panics
/// Never, as long as this package is in the workspace.
pub fn workspace() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the package lies in the workspace")
}

/// A file or folder of the measured and sample data that are stored outside the repository, in the folder `RINS_DATA`.
///
/// Tests that need one are ignored if the folder did not exist when they were built.
///
/// # Panics
/// If it does not exist.
pub fn outside_data(name: &str) -> PathBuf {
    let folder = std::env::var_os("RINS_DATA").expect("RINS_DATA names the folder of the data");
    let path = PathBuf::from(folder).join(name);
    assert!(path.exists(), "{} is not there", path.display());
    path
}
