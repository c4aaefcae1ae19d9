//! The score card: a page of the book, from a journal.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use crate::draw::Kind;
use crate::hide::Hidden;
use crate::journal::Record;
use crate::laboratory::{Level, Schedule};
use crate::score::{class, classes};
use crate::statistics::{Share, power, threshold};

/// The share of clean runs on which anything may be named.
const FALSE_ALARMS: f64 = 0.01;

/// The page for these records.
pub fn card(records: &[Record]) -> String {
    let mut page = String::from(HEAD);
    let (timed, records): (Vec<&Record>, Vec<&Record>) =
        records.iter().partition(|record| record.timed);
    let answered: Vec<&Record> =
        records.iter().copied().filter(|record| record.answered()).collect();
    let failures = Share::count(records.iter().map(|record| !record.answered()));
    let _ = writeln!(
        page,
        "{} trials; {} ended without an answer. In brackets: counts, and the bounds of Clopper and Pearson at 95 %.\n",
        records.len(),
        failures.hits
    );
    table(&mut page, &targets(&answered, &timed));
    page.push_str("\n## By schedule\n\n");
    by_schedule(&mut page, &answered);
    page.push_str("\n## By realism\n\n");
    by_level(&mut page, &answered);
    page.push_str("\n## Detection\n\n");
    detection(&mut page, &answered);
    page.push_str("\n## By effect\n\n");
    by_effect(&mut page, &answered);
    page.push_str("\n## What is taken for what\n\n");
    confusion(&mut page, &answered);
    page.push_str("\n## Outside the catalogue\n\n");
    outside(&mut page, &answered);
    page
}

const HEAD: &str = "# Blind trials

The diagnosis is tried on runs that share nothing with it. `rins-blind`, which uses no other crate of this workspace, makes them from an
oversampled motion: a table with a servo, cogging and friction, attitudes as quaternions, rates and forces by differences,
sensor errors on every short step. `rins diagnose` sees the log and the rig file. What is hidden is kept apart,
and this page is what became of it: `cargo xtask blind` runs trials, `cargo xtask blind --card` writes this page from
those that were run.

A trial draws a place, the axis' tilt (15 to 35 deg), an IMU (gyro noise 0.005 to 0.05 deg/h/√Hz, its constant errors over
decades), an encoder, a temperature, a schedule of 360 to 540 s at 50 or 100 Hz, and what is hidden: nothing (35 %), one effect
of the catalogue (40 %), two (10 %), or something outside it (15 %). An effect is so many times its Cramér-Rao bound
strong, in a random direction of what the run shows of it; sigmas below are those.

";

/// A figure, what it should be, what it is, and how it is bounded.
type Row = (&'static str, &'static str, String);

fn table(page: &mut String, rows: &[Row]) {
    page.push_str("| figure | target | found |\n| --- | --- | --- |\n");
    for (figure, target, found) in rows {
        let _ = writeln!(page, "| {figure} | {target} | {found} |");
    }
}

/// Whether a level is one of those that the targets are about.
fn is_plain(record: &Record) -> bool {
    matches!(record.level, Level::White | Level::Flicker)
}

/// Records of one hidden effect, on plain levels.
fn ones<'a>(records: &[&'a Record]) -> Vec<(&'a Record, &'a Hidden)> {
    let plain = records.iter().copied().filter(|record| is_plain(record));
    plain.filter_map(|record| Some((record, record.one()?))).collect()
}

fn in_set((record, hidden): &(&Record, &Hidden)) -> bool {
    record.set_with(&hidden.id).is_some()
}

fn meant(low: f64, high: f64) -> impl Fn(&&(&Record, &Hidden)) -> bool {
    move |(_, hidden)| (low..=high).contains(&hidden.meant)
}

