//! The path of a log in a rig file: relative to the rig file.

use std::path::{Component, Path, PathBuf};

use super::page::{Page, text};

pub(super) fn path(page: &mut Page, log: &Path, folder: &Path) {
    match between(folder, log).to_str() {
        Some(path) => page.known("path", &text(path)),
        None => page.leave("path", "\"\"", "its name is not UTF-8 text; rename the log"),
    }
}

/// The path from `folder` to the file `log`.
///
/// Symbolic links are resolved first, because `..` has another meaning after one; the file's own name is
/// kept. If the folder does not exist yet, the path is absolute.
pub(super) fn between(folder: &Path, log: &Path) -> PathBuf {
    let current = |path: &Path| {
        let here = path.as_os_str().is_empty();
        if here { PathBuf::from(".") } else { path.to_path_buf() }
    };
    let name = log.file_name().unwrap_or_default();
    let holder = log.parent().map(current).unwrap_or_default();
    let Ok(to) = holder.canonicalize() else { return log.to_path_buf() };
    let Ok(from) = current(folder).canonicalize() else { return to.join(name) };
    let shared = from.components().zip(to.components()).take_while(|(a, b)| a == b).count();
    let is_root = |component: Option<Component<'_>>| {
        component.is_none_or(|c| matches!(c, Component::Prefix(_)))
    };
    // If the folders have only the root in common, an absolute path is clearer.
    if shared < 2 && is_root(from.components().nth(shared).filter(|_| shared == 0)) {
        return to.join(name);
    }
    let up = from.components().skip(shared).map(|_| Component::ParentDir);
    up.chain(to.components().skip(shared)).collect::<PathBuf>().join(name)
}

#[cfg(test)]
mod tests {
    use super::between;
    use std::path::Path;

    #[test]
    fn the_path_leads_from_the_rig_to_the_log() {
        let root = tempfile::tempdir().unwrap();
        let root = root.path().canonicalize().unwrap();
        for folder in ["a", "a/b", "c"] {
            std::fs::create_dir_all(root.join(folder)).unwrap();
        }
        let log = root.join("a/run.csv");
        std::fs::write(&log, "x").unwrap();
        for (folder, path) in
            [("a", "run.csv"), ("", "a/run.csv"), ("a/b", "../run.csv"), ("c", "../a/run.csv")]
        {
            let folder = root.join(folder);
            let found = between(&folder, &log);
            assert_eq!(found, Path::new(path));
            assert!(folder.join(found).is_file());
        }
        assert_eq!(between(&root.join("not there"), &log), log);
        assert_eq!(between(Path::new("/"), &log), log);
    }
}
