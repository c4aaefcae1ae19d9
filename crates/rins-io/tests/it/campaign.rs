//! Results of campaigns, whole and damaged, and their journals.

use std::fs;
use std::path::Path;
use std::time::{Duration, Instant};

use rins_campaign::{PARAMETERS, RunFailure};
use rins_io::{
    CampaignModel, Heading, Identity, IoError, Journal, JournalRun, ModelRecord, Overwrite,
    PartRuns, Record, Row, RunRows, write_part,
};
use tempfile::tempdir;

fn identity() -> Identity {
    Identity { scenario: "a scenario".into(), runs: 2, seed: 3, shard: (1, 1), model: None }
}

/// The numbers of a run in the journals of these tests.
const NUMBERS: usize = 4;

#[derive(Debug, PartialEq)]
struct Part {
    heading: Heading,
    runs: Vec<RunRows>,
}

/// Two runs of each of these scenarios.
fn part(cells: &[u64]) -> Part {
    let row = |cell: u64, run: u64, place: usize| Row {
        cell,
        run,
        place,
        parameter: PARAMETERS[place].into(),
        unit: "arcsec".into(),
        record: Record {
            truth: 1.0,
            estimate: 1.5 + run as f64,
            covariances: (0..3).map(|other| f64::from(u8::from(other == place))).collect(),
            nis_ratio: 0.9,
            of_model: None,
        },
        failure: if run == 1 { "why it failed".into() } else { String::new() },
    };
    let mut values = Vec::new();
    let mut runs = Vec::new();
    for &cell in cells {
        if let Ok(place) = usize::try_from(cell)
            && place < 1000
        {
            values.resize(place + 1, Vec::new());
            values[place] = vec![format!("{cell} deg"), "a".into()];
        }
        runs.extend((0..2).map(|run| (0..3).map(|place| row(cell, run, place)).collect()));
    }
    let keys = vec!["roll".into(), "b".into()];
    Part { heading: Heading { identity: identity(), keys, values }, runs }
}

fn write(path: &Path, part: &Part) {
    let runs = part.runs.iter().cloned().map(Ok);
    write_part(path, Overwrite::Force, &part.heading, runs).unwrap();
}

fn read_part(path: &Path) -> Result<Part, IoError> {
    let mut file = PartRuns::open(path)?;
    let runs = file.by_ref().collect::<Result<_, _>>()?;
    Ok(Part { heading: file.heading().clone(), runs })
}

#[test]
fn results_are_read_as_they_were_written() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("part.parquet");
    let written = part(&[0, 1, 4]);
    write(&path, &written);
    assert_eq!(read_part(&path).unwrap(), written);
}

/// The results of a campaign with a model of two parameters.
fn part_of_model() -> Part {
    let model = CampaignModel {
        name: "a model".into(),
        text: "its text\nhas two lines".into(),
        noise: "given".into(),
        truth: "prior".into(),
        parameters: 2,
    };
    let row = |run: u64, place: usize| Row {
        cell: 0,
        run,
        place,
        parameter: ["gyro.bias.x", "accel.scale.z"][place].into(),
        unit: ["deg/h", "ppm"][place].into(),
        record: Record {
            truth: 0.1 + run as f64,
            estimate: 0.2,
            covariances: vec![4.0 + place as f64, 5.0],
            nis_ratio: 1.1,
            of_model: Some(ModelRecord {
                prior_sigma: 7.0,
                rank: 0.25,
                nees: 1.5,
                nees_dof: 2,
                iterations: 3,
                converged: run == 0,
            }),
        },
        failure: String::new(),
    };
    let identity = Identity { model: Some(model), ..identity() };
    Part {
        heading: Heading { identity, keys: Vec::new(), values: vec![Vec::new()] },
        runs: (0..2).map(|run| (0..2).map(|place| row(run, place)).collect()).collect(),
    }
}

#[test]
fn results_of_a_model_are_read_as_they_were_written() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("part.parquet");
    let mut written = part_of_model();
    write(&path, &written);
    assert_eq!(read_part(&path).unwrap(), written);
    // Every run has the parameters of the first one.
    written.runs[1].swap(0, 1);
    write(&path, &written);
    let said = read_part(&path).unwrap_err().to_string();
    assert!(said.contains("a run without its parameters in their order"), "{said}");
    // A number of parameters that the columns do not have.
    let mut other = part_of_model();
    other.heading.identity.model.as_mut().unwrap().parameters = 3;
    write(&path, &other);
    assert!(read_part(&path).is_err());
}

