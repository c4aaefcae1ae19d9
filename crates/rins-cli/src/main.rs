//! The `rins` command: simulates, checks, aligns, navigates and calibrates an IMU on a rate table.
#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a command line program prints")]

use std::process::ExitCode;

use crate::args::{Arguments, Command};
use crate::outcome::Outcome;

mod args;
mod commands;
mod number;
mod outcome;
mod progress;
mod report;
mod view;

fn main() -> ExitCode {
    let arguments = Arguments::read();
    let delivered = run(&arguments).and_then(|outcome| deliver(&arguments, &outcome));
    match delivered {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => {
            eprintln!("rins: {error:#}");
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
        println!("{}", serde_json::to_string(&outcome.json)?);
    } else {
        print!("{}", outcome.text);
        if let Some(place) = written {
            println!("\n{place}");
        }
    }
    match &outcome.failure {
        Some(failure) => Err(anyhow::anyhow!("{failure}")),
        None => Ok(()),
    }
}
