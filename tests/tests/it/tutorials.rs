//! The tutorials of the book: every command runs, and its output is that of the page.

use std::fs;
use std::path::Path;

use crate::support::rins_words;

/// A fenced block of a page: its language, and its lines.
struct Block<'p> {
    language: &'p str,
    lines: Vec<&'p str>,
}

fn blocks(page: &str) -> Vec<Block<'_>> {
    let mut blocks: Vec<Block> = Vec::new();
    let mut open = false;
    for line in page.lines() {
        match line.strip_prefix("```") {
            Some(_) if open => open = false,
            Some(language) => {
                open = true;
                blocks.push(Block { language, lines: Vec::new() });
            }
            None if open => blocks.last_mut().unwrap().lines.push(line),
            None => {}
        }
    }
    assert!(!open, "a block does not end");
    blocks
}

/// The arguments of a command line, in which quotation marks hold words together.
fn arguments(line: &str) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    for (place, part) in line.split('"').enumerate() {
        if place % 2 == 1 {
            words.push(part.into());
        } else {
            words.extend(part.split_whitespace().map(str::to_owned));
        }
    }
    words
}

fn single_spaced(line: &str) -> String {
    line.split_whitespace().collect::<Vec<_>>().join(" ")
}

/// Runs the commands of a page one after the other in a folder beside the scenarios. Each line of a text block begins a line of what the
/// command before has printed, in the same order.
fn follow(name: &str) {
    let book = rins_tests::workspace().join("docs/src/tutorials");
    let page = fs::read_to_string(book.join(name)).unwrap();
    let folder = tempfile::tempdir().unwrap();
    copied(&rins_tests::workspace().join("scenarios"), &folder.path().join("scenarios"));
    let (mut printed, mut ran, mut compared) = (String::new(), 0, 0);
    for block in blocks(&page) {
        match block.language {
            "sh" => {
                printed.clear();
                for line in block.lines {
                    let command = line.strip_prefix("rins ").expect("a command of rins");
                    let words = arguments(command);
                    let finished = rins_words(folder.path(), &words);
                    assert_eq!(finished.code, Some(0), "{name}: {line}: {}", finished.err);
                    printed.push_str(&finished.out);
                    ran += 1;
                }
            }
            "text" => {
                let mut lines = printed.lines().map(single_spaced);
                for wanted in block.lines {
                    let wanted = single_spaced(wanted);
                    let found = lines.any(|line| line.starts_with(&wanted));
                    assert!(found, "{name}: {wanted:?} is not in\n{printed}");
                    compared += 1;
                }
            }
            other => panic!("{name}: a block of {other:?} is not run"),
        }
    }
    assert!(ran >= 4 && compared >= 4, "{name}: {ran} commands, {compared} lines");
}

/// Copies the scenario files, which are small.
fn copied(from: &Path, to: &Path) {
    fs::create_dir_all(to).unwrap();
    for entry in fs::read_dir(from).unwrap().map(Result::unwrap) {
        let (source, target) = (entry.path(), to.join(entry.file_name()));
        if source.is_dir() {
            copied(&source, &target);
        } else {
            fs::copy(source, target).unwrap();
        }
    }
}

#[test]
fn first_hour_can_be_followed() {
    follow("first-hour.md");
}

#[test]
fn named_effect_can_be_followed() {
    follow("name-an-effect.md");
}

#[test]
fn designed_schedule_can_be_followed() {
    follow("design-a-schedule.md");
}

#[test]
fn campaign_can_be_followed() {
    follow("campaigns.md");
    let folder = rins_tests::workspace().join("docs/src/tutorials");
    let pages = fs::read_dir(folder).unwrap().count();
    assert_eq!(pages, 4, "a page without a test");
}

#[test]
fn commands_are_read_as_a_shell_reads_them() {
    assert_eq!(
        arguments(r#"design a.toml --tilts "0 deg,90 deg""#),
        ["design", "a.toml", "--tilts", "0 deg,90 deg"]
    );
}
