//! Violations in a small test workspace are found, and nothing else is.

use std::fs;
use std::path::{Path, PathBuf};

use tempfile::TempDir;

use super::crates::layer_of;
use super::{findings, tracked_files};

/// A workspace without violations, in a temporary folder.
struct Planted {
    root: TempDir,
    files: Vec<PathBuf>,
}

impl Planted {
    fn new() -> Self {
        let mut planted = Self { root: TempDir::new().unwrap(), files: Vec::new() };
        for name in ["rins-frames", "rins-imu", "rins-io"] {
            planted.write(&format!("crates/{name}/Cargo.toml"), &manifest(name, ""));
            planted.write(&format!("crates/{name}/src/lib.rs"), "//! A crate.\n");
            planted.write(&format!("crates/{name}/README.md"), "```\nlet one = 1;\n```\n");
            planted.write(&format!("crates/{name}/examples/one.rs"), "//! One.\nfn main() {}\n");
        }
        planted
    }

    fn write(&mut self, path: &str, text: &str) {
        let full = self.root.path().join(path);
        fs::create_dir_all(full.parent().unwrap()).unwrap();
        fs::write(full, text).unwrap();
        if !self.files.iter().any(|file| file == Path::new(path)) {
            self.files.push(path.into());
        }
    }

    fn remove(&mut self, path: &str) {
        fs::remove_file(self.root.path().join(path)).unwrap();
        self.files.retain(|file| file != Path::new(path));
    }

    fn found(&self) -> Vec<String> {
        let findings = findings(self.root.path(), &self.files).unwrap();
        findings.iter().map(ToString::to_string).collect()
    }
}

fn manifest(name: &str, dependencies: &str) -> String {
    format!(
        "[package]\nname = \"{name}\"\ndescription = \"d\"\nlicense.workspace = true\n\
         [lints]\nworkspace = true\n{dependencies}"
    )
}

/// The findings if `crates/{name}/Cargo.toml` gets these dependencies, which start at line 7.
fn found_with(name: &str, dependencies: &str) -> Vec<String> {
    let mut planted = Planted::new();
    planted.write(&format!("crates/{name}/Cargo.toml"), &manifest(name, dependencies));
    planted.found()
}

/// The findings if this file is added.
fn found_beside(path: &str, text: &str) -> Vec<String> {
    let mut planted = Planted::new();
    planted.write(path, text);
    planted.found()
}

const NOTHING: [&str; 0] = [];

#[test]
fn workspace_is_tidy() {
    let root = crate::root();
    let files = tracked_files(&root).unwrap();
    assert!(files.iter().any(|file| file == Path::new("xtask/src/tidy.rs")), "{files:?}");
    let found: Vec<_> = findings(&root, &files).unwrap().iter().map(ToString::to_string).collect();
    assert!(found.is_empty(), "\n{}", found.join("\n"));
}

#[test]
fn clean_workspace_has_no_findings() {
    assert_eq!(Planted::new().found(), NOTHING);
}

#[test]
fn long_file_is_found() {
    let text = |lines: usize| format!("//! One idea.\n{}", "\n".repeat(lines - 1));
    assert_eq!(found_beside("crates/rins-io/src/a.rs", &text(400)), NOTHING);
    assert_eq!(
        found_beside("crates/rins-io/src/a.rs", &text(401)),
        ["crates/rins-io/src/a.rs:401: 401 lines, more than 400: two ideas?"]
    );
}

#[test]
fn file_without_first_line_is_found() {
    assert_eq!(
        found_beside("xtask/src/a.rs", "fn main() {}\n"),
        ["xtask/src/a.rs:1: no `//!` line that says what the file is for"]
    );
}

#[test]
fn name_that_says_nothing_is_found() {
    let expected = ["crates/rins-io/src/utils.rs:1: `utils` names nothing: name the idea"];
    assert_eq!(found_beside("crates/rins-io/src/utils.rs", "//! Things.\n"), expected);
}

#[test]
fn tabs_are_found_except_in_logs() {
    let expected = ["docs/a.md:2: a tab: indent with spaces"];
    assert_eq!(found_beside("docs/a.md", "one\n\ttwo\n"), expected);
    assert_eq!(found_beside("tests/data/a.csv", "1\t2\n"), NOTHING);
}

#[test]
fn postponed_work_needs_its_issue() {
    let mark = super::text::POSTPONED[0];
    for kept in [format!("{mark}(#12): later"), format!("{mark}S"), format!("MY_{mark}")] {
        assert_eq!(found_beside("a.md", &kept), NOTHING, "{kept}");
    }
    for breach in [mark.to_owned(), format!("{mark}: later"), format!("{mark}(#): x")] {
        let expected = [format!("a.md:1: `{mark}` without its issue, as in `{mark}(#12)`")];
        assert_eq!(found_beside("a.md", &breach), expected, "{breach}");
    }
}

#[test]
fn every_forbidden_word_is_found() {
    for (word, why) in super::text::FORBIDDEN {
        let expected = [format!("a.toml:2: `{}`: {why}", word.trim())];
        assert_eq!(found_beside("a.toml", &format!("# one\n# {word}x\n")), expected);
    }
    assert_eq!(found_beside("a.md", "https://example.org/home/page"), NOTHING);
}

