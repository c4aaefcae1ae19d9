//! How an outcome is delivered: written where the command line says, and printed.

use std::io::{self, Write as _};

use anyhow::Context;
use rins::Outcome;
use rins_io::shown;

use crate::args::Arguments;

/// Writes the output folder first: what is printed then names files that exist.
///
/// `further` is printed below the text.
pub(crate) fn deliver(
    arguments: &Arguments,
    outcome: &impl Outcome,
    further: &str,
) -> anyhow::Result<()> {
    let written = match arguments.command.folder() {
        None => None,
        Some(folder) => Some(match outcome.write(folder, arguments.overwrite())? {
            Some(page) => format!("\nReport: {}\n", shown(&page)),
            None => format!("\nWritten: {}\n", shown(folder)),
        }),
    };
    print_outcome(arguments, outcome, &(further.to_owned() + &written.unwrap_or_default()))
}

/// Prints an outcome, and below its text what else is to be said.
pub(crate) fn print_outcome(
    arguments: &Arguments,
    outcome: &impl Outcome,
    further: &str,
) -> anyhow::Result<()> {
    if arguments.json {
        print(&(outcome.json()? + "\n"))?;
    } else {
        print(&format!("{outcome}{further}"))?;
    }
    match outcome.failure() {
        Some(failure) => Err(anyhow::Error::msg(failure)),
        None => Ok(()),
    }
}

/// Prints a result, of which a reader may have had enough before its end.
pub(crate) fn print(text: &str) -> anyhow::Result<()> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        printed => printed.context("cannot write to standard output"),
    }
}
