//! Results are written atomically, and no file of the user is lost.

use std::fs;
use std::path::Path;

use rins_io::{IoError, Overwrite, write_file, write_folder};
use tempfile::TempDir;

use crate::support::without;

fn put(path: &Path, overwrite: Overwrite, text: &str) -> Result<(), IoError> {
    write_file(path, overwrite, |file| {
        file.write_all(text.as_bytes()).map_err(|source| IoError::File {
            action: "write",
            path: path.into(),
            source,
        })
    })
}

fn fill(path: &Path, overwrite: Overwrite, names: &[&str]) -> Result<(), IoError> {
    write_folder(path, overwrite, |folder| {
        for name in names {
            put(&folder.join(name), Overwrite::Refuse, name)?;
        }
        Ok(())
    })
}

fn names(folder: &Path) -> Vec<String> {
    let entries = fs::read_dir(folder).unwrap();
    let mut names: Vec<String> =
        entries.map(|entry| entry.unwrap().file_name().into_string().unwrap()).collect();
    names.sort();
    names
}

fn said(result: Result<(), IoError>, folder: &TempDir) -> String {
    without(&result.unwrap_err(), folder.path())
}

fn failure() -> IoError {
    let source = std::io::Error::other("the disk is full");
    IoError::File { action: "write", path: "x".into(), source }
}

#[test]
fn a_file_is_replaced_only_under_force() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("log.csv");
    put(&path, Overwrite::Refuse, "old").unwrap();
    assert_eq!(
        said(put(&path, Overwrite::Refuse, "new"), &folder),
        "log.csv: exists already; choose another name, or --force to replace it"
    );
    assert_eq!(fs::read_to_string(&path).unwrap(), "old");
    put(&path, Overwrite::Force, "new").unwrap();
    assert_eq!(fs::read_to_string(&path).unwrap(), "new");
    assert_eq!(names(folder.path()), ["log.csv"]);
}

#[test]
fn a_failure_leaves_no_trace() {
    let folder = tempfile::tempdir().unwrap();
    let file = folder.path().join("log.csv");
    put(&file, Overwrite::Refuse, "old").unwrap();
    let result = write_file(&file, Overwrite::Force, |file| {
        file.write_all(b"half").map_err(|_| failure())?;
        Err(failure())
    });
    assert_eq!(said(result, &folder), "cannot write x");
    assert_eq!(fs::read_to_string(&file).unwrap(), "old");

    let run = folder.path().join("run");
    let result = write_folder(&run, Overwrite::Refuse, |folder| {
        put(&folder.join("run.csv"), Overwrite::Refuse, "half")?;
        Err(failure())
    });
    assert_eq!(said(result, &folder), "cannot write x");
    assert_eq!(names(folder.path()), ["log.csv"]);
}

#[test]
fn a_folder_appears_with_all_its_files() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    fill(&run, Overwrite::Refuse, &["run.csv", "rig.toml", "truth.json"]).unwrap();
    assert_eq!(names(&run), ["rig.toml", "run.csv", "truth.json"]);
    assert_eq!(names(folder.path()), ["run"]);
    assert_eq!(
        said(fill(&run, Overwrite::Refuse, &["run.csv"]), &folder),
        "run: exists already; choose another name, or --force to replace it"
    );
    fill(&run, Overwrite::Force, &["result.json"]).unwrap();
    assert_eq!(names(&run), ["result.json"]);
    assert_eq!(names(folder.path()), ["run"]);
}

/// Two programs write one folder: the other one creates or removes files while this one works.
#[test]
fn a_folder_that_another_program_writes_is_not_replaced() {
    let overtaken =
        "out: was written by another program in the meantime; choose another name, or try again";
    for overwrite in [Overwrite::Refuse, Overwrite::Force] {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("out");
        let result = write_folder(&path, overwrite, |staging| {
            put(&staging.join("result.json"), Overwrite::Refuse, "ours")?;
            fill(&path, Overwrite::Refuse, &["result.json"])
        });
        assert_eq!(said(result, &folder), overtaken);
        assert_eq!(fs::read_to_string(path.join("result.json")).unwrap(), "result.json");
        assert_eq!(names(folder.path()), ["out"]);
    }
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out");
    fill(&path, Overwrite::Refuse, &["result.json"]).unwrap();
    let result = write_folder(&path, Overwrite::Force, |staging| {
        put(&staging.join("result.json"), Overwrite::Refuse, "ours")?;
        fs::remove_dir_all(&path).unwrap();
        Ok(())
    });
    assert_eq!(said(result, &folder), overtaken);
    assert!(names(folder.path()).is_empty());
}

