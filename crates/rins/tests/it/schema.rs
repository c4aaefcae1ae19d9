//! The schemas in the repository are those of the result structs.

use std::fs;
use std::path::Path;

#[test]
fn schemas_in_the_book_are_those_of_the_results() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../docs/schema");
    let mut stale = Vec::new();
    for (command, schema) in rins::schemas() {
        let expected = serde_json::to_string_pretty(&schema).unwrap() + "\n";
        let found = fs::read_to_string(folder.join(format!("{command}.json"))).unwrap_or_default();
        if found != expected {
            stale.push(command);
        }
    }
    let files = fs::read_dir(&folder).map_or(0, Iterator::count);
    assert!(
        stale.is_empty() && files == rins::schemas().len(),
        "stale: {stale:?}, {files} files; run `cargo run -p rins --example schemas -- docs/schema`"
    );
}

#[test]
fn every_key_of_every_result_is_documented() {
    fn undocumented(path: &str, schema: &serde_json::Value, found: &mut Vec<String>) {
        if let Some(properties) = schema["properties"].as_object() {
            for (key, property) in properties {
                let path = format!("{path}.{key}");
                if property["description"].as_str().is_none_or(str::is_empty) {
                    found.push(path);
                }
            }
        }
        for (name, definition) in schema["$defs"].as_object().into_iter().flatten() {
            undocumented(name, definition, found);
        }
    }
    let mut found = Vec::new();
    for (command, schema) in rins::schemas() {
        undocumented(command, &schema, &mut found);
    }
    assert!(found.is_empty(), "{found:?}");
}
