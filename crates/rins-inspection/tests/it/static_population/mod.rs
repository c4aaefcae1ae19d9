//! Static intervals in a population of logs: grades from MEMS to laser gyros, 10 Hz to 2 kHz, intervals of 2 to 60 s, with
//! motions by hand or by a table, or oscillations between them.

mod logs;

use std::collections::BTreeMap;
use std::ops::Range;

use rins_inspection::StaticIntervals;

use self::logs::{Log, log};

/// The tolerance of the ends of an interval \[s\].
const WITHIN: f64 = 0.3;

/// The shortest interval of the search \[s\]: two seconds minus the tolerances of its ends.
const SHORTEST: f64 = 2.0 - 2.0 * WITHIN;

/// The result of a search.
#[derive(Clone, Copy, Debug, Default)]
struct Score {
    intervals: usize,
    missed: usize,
    ends_off: usize,
    found: usize,
    moving: usize,
}

impl Score {
    fn add(&mut self, other: &Self) {
        self.intervals += other.intervals;
        self.missed += other.missed;
        self.ends_off += other.ends_off;
        self.found += other.found;
        self.moving += other.moving;
    }
}

#[expect(clippy::print_stdout, reason = "the whole population is looked at on demand")]
fn score(log: &Log, tell: bool) -> Score {
    let found = StaticIntervals::of(&log.recording, &log.options);
    let times = |span: &Range<usize>| {
        let first = &log.recording.increments[span.start];
        [log.recording.times[span.start] - first.interval, log.recording.times[span.end - 1]]
    };
    let spans: Vec<[f64; 2]> = found.spans(SHORTEST).iter().map(times).collect();
    let mut score =
        Score { intervals: log.stationary.len(), found: spans.len(), ..Score::default() };
    for [from, to] in &spans {
        let inside = |&&[start, end]: &&[f64; 2]| *from >= start - WITHIN && *to <= end + WITHIN;
        if !log.stationary.iter().any(|span| inside(&span)) {
            score.moving += 1;
            if tell {
                println!("  moving: {from:.2} to {to:.2}");
            }
        }
    }
    for &[start, end] in &log.stationary {
        let own: Vec<&[f64; 2]> =
            spans.iter().filter(|[from, to]| *from < end && *to > start).collect();
        match (own.first(), own.last()) {
            (Some(first), Some(last)) => {
                if (first[0] - start).abs() > WITHIN || (last[1] - end).abs() > WITHIN {
                    score.ends_off += 1;
                    if tell {
                        println!(
                            "  ends: {start:.2} to {end:.2} as {:.2} to {:.2}",
                            first[0], last[1]
                        );
                    }
                }
            }
            _ => {
                score.missed += 1;
                if tell {
                    println!("  missed: {start:.2} to {end:.2}");
                }
            }
        }
    }
    if tell && score.missed + score.ends_off + score.moving > 0 {
        for one in found.all.iter().filter(|one| one.remark().is_some()) {
            println!(
                "    {:.2} to {:.2}: {}",
                one.start,
                one.end,
                one.remark().unwrap_or_default()
            );
        }
    }
    score
}

#[test]
fn static_intervals_of_any_log_are_found() {
    let mut all = Score::default();
    for seed in 0..40 {
        all.add(&score(&log(seed), false));
    }
    assert!(all.intervals > 100, "{all:?}");
    assert_eq!(all.moving, 0, "{all:?}");
    assert!(all.missed + all.ends_off <= all.intervals / 50, "{all:?}");
}

/// The whole population, with its detection rates by grade, sampling rate and motion.
#[test]
#[ignore = "500 logs take long in a debug build: run with --ignored --nocapture for the table of rates"]
fn static_intervals_of_five_hundred_logs_are_found() {
    let count: u64 =
        std::env::var("RINS_STATIC_LOGS").ok().and_then(|count| count.parse().ok()).unwrap_or(500);
    let first: u64 = std::env::var("RINS_STATIC_FIRST")
        .ok()
        .and_then(|count| count.parse().ok())
        .unwrap_or(1000);
    let mut by: BTreeMap<String, Score> = BTreeMap::new();
    for seed in first..first + count {
        let log = log(seed);
        let one = score(&log, false);
        if one.missed + one.ends_off + one.moving > 0 {
            println!("{seed}: {} {} Hz {}", log.grade, log.rate, log.motion);
            score(&log, true);
        }
        for key in
            ["all".into(), log.grade.into(), format!("{:6.0} Hz", log.rate), log.motion.into()]
        {
            by.entry(key).or_default().add(&one);
        }
    }
    for (key, score) in &by {
        println!("{key:>12}: {score:?}");
    }
    let all = by["all"];
    // If an oscillation begins slowly in strong noise, half a percent of the intervals include slightly more of it than the
    // tolerance.
    assert!(all.moving * 200 <= all.found, "{all:?}");
    assert!((all.missed + all.ends_off) * 50 <= all.intervals, "{all:?}");
}
