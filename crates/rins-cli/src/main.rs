//! The `rins` command: simulates, checks, aligns, navigates and calibrates an IMU on a rate table.

use std::io::{self, Write as _};
use std::process::ExitCode;

use anyhow::Context;

use crate::args::{Arguments, Command};
use crate::outcome::Outcome;
use rins_io::one_line;

mod args;
mod commands;
mod interrupt;
mod outcome;
mod progress;
mod view;

fn main() -> ExitCode {
    let arguments = Arguments::read();
    let _inputs = rins_io::protect_inputs();
    let delivered = interrupt::listen()
        .and_then(|()| run(&arguments))
        .and_then(|outcome| deliver(&arguments, &outcome));
    match delivered {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            // Where nobody can be told, the exit code tells.
            let _ = writeln!(io::stderr(), "rins: {}", one_line(&format!("{error:#}")));
            ExitCode::FAILURE
        }
    }
}

fn run(arguments: &Arguments) -> anyhow::Result<Outcome> {
    match &arguments.command {
        Command::Demo(demo) => commands::demo::run(demo),
        Command::Init(init) => commands::init::run(init),
        Command::Simulate(simulate) => commands::simulate::run(simulate),
        Command::Convert(convert) => commands::convert::run(convert, arguments.overwrite()),
        Command::Check(input) => commands::check::run(&input.rig),
        Command::Allan(input) => commands::allan::run(&input.rig),
        Command::Align(input) => commands::align::run(&input.rig),
        Command::MonteCarlo(campaign) => {
            commands::monte_carlo::run(campaign, arguments.overwrite())
        }
        Command::Merge(merge) => commands::merge::run(merge, arguments.overwrite()),
        Command::Navigate(navigate) => commands::navigate::run(navigate),
        Command::Calibrate(calibrate) => commands::calibrate::run(calibrate),
        Command::Diagnose(diagnose) => commands::diagnose::run(diagnose),
        Command::Observe(observe) => commands::observe::run(observe),
        Command::Apply(apply) => commands::apply::run(apply, arguments.overwrite()),
        Command::Compare(compare) => commands::compare::run(compare),
    }
}

/// Writes the output folder first: what is printed then names files that exist.
fn deliver(arguments: &Arguments, outcome: &Outcome) -> anyhow::Result<()> {
    let written = outcome.write(arguments.command.destination(), arguments.overwrite())?;
    if arguments.json {
        print(&(serde_json::to_string(&outcome.json)? + "\n"))?;
    } else {
        let place = written.map_or_else(String::new, |place| format!("\n{place}\n"));
        print(&(outcome.text.clone() + &place))?;
    }
    match &outcome.failure {
        Some(failure) => Err(anyhow::anyhow!("{failure}")),
        None => Ok(()),
    }
}

/// Prints a result, of which a reader may have had enough before its end.
fn print(text: &str) -> anyhow::Result<()> {
    let mut out = io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(error) if error.kind() == io::ErrorKind::BrokenPipe => Ok(()),
        printed => printed.context("cannot write to standard output"),
    }
}
