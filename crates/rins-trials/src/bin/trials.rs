//! Runs blind trials, or makes the score card of those that were run.
#![expect(clippy::print_stdout, clippy::print_stderr, reason = "a command line program prints")]

use std::path::{Path, PathBuf};
use std::process::ExitCode;

use rins_trials::{
    Analyser, Frozen, InjectionTrial, Length, Plan, Population, Record, Trial, Trouble, card,
    certificates, history_page, history_trial, injections, merge, null_page, records, run,
    run_frozen, time,
};

const USAGE: &str = "usage: trials run|null RINS JOURNAL SEED TRIALS THREADS [--shard I/N] [ARGUMENT...] | trials merge MERGED JOURNAL... | trials time RINS JOURNAL SEED TRIALS [ARGUMENT...] | \
                     trials frozen RINS [ARGUMENT...] | trials folder SEED INDEX FOLDER [longest|null] | trials card JOURNAL PAGE | \
                     trials null-page JOURNAL PAGE REVISION | trials histories SEED CAMPAIGNS PAGE REVISION | \
                     trials certificates RINS SEED LABORATORIES THREADS PAGE REVISION | \
                     trials injections RINS RIGS SEED ROUNDS PAGE REVISION";

fn main() -> ExitCode {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let words: Vec<&str> = words.iter().map(String::as_str).collect();
    match commanded(&words) {
        None => {
            eprintln!("error: {USAGE}");
            ExitCode::from(2)
        }
        Some(Ok(())) => ExitCode::SUCCESS,
        Some(Err(error)) => {
            eprintln!("error: {}", error.with_causes());
            ExitCode::FAILURE
        }
    }
}

/// What came of a command; none if it is none.
fn commanded(words: &[&str]) -> Option<Result<(), Trouble>> {
    let cores = std::thread::available_parallelism().map_or(1, usize::from);
    let told = |record: &Record| println!("{}", line(record));
    Some(match *words {
        [which @ ("run" | "null"), program, journal, seed, trials, threads, ref more @ ..] => {
            let population = if which == "run" { Population::Blind } else { Population::Null };
            let (shard, more) = match *more {
                ["--shard", shard, ref more @ ..] => (self::shard(shard)?, more),
                _ => ((1, 1), more),
            };
            let plan = Plan {
                population,
                seed: seed.parse().ok()?,
                trials: trials.parse().ok()?,
                threads: threads.parse().ok()?,
                shard,
            };
            let analyser = Analyser::new(program, (cores / plan.threads.max(1)).max(1));
            let analyser = analyser.with(more);
            run(&plan, &analyser, Path::new(journal), told)
        }
        ["merge", merged, ref journals @ ..] if !journals.is_empty() => {
            let journals: Vec<&Path> = journals.iter().map(Path::new).collect();
            merge(&journals, Path::new(merged))
        }
        ["time", program, journal, seed, trials, ref more @ ..] => {
            let analyser = Analyser::new(program, cores).with(more);
            let (seed, trials) = (seed.parse().ok()?, trials.parse().ok()?);
            time(seed, trials, &analyser, Path::new(journal), told)
        }
        ["frozen", program, ref more @ ..] => {
            let told = |trial: &Frozen, fault: Option<&str>| match fault {
                None => println!("as before: {}", trial.name),
                Some(fault) => println!("NOT AS BEFORE: {}: {fault}", trial.name),
            };
            run_frozen(&Analyser::new(program, 1).with(more), cores, told)
        }
        ["folder", seed, index, folder, ref kind @ ..] => {
            let (seed, index) = (seed.parse().ok()?, index.parse().ok()?);
            let trial = match *kind {
                [] => Trial::draw(seed, index, Length::Drawn),
                ["longest"] => Trial::draw(seed, index, Length::Longest),
                ["null"] => Ok(Trial::null(seed, index)),
                _ => return None,
            };
            trial.map_err(Trouble::from).and_then(|trial| made(&trial, Path::new(folder)))
        }
        ["card", journal, page] => {
            records(Path::new(journal)).and_then(|all| Ok(std::fs::write(page, card(&all))?))
        }
        ["null-page", journal, page, revision] => records(Path::new(journal))
            .and_then(|all| Ok(std::fs::write(page, null_page(&all, revision))?)),
        ["histories", seed, campaigns, page, revision] => {
            let (seed, campaigns) = (seed.parse().ok()?, campaigns.parse().ok()?);
            histories(seed, campaigns, Path::new(page), revision)
        }
        ["injections", program, rigs, seed, rounds, page, revision] => {
            let analyser = Analyser::new(program, cores);
            let rigs: Vec<PathBuf> = rigs.split(',').map(PathBuf::from).collect();
            let told = |one: &InjectionTrial| println!("{}", injected(one));
            let draw = (seed.parse().ok()?, rounds.parse().ok()?);
            injections(&rigs, &analyser, draw, (Path::new(page), revision), told)
        }
        ["certificates", program, seed, laboratories, threads, page, revision] => {
            let (seed, laboratories) = (seed.parse().ok()?, laboratories.parse().ok()?);
            let page = (Path::new(page), revision);
            certificates(program, (seed, laboratories), threads.parse().ok()?, page)
        }
        _ => return None,
    })
}

