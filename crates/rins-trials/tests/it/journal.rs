//! A journal that is broken off and gone on with, and the page of it.
#![cfg(unix)]

use std::fs;
use std::os::unix::fs::PermissionsExt as _;
use std::path::{Path, PathBuf};

use rins_trials::{Analyser, Grade, Kind, Plan, Population, card, merge, null_page, records, run};

/// A program that says this of every run, whatever it is.
fn saying(answer: &str, folder: &Path) -> PathBuf {
    let program = folder.join("program");
    let text = format!("#!/bin/sh\ntest -f rig.toml && test -f run.csv && echo '{answer}'\n");
    fs::write(&program, text).expect("the folder is writable");
    fs::set_permissions(&program, fs::Permissions::from_mode(0o755)).expect("it is ours");
    program
}

#[test]
fn journal_is_gone_on_with_where_it_broke_off() {
    let folder = tempfile::tempdir().unwrap();
    let journal = folder.path().join("journal.jsonl");
    let named = r#"{"verdict": "ambiguous", "causes": [{"effect": "gyro_lag", "cannot_tell_from": ["encoder_latency"],
        "ln_p": -9, "parameters": [{"id": "gyro_lag.delay", "value": 2, "sigma": 0.5, "unit": "ms"}]}]}"#;
    let analyser = Analyser::new(saying(&named.replace('\n', " "), folder.path()), 1);
    let plan =
        |trials| Plan { population: Population::Blind, seed: 5, trials, threads: 2, shard: (1, 1) };
    run(&plan(3), &analyser, &journal, |_| ()).unwrap();
    // Broken off in the middle of a line.
    let whole = fs::read_to_string(&journal).unwrap();
    fs::write(&journal, &whole[..whole.len() - 9]).unwrap();
    assert_eq!(records(&journal).unwrap().len(), 2);
    run(&plan(4), &analyser, &journal, |_| ()).unwrap();
    let all = records(&journal).unwrap();
    let mut indices: Vec<u64> = all.iter().map(|record| record.index).collect();
    indices.sort_unstable();
    assert_eq!(indices, [0, 1, 2, 3]);
    for record in &all {
        let cause = &record.answer.causes[0];
        assert_eq!(cause.set().collect::<Vec<_>>(), ["gyro_lag", "encoder_latency"]);
        assert_eq!(cause.parameters, [("delay".to_owned(), 2e-3, 5e-4)]);
        assert_eq!(record.answer.failure, None);
    }
    let clean = all.iter().filter(|record| record.kind == Kind::Nothing).count();
    let page = card(&all);
    assert!(page.contains(&format!("({clean} of {clean};")) || clean == 0, "{page}");
}

#[test]
fn program_that_fails_is_a_failure_and_no_answer() {
    let folder = tempfile::tempdir().unwrap();
    let journal = folder.path().join("journal.jsonl");
    let analyser = Analyser::new(saying("", folder.path()).with_file_name("program"), 1);
    fs::write(&analyser.program, "#!/bin/sh\necho 'no such thing' >&2\nexit 1\n").unwrap();
    run(
        &Plan { population: Population::Blind, seed: 5, trials: 1, threads: 1, shard: (1, 1) },
        &analyser,
        &journal,
        |_| (),
    )
    .unwrap();
    let all = records(&journal).unwrap();
    assert!(all[0].answer.failure.as_ref().is_some_and(|why| why.contains("no such thing")));
    assert!(card(&all).contains("1 trials were run; 1 ended without an answer"));
}

#[test]
fn every_name_in_a_run_without_effects_is_a_false_alarm() {
    let folder = tempfile::tempdir().unwrap();
    let journal = folder.path().join("journal.jsonl");
    let named = r#"{"verdict": "named", "causes": [{"effect": "gyro_lag", "cannot_tell_from": [], "ln_p": -9, "parameters": []}]}"#;
    let analyser = Analyser::new(saying(named, folder.path()), 1);
    let plan = Plan { population: Population::Null, seed: 5, trials: 6, threads: 2, shard: (1, 1) };
    run(&plan, &analyser, &journal, |_| ()).unwrap();
    let all = records(&journal).unwrap();
    assert!(all.iter().all(|record| record.kind == Kind::Nothing && record.hidden.is_empty()));
    assert!(all.iter().any(|record| record.grade != Grade::Navigation));
    let page = null_page(&all, "abc");
    // ln p of -9 is a p-value of 1.2e-4.
    assert!(page.contains("p < 0.001 | 100.0 % (6 of 6;"), "{page}");
    assert!(page.contains("p < 0.0001 | 0.0 % (0 of 6;"), "{page}");
    assert!(page.contains("6 runs at revision abc; 0 ended without an answer"), "{page}");
}

#[test]
fn shards_have_the_card_of_all_trials() {
    let folder = tempfile::tempdir().unwrap();
    let at = |name: &str| folder.path().join(name);
    let named = r#"{"verdict": "named", "causes": [{"effect": "gyro_lag", "cannot_tell_from": [], "ln_p": -9, "parameters": []}]}"#;
    let analyser = Analyser::new(saying(named, folder.path()), 1);
    let plan = |shard| Plan { population: Population::Null, seed: 5, trials: 7, threads: 2, shard };
    run(&plan((1, 1)), &analyser, &at("whole"), |_| ()).unwrap();
    let shards = [at("3"), at("1"), at("2")];
    let shards: Vec<&Path> = shards.iter().map(PathBuf::as_path).collect();
    for (shard, journal) in [3, 1, 2].into_iter().zip(&shards) {
        run(&plan((shard, 3)), &analyser, journal, |_| ()).unwrap();
    }
    merge(&shards, &at("merged")).unwrap();
    // The times of the answers are those of the clock.
    let all = |name: &str| {
        let mut all = records(&at(name)).unwrap();
        for record in &mut all {
            record.answer.seconds = 1.0;
        }
        all
    };
    let (whole, merged) = (all("whole"), all("merged"));
    let indices: Vec<u64> = merged.iter().map(|record| record.index).collect();
    assert_eq!(indices, [0, 1, 2, 3, 4, 5, 6]);
    assert_eq!(null_page(&merged, "abc"), null_page(&whole, "abc"));
    assert_eq!(card(&merged), card(&whole));

    for (journals, words) in [
        (&shards[..2], "trial 2 where trial 1"),
        (&[shards[0], shards[1], shards[2], shards[1]][..], "trial 0 where trial 1"),
    ] {
        let error = merge(journals, &at("refused")).unwrap_err();
        assert!(error.to_string().contains(words), "{error}");
    }
    run(&Plan { seed: 6, ..plan((2, 3)) }, &analyser, &at("other"), |_| ()).unwrap();
    let error = merge(&[shards[0], shards[1], &at("other")], &at("refused")).unwrap_err();
    assert!(error.to_string().contains("has the seed 6"), "{error}");
    assert!(merge(&[&at("none")], &at("refused")).is_err() && !at("refused").exists());
}
