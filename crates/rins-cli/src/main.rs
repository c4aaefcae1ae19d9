//! The `rins` command.

use std::env;
use std::process::ExitCode;

fn main() -> ExitCode {
    rins_cli::run(env::args_os()).into()
}
