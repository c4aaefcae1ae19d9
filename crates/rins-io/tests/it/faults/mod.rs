//! Every reader with every fault: the results are in `tests/data/faults.txt`, and none panics.

mod readers;
mod spoils;

use std::fmt::Write as _;
use std::fs;
use std::panic::{AssertUnwindSafe, catch_unwind};
use std::path::Path;

use rins_io::{LogFile, Overwrite, convert, draft_rig, peek};

use crate::support::folder;
use readers::{Reader, Writing, readers};
use spoils::spoilt;

/// The number of panics, and the other results.
#[derive(Default)]
struct Met {
    panics: Vec<String>,
    told: String,
    cases: usize,
}

impl Met {
    /// Calls a reader with `bytes` in place of its valid file, and all other functions that read such a file.
    fn meet(&mut self, reader: &Reader, fault: &str, bytes: &[u8]) -> Option<String> {
        self.meet_then(reader, fault, bytes, |_| {})
    }

    /// The same, followed by `then` with the folder if the file was read.
    fn meet_then(
        &mut self,
        reader: &Reader,
        fault: &str,
        bytes: &[u8],
        then: impl Fn(&Path),
    ) -> Option<String> {
        let mut files: Vec<(&str, &[u8])> =
            reader.others.iter().map(|(name, bytes)| (*name, bytes.as_slice())).collect();
        files.push((reader.file, bytes));
        let folder = folder(&files);
        let path = |name: &str| folder.path().join(name);
        let caught = catch_unwind(AssertUnwindSafe(|| {
            let read = reader.run(folder.path());
            // The functions that are called before a rig file exists.
            let _ = peek(&path(reader.file));
            let _ = draft_rig(&path(reader.file), folder.path());
            if read.is_ok() {
                then(folder.path());
            }
            match read {
                Ok(0) => "read".to_owned(),
                Ok(samples) => format!("{samples} samples"),
                Err(error) => chain(&error).replace(&format!("{}/", folder.path().display()), ""),
            }
        }));
        self.cases += 1;
        caught.map_err(|_| self.panics.push(format!("{}: {fault}", reader.name))).ok()
    }
}

/// An error with its sources, each line shortened to a readable length.
fn chain(error: &dyn std::error::Error) -> String {
    let mut text = error.to_string();
    let mut source = error.source();
    while let Some(error) = source {
        let _ = write!(text, ": {error}");
        source = error.source();
    }
    text
}

/// Converts a log that was read to every format.
fn converted(folder: &Path) {
    let rig = folder.join("rig.toml");
    for format in LogFile::ALL.into_iter().filter(|_| rig.exists()) {
        let _ =
            convert(&rig, &folder.join(format!("new.{}", format.name())), format, Overwrite::Force);
    }
}

#[test]
fn every_reader_meets_every_fault_as_expected() {
    let mut met = Met::default();
    for reader in readers() {
        let good = met.meet(&reader, "none", &reader.good).unwrap_or_default();
        let _ = writeln!(met.told, "{}\n  none: {good}", reader.name);
        for (fault, bytes) in spoilt(&reader) {
            let said = met.meet_then(&reader, fault, &bytes, converted);
            let said = said.unwrap_or_else(|| "PANIC".into());
            assert!(said.len() < 600 && !said.contains('\n'), "{}: {fault}: {said}", reader.name);
            let _ = writeln!(met.told, "  {fault}: {said}");
        }
    }
    assert!(met.panics.is_empty(), "{:?}", met.panics);
    let expected = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/data/faults.txt");
    let expected = fs::read_to_string(expected).unwrap_or_default();
    let expected: String = expected
        .lines()
        .filter(|line| !line.starts_with('#'))
        .fold(String::new(), |text, line| text + line + "\n");
    for (said, expected) in met.told.lines().zip(expected.lines()) {
        assert_eq!(said, expected);
    }
    assert_eq!(met.told, expected, "all of what is said:\n{}", met.told);
    println!("{} cases", met.cases);
}

/// Each of these is shorter than the file: no remaining length causes a panic, and data that are read are
/// those of the file.
#[test]
fn files_cut_at_any_length_are_read_or_refused() {
    let mut met = Met::default();
    for reader in readers() {
        let total = reader.good.len();
        // Near all powers of two and line ends, and at regular steps.
        let step = (total / 60).max(1);
        let ends = (0..total).filter(|place| reader.good[*place] == b'\n').step_by(4);
        let powers = (0..usize::BITS).map(|bit| 1_usize << bit).take_while(|power| *power < total);
        let mut lengths: Vec<usize> = (0..total).step_by(step).chain(ends).chain(powers).collect();
        let near =
            lengths.clone().into_iter().flat_map(|length| [length + 1, length.saturating_sub(1)]);
        lengths.extend(near.collect::<Vec<_>>());
        lengths.retain(|length| *length < total);
        lengths.sort_unstable();
        lengths.dedup();
        for length in lengths {
            let said = met.meet(&reader, "cut", &reader.good[..length]);
            let said = said.unwrap_or_else(|| panic!("{} cut at {length} panics", reader.name));
            // A TOML or text file can be valid without its end.
            let binary = matches!(reader.writing, Writing::Binary { .. });
            let whole = length % 56 == 0 && reader.name == "psins-bin";
            let refused = said.contains(reader.file) || said.contains("run.csv");
            assert!(refused || !binary || whole, "{} cut at {length}: {said}", reader.name);
        }
    }
    assert!(met.panics.is_empty() && met.cases > 1000, "{:?} of {}", met.panics, met.cases);
}

/// A reader reports a file of another format.
#[test]
fn files_of_another_format_are_refused() {
    let (mut met, readers) = (Met::default(), readers());
    for reader in &readers {
        for other in readers.iter().filter(|other| other.good != reader.good) {
            let said = met.meet(reader, other.name, &other.good).expect("no panic");
            let read = said.ends_with("samples") || said == "read";
            // Columns by number are read from any text with numbers in these columns.
            let numbers = ["accelerometers on their own clock", "a thermometer"];
            let parquet = reader.name.ends_with("parquet") && other.name.ends_with("parquet");
            let mat = reader.name.starts_with("mat") && other.name.starts_with("mat");
            let readable = parquet || mat || numbers.contains(&reader.name);
            assert!(!read || readable, "{} reads {}: {said}", reader.name, other.name);
        }
    }
    assert!(met.panics.is_empty(), "{:?}", met.panics);
}
