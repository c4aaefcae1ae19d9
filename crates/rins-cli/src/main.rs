//! The `rins` command: simulates, checks, aligns, navigates and calibrates an IMU on a rate table.

use std::io::{self, Write as _};
use std::process::ExitCode;

use rins_io::one_line;

use crate::args::Arguments;

mod args;
mod choices;
mod deliver;
mod interrupt;
mod live;
mod progress;
mod run;
mod serve;

fn main() -> ExitCode {
    let arguments = Arguments::read();
    let _inputs = rins_io::protect_inputs();
    match interrupt::listen().and_then(|()| run::run(&arguments)) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // Where nobody can be told, the exit code tells.
            let _ = writeln!(io::stderr(), "rins: {}", one_line(&format!("{error:#}")));
            ExitCode::FAILURE
        }
    }
}