fn targets(records: &[&Record], timed: &[&Record]) -> Vec<Row> {
    let clean: Vec<&&Record> =
        records.iter().filter(|r| r.kind == Kind::Nothing && is_plain(r)).collect();
    let on = |level: Level| {
        let of_level = clean.iter().filter(|record| record.level == level);
        Share::count(of_level.map(|record| record.false_names().next().is_some())).text()
    };
    let ones = ones(records);
    let strong = |low, high| ones.iter().filter(meant(low, high));
    let sets = |low, high| Share::count(strong(low, high).map(in_set)).text();
    let seen = |low, high| Share::count(strong(low, high).map(|(r, _)| r.detected())).text();
    let firsts = ones.iter().filter(|(r, h)| h.is_separable() && r.first().is_some());
    let right = |(r, h): &(&Record, &Hidden)| r.first().is_some_and(|named| named.effect == h.id);
    let covered = ones.iter().filter(|(_, h)| h.strength >= 6.0).flat_map(|(r, _)| r.covered());
    let both = records.iter().filter(|r| r.kind == Kind::Two && is_plain(r));
    let beyond: Vec<&&Record> = records
        .iter()
        .filter(|r| is_plain(r))
        .filter(|r| r.outside.as_ref().is_some_and(|o| o.remainder.is_some_and(|r| r >= 15.0)))
        .collect();
    let flagged = |r: &&&Record| !r.answer.unexplained.is_empty();
    let misnamed = |r: &&&Record| !r.answer.causes.is_empty() && r.answer.unexplained.is_empty();
    let clean_after = |(r, h): &(&Record, &Hidden)| {
        r.set_with(&h.id).is_some() && r.answer.causes.len() == 1 && r.answer.unexplained.is_empty()
    };
    let times = |of: &[&Record]| seconds(of.iter().map(|r| r.answer.seconds).collect());
    vec![
        ("named on clean data, white noise", "≤ 1 %", on(Level::White)),
        ("named on clean data, with flicker of 0.005 deg/h", "≤ 1 %", on(Level::Flicker)),
        (
            "unexplained on clean data",
            "≤ 1 %",
            Share::count(clean.iter().map(|r| !r.answer.unexplained.is_empty())).text(),
        ),
        ("detected at 6 σ", "≥ 95 % at 6.5 σ", seen(6.0, 6.0)),
        ("detected at 8 σ", "", seen(8.0, 8.0)),
        ("detected at 12 σ and above", "100 % at 9 σ", seen(12.0, 200.0)),
        ("truth in the set at 8 σ", "≥ 98 %", sets(8.0, 8.0)),
        ("truth in the set at 12 σ and above", "≥ 99.5 %", sets(12.0, 200.0)),
        (
            "first name right where the schedule separates, s/κ ≥ 5",
            "≥ 95 %",
            Share::count(firsts.map(right)).text(),
        ),
        ("mean size of the set at 12 σ, three rates", "≤ 2", mean_size(&ones, 12.0)),
        ("mean size of the set at 100 σ, three rates", "≤ 1.5", mean_size(&ones, 100.0)),
        (
            "95 % interval of the named amplitude covers, s ≥ 6",
            "93 – 97 %",
            Share::count(covered).text(),
        ),
        (
            "nothing else named, nothing left, 8 σ and above",
            "≥ 95 %",
            Share::count(strong(8.0, 200.0).map(clean_after)).text(),
        ),
        (
            "outside the catalogue, remainder ≥ 15 σ: unexplained",
            "≥ 95 %",
            Share::count(beyond.iter().map(flagged)).text(),
        ),
        (
            "outside the catalogue, remainder ≥ 15 σ: named as if complete",
            "≤ 2 %",
            Share::count(beyond.iter().map(misnamed)).text(),
        ),
        (
            "two effects of 10 σ, both in sets",
            "≥ 90 %",
            Share::count(both.map(|r| r.hidden.iter().all(|h| r.set_with(&h.id).is_some()))).text(),
        ),
        ("time for 720 s at 100 Hz, two threads: median, 95 %, longest", "< 10 s", times(timed)),
        ("time of a trial's diagnosis, one thread: median, 95 %, longest", "", times(records)),
    ]
}

fn mean_size(ones: &[(&Record, &Hidden)], at: f64) -> String {
    let sizes: Vec<f64> = ones
        .iter()
        .filter(meant(at, at))
        .filter(|(record, _)| record.schedule == Schedule::ThreeRates)
        .filter_map(|(record, hidden)| Some(record.set_with(&hidden.id)?.set().count() as f64))
        .collect();
    if sizes.is_empty() {
        return "none of the kind".into();
    }
    format!("{:.2} ({} sets)", sizes.iter().sum::<f64>() / sizes.len() as f64, sizes.len())
}

