//! The three commands: each prints its results and returns whether they are as expected.
#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a command line program prints")]

use std::error::Error;
use std::process::ExitCode;

mod coverage;
mod reproduce;
mod verify;

const USAGE: &str = "usage: reproduction (verify | reproduce [--check] | coverage [RUNS])";

/// Runs the command that these arguments name.
pub(crate) fn run(arguments: &[&str]) -> ExitCode {
    let done = match arguments {
        ["verify"] => verify::run(),
        ["reproduce"] => reproduce::write(),
        ["reproduce", "--check"] => reproduce::check(),
        ["coverage"] => coverage::run(coverage::RUNS),
        ["coverage", runs] => match runs.parse() {
            Ok(n_runs) if n_runs > 1 => coverage::run(n_runs),
            _ => {
                eprintln!("error: {runs:?} is not a number of runs, at least 2");
                return ExitCode::from(2);
            }
        },
        _ => {
            eprintln!("{USAGE}");
            return ExitCode::from(2);
        }
    };
    match done {
        Ok(true) => ExitCode::SUCCESS,
        Ok(false) => ExitCode::FAILURE,
        Err(error) => {
            report(&*error);
            ExitCode::FAILURE
        }
    }
}

fn report(error: &dyn Error) {
    eprintln!("error: {error}");
    let mut source = error.source();
    while let Some(cause) = source {
        eprintln!("  because {cause}");
        source = cause.source();
    }
}
