//! All steps of CI after the tests, in sequence.

use std::env;
use std::fmt;
use std::fs;
use std::path::Path;
use std::process::Command;
use std::time::{Instant, SystemTime};

use clap::Args;

use crate::Result;
use crate::manifest::{Manifest, crate_folders, examples};

/// The options of the steps.
#[derive(Args)]
pub(crate) struct Options {
    /// Run only the steps with these names
    steps: Vec<String>,
    /// List the steps and their commands, and run none
    #[arg(long)]
    list: bool,
}

/// A name, environment variables, and a command.
type Row = (&'static str, Environment, &'static str);

/// Environment variables with their values.
type Environment = &'static [(&'static str, &'static str)];

/// The fixed steps, which do not depend on the list of crates; steps that only read the sources come first.
const STEPS: &[Row] = &[
    ("tidy", &[], "cargo xtask tidy"),
    ("deny", &[], "cargo deny --log-level error check bans licenses sources"),
    ("format", &[], "cargo fmt --all --check"),
    ("lint", &[], "cargo clippy --quiet --workspace --all-targets -- -D warnings"),
    (
        "lint-book",
        &[],
        "cargo clippy --quiet -p xtask --features book --all-targets -- -D warnings",
    ),
    ("test-book", &[], "cargo test --quiet --profile tool -p xtask --features book --bin book"),
    // Ignored without a browser; CI has one.
    ("browser", &[], "cargo test --quiet --workspace --test browser -- --ignored"),
    ("doc", &[("RUSTDOCFLAGS", "-D warnings")], "cargo doc --quiet --workspace --no-deps"),
    ("book", &[], "cargo xtask doc"),
    ("no-std-frames", &[], "cargo build --quiet --package rins-frames --no-default-features"),
    ("no-std-ekf", &[], "cargo build --quiet --package rins-ekf --no-default-features"),
    // The bounds of the readers do not depend on their speed.
    ("fuzz", &[("CARGO_PROFILE_RELEASE_OPT_LEVEL", "1")], "cargo xtask fuzz --seconds 3"),
    // `lint` compiles the benchmarks; those with instruction counts are built and run.
    ("instructions", &[], "cargo xtask bench --instructions"),
    // With the features of the tests: with those of a single package, all dependencies would be built again.
    ("programs", &[], "cargo build --quiet --workspace --bins --examples"),
    // A new environment: pip builds and installs the package, which is then tested.
    ("python", &[], "bash crates/rins-python/ci.sh"),
    // With the profile of the tests: an optimized build of everything would take twice as long.
    ("dist", &[], "cargo xtask dist --profile dev"),
];

/// Programs that the step `programs` has built; running them by cargo would build more.
const PROGRAMS: &[(&str, &[&str])] = &[
    ("verify", &["reproduction", "verify"]),
    ("reproduce", &["reproduction", "reproduce", "--check"]),
    ("demo", &["rins", "demo", "-o", "target/ci/demo"]),
    // Diagnoses of complete runs, which would take minutes in the tests.
    ("frozen-trials", &["trials", "frozen", RINS]),
];

/// The placeholder for the path of the command `rins`.
const RINS: &str = "RINS";

/// The arguments of examples that take a file or a folder, mostly output of the step `demo`.
const ARGUMENTS: &[(&str, &str)] = &[
    ("apply", "target/ci/demo/calibration.toml"),
    ("calibrate", "target/ci/demo/rig.toml"),
    ("calibrated_runs", "2 scenarios/schedules/ii-reversal.toml"),
    ("campaign", "scenarios/paper/section-4-1.toml"),
    ("diagnose", "target/ci/demo/rig.toml"),
    ("online", "scenarios/paper/simulation.toml"),
    ("read_run", "target/ci/demo/rig.toml"),
    ("schedule", "scenarios/schedules/i-constant-rate.toml"),
    ("schemas", "target/ci/schema"),
];

