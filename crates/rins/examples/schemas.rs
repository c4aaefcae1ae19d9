//! Writes the JSON schema of every command's result into a folder: `docs/schema` of this repository, or a folder of your choice.

use std::fs;
use std::path::PathBuf;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let folder = PathBuf::from(std::env::args().nth(1).ok_or("usage: schemas FOLDER")?);
    fs::create_dir_all(&folder)?;
    for (command, schema) in rins::schemas() {
        let text = serde_json::to_string_pretty(&schema)? + "\n";
        fs::write(folder.join(format!("{command}.json")), text)?;
    }
    Ok(())
}