fn seconds(mut times: Vec<f64>) -> String {
    times.sort_by(f64::total_cmp);
    let Some(&longest) = times.last() else { return "none".into() };
    format!("{:.1}, {:.1}, {longest:.1} s", times[times.len() / 2], times[times.len() * 19 / 20])
}

/// Named falsely, detected, in the set, of records of a kind.
fn brief(records: &[&Record]) -> String {
    let clean = records.iter().filter(|r| r.kind == Kind::Nothing);
    let falsely = Share::count(clean.map(|r| r.false_names().next().is_some()));
    let ones: Vec<(&Record, &Hidden)> =
        records.iter().filter_map(|record| Some((*record, record.one()?))).collect();
    let strong: Vec<&(&Record, &Hidden)> = ones.iter().filter(|(_, h)| h.meant >= 8.0).collect();
    let detected = Share::count(strong.iter().map(|(r, _)| r.detected()));
    let sets = Share::count(strong.iter().map(|one| in_set(one)));
    let others = records.iter().filter(|r| r.kind == Kind::One);
    let wrong = Share::count(others.map(|r| r.false_names().next().is_some()));
    format!("{} | {} | {} | {}", falsely.text(), detected.text(), sets.text(), wrong.text())
}

const BRIEF: &str = "| | named on clean data | detected at ≥ 8 σ | in the set at ≥ 8 σ | a false name beside one effect |\n\
                     | --- | --- | --- | --- | --- |\n";

fn by_schedule(page: &mut String, records: &[&Record]) {
    page.push_str(BRIEF);
    for schedule in Schedule::ALL {
        let of: Vec<&Record> = records
            .iter()
            .copied()
            .filter(|record| record.schedule == schedule && is_plain(record))
            .collect();
        let _ = writeln!(page, "| {} | {} |", schedule.name(), brief(&of));
    }
}

fn by_level(page: &mut String, records: &[&Record]) {
    page.push_str(BRIEF);
    for level in Level::ALL {
        let of: Vec<&Record> =
            records.iter().copied().filter(|record| record.level == level).collect();
        let _ = writeln!(page, "| {} | {} |", level.name(), brief(&of));
    }
}

/// Detection against strength, beside that of a test of which the truth is one of all candidates.
fn detection(page: &mut String, records: &[&Record]) {
    page.push_str(
        "Theory is the power of the likelihood-ratio test of the true effect, chi-square of its degrees, where one \
         percent is shared among all effects of the catalogue and the places at which each may happen.\n\n\
         | strength \\[σ\\] | detected | theory | in the set | first name right | false names |\n\
         | ---: | --- | ---: | --- | --- | --- |\n",
    );
    let ones = ones(records);
    let mut strengths: Vec<f64> = ones.iter().map(|(_, hidden)| hidden.meant).collect();
    strengths.sort_by(f64::total_cmp);
    strengths.dedup();
    for strength in strengths {
        let of: Vec<&(&Record, &Hidden)> = ones.iter().filter(meant(strength, strength)).collect();
        let theory: f64 = of.iter().map(|(_, hidden)| expected(hidden)).sum();
        let right =
            |(r, h): &&(&Record, &Hidden)| r.first().is_some_and(|named| named.effect == h.id);
        let _ = writeln!(
            page,
            "| {strength} | {} | {:.1} % | {} | {} | {} |",
            Share::count(of.iter().map(|(r, _)| r.detected())).text(),
            100.0 * theory / of.len() as f64,
            Share::count(of.iter().map(|one| in_set(one))).text(),
            Share::count(of.iter().map(right)).text(),
            of.iter().map(|(r, _)| r.false_names().count()).sum::<usize>()
        );
    }
}

fn expected(hidden: &Hidden) -> f64 {
    let terms = crate::hide::hideable();
    let term = terms.iter().find(|term| term.id == hidden.id);
    let has = |name: &str| term.is_some_and(|t| t.settings.iter().any(|s| s.name == name));
    let looks = if has("time") {
        16.0
    } else if has("order") {
        9.0
    } else if has("time_constant") {
        3.0
    } else {
        1.0
    };
    let limit = threshold(FALSE_ALARMS / terms.len() as f64 / looks, hidden.dof);
    power(hidden.strength, hidden.dof, limit)
}

