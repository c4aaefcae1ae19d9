//! The `rins` command as a function: simulates, checks, aligns, navigates and calibrates an IMU on a rate table.
//!
//! [`run`] is the whole command, for a program that contains it. For functions with typed results, use the crate `rins`.

use std::ffi::OsString;
use std::io::{self, Write as _};

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
mod shell;

/// Runs a command line, whose first word is the name of the program, and returns the exit code: 0 done, 1 the data or the
/// files are at fault, 2 usage.
///
/// Output goes to standard output and standard error. An interrupt ends the process: it is for the main function of a program.
///
/// ```
/// assert_eq!(rins_cli::run(["rins".into(), "--version".into()]), 0);
/// ```
pub fn run(arguments: impl IntoIterator<Item = OsString>) -> u8 {
    let arguments = match Arguments::read(arguments) {
        Ok(arguments) => arguments,
        Err(refusal) => {
            // Where nobody can be told, the exit code tells.
            let _ = refusal.print();
            return u8::try_from(refusal.exit_code()).unwrap_or(2);
        }
    };
    let _inputs = rins_io::protect_inputs();
    match interrupt::listen().and_then(|()| run::run(&arguments)) {
        Ok(()) => 0,
        Err(error) => {
            // Where nobody can be told, the exit code tells.
            let _ = writeln!(io::stderr(), "rins: {}", one_line(&format!("{error:#}")));
            1
        }
    }
}