#[test]
fn an_empty_folder_is_filled() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    fs::create_dir(&run).unwrap();
    fill(&run, Overwrite::Refuse, &["result.json"]).unwrap();
    assert_eq!(names(&run), ["result.json"]);
}

#[test]
fn what_is_not_ours_is_never_replaced() {
    let folder = tempfile::tempdir().unwrap();
    let run = folder.path().join("run");
    fs::create_dir(&run).unwrap();
    // A measured run: its files have names of rins results, but no result is among them.
    for name in ["run.csv", "rig.toml"] {
        fs::write(run.join(name), "measured").unwrap();
    }
    assert_eq!(
        said(fill(&run, Overwrite::Force, &["result.json"]), &folder),
        "run: is not replaced, as it does not hold a result of rins; choose another name"
    );
    fs::write(run.join("result.json"), "{}").unwrap();
    fs::write(run.join("thesis.tex"), "years of work").unwrap();
    assert_eq!(
        said(fill(&run, Overwrite::Force, &["result.json"]), &folder),
        "run: is not replaced, as it also holds \"thesis.tex\"; move that away or choose another \
         name"
    );
    fs::remove_file(run.join("thesis.tex")).unwrap();
    fs::create_dir(run.join("report.html")).unwrap();
    assert_eq!(
        said(fill(&run, Overwrite::Force, &["result.json"]), &folder),
        "run: is not replaced, as it also holds \"report.html\"; move that away or choose another \
         name"
    );
    assert_eq!(names(&run), ["report.html", "result.json", "rig.toml", "run.csv"]);
}

#[test]
fn files_and_folders_do_not_replace_each_other() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("run");
    fs::write(&path, "a file").unwrap();
    assert_eq!(
        said(fill(&path, Overwrite::Force, &["result.json"]), &folder),
        "run: is a file, expected a folder"
    );
    fs::remove_file(&path).unwrap();
    fs::create_dir(&path).unwrap();
    assert_eq!(
        said(put(&path, Overwrite::Force, "text"), &folder),
        "run: is a folder, expected a file"
    );
    let nameless = put(Path::new(".."), Overwrite::Force, "text").unwrap_err();
    assert_eq!(nameless.to_string(), "..: does not end in the name of a file or folder");
}

#[test]
fn a_missing_parent_is_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("no/such/place");
    assert_eq!(said(put(&path, Overwrite::Refuse, "text"), &folder), "cannot write no/such/place");
    assert_eq!(
        said(fill(&path, Overwrite::Refuse, &["run.csv"]), &folder),
        "cannot write no/such/place"
    );
}

#[cfg(unix)]
#[test]
fn results_have_ordinary_permissions() {
    use std::os::unix::fs::PermissionsExt;
    let folder = tempfile::tempdir().unwrap();
    let mode = |path: &Path| fs::metadata(path).unwrap().permissions().mode() & 0o777;
    fs::write(folder.path().join("plain"), "").unwrap();
    fs::create_dir(folder.path().join("plain folder")).unwrap();
    let file = folder.path().join("log.csv");
    put(&file, Overwrite::Refuse, "text").unwrap();
    assert_eq!(mode(&file), mode(&folder.path().join("plain")));
    let run = folder.path().join("run");
    fill(&run, Overwrite::Refuse, &["run.csv"]).unwrap();
    assert_eq!(mode(&run), mode(&folder.path().join("plain folder")));
}

#[cfg(unix)]
#[test]
fn a_link_is_not_followed() {
    let folder = tempfile::tempdir().unwrap();
    let real = folder.path().join("real");
    fill(&real, Overwrite::Refuse, &["result.json"]).unwrap();
    let link = folder.path().join("link");
    std::os::unix::fs::symlink(&real, &link).unwrap();
    assert_eq!(
        said(fill(&link, Overwrite::Force, &["result.json"]), &folder),
        "link: is a symbolic link, expected a folder"
    );
}
