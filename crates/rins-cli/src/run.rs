//! The commands: each is one function of the library, from its arguments to its outcome.

use std::path::Path;

use rins::{
    ApplyOptions, CalibrateOptions, ConvertOptions, DesignOptions, DiagnoseOptions, HistoryOptions,
    Log, MissionOptions, MonteCarloOptions, NavigateOptions, ObserveOptions,
};
use rins_io::{IoError, ensure_replaceable_folder, shown, write_file};

use crate::args::{
    Apply, Arguments, Calibrate, Command, Convert, Demo, Design, Diagnose, Init, MonteCarlo,
    Navigate, Observe,
};
use crate::deliver::{deliver, print_outcome};
use crate::interrupt;
use crate::live::run_live;
use crate::progress::{drawn, during};
use crate::shell::{print_completions, write_man_pages};

/// Does what the command line says.
pub(crate) fn run(arguments: &Arguments) -> anyhow::Result<()> {
    if let Some(folder) = arguments.command.folder() {
        ensure_replaceable_folder(folder, arguments.overwrite())?;
    }
    match &arguments.command {
        Command::Demo(demo) => run_demo(arguments, demo),
        Command::Init(init) => run_init(arguments, init),
        Command::Simulate(simulate) => {
            let run = rins::simulate(&simulate.scenario, simulate.seed)?;
            deliver(arguments, &run, "")
        }
        Command::Convert(convert) => run_convert(arguments, convert),
        Command::Check(input) => deliver(arguments, &rins::check(&open(&input.rig)?), ""),
        Command::Allan(input) => {
            let log = during("reading", || Log::open_partial(&input.rig))?;
            deliver(arguments, &rins::allan(&log)?, "")
        }
        Command::Align(input) => {
            let log = open(&input.rig)?;
            deliver(arguments, &during("aligning", || rins::align(&log))?, "")
        }
        Command::MonteCarlo(campaign) => run_monte_carlo(arguments, campaign),
        Command::Merge(merge) => {
            let merged = rins::merge(&merge.parts, &merge.output, arguments.overwrite())?;
            deliver(arguments, &merged, "")
        }
        Command::Navigate(navigate) => run_navigate(arguments, navigate),
        Command::Calibrate(calibrate) => run_calibrate(arguments, calibrate),
        Command::Diagnose(diagnose) => run_diagnose(arguments, diagnose),
        Command::Observe(observe) => run_observe(arguments, observe),
        Command::Design(design) => run_design(arguments, design),
        Command::Apply(apply) => run_apply(arguments, apply),
        Command::Compare(compare) => {
            deliver(arguments, &rins::compare(&compare.before, &compare.after)?, "")
        }
        Command::History(history) => {
            let options = HistoryOptions {
                date: history.date,
                temperature: history.temperature,
                since_power_on: history.minutes_since_power_on.map(|minutes| 60.0 * minutes),
                progress: drawn(),
            };
            deliver(arguments, &rins::history(&history.runs, &options)?, "")
        }
        Command::Completions(completions) => print_completions(arguments, completions.shell),
        Command::Man(pages) => write_man_pages(arguments, &pages.output),
        Command::Mission(mission) => {
            let options = MissionOptions {
                calibration: mission.calibration.clone(),
                runs: mission.runs,
                seed: mission.seed,
                want: mission.want.clone(),
                progress: drawn(),
            };
            deliver(arguments, &rins::mission(&mission.file, &options)?, "")
        }
    }
}

/// Reads a rig file and its log.
fn open(rig: &Path) -> anyhow::Result<Log> {
    Ok(during("reading", || Log::open(rig))?)
}

fn open_all(rigs: &[impl AsRef<Path>]) -> anyhow::Result<Vec<Log>> {
    rigs.iter().map(|rig| open(rig.as_ref())).collect()
}

fn run_demo(arguments: &Arguments, demo: &Demo) -> anyhow::Result<()> {
    let outcome = rins::demo::demo(&drawn())?;
    deliver(arguments, &outcome, &next(&demo.output))
}

fn run_init(arguments: &Arguments, init: &Init) -> anyhow::Result<()> {
    let drafted = rins::init(&init.log, init.output.as_deref())?;
    let Some(output) = &init.output else { return print_outcome(arguments, &drafted, "") };
    write_file(output, arguments.overwrite(), |out| {
        out.write_all(drafted.text().as_bytes()).map_err(|source| IoError::File {
            action: "write",
            path: output.clone(),
            source,
        })
    })?;
    print_outcome(arguments, &drafted, &format!("\nWritten: {}\n", shown(output)))
}