#[test]
fn scenarios_that_no_grid_has_are_refused() {
    let folder = tempdir().unwrap();
    for (cell, words) in [
        (u64::MAX, "a scenario beyond those that a grid can have"),
        (1 << 62, "a scenario beyond those that a grid can have"),
        (100_000, "a scenario beyond those that a grid can have"),
        (0, "not in the order of their scenarios"),
    ] {
        let path = folder.path().join("part.parquet");
        write(&path, &part(&[1, cell]));
        let said = read_part(&path).unwrap_err().to_string();
        assert!(said.contains("part.parquet: ") && said.contains(words), "{cell}: {said}");
    }
}

#[test]
fn runs_out_of_order_are_refused_and_none_comes_after() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("part.parquet");
    let mut swapped = part(&[0, 1]);
    swapped.runs.swap(2, 3);
    let mut mixed = part(&[0, 1]);
    mixed.runs[3].swap(0, 1);
    let mut torn = part(&[0, 1]);
    torn.runs[3][2].run = 7;
    for (part, words) in [
        (swapped, "runs that are not in their order"),
        (mixed, "a run without its three parameters"),
        (torn, "a run without its three parameters"),
    ] {
        write(&path, &part);
        let mut runs = PartRuns::open(&path).unwrap();
        let read: Vec<_> = runs.by_ref().collect();
        assert_eq!(read.len(), 4);
        let said = read[3].as_ref().unwrap_err().to_string();
        assert!(said.contains(words), "{said}");
        assert!(runs.next().is_none());
    }
}

#[test]
fn a_run_that_cannot_be_had_leaves_no_results() {
    let folder = tempdir().unwrap();
    let (from, to) = (folder.path().join("none.parquet"), folder.path().join("part.parquet"));
    let Part { heading, runs } = part(&[0]);
    let missing = PartRuns::open(&from).unwrap_err();
    let expected = missing.to_string();
    let sound = || runs.iter().cloned().map(Ok);
    let runs = sound().chain([Err(missing)]).chain(sound());
    let error = write_part(&to, Overwrite::Refuse, &heading, runs).unwrap_err();
    assert_eq!(error.to_string(), expected);
    assert_eq!(fs::read_dir(folder.path()).unwrap().count(), 0);
}

#[test]
fn what_is_no_campaign_is_refused() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("part.parquet");
    let mut other = part(&[0]);
    other.runs[0][0].parameter = "gyro.bias.x".into();
    write(&path, &other);
    let said = read_part(&path).unwrap_err().to_string();
    assert!(said.contains("a parameter that no campaign estimates"), "{said}");
    for bytes in [&b""[..], b"PAR1", b"PAR1PAR1"] {
        fs::write(&path, bytes).unwrap();
        let said = read_part(&path).unwrap_err().to_string();
        assert!(said.contains("part.parquet: "), "{said}");
    }
}

/// A file with any byte changed or truncated anywhere is read or refused, without delay.
#[test]
fn damaged_results_are_read_or_refused() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("part.parquet");
    write(&path, &part(&[0, 1]));
    let whole = fs::read(&path).unwrap();
    let damaged = |bytes: &[u8]| {
        fs::write(&path, bytes).unwrap();
        let start = Instant::now();
        let refused = read_part(&path).is_err();
        assert!(start.elapsed() < Duration::from_secs(5));
        usize::from(refused)
    };
    let lengths = (0..whole.len()).step_by(7);
    assert!(lengths.clone().all(|length| damaged(&whole[..length]) == 1));
    let mut refused = 0;
    for place in 0..whole.len() {
        let mut bytes = whole.clone();
        bytes[place] ^= [0xff, 1 << (place % 8)][place % 2];
        refused += damaged(&bytes);
    }
    assert!(refused > whole.len() / 4, "{refused} of {}", whole.len());
}

/// The chunks, among the first ten, that are in the journal.
fn journal(path: &Path) -> Vec<u64> {
    let journal = Journal::resume(path, &identity(), NUMBERS).unwrap().unwrap();
    (0..10).filter(|chunk| journal.len_of(*chunk).is_some()).collect()
}