/// A shard and how many there are, as in `2/5`.
fn shard(text: &str) -> Option<(u64, u64)> {
    let (shard, of) = text.split_once('/')?;
    let (shard, of) = (shard.parse().ok()?, of.parse().ok()?);
    (1..=of).contains(&shard).then_some((shard, of))
}

/// Runs so many campaigns and writes the page of what came of them.
fn histories(seed: u64, campaigns: u64, page: &Path, revision: &str) -> Result<(), Trouble> {
    let mut all = Vec::new();
    for index in 0..campaigns {
        let start = std::time::Instant::now();
        all.push(history_trial(seed, index)?);
        println!("{index:5} {} {:.2} s", all[all.len() - 1], start.elapsed().as_secs_f64());
    }
    Ok(std::fs::write(page, history_page(&all, seed, revision))?)
}

/// Makes the folder of one trial, and says what is hidden in it.
fn made(trial: &Trial, folder: &Path) -> Result<(), Trouble> {
    std::fs::create_dir_all(folder)?;
    let log = rins_blind::record(&trial.experiment);
    rins_blind::write(folder, &log, &trial.known, trial.experiment.interval)?;
    println!("{}", serde_json::to_string_pretty(&trial.hidden)?);
    println!("{}", serde_json::to_string_pretty(&trial.outside)?);
    Ok(())
}

/// An injection in one line.
fn injected(one: &InjectionTrial) -> String {
    let error = one.error.map_or_else(String::new, |error| format!(" {error:.1}σ off"));
    format!(
        "{} {} {} {:.1}σ {}{error}; false [{}]; before [{}] {:.1} s {}",
        one.log,
        one.injection.id,
        one.injection.channel,
        one.injection.strength,
        if one.is_found { "found" } else { "missed" },
        one.false_names.join(", "),
        one.before.join(", "),
        one.seconds,
        one.failure.as_deref().unwrap_or_default()
    )
}

/// A trial in one line.
fn line(record: &Record) -> String {
    let hidden: Vec<String> =
        record.hidden.iter().map(|one| format!("{} {:.1}σ", one.id, one.strength)).collect();
    let outside = record.outside.as_ref().map(|one| {
        format!("{} on {}, {:.0}σ", one.name, one.channel, one.remainder.unwrap_or_default())
    });
    let named: Vec<String> =
        record.answer.causes.iter().map(|one| one.set().collect::<Vec<_>>().join("|")).collect();
    format!(
        "{:5} {:11} {:22} [{}{}] -> {} [{}] {} {:.1} s {}",
        record.index,
        record.schedule.name(),
        record.level.name(),
        hidden.join(", "),
        outside.unwrap_or_default(),
        record.answer.verdict,
        named.join(", "),
        record.answer.unexplained.join("; "),
        record.answer.seconds,
        record.answer.failure.as_deref().unwrap_or_default()
    )
}