/// The step with a cargo command that must be installed.
const INSTALLED: &str = "deny";

/// The output folder of the steps, created anew: the demo replaces no files.
const SCRATCH: &str = "target/ci";

/// Packages outside `crates/`, which are not published.
const UNPUBLISHED: [&str; 2] = ["rins-tests", "xtask"];

/// A command that must succeed; its words contain no blanks.
#[derive(Debug)]
struct Step {
    name: String,
    environment: Environment,
    command: String,
}

/// The command line.
impl fmt::Display for Step {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        for (key, value) in self.environment {
            write!(f, "{key}='{value}' ")?;
        }
        f.write_str(&self.command)
    }
}

impl Step {
    fn run(&self, root: &Path) -> Result<()> {
        println!("== {}: {self}", self.name);
        // CI installs it, and fails without it.
        if self.name == INSTALLED && !is_installed(INSTALLED) && env::var_os("CI").is_none() {
            println!("== {}: skipped, as cargo install cargo-{INSTALLED} has not run", self.name);
            return Ok(());
        }
        let start = Instant::now();
        let mut words = self.command.split(' ');
        let program = words.next().unwrap_or_default();
        let status = Command::new(program)
            .args(words)
            .envs(self.environment.iter().copied())
            .current_dir(root)
            .status()
            .map_err(|error| format!("{program}: {error}"))?;
        let seconds = start.elapsed().as_secs_f64();
        if !status.success() {
            let name = &self.name;
            return Err(format!(
                "{name} failed after {seconds:.1} s ({status}); repeat it with\n  {self}"
            )
            .into());
        }
        println!("== {}: passed in {seconds:.1} s", self.name);
        Ok(())
    }
}

/// Whether `cargo` has this command.
fn is_installed(command: &str) -> bool {
    let asked = Command::new("cargo").args([command, "--version"]).output();
    asked.is_ok_and(|output| output.status.success())
}

/// Runs the selected steps up to the first failure.
pub(crate) fn run(root: &Path, options: &Options) -> Result<()> {
    let steps = chosen(steps(root)?, &options.steps)?;
    if options.list {
        for step in &steps {
            println!("{:24} {step}", step.name);
        }
        return Ok(());
    }
    let scratch = root.join(SCRATCH);
    if scratch.exists() {
        fs::remove_dir_all(&scratch)?;
    }
    fs::create_dir_all(&scratch)?;
    let start = Instant::now();
    for step in &steps {
        step.run(root)?;
    }
    println!("== {} steps passed in {:.0} s", steps.len(), start.elapsed().as_secs_f64());
    Ok(())
}

/// All steps, in their order.
fn steps(root: &Path) -> Result<Vec<Step>> {
    let fixed = STEPS.iter().map(|&(name, environment, command)| Step {
        name: name.into(),
        environment,
        command: command.into(),
    });
    let mut steps: Vec<Step> = fixed.collect();
    let target = crate::target(root)?;
    let built = target.strip_prefix(root).unwrap_or(&target).join("debug");
    let rins = target.join("debug/rins").display().to_string();
    let built = built.display();
    steps.extend(PROGRAMS.iter().map(|(name, words)| {
        let words = words.iter().map(|&word| if word == RINS { &rins } else { word });
        let command = words.collect::<Vec<_>>().join(" ");
        Step { name: (*name).into(), environment: &[], command: format!("{built}/{command}") }
    }));
    let mut unpublished = UNPUBLISHED.map(str::to_owned).to_vec();
    for folder in crate_folders(root)? {
        let Manifest { name, published, .. } = Manifest::read(&folder.join("Cargo.toml"))?;
        steps.extend(examples(&folder).into_iter().map(|example| Step {
            name: format!("example-{example}"),
            environment: &[],
            command: match ARGUMENTS.iter().find(|(name, _)| *name == example) {
                Some((_, argument)) => format!("{built}/examples/{example} {argument}"),
                None => format!("{built}/examples/{example}"),
            },
        }));
        if !published {
            unpublished.push(name);
        }
    }
    // Cargo identifies an unpacked or built package by name, version and folder: a new folder prevents the use of one from another
    // commit.
    let now = SystemTime::now().duration_since(SystemTime::UNIX_EPOCH)?.as_millis();
    let mut command = format!(
        "cargo package --quiet --workspace --allow-dirty --target-dir {SCRATCH}/package-{now}"
    );
    for name in unpublished {
        command.push_str(" --exclude ");
        command.push_str(&name);
    }
    // They are built and not run.
    let environment = &[("CARGO_PROFILE_DEV_DEBUG", "0"), ("CARGO_PROFILE_DEV_OPT_LEVEL", "0")];
    steps.push(Step { name: "package".into(), environment, command });
    Ok(steps)
}