fn run_convert(arguments: &Arguments, convert: &Convert) -> anyhow::Result<()> {
    let options = ConvertOptions {
        output: convert.output.clone(),
        format: convert.format.map(Into::into),
        overwrite: arguments.overwrite(),
    };
    deliver(arguments, &rins::convert(&convert.rig, options)?, "")
}

fn run_apply(arguments: &Arguments, apply: &Apply) -> anyhow::Result<()> {
    let options = ApplyOptions {
        calibration: apply.calibration.clone(),
        output: apply.output.clone(),
        format: apply.format.map(Into::into),
        extrapolate: apply.extrapolate,
        overwrite: arguments.overwrite(),
    };
    deliver(arguments, &rins::apply(&apply.rig, options)?, "")
}

fn run_navigate(arguments: &Arguments, navigate: &Navigate) -> anyhow::Result<()> {
    let log = open(&navigate.input.rig)?;
    let options = NavigateOptions {
        calibration: navigate.calibration.clone(),
        extrapolate: navigate.extrapolate,
    };
    deliver(arguments, &during("navigating", || rins::navigate(&log, &options))?, "")
}

fn run_calibrate(arguments: &Arguments, calibrate: &Calibrate) -> anyhow::Result<()> {
    if let Some(source) = calibrate.live {
        return run_live(arguments, calibrate, source);
    }
    let logs = open_all(&calibrate.rigs)?;
    let options = CalibrateOptions {
        model: calibrate.model.clone(),
        noise: calibrate.noise.into(),
        progress: drawn(),
    };
    deliver(arguments, &rins::calibrate(logs, &options)?, "")
}

fn run_diagnose(arguments: &Arguments, diagnose: &Diagnose) -> anyhow::Result<()> {
    let logs = open_all(&diagnose.rigs)?;
    let options = DiagnoseOptions {
        model: diagnose.model.clone(),
        held_out: diagnose.held_out.as_deref().map(open).transpose()?,
        transfer: diagnose.transfer,
        hypothesis: diagnose.hypothesis.clone(),
        noise: diagnose.noise.into(),
        bootstrap: diagnose.bootstrap,
        progress: drawn(),
    };
    deliver(arguments, &rins::diagnose(logs, options)?, "")
}

fn run_observe(arguments: &Arguments, observe: &Observe) -> anyhow::Result<()> {
    let options = ObserveOptions {
        model: observe.model.clone(),
        compare: observe.compare,
        separate: observe.separate.clone(),
        want: observe.want.clone(),
        max_rate: observe.max_rate,
        max_acceleration: observe.max_acceleration,
        max_duration: observe.max_duration,
        directions: observe.directions,
        progress: drawn(),
    };
    deliver(arguments, &rins::observe(&observe.scenarios, &options)?, "")
}

fn run_design(arguments: &Arguments, design: &Design) -> anyhow::Result<()> {
    let options = DesignOptions {
        goal: design.goal.clone(),
        model: design.model.clone(),
        duration: design.duration,
        max_rate: design.max_rate,
        max_acceleration: design.max_acceleration,
        directions: design.directions,
        tilts: design.tilts.clone(),
        mountings: design.mountings.clone(),
        service: design.service.clone(),
        progress: drawn(),
    };
    deliver(arguments, &rins::design(&design.scenarios, &options)?, "")
}

fn run_monte_carlo(arguments: &Arguments, campaign: &MonteCarlo) -> anyhow::Result<()> {
    let options = MonteCarloOptions {
        runs: campaign.runs,
        seed: campaign.seed,
        model: campaign.model.clone(),
        noise: campaign.noise.into(),
        truth: campaign.truth.into(),
        output: campaign.output.clone(),
        resume: campaign.resume,
        shard: campaign.shard,
        threads: campaign.threads,
        overwrite: arguments.overwrite(),
        stopped: interrupt::stopped(),
        progress: drawn(),
    };
    deliver(arguments, &rins::monte_carlo(&campaign.scenario, &options)?, "")
}

/// What to try next on the files in `folder`, ready to be pasted into a shell.
fn next(folder: &Path) -> String {
    let [rig, calibration] = ["rig.toml", "extended-calibration.toml"]
        .map(|name| quoted(&folder.join(name).display().to_string()));
    format!(
        "\n  The run and its rig file lie beside the report. Try next:\n    \
         rins check {rig}\n    \
         rins calibrate {rig} -o my-calibration\n    \
         rins diagnose {rig}\n    \
         rins navigate {rig} --calibration {calibration}\n"
    )
}

/// A path as a shell takes it for one word.
fn quoted(path: &str) -> String {
    let plain = |letter: char| letter.is_alphanumeric() || "/\\:._-+,@%".contains(letter);
    if path.chars().all(plain) { path.into() } else { format!("'{}'", path.replace('\'', r"'\''")) }
}
