//! The program and the inputs of a calibration or a model: `[provenance]`.

use std::fmt::Write as _;

use crate::document::quoted;
use crate::error::IoError;
use crate::input_file::InputFile;
use crate::rig::named;
use crate::section::Section;
use crate::shown::shown;

/// The program and the inputs of a calibration or a model, as far as they are known.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Provenance {
    /// The version of rins.
    pub version: Option<String>,
    /// The files that were read.
    pub inputs: Vec<InputFile>,
}

/// The form of `sha256`.
const DIGESTS: &str = "a list of SHA-256 digests of 64 hexadecimal digits";

/// Reads `[provenance]`, which may be left out.
pub(crate) fn read(root: &Section<'_>) -> Result<Provenance, IoError> {
    let Some(section) = root.section("provenance", &["version", "inputs", "sha256"])? else {
        return Ok(Provenance::default());
    };
    let version = named(&section, "version", "a version of rins")?;
    let paths = section.list_of_texts("inputs", "a list of paths")?;
    let digests = section.list_of_texts("sha256", DIGESTS)?;
    let is_digest = |text: &String| text.len() == 64 && text.bytes().all(|b| b.is_ascii_hexdigit());
    if !digests.iter().all(is_digest) {
        return Err(section.not_allowed("sha256", DIGESTS));
    }
    if digests.len() != paths.len() {
        let reason = format!("has {} digests for {} inputs", digests.len(), paths.len());
        return Err(section.conflict("sha256", reason));
    }
    let inputs = paths.into_iter().zip(digests);
    let inputs = inputs.map(|(path, sha256)| InputFile { path: path.into(), sha256 }).collect();
    Ok(Provenance { version, inputs })
}

/// The section, as it is written; nothing if nothing is known.
pub(crate) fn written(provenance: &Provenance) -> String {
    let Provenance { version, inputs } = provenance;
    let mut text = String::new();
    if provenance == &Provenance::default() {
        return text;
    }
    text.push_str("\n# The program and the files that it has read.\n[provenance]\n");
    // Writing to a string cannot fail.
    if let Some(version) = version {
        let _ = writeln!(text, "version = {}", quoted(version));
    }
    let list = |of: fn(&InputFile) -> String| {
        inputs.iter().map(|input| quoted(&of(input))).collect::<Vec<_>>().join(", ")
    };
    let _ = writeln!(text, "inputs = [{}]", list(|input| shown(&input.path)));
    let _ = writeln!(text, "sha256 = [{}]", list(|input| input.sha256.clone()));
    text
}
