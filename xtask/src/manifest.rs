//! The content of a `Cargo.toml`, with line numbers.

use std::fs;
use std::path::{Path, PathBuf};

use toml::de::{DeTable, DeValue};

use crate::Result;

/// The parts of a manifest that the rules of the workspace refer to.
#[derive(Debug, Default)]
pub(crate) struct Manifest {
    /// The package's name.
    pub(crate) name: String,
    /// Whether it may be published.
    pub(crate) published: bool,
    /// The keys of `[package]`.
    pub(crate) keys: Vec<String>,
    /// Whether it inherits the lints of the workspace.
    pub(crate) inherits_lints: bool,
    /// Its dependencies.
    pub(crate) dependencies: Vec<Dependency>,
}

/// One line of a table of dependencies.
#[derive(Debug)]
pub(crate) struct Dependency {
    /// The name of the package, even if it is renamed.
    pub(crate) package: String,
    /// Whether it is a dev-dependency, for tests, examples and benches only.
    pub(crate) dev: bool,
    /// The line in the file.
    pub(crate) line: usize,
}

impl Manifest {
    /// The manifest at `path`.
    pub(crate) fn read(path: &Path) -> Result<Self> {
        let text = fs::read_to_string(path).map_err(|e| format!("{}: {e}", path.display()))?;
        Self::parse(&text).map_err(|e| format!("{}: {e}", path.display()).into())
    }

    fn parse(text: &str) -> Result<Self> {
        let parsed = DeTable::parse(text)?;
        let table = parsed.get_ref();
        let mut manifest = Self { published: true, ..Self::default() };
        if let Some(package) = table_in(table, "package") {
            manifest.name = text_in(package, "name").unwrap_or_default();
            manifest.published =
                !matches!(value_in(package, "publish"), Some(DeValue::Boolean(false)));
            manifest.keys = package.keys().map(|key| key.get_ref().to_string()).collect();
        }
        manifest.inherits_lints = table_in(table, "lints").is_some_and(|lints| {
            matches!(value_in(lints, "workspace"), Some(DeValue::Boolean(true)))
        });
        manifest.collect(text, table);
        for (_, target) in table_in(table, "target").into_iter().flatten() {
            if let DeValue::Table(target) = target.get_ref() {
                manifest.collect(text, target);
            }
        }
        Ok(manifest)
    }

    fn collect(&mut self, text: &str, table: &DeTable<'_>) {
        for (kind, dev) in
            [("dependencies", false), ("build-dependencies", false), ("dev-dependencies", true)]
        {
            for (key, value) in table_in(table, kind).into_iter().flatten() {
                let renamed = match value.get_ref() {
                    DeValue::Table(table) => text_in(table, "package"),
                    _ => None,
                };
                let package = renamed.unwrap_or_else(|| key.get_ref().to_string());
                let line = 1 + text[..key.span().start].matches('\n').count();
                self.dependencies.push(Dependency { package, dev, line });
            }
        }
    }
}

/// The folders of the crates, in order of name.
pub(crate) fn crate_folders(root: &Path) -> Result<Vec<PathBuf>> {
    let mut folders = Vec::new();
    for entry in fs::read_dir(root.join("crates"))? {
        let folder = entry?.path();
        if folder.join("Cargo.toml").is_file() {
            folders.push(folder);
        }
    }
    folders.sort();
    Ok(folders)
}

/// The names of the examples of the crate in `folder`, sorted.
pub(crate) fn examples(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder.join("examples")).into_iter().flatten().flatten();
    let sources = entries
        .map(|entry| entry.path())
        .filter(|path| path.extension().is_some_and(|e| e == "rs"));
    let mut names: Vec<String> =
        sources.filter_map(|path| Some(path.file_stem()?.to_str()?.to_owned())).collect();
    names.sort();
    names
}

fn value_in<'t, 'i>(table: &'t DeTable<'i>, key: &str) -> Option<&'t DeValue<'i>> {
    table.get(key).map(toml::Spanned::get_ref)
}

fn table_in<'t, 'i>(table: &'t DeTable<'i>, key: &str) -> Option<&'t DeTable<'i>> {
    match value_in(table, key) {
        Some(DeValue::Table(table)) => Some(table),
        _ => None,
    }
}

fn text_in(table: &DeTable<'_>, key: &str) -> Option<String> {
    match value_in(table, key) {
        Some(DeValue::String(text)) => Some(text.to_string()),
        _ => None,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_way_to_write_a_dependency_is_seen() {
        let text = r#"
[package]
name = "one"
publish = false

[dependencies]
plain = "1"
inherited.workspace = true
alias = { package = "renamed", version = "1" }

[dependencies.spelt-out]
workspace = true

[target.'cfg(unix)'.build-dependencies]
conditional = "1"

[dev-dependencies]
tested = "1"
"#;
        let manifest = Manifest::parse(text).unwrap();
        assert_eq!((manifest.name.as_str(), manifest.published), ("one", false));
        let mut seen: Vec<_> =
            manifest.dependencies.iter().map(|d| (d.line, d.package.as_str(), d.dev)).collect();
        seen.sort_unstable();
        let expected = [
            (7, "plain", false),
            (8, "inherited", false),
            (9, "renamed", false),
            (11, "spelt-out", false),
            (15, "conditional", false),
            (18, "tested", true),
        ];
        assert_eq!(seen, expected);
    }
}