/// The steps with these names, or all if there are none.
fn chosen(steps: Vec<Step>, names: &[String]) -> Result<Vec<Step>> {
    if let Some(unknown) = names.iter().find(|name| !steps.iter().any(|step| step.name == **name)) {
        return Err(format!("no step is called {unknown}: see cargo xtask ci --list").into());
    }
    let is_chosen = |step: &Step| names.is_empty() || names.contains(&step.name);
    Ok(steps.into_iter().filter(is_chosen).collect())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn step(command: &str) -> Step {
        Step { name: "a step".into(), environment: &[("A", "b c")], command: command.into() }
    }

    #[test]
    fn failed_step_says_how_to_repeat_it() {
        let error = step("cargo no-such-command").run(&crate::root()).unwrap_err().to_string();
        assert!(error.starts_with("a step failed"), "{error}");
        assert!(error.ends_with("  A='b c' cargo no-such-command"), "{error}");
        assert!(step("cargo --version").run(&crate::root()).is_ok());
    }

    #[test]
    fn commands_that_are_not_installed_are_known() {
        assert!(is_installed("clippy") && !is_installed("no-such-command"));
        let steps = steps(&crate::root()).unwrap();
        assert!(steps.iter().any(|step| step.name == INSTALLED));
    }

    #[test]
    fn steps_are_chosen_by_name() {
        let all = || steps(&crate::root()).unwrap();
        assert_eq!(chosen(all(), &[]).unwrap().len(), all().len());
        let picked = chosen(all(), &["package".into(), "tidy".into()]).unwrap();
        let names: Vec<_> = picked.iter().map(|step| step.name.as_str()).collect();
        assert_eq!(names, ["tidy", "package"], "steps keep their order");
        assert!(chosen(all(), &["pakage".into()]).unwrap_err().to_string().contains("pakage"));
    }

    /// Cargo builds the examples of all crates into one folder.
    #[test]
    fn names_of_steps_are_not_repeated() {
        let mut names: Vec<_> =
            steps(&crate::root()).unwrap().into_iter().map(|step| step.name).collect();
        let count = names.len();
        names.sort();
        names.dedup();
        assert_eq!(names.len(), count);
    }

    /// The other examples read no arguments, and must run without them.
    #[test]
    fn examples_that_read_arguments_are_given_some() {
        let root = crate::root();
        for folder in crate_folders(&root).unwrap() {
            for example in examples(&folder) {
                let source = folder.join("examples").join(&example).with_extension("rs");
                let Ok(text) = fs::read_to_string(&source) else {
                    continue;
                };
                let is_given = ARGUMENTS.iter().any(|(name, _)| *name == example);
                assert_eq!(text.contains("env::args"), is_given, "{}", source.display());
            }
        }
    }

    #[test]
    fn what_is_not_published_is_not_packaged() {
        let steps = steps(&crate::root()).unwrap();
        let package = &steps.last().unwrap().command;
        assert!(package.contains("--exclude rins-testing"), "{package}");
        assert!(!package.contains("--exclude rins-frames"), "{package}");
    }
}
