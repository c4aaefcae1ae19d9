//! Campaigns of any model: determinism, calibration, and inputs that are refused.

use std::fs;
use std::path::{Path, PathBuf};

use rins::campaign::CampaignResult;
use rins::{ModelChoice, MonteCarloOptions, NoiseChoice, Outcome, Overwrite, TruthChoice};
use tempfile::TempDir;

/// The reversal schedule, shortened, with an error of a rotation that the model `full` has.
const SCENARIO: &str = r#"
[site]
latitude = "45 deg"
longitude = "0 deg"
height = "0 m"

[log]
rate = "25 Hz"
table_angle = { noise = "1 arcsec" }

[table]
wobble = "0.001 arcsec"
profile = [
    { rate = "10 deg/s", duration = "36 s" },
    { rate = "-10 deg/s", duration = "36 s" },
]

[attitude]
roll = "0 deg"
pitch = "25 deg"
yaw = "0 deg"
sigma = "0.1 deg"

[imu.gyro]
noise = "0.02 deg/h/sqrt(Hz)"
bias_sigma = "0.1 deg/h"
scale_sigma = "500 ppm"
misalignment_sigma = "120 arcsec"

[imu.accel]
noise = "30 ug/sqrt(Hz)"
bias_sigma = "200 ug"
scale_sigma = "300 ppm"
misalignment_sigma = "60 arcsec"

[truth]
seed = 2
attitude = { roll = "0 deg", pitch = "25.02 deg", yaw = "0 deg" }
gyro = { scale = ["0 ppm", "0 ppm", "300 ppm"] }
"#;

struct Folder(TempDir);

