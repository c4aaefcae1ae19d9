//! Tables of the score card: by schedule, by noise and table, by amplitude, by effect.

use std::collections::BTreeMap;
use std::fmt::Write as _;

use rins_terms::SettingKind;
use rins_terms::catalogue::BASE_TILT_STEP;

use crate::draw::Kind;
use crate::hide::Hidden;
use crate::journal::Record;
use crate::laboratory::{Level, Schedule};
use crate::score::{class, classes, in_set, is_plain, meant, ones};
use crate::statistics::{Share, power, threshold};

/// The allowed fraction of runs without unmodeled error in which an effect is reported.
const FALSE_ALARMS: f64 = 0.01;

/// The highest frequency of the search \[Hz\].
const HIGHEST: f64 = 1.0;

/// False alarms, detections, credible sets and false effects of these records.
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

const BRIEF: &str = "| | effect reported without unmodeled error | detected at ≥ 8 σ | in the credible set at ≥ 8 σ | false effect in addition to a true one |\n\
                     | --- | --- | --- | --- | --- |\n";

/// Results by schedule.
pub(crate) fn by_schedule(page: &mut String, records: &[&Record]) {
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

/// Results by noise and table.
pub(crate) fn by_level(page: &mut String, records: &[&Record]) {
    page.push_str(BRIEF);
    for level in Level::ALL {
        let of: Vec<&Record> =
            records.iter().copied().filter(|record| record.level == level).collect();
        let _ = writeln!(page, "| {} | {} |", level.name(), brief(&of));
    }
}

/// Detection by amplitude, and the theoretical power of a test of all candidates.
pub(crate) fn detection(page: &mut String, records: &[&Record]) {
    page.push_str(
        "Theory is the power of the likelihood-ratio test of the true effect. The statistic is chi-square with the degrees of freedom of\n\
         the effect. The significance level of 1 % is divided among all effects of the catalogue and their possible event times.\n\n\
         | amplitude \\[σ\\] | detected | theory | in the credible set | most probable effect correct | false effects |\n\
         | ---: | --- | ---: | --- | --- | --- |\n",
    );
    let ones = ones(records);
    let mut strengths: Vec<f64> = ones.iter().map(|(_, hidden)| hidden.meant).collect();
    strengths.sort_by(f64::total_cmp);
    strengths.dedup();
    for strength in strengths {
        let of: Vec<&(&Record, &Hidden)> = ones.iter().filter(meant(strength, strength)).collect();
        let theory: f64 = of.iter().map(|(record, hidden)| expected(record, hidden)).sum();
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

/// Detection at the smallest amplitude with a target, by class.
pub(crate) fn faint(page: &mut String, records: &[&Record]) {
    page.push_str(
        "Theory takes the noise parameters as known. The diagnosis estimates them from the same run, and a slow effect may be absorbed by\n\
         bias instability that the data sheet does not state.\n\n\
         | at 6.5 σ | detected | theory |\n| --- | --- | ---: |\n",
    );
    let ones = ones(records);
    for row in classes() {
        let of: Vec<&(&Record, &Hidden)> =
            ones.iter().filter(meant(6.5, 6.5)).filter(|(_, h)| class(&h.id) == row).collect();
        if of.is_empty() {
            continue;
        }
        let theory: f64 = of.iter().map(|(record, hidden)| expected(record, hidden)).sum();
        let detected = Share::count(of.iter().map(|(r, _)| r.detected())).text();
        let _ =
            writeln!(page, "| {row} | {detected} | {:.1} % |", 100.0 * theory / of.len() as f64);
    }
}

/// The power of a test of the hidden effect over all its possible settings.
fn expected(record: &Record, hidden: &Hidden) -> f64 {
    let terms = crate::hide::hideable();
    let settings = terms.iter().find(|term| term.id == hidden.id).map_or(&[][..], |t| t.settings);
    let looks = |kind| match kind {
        // The gyros measure a tilt step of the base in one sample.
        SettingKind::Time if hidden.id == BASE_TILT_STEP.id => record.duration / record.interval,
        SettingKind::Time => 16.0,
        SettingKind::Order => 9.0,
        SettingKind::TimeConstant | SettingKind::Axis => 3.0,
        SettingKind::Frequency => HIGHEST * record.duration,
        _ => 1.0,
    };
    let looks: f64 = settings.iter().map(|setting| looks(setting.kind)).product();
    let limit = threshold(FALSE_ALARMS / terms.len() as f64 / looks, hidden.dof);
    power(hidden.strength, hidden.dof, limit)
}

/// Results by effect.
pub(crate) fn by_effect(page: &mut String, records: &[&Record]) {
    page.push_str(
        "At 8 σ and above, for all kinds of noise and table.\n\n| effect | trials | in the credible set | most probable | confused with, or missed |\n\
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
            let name = record.first().map_or(NOTHING, |named| named.effect.as_str());
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

/// The column of trials with residual structure and without a reported effect.
const RESIDUAL_ONLY: &str = "residual structure only";

/// The column, and the entry, of trials without a report.
const NOTHING: &str = "nothing";

/// Rows: classes of the true effects; columns: classes of the most probable reported effects.
pub(crate) fn confusion(page: &mut String, records: &[&Record]) {
    page.push_str(
        "Rows are the true effects at 8 σ and above, columns the most probable reported effects, in classes with similar signatures.\n\n\
         | true effect |",
    );
    let columns: Vec<&str> = classes().chain([RESIDUAL_ONLY, NOTHING]).collect();
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
                None if record.answer.unexplained.is_empty() => NOTHING,
                None => RESIDUAL_ONLY,
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

/// Results for structures outside the catalogue.
pub(crate) fn outside(page: &mut String, records: &[&Record]) {
    page.push_str(
        "These are residual structures that no effect of the catalogue produces. The remainder is their size after subtraction of the most\n\
         similar effect.\n\n\
         | structure | remainder | residual structure reported | effect reported, no residual structure | nothing reported |\n\
         | --- | --- | --- | --- | --- |\n",
    );
    let mut kinds: BTreeMap<(&str, &str), Vec<&Record>> = BTreeMap::new();
    for record in records {
        if let Some(outside) = &record.outside {
            let size = match outside.remainder {
                None => "noise",
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

/// How often the first name is right, by the probability that is stated of it.
pub(crate) fn reliability(page: &mut String, records: &[&Record]) {
    const BINS: [f64; 6] = [0.0, 0.3, 0.5, 0.7, 0.9, 0.98];
    page.push_str(
        "The most probable effect of a run with one hidden effect is correct as often as the stated posterior probability says.\n\n",
    );
    page.push_str("| stated probability | mean | correct |\n| --- | ---: | --- |\n");
    let stated: Vec<(f64, bool)> = ones(records)
        .into_iter()
        .filter_map(|(record, hidden)| {
            let first = record.first()?;
            Some((first.probability?, first.effect == hidden.id))
        })
        .collect();
    for (place, low) in BINS.into_iter().enumerate() {
        let high = BINS.get(place + 1).copied().unwrap_or(1.0 + f64::EPSILON);
        let own: Vec<(f64, bool)> =
            stated.iter().copied().filter(|(stated, _)| (low..high).contains(stated)).collect();
        if own.is_empty() {
            continue;
        }
        let mean = own.iter().map(|(stated, _)| stated).sum::<f64>() / own.len() as f64;
        let right = Share::count(own.iter().map(|(_, right)| *right)).text();
        let _ = writeln!(page, "| {low:.2} – {:.2} | {mean:.2} | {right} |", high.min(1.0));
    }
}