#[test]
fn a_journal_gives_back_what_was_added_in_any_order() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("results.parquet.part");
    let run = |number: f64| -> JournalRun {
        Ok(vec![number, -0.0, f64::MIN_POSITIVE / 3.0, 1.0 / number])
    };
    let failed = || Err(RunFailure { reason: "none".into() });
    let chunks = [(8, vec![run(0.1), failed()]), (2, vec![failed()]), (5, vec![run(7.0)])];
    let same = |journal: &mut Journal| {
        for (chunk, runs) in [&chunks[2], &chunks[0], &chunks[1]] {
            assert_eq!(journal.len_of(*chunk), Some(runs.len() as u64));
            assert_eq!(&journal.runs(*chunk).unwrap(), runs);
        }
        assert!(journal.runs(4).is_err());
    };
    let mut made = Journal::create(&path, &identity(), NUMBERS, Overwrite::Refuse).unwrap();
    for (chunk, runs) in &chunks {
        made.add(*chunk, runs).unwrap();
    }
    same(&mut made);
    // Chunks added after a resume are appended to the last one.
    made.add(9, &[failed()]).unwrap();
    drop(made);
    let mut resumed = Journal::resume(&path, &identity(), NUMBERS).unwrap().unwrap();
    same(&mut resumed);
    assert_eq!(resumed.runs(9).unwrap(), [failed()]);
    // If a chunk is repeated, the later one counts.
    resumed.add(2, &[run(3.0), failed()]).unwrap();
    drop(resumed);
    let mut resumed = Journal::resume(&path, &identity(), NUMBERS).unwrap().unwrap();
    assert_eq!(resumed.runs(2).unwrap(), [run(3.0), failed()]);
}

#[test]
fn a_journal_goes_on_behind_its_last_whole_portion() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("results.parquet.part");
    let reason = "a sigma of 3 µg/√Hz".to_owned();
    let mut made = Journal::create(&path, &identity(), NUMBERS, Overwrite::Refuse).unwrap();
    for chunk in [4, 7] {
        made.add(chunk, &[Err(RunFailure { reason: reason.clone() })]).unwrap();
    }
    drop(made);
    assert_eq!(journal(&path), [4, 7]);
    // If it is cut anywhere, even within a character of the reason, the complete chunks before remain.
    let whole = fs::read(&path).unwrap();
    let lines: Vec<usize> =
        (0..).zip(&whole).filter(|(_, byte)| **byte == b'\n').map(|(place, _)| place + 1).collect();
    // The first line identifies the campaign, and each chunk has three lines.
    let (first, second) = (lines[0], lines[3]);
    for length in first..whole.len() {
        fs::write(&path, &whole[..length]).unwrap();
        let expected: &[u64] = if length < second { &[] } else { &[4] };
        assert_eq!(journal(&path), expected, "{length}");
        let left = fs::read(&path).unwrap();
        assert!(left.is_empty() || whole.starts_with(&left) && left.ends_with(b"\n"), "{length}");
    }
    // An existing journal is never replaced by a new one.
    assert!(Journal::create(&path, &identity(), NUMBERS, Overwrite::Refuse).is_err());
}

/// If a bit is flipped, no run is changed: a chunk is unchanged, or it is repeated.
#[test]
fn a_journal_with_a_flipped_bit_gives_back_no_other_run() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("results.parquet.part");
    let run = |number: f64| -> JournalRun { Ok(vec![number, 2.0 * number, 3.0, 1.0]) };
    let failed = || Err(RunFailure { reason: "not aligned".into() });
    let chunks = [(1, vec![run(0.1), failed()]), (2, vec![run(0.2)]), (6, vec![run(0.3)])];
    let mut made = Journal::create(&path, &identity(), NUMBERS, Overwrite::Refuse).unwrap();
    for (chunk, runs) in &chunks {
        made.add(*chunk, runs).unwrap();
    }
    drop(made);
    let whole = fs::read(&path).unwrap();
    let first = whole.iter().position(|byte| *byte == b'\n').unwrap() + 1;
    let mut again = 0;
    for place in first..whole.len() {
        for bit in 0..8 {
            let mut flipped = whole.clone();
            flipped[place] ^= 1 << bit;
            fs::write(&path, &flipped).unwrap();
            let mut journal = Journal::resume(&path, &identity(), NUMBERS).unwrap().unwrap();
            let mut left = 0;
            for chunk in 0..200 {
                if journal.len_of(chunk).is_some() {
                    let (_, runs) = chunks.iter().find(|(index, _)| *index == chunk).unwrap();
                    assert_eq!(&journal.runs(chunk).unwrap(), runs, "{place}, bit {bit}");
                    left += 1;
                }
            }
            again += chunks.len() - left;
        }
    }
    assert!(again >= 8 * (whole.len() - first), "a flip is never without effect");
}

#[test]
fn a_journal_of_one_long_line_is_not_read_into_memory() {
    let folder = tempdir().unwrap();
    let path = folder.path().join("results.parquet.part");
    drop(Journal::create(&path, &identity(), NUMBERS, Overwrite::Refuse).unwrap());
    let file = fs::OpenOptions::new().write(true).open(&path).unwrap();
    let first = file.metadata().unwrap().len();
    file.set_len(1 << 40).unwrap();
    let start = Instant::now();
    assert_eq!(journal(&path), [0_u64; 0]);
    assert_eq!(fs::metadata(&path).unwrap().len(), first);
    assert!(start.elapsed() < Duration::from_secs(5));
}