impl Folder {
    fn new() -> Self {
        let folder = tempfile::tempdir().unwrap();
        fs::write(folder.path().join("scenario.toml"), SCENARIO).unwrap();
        Self(folder)
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn bytes(&self, name: &str) -> Vec<u8> {
        fs::read(self.path(name)).unwrap()
    }

    /// A model file with this text after its first lines.
    fn model(&self, base: &str, terms: &str) -> ModelChoice {
        let path = self.path("model.toml");
        fs::write(&path, format!("schema = 1\nbase = {base:?}\n{terms}")).unwrap();
        ModelChoice::File(path)
    }

    fn run(&self, options: &MonteCarloOptions) -> Result<CampaignResult, String> {
        let done = rins::monte_carlo(&self.path("scenario.toml"), options);
        done.map(|outcome| outcome.result()).map_err(|error| format!("{error:#}"))
    }

    /// The options of `runs` runs of the full model with given noise.
    fn full(&self, runs: u64, name: &str) -> MonteCarloOptions {
        MonteCarloOptions {
            model: ModelChoice::Full,
            noise: NoiseChoice::Given,
            ..MonteCarloOptions::new(runs, self.path(name))
        }
    }
}

fn sibling(path: &Path, ending: &str) -> String {
    path.with_extension(ending).file_name().unwrap().to_string_lossy().into_owned()
}

#[test]
fn bytes_are_the_same_for_any_threads_shards_and_interruptions() {
    let folder = Folder::new();
    for (threads, name) in [(1, "one.parquet"), (3, "three.parquet")] {
        let options = MonteCarloOptions { threads: Some(threads), ..folder.full(7, name) };
        folder.run(&options).unwrap();
    }
    let one = folder.bytes("one.parquet");
    assert!(one == folder.bytes("three.parquet"));
    let parts: Vec<PathBuf> = (1..=3)
        .map(|shard| {
            let name = format!("part{shard}.parquet");
            let options = MonteCarloOptions { shard: Some((shard, 3)), ..folder.full(7, &name) };
            folder.run(&options).unwrap();
            folder.path(&name)
        })
        .collect();
    let merged = folder.path("merged.parquet");
    let whole = rins::merge(&parts, &merged, Overwrite::Refuse).unwrap().result();
    assert!(one == folder.bytes("merged.parquet"));
    let page = |name: &str| fs::read_to_string(folder.path(name)).unwrap();
    let plots = |page: &str| page.split_once("Posteriors and true values").unwrap().1.to_owned();
    // The provenance of both is different; tables and plots are not.
    let body = |name: &str| plots(&page(name)).split("</section>").next().unwrap().to_owned();
    assert_eq!(body(&sibling(&merged, "html")), body("one.html"));
    // Stopped from the start, nothing is run; resumed, the result has the same bytes.
    let stopped = folder.full(7, "cut.parquet");
    stopped.stopped.store(true, std::sync::atomic::Ordering::Relaxed);
    let said = folder.run(&stopped).unwrap_err();
    assert!(said.contains("continue with --resume"), "{said}");
    let options = MonteCarloOptions { resume: true, ..folder.full(7, "cut.parquet") };
    let resumed = folder.run(&options).unwrap();
    assert!(one == folder.bytes("cut.parquet"));
    assert_eq!(whole.cells, resumed.cells);
    // Other sources of the truth are another campaign, as are other models.
    for options in [
        MonteCarloOptions { truth: TruthChoice::Scenario, ..folder.full(7, "other.parquet") },
        MonteCarloOptions { noise: NoiseChoice::Likely, ..folder.full(7, "other.parquet") },
    ] {
        let options =
            MonteCarloOptions { shard: Some((2, 3)), overwrite: Overwrite::Force, ..options };
        folder.run(&options).unwrap();
        let mixed = [parts[0].clone(), folder.path("other.parquet"), parts[2].clone()];
        let said = rins::merge(&mixed, &folder.path("mixed.parquet"), Overwrite::Refuse);
        assert!(format!("{:#}", said.unwrap_err()).contains("not of the campaign"));
    }
}

#[test]
fn posteriors_of_the_full_model_are_calibrated() {
    let folder = Folder::new();
    let result = folder.run(&folder.full(120, "runs.parquet")).unwrap();
    let cell = &result.cells[0];
    assert_eq!((cell.runs, cell.failed, cell.not_converged), (120, Some(0), Some(0)));
    assert_eq!(cell.parameters.len(), 27);
    assert_eq!(cell.consistent, Some(true), "NEES {:?} in {:?}", cell.nees, cell.nees_bounds_99);
    let combinations = cell.combinations.as_ref().unwrap();
    assert!((5..27).contains(&combinations.len()), "{}", combinations.len());
    let posteriors = cell.parameters.iter().map(|one| one.posterior.as_ref().unwrap());
    for posterior in posteriors.chain(combinations.iter().map(|one| &one.posterior)) {
        assert_eq!(posterior.calibrated, Some(true), "{posterior:?}");
    }
    // A run that turns both ways determines the scale error about the axis, but not an accelerometer bias along it beside the scale error.
    let observability = |id: &str| {
        let found = cell.parameters.iter().find(|one| one.id == id).unwrap();
        found.posterior.as_ref().unwrap().observability.as_str()
    };
    assert_eq!(observability("gyro.scale.z"), "observable");
    assert_eq!(observability("accel.bias.z"), "observable only in a combination");
}

#[test]
fn true_values_of_the_scenario_are_those_of_every_run() {
    let folder = Folder::new();
    let options =
        MonteCarloOptions { truth: TruthChoice::Scenario, ..folder.full(4, "runs.parquet") };
    let result = folder.run(&options).unwrap();
    assert_eq!(result.truth.as_deref(), Some("scenario"));
    let value = |id: &str| {
        let found = result.cells[0].parameters.iter().find(|one| one.id == id).unwrap();
        (found.truth, found.mean_error, found.sigma_rms)
    };
    let (truth, error, sigma) = value("gyro.scale.z");
    assert!((truth - 300.0).abs() < 1e-9 && error.abs() < 5.0 * sigma, "{truth} {error} {sigma}");
    // The pitch of the axis is 0.02 deg larger than the rig file states: 72 arcsec about x.
    let (truth, error, sigma) = value("axis.attitude.x");
    assert!((truth - 72.0).abs() < 1e-6 && error.abs() < 5.0 * sigma, "{truth} {error} {sigma}");
    assert!(sigma < 36.0, "the attitude is observable: {sigma} arcsec");
    // A parameter that the prior dominates is not calibrated for given true values, and not tested.
    let combined = result.cells[0].parameters.iter().find(|one| one.id == "accel.bias.z");
    assert_eq!(combined.unwrap().posterior.as_ref().unwrap().calibrated, None);
}

/// Machines have the model file in different folders.
#[test]
fn shards_of_a_model_file_in_different_folders_are_one_campaign() {
    let folders = [Folder::new(), Folder::new()];
    let terms = "[[term]]\nid = \"gyro.scale\"\nestimate = [\"z\"]\n";
    let parts = [(1, &folders[0]), (2, &folders[1])].map(|(shard, folder)| {
        let options = MonteCarloOptions {
            model: folder.model("paper12", terms),
            shard: Some((shard, 2)),
            ..folder.full(4, "part.parquet")
        };
        folder.run(&options).unwrap();
        folder.path("part.parquet")
    });
    let merged = folders[0].path("merged.parquet");
    let result = rins::merge(&parts, &merged, Overwrite::Refuse).unwrap().result();
    assert_eq!(result.model.as_deref(), Some("model.toml"));
    let options = MonteCarloOptions {
        model: folders[1].model("paper12", terms),
        ..folders[1].full(4, "whole.parquet")
    };
    folders[1].run(&options).unwrap();
    assert!(folders[0].bytes("merged.parquet") == folders[1].bytes("whole.parquet"));
}

#[test]
fn a_model_file_adds_its_parameters_and_leaves_other_errors_as_they_are() {
    let folder = Folder::new();
    let terms = r#"
[[term]]
id = "gyro.scale"
estimate = ["x", "z"]
sigma = { x = "1 ppm" }

[[term]]
id = "encoder_latency"
"#;
    let model = folder.model("paper12", terms);
    let options = MonteCarloOptions { model, ..folder.full(40, "runs.parquet") };
    let result = folder.run(&options).unwrap();
    let ids: Vec<&str> = result.cells[0].parameters.iter().map(|one| one.id.as_str()).collect();
    let first = ["gyro.scale.x", "gyro.scale.z", "gyro.misalignment.xz", "gyro.misalignment.yz"];
    assert!(ids.starts_with(&first) && ids[4].starts_with("encoder_latency."), "{ids:?}");
    // The Earth's rate shows the scale error across the axis to hundreds of ppm only, which a prior of 1 ppm dominates.
    let scale = result.cells[0].parameters[0].posterior.as_ref().unwrap();
    assert_eq!((scale.observability.as_str(), scale.prior_sigma.round()), ("unobservable", 1.0));
    assert!(result.model.as_deref().unwrap().ends_with("model.toml"));
    // The model lacks the attitude of the axis, whose error of 72 arcsec makes the estimates inconsistent.
    assert_eq!(result.cells[0].consistent, Some(false));
}

#[test]
fn inputs_without_a_campaign_are_refused() {
    let folder = Folder::new();
    let none = folder.run(&folder.full(0, "x.parquet")).unwrap_err();
    assert!(none.contains("0 runs"), "{none}");
    let of_file = |base: &str, terms: &str| {
        let model = folder.model(base, terms);
        folder.run(&MonteCarloOptions { model, ..folder.full(2, "x.parquet") }).unwrap_err()
    };
    let unknown = of_file("full", "\n[[term]]\nid = \"gyro.byas\"\n");
    assert!(unknown.contains("model.toml:5") && unknown.contains("gyro.bias"), "{unknown}");
    let nothing = of_file("none", "");
    assert!(nothing.contains("estimates 0 parameters"), "{nothing}");
    let thermal = of_file("full", "\n[[term]]\nid = \"gyro_thermal_lag\"\n");
    assert!(thermal.contains("temperature") && thermal.contains("scenario.toml"), "{thermal}");
    let missing = MonteCarloOptions {
        model: ModelChoice::File(folder.path("none.toml")),
        ..folder.full(2, "x.parquet")
    };
    assert!(folder.run(&missing).unwrap_err().contains("none.toml"));
    for (old, new, words) in [
        (
            "[attitude]\nroll = \"0 deg\"\npitch = \"25 deg\"\nyaw = \"0 deg\"\nsigma = \"0.1 deg\"\n",
            "",
            "state [attitude]",
        ),
        ("table_angle = { noise = \"1 arcsec\" }\n", "", "table_angle or table_rate"),
    ] {
        assert!(SCENARIO.contains(old));
        fs::write(folder.path("scenario.toml"), SCENARIO.replace(old, new)).unwrap();
        let said = folder.run(&folder.full(2, "x.parquet")).unwrap_err();
        assert!(said.contains(words), "{said}");
        assert!(!folder.path("x.parquet").exists() && !folder.path("x.parquet.part").exists());
    }
}

#[test]
fn the_priors_are_those_of_each_scenario_of_a_grid() {
    let folder = Folder::new();
    let grid = "\n[grid]\n\"attitude.sigma\" = [\"0.1 deg\", \"0.01 deg\"]\n";
    fs::write(folder.path("scenario.toml"), format!("{SCENARIO}{grid}")).unwrap();
    let result = folder.run(&folder.full(2, "x.parquet")).unwrap();
    let prior = |cell: usize| {
        let attitude = result.cells[cell].parameters.iter().find(|one| one.id == "axis.attitude.x");
        attitude.unwrap().posterior.as_ref().unwrap().prior_sigma
    };
    assert!((prior(0) - 360.0).abs() < 1e-9 && (prior(1) - 36.0).abs() < 1e-9);
}
