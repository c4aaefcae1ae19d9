//! Rules about crates: their layers, their dependencies, and their required files.

use std::fs;
use std::path::{Path, PathBuf};

use super::Finding;
use crate::Result;
use crate::manifest::{Dependency, Manifest, crate_folders, examples};

/// The crates in layers, the lowest first: a crate uses only crates of lower layers.
const LAYERS: &[&[&str]] = &[
    &["rins-frames", "rins-ekf", "rins-bayes", "rins-lanes", "rins-report", "rins-blind"],
    &["rins-imu", "rins-motion", "rins-history"],
    &["rins-terms", "rins-inspection"],
    &["rins-simulation", "rins-calibration"],
    &["rins-estimation", "rins-campaign"],
    &["rins-diagnosis", "rins-design"],
    &["rins-io"],
    &["rins", "rins-reproduction", "rins-trials"],
    &["rins-cli"],
    &["rins-python"],
];

/// The crate for tests only: a dev-dependency of any other, and in no layer.
const TESTING: &str = "rins-testing";

/// Dependencies that only some crates may use, outside their tests.
const CONFINED: &[(&str, &[&str])] = &[
    ("anyhow", &["rins", "rins-cli"]),
    ("clap", &["rins-cli"]),
    ("schemars", &["rins"]),
    ("serde", &["rins-io", "rins-report", "rins-estimation", "rins", "rins-trials"]),
    ("serde_json", &["rins-io", "rins-report", "rins", "rins-cli", "rins-trials"]),
    ("toml", &["rins-io", "rins"]),
];

/// The keys of `[package]` that a published crate needs.
const REQUIRED_KEYS: &[&str] = &["description", "license"];

/// All violations in the crates of the workspace at `root`.
pub(super) fn findings(root: &Path) -> Result<Vec<Finding>> {
    let mut findings = Vec::new();
    for folder in crate_folders(root)? {
        let manifest = Manifest::read(&folder.join("Cargo.toml"))?;
        let shown = folder.strip_prefix(root).unwrap_or(&folder).to_path_buf();
        let breaches = dependencies(&manifest).into_iter().chain(package(&manifest, &shown));
        findings.extend(breaches.map(|(line, what)| Finding {
            path: shown.join("Cargo.toml"),
            line,
            what,
        }));
        if manifest.published {
            findings.extend(files(root, &shown));
        }
    }
    Ok(findings)
}

pub(super) fn layer_of(name: &str) -> Option<usize> {
    LAYERS.iter().position(|layer| layer.contains(&name))
}

/// The violations in the crate's dependencies.
fn dependencies(manifest: &Manifest) -> Vec<(usize, String)> {
    let name = manifest.name.as_str();
    let mut breaches = Vec::new();
    let layer = layer_of(name);
    if layer.is_none() && name != TESTING {
        breaches.push((1, format!("{name} stands in no layer of xtask/src/tidy/crates.rs")));
    }
    for dependency in &manifest.dependencies {
        let what = match layer {
            Some(height) => upward(name, height, dependency),
            None => None,
        };
        let what = what.or_else(|| confined(name, dependency));
        breaches.extend(what.map(|what| (dependency.line, what)));
    }
    breaches
}

/// The violation by a dependency of a crate at `height` on the same or a higher layer, if it is one.
fn upward(name: &str, height: usize, dependency: &Dependency) -> Option<String> {
    let Dependency { package, dev, .. } = dependency;
    if package == TESTING {
        return (!dev).then(|| format!("{TESTING} is for tests: make it a dev-dependency"));
    }
    let used = layer_of(package)?;
    let allowed = if *dev { used <= height } else { used < height };
    (!allowed).then(|| format!("{name} (layer {height}) uses {package} (layer {used})"))
}

fn confined(name: &str, dependency: &Dependency) -> Option<String> {
    let (package, users) = CONFINED.iter().find(|(package, _)| *package == dependency.package)?;
    let allowed = dependency.dev || users.contains(&name);
    (!allowed).then(|| format!("{package} is for {} only", users.join(" and ")))
}

/// The violations in the manifest itself.
fn package(manifest: &Manifest, folder: &Path) -> Vec<(usize, String)> {
    let mut breaches = Vec::new();
    if !folder.ends_with(&manifest.name) {
        breaches.push((1, format!("{} lies in {}", manifest.name, folder.display())));
    }
    if !manifest.inherits_lints {
        breaches.push((1, "no `[lints] workspace = true`".into()));
    }
    for key in REQUIRED_KEYS.iter().filter(|key| !manifest.keys.iter().any(|had| had == *key)) {
        breaches.push((1, format!("no `{key}`")));
    }
    breaches
}

/// The violations in the files of a published crate: it needs a README with an example, and an example that runs.
fn files(root: &Path, folder: &Path) -> Vec<Finding> {
    let finding = |path: PathBuf, what: &str| Finding { path, line: 1, what: what.into() };
    let mut findings = Vec::new();
    let readme = folder.join("README.md");
    match fs::read_to_string(root.join(&readme)) {
        Err(_) => findings.push(finding(readme, "no README")),
        Ok(text) if !text.contains("```") => findings.push(finding(readme, "shows no example")),
        Ok(_) => {}
    }
    let is_library = root.join(folder).join("src/lib.rs").is_file();
    if is_library && examples(&root.join(folder)).is_empty() {
        findings.push(finding(folder.join("examples"), "no example that runs"));
    }
    findings
}