#[test]
fn banner_is_found() {
    let rule = "-".repeat(10);
    let expected = ["a.rs:3: a banner: a file that needs one is two files"];
    assert_eq!(found_beside("a.rs", &format!("//! One.\n\n// {rule} Two {rule}\n")), expected);
}

#[test]
fn unknown_citation_is_found() {
    let cite = |key| format!("//! As ‹{key}› says.\n");
    let mut planted = Planted::new();
    planted.write("docs/src/references.md", "# References\n\n## nie2019\n");
    planted.write("a.rs", &cite("nie2019"));
    planted.write("b.rs", &cite("nie2020"));
    let expected = "b.rs:1: ‹nie2020› is not in docs/src/references.md";
    assert_eq!(planted.found(), [expected]);
}

#[test]
fn binary_and_vendored_files_are_left_alone() {
    let mut planted = Planted::new();
    planted.write("docs/katex/a.css", "\t");
    planted.files.push("a.bin".into());
    fs::write(planted.root.path().join("a.bin"), [0xff, b'\t']).unwrap();
    assert_eq!(planted.found(), NOTHING);
}

/// The message if `rins-imu` uses a crate of a higher layer.
fn upward(name: &str) -> String {
    let layer = layer_of(name).unwrap();
    assert!(layer > 1, "{name} is not above rins-imu");
    format!("crates/rins-imu/Cargo.toml:8: rins-imu (layer 1) uses {name} (layer {layer})")
}

#[test]
fn dependency_on_the_same_layer_or_above_is_found() {
    let inherited = |table: &str, name: &str| format!("[{table}]\n{name}.workspace = true\n");
    assert_eq!(found_with("rins-io", &inherited("dependencies", "rins-imu")), NOTHING);
    assert_eq!(found_with("rins-imu", &inherited("dependencies", "rins-io")), [upward("rins-io")]);
    let sideways = "crates/rins-imu/Cargo.toml:8: rins-imu (layer 1) uses rins-motion (layer 1)";
    assert_eq!(found_with("rins-imu", &inherited("dependencies", "rins-motion")), [sideways]);
    assert_eq!(found_with("rins-imu", &inherited("build-dependencies", "rins-motion")), [sideways]);
}

#[test]
fn dev_dependency_may_go_sideways_but_not_up() {
    let inherited = |name: &str| format!("[dev-dependencies]\n{name}.workspace = true\n");
    assert_eq!(found_with("rins-imu", &inherited("rins-motion")), NOTHING);
    assert_eq!(
        found_with("rins-imu", &inherited("rins-calibration")),
        [upward("rins-calibration")]
    );
}

#[test]
fn renamed_upward_dependency_is_found() {
    let renamed = "[dependencies]\nharmless = { package = \"rins-cli\", path = \"../rins-cli\" }\n";
    assert_eq!(found_with("rins-imu", renamed), [upward("rins-cli")]);
}

#[test]
fn testing_crate_is_for_tests_only() {
    let inherited = |table: &str| format!("[{table}]\nrins-testing.workspace = true\n");
    assert_eq!(found_with("rins-frames", &inherited("dev-dependencies")), NOTHING);
    assert_eq!(
        found_with("rins-frames", &inherited("dependencies")),
        ["crates/rins-frames/Cargo.toml:8: rins-testing is for tests: make it a dev-dependency"]
    );
}

#[test]
fn serde_is_for_the_crates_that_read_and_write() {
    let serde = "[dependencies]\nserde = { version = \"1\", features = [\"derive\"] }\n";
    assert_eq!(found_with("rins-io", serde), NOTHING);
    assert_eq!(
        found_with("rins-imu", serde),
        [
            "crates/rins-imu/Cargo.toml:8: serde is for rins-io and rins-report and rins-estimation and rins and rins-trials only"
        ]
    );
    assert_eq!(found_with("rins-imu", &serde.replace("dep", "dev-dep")), NOTHING);
}

#[test]
fn crate_of_no_layer_is_found() {
    let mut planted = Planted::new();
    for file in ["Cargo.toml", "README.md", "examples/one.rs"] {
        let path = planted.root.path().join("crates/rins-io").join(file);
        let text = fs::read_to_string(path).unwrap().replace("rins-io", "rins-new");
        planted.write(&format!("crates/rins-new/{file}"), &text);
    }
    assert_eq!(
        planted.found(),
        ["crates/rins-new/Cargo.toml:1: rins-new stands in no layer of xtask/src/tidy/crates.rs"]
    );
}