fn by_effect(page: &mut String, records: &[&Record]) {
    page.push_str(
        "At 8 σ and above, on all levels.\n\n| effect | trials | in the set | first | taken for, or missed |\n\
         | --- | ---: | ---: | ---: | --- |\n",
    );
    let mut effects: BTreeMap<&str, Vec<&Record>> = BTreeMap::new();
    for record in records {
        if let Some(hidden) = record.one().filter(|hidden| hidden.meant >= 8.0) {
            effects.entry(&hidden.id).or_default().push(record);
        }
    }
    for (id, of) in effects {
        let sets = of.iter().filter(|r| r.set_with(id).is_some()).count();
        let firsts = of.iter().filter(|r| r.first().is_some_and(|n| n.effect == id)).count();
        let mut others: BTreeMap<&str, usize> = BTreeMap::new();
        for record in of.iter().filter(|record| record.set_with(id).is_none()) {
            let name = record.first().map_or("nothing", |named| named.effect.as_str());
            *others.entry(name).or_default() += 1;
        }
        let others: Vec<String> = others
            .iter()
            .map(|(name, n)| if *n == 1 { format!("`{name}`") } else { format!("`{name}` {n}") })
            .collect();
        let _ =
            writeln!(page, "| `{id}` | {} | {sets} | {firsts} | {} |", of.len(), others.join(", "));
    }
}

/// Rows: the class of what was hidden; columns: of what was named first.
fn confusion(page: &mut String, records: &[&Record]) {
    page.push_str(
        "Rows are what was hidden, at 8 σ and above, columns what was named first, by classes of effects that act alike.\n\n| hidden |",
    );
    let columns: Vec<&str> = classes().chain(["unexplained", "nothing"]).collect();
    for column in &columns {
        let _ = write!(page, " {column} |");
    }
    page.push_str("\n| --- |");
    page.push_str(&" ---: |".repeat(columns.len()));
    page.push('\n');
    for row in classes() {
        let mut counts = vec![0_usize; columns.len()];
        for record in records {
            let Some(hidden) = record.one().filter(|hidden| hidden.meant >= 8.0) else { continue };
            if class(&hidden.id) != row {
                continue;
            }
            let named = match record.first() {
                Some(named) => class(&named.effect),
                None if record.answer.unexplained.is_empty() => "nothing",
                None => "unexplained",
            };
            if let Some(place) = columns.iter().position(|column| *column == named) {
                counts[place] += 1;
            }
        }
        let _ = write!(page, "| {row} |");
        for count in counts {
            let shown = if count == 0 { String::new() } else { count.to_string() };
            let _ = write!(page, " {shown} |");
        }
        page.push('\n');
    }
}

fn outside(page: &mut String, records: &[&Record]) {
    page.push_str(
        "Structures no effect makes; the remainder is what is left of them beside the effect that is most like them.\n\n\
         | structure | remainder | unexplained | named as if complete | not seen |\n| --- | --- | --- | --- | --- |\n",
    );
    let mut kinds: BTreeMap<(&str, &str), Vec<&Record>> = BTreeMap::new();
    for record in records {
        if let Some(outside) = &record.outside {
            let size = match outside.remainder {
                None => "scatter",
                Some(left) if left >= 15.0 => "≥ 15 σ",
                Some(_) => "8, 12 σ",
            };
            kinds.entry((&outside.name, size)).or_default().push(record);
        }
    }
    for ((name, size), of) in kinds {
        let flagged = Share::count(of.iter().map(|r| !r.answer.unexplained.is_empty()));
        let misnamed = Share::count(
            of.iter().map(|r| !r.answer.causes.is_empty() && r.answer.unexplained.is_empty()),
        );
        let unseen = Share::count(of.iter().map(|r| !r.detected()));
        let _ = writeln!(
            page,
            "| {name} | {size} | {} | {} | {} |",
            flagged.text(),
            misnamed.text(),
            unseen.text()
        );
    }
}
