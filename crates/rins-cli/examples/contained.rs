//! A program that contains the command: it inspects the embedded run as `rins check` does.

use std::error::Error;
use std::process::ExitCode;

fn main() -> Result<ExitCode, Box<dyn Error>> {
    let folder = tempfile::tempdir()?;
    // Writes the rig file and the log of the embedded run.
    rins::demo::log(folder.path())?;
    let rig = folder.path().join("rig.toml");
    Ok(rins_cli::run(["rins".into(), "check".into(), rig.into()]).into())
}