#[test]
fn what_a_published_crate_lacks_is_found() {
    let mut planted = Planted::new();
    planted.write("crates/rins-io/Cargo.toml", "[package]\nname = \"rins-other\"\n");
    planted.write("crates/rins-io/README.md", "# rins-io\n");
    planted.remove("crates/rins-io/examples/one.rs");
    planted.remove("crates/rins-imu/README.md");
    assert_eq!(
        planted.found(),
        [
            "crates/rins-imu/README.md:1: no README",
            "crates/rins-io/Cargo.toml:1: rins-other stands in no layer of xtask/src/tidy/crates.rs",
            "crates/rins-io/Cargo.toml:1: rins-other lies in crates/rins-io",
            "crates/rins-io/Cargo.toml:1: no `[lints] workspace = true`",
            "crates/rins-io/Cargo.toml:1: no `description`",
            "crates/rins-io/Cargo.toml:1: no `license`",
            "crates/rins-io/README.md:1: shows no example",
            "crates/rins-io/examples:1: no example that runs",
        ]
    );
}

/// The findings if a crate that uses the catalogue has these files, with a catalogue of one term with one setting.
fn found_beside_catalogue(name: &str, files: &[(&str, &str)]) -> Vec<String> {
    let mut planted = Planted::new();
    let uses = "[dependencies]\nrins-terms.workspace = true\n";
    for (name, dependencies) in [("rins-terms", ""), (name, uses)] {
        planted.write(&format!("crates/{name}/Cargo.toml"), &manifest(name, dependencies));
        planted.write(&format!("crates/{name}/src/lib.rs"), "//! A crate.\n");
        planted.write(&format!("crates/{name}/README.md"), "```\nlet one = 1;\n```\n");
        planted.write(&format!("crates/{name}/examples/one.rs"), "//! One.\nfn main() {}\n");
    }
    let term = "Term { id: \"gyro_lag\", also: &[\"readout_lag\"], settings: &[ORDER] }";
    let setting = "Setting { name: \"order\", meaning: \"turns\" }";
    let catalogue =
        format!("//! Terms.\nconst ORDER: Setting = {setting};\npub static LAG: Term = {term};\n");
    planted.write("crates/rins-terms/src/catalogue.rs", &catalogue);
    for (file, text) in files {
        planted.write(&format!("crates/{name}/src/{file}"), &format!("//! A file.\n{text}\n"));
    }
    planted.found()
}

#[test]
fn term_told_by_its_id_is_found() {
    let found = |text: &str| found_beside_catalogue("rins-estimation", &[("a.rs", text)]);
    let breach = |word: &str| {
        format!(
            "crates/rins-estimation/src/a.rs:2: `{word}` has a term's id: use its constant in \
             `rins_terms::catalogue`"
        )
    };
    let id = "gyro_lag";
    assert_eq!(found("fn f(id: &str) -> bool { id == \"gyro_lag\" }"), [breach(id)]);
    assert_eq!(found("fn f(id: &str) -> bool { matches!(id, \"gyro_lag\") }"), [breach(id)]);
    assert_eq!(found("const IDS: [&str; 2] = [\"x\", \"gyro_lag\"];"), [breach(id)]);
    assert_eq!(found("const ID: &str = \"readout_lag\";"), [breach("readout_lag")]);
    assert_eq!(found("const ID: &str = \"gyro_lag.delay\";"), [breach("gyro_lag.delay")]);
    assert_eq!(found("const ID: &str = \"gyro_lag. It is late\";"), NOTHING);
    assert_eq!(found("/// gyro_lag\nconst WORDS: &str = \"the gyro_lag\";"), NOTHING);
}

#[test]
fn setting_told_by_its_name_is_found() {
    let found = |text: &str| found_beside_catalogue("rins-estimation", &[("a.rs", text)]);
    let expected =
        "crates/rins-estimation/src/a.rs:2: `order` is a setting's name: use its `SettingKind`";
    assert_eq!(found("fn f(s: &str) { match s { \"order\" => {} _ => {} } }"), [expected]);
    assert_eq!(found("fn f() { dbg!([\"order\"]); }"), [expected]);
    // A key of a result is written, not read; and a definition outside the catalogue is allowed.
    assert_eq!(found("fn f() { json!({\"order\": 1}); }"), NOTHING);
    assert_eq!(found("const S: Setting = Setting { name: \"order\", meaning: \"\" };"), NOTHING);
    assert_eq!(found("const T: Term = Term { id: \"gyro_lag\", also: &[] };"), NOTHING);
}

#[test]
fn tests_and_readers_of_files_may_name_settings() {
    let found = |name: &str, text: &str| found_beside_catalogue(name, &[("a.rs", text)]);
    let (order, id) = ("const KEY: &str = \"order\";", "const ID: &str = \"gyro_lag\";");
    assert_eq!(found("rins-estimation", order).len(), 1);
    assert_eq!(found("rins-io", order), NOTHING);
    assert_eq!(found("rins-io", id).len(), 1);
    let within = format!("#[cfg(test)]\nmod tests {{ {order} {id} }}");
    assert_eq!(found("rins-estimation", &within), NOTHING);
    let parent = ("a.rs", "#[cfg(test)]\nmod tests;");
    let apart = [parent, ("a/tests.rs", order), ("a/tests/more.rs", id)];
    assert_eq!(found_beside_catalogue("rins-estimation", &apart), NOTHING);
    assert_eq!(found_beside_catalogue("rins-estimation", &apart[1..]).len(), 2);
}
