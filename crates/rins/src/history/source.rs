//! The calibrations of a history: files, folders of them, and logs that are calibrated one by one.

use std::path::{Path, PathBuf};

use anyhow::Context;
use rins_io::{Calibration, InputFile, TomlContent, shown};

use crate::basis::BasisResult;
use crate::calibrate::single_calibration;
use crate::log::{Log, setup};
use crate::progress::Progress;

/// The name of a calibration file in a folder of results.
const CALIBRATION: &str = "calibration.toml";

/// The name of a rig file in the folder of a run.
const RIG: &str = "rig.toml";

/// One run of a history.
#[derive(Clone, Debug)]
pub(super) struct Source {
    /// The path of its file.
    pub(super) name: String,
    pub(super) calibration: Calibration,
    pub(super) basis: BasisResult,
}

/// The calibrations at these paths: a calibration file, a rig file whose log is calibrated by itself, or a folder with one of either in it
/// or in each of its folders.
pub(super) fn sources(paths: &[PathBuf], progress: &Progress) -> anyhow::Result<Vec<Source>> {
    let mut files = Vec::new();
    for path in paths {
        if path.is_dir() {
            let found = in_folder(path)?;
            anyhow::ensure!(
                !found.is_empty(),
                "{}: there is neither {CALIBRATION} nor {RIG} in it or in its folders",
                shown(path)
            );
            files.extend(found);
        } else {
            files.push(path.clone());
        }
    }
    for (place, file) in files.iter().enumerate() {
        anyhow::ensure!(!files[..place].contains(file), "{} is given twice", shown(file));
    }
    files.iter().map(|file| source(file, progress)).collect()
}

/// The calibration or rig file of a folder, or of each folder in it.
fn in_folder(folder: &Path) -> anyhow::Result<Vec<PathBuf>> {
    let own = |folder: &Path| {
        [CALIBRATION, RIG].map(|name| folder.join(name)).into_iter().find(|file| file.is_file())
    };
    if let Some(file) = own(folder) {
        return Ok(vec![file]);
    }
    let context = || format!("cannot read {}", shown(folder));
    let mut folders = Vec::new();
    for entry in std::fs::read_dir(folder).with_context(context)? {
        folders.push(entry.with_context(context)?.path());
    }
    folders.sort();
    Ok(folders.iter().filter_map(|folder| own(folder)).collect())
}

fn source(file: &Path, progress: &Progress) -> anyhow::Result<Source> {
    let (calibration, basis) = match TomlContent::of(file)? {
        TomlContent::Calibration => {
            let calibration = Calibration::read(file)?;
            let basis = BasisResult::of_calibration(InputFile::of(file)?, &calibration.measured);
            (calibration, basis)
        }
        TomlContent::Rig => {
            let log = Log::open(file)?;
            let basis = BasisResult::of_log(&log).assuming(setup(&log.loaded).1);
            (single_calibration(log, progress)?, basis)
        }
        TomlContent::Other => anyhow::bail!(
            "{}: neither a calibration file (it has no key `schema`) nor a rig file (no [log])",
            shown(file)
        ),
    };
    Ok(Source { name: shown(file), calibration, basis })
}
