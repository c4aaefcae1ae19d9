//! Tests of the workspace as a whole: how they find the `rins` command and measured data.

use std::path::{Path, PathBuf};
use std::process::{Command, Output};
use std::sync::OnceLock;

/// The `rins` command, built once with the profile of the tests.
///
/// # Panics
/// If it cannot be built.
pub fn rins() -> Command {
    static BINARY: OnceLock<PathBuf> = OnceLock::new();
    let binary = BINARY.get_or_init(|| {
        let test = std::env::current_exe().expect("a test knows where it is");
        let folder = test.ancestors().nth(2).expect("a test lies in <target>/<profile>/deps");
        let mut build = Command::new(env!("CARGO"));
        build.args(["build", "--quiet", "--package", "rins-cli"]).current_dir(workspace());
        if folder.ends_with("release") {
            build.arg("--release");
        }
        assert!(build.status().expect("cargo runs").success(), "rins-cli does not build");
        folder.join(format!("rins{}", std::env::consts::EXE_SUFFIX))
    });
    Command::new(binary)
}

/// Runs `rins` with these arguments.
///
/// # Panics
/// If it cannot be started.
pub fn run<S: AsRef<std::ffi::OsStr>>(arguments: impl IntoIterator<Item = S>) -> Output {
    rins().args(arguments).output().expect("rins starts")
}

/// The workspace's root.
///
/// # Panics
/// Never, as long as this package lies in it.
pub fn workspace() -> &'static Path {
    Path::new(env!("CARGO_MANIFEST_DIR")).parent().expect("the package lies in the workspace")
}

/// A file or folder of the measured and sample data that are kept outside of the repository, or
/// `None`, said on standard error, where `RINS_DATA` does not name their folder.
#[expect(clippy::print_stderr, reason = "a skipped test says so")]
pub fn outside_data(name: &str) -> Option<PathBuf> {
    match std::env::var_os("RINS_DATA") {
        Some(folder) => Some(PathBuf::from(folder).join(name)),
        None => {
            eprintln!("skipped: RINS_DATA is not set, so {name} cannot be read");
            None
        }
    }
}
