//! Repairs and omissions made while reading a log, which are part of every result.

use std::fmt::Write as _;
use std::path::Path;

use rins_io::shown;
use rins_io::{Gap, Gaps, LogFormat, LogSummary, Omission, Reading, Rig, TableClock};
use rins_report::number::figure;

/// The jitter of time stamps, as a fraction of a sample interval, up to which only the figure is reported.
const ODD_JITTER: f64 = 0.02;

/// A fraction of a second in a suitable unit.
fn short_time(seconds: f64) -> String {
    let units = [(1e-3, "ms"), (1e-6, "us")];
    let (unit, symbol) =
        units.into_iter().find(|(unit, _)| seconds > 0.999 * unit).unwrap_or((1e-9, "ns"));
    // Rounded, so that a decimal unit is printed without binary digits.
    format!("{} {symbol}", (seconds / unit * 1e6).round() / 1e6)
}

/// The repairs and omissions, one sentence each.
pub(crate) fn repairs(rig: &Rig, summary: &LogSummary) -> Vec<String> {
    let mut told = left_out(summary, rig.path.parent());
    told.extend(gaps(rig, summary));
    if summary.jitter_rms > ODD_JITTER * summary.nominal_interval {
        told.push(format!(
            "time stamps jitter by {:.2} ms rms, {:.0} % of an interval: intervals are as long as their stamps say",
            summary.jitter_rms * 1e3,
            summary.jitter_rms / summary.nominal_interval * 100.0
        ));
    }
    told.extend(overflows(summary));
    if let Some(rounded) = summary.rounded {
        told.push(format!(
            "time stamps are rounded to {}: they are those of an even clock of {:.6} Hz, whose intervals are used",
            short_time(rounded.unit),
            rounded.interval.recip()
        ));
    }
    if let Some(TableClock { rate, left_out }) = summary.table_clock {
        told.push(format!(
            "the table angle has its own clock ({} Hz): between its readings it follows the gyro about the spin axis; {left_out} \
             sample(s) outside of its readings are left out",
            figure(rate, 4)
        ));
    }
    if let Some(redivided) = summary.redivided {
        told.push(format!(
            "the accelerometers' {} samples have a clock of their own and were divided anew at the gyros' intervals; {} \
             gyro sample(s) outside of them are left out",
            redivided.samples, redivided.left_out
        ));
    }
    if summary.ramps > 0 {
        told.push(format!(
            "over {} change(s) of rate the table's trajectory is taken from the gyro about the axis of rotation: [table] profile states other \
             ramps, or none",
            summary.ramps
        ));
    }
    if !has_time(rig) {
        told.push("no time column: rows are taken to follow each other without a gap".into());
    }
    told
}

/// The overflows of the time column.
fn overflows(summary: &LogSummary) -> Option<String> {
    let [first, ..] = &summary.overflows[..] else { return None };
    let bits = first.period.log2();
    let period = if bits.fract() == 0.0 {
        format!("a counter of {bits:.0} bits")
    } else {
        format!("a clock that starts again after {} units", figure(first.period, 6))
    };
    let count = match summary.overflows.len() {
        1 => "once".to_owned(),
        count => format!("{count} times"),
    };
    Some(format!(
        "the time column is {period} and overflows {count}, first at sample {}: it is continued",
        first.row + 1
    ))
}

fn has_time(rig: &Rig) -> bool {
    matches!(&rig.log.format, LogFormat::Columns(columns) if columns.time.is_some())
}

/// The lines that are not samples, by file and reason.
fn left_out(summary: &LogSummary, folder: Option<&Path>) -> Vec<String> {
    let alike =
        |a: &rins_io::LeftOut, b: &rins_io::LeftOut| a.path == b.path && a.reason == b.reason;
    let told = summary.left_out.chunk_by(alike).map(|lines| {
        let (first, count) = (&lines[0], lines.len());
        let path = folder.and_then(|folder| first.path.strip_prefix(folder).ok());
        let path = shown(path.unwrap_or(&first.path));
        match first.reason {
            Omission::Repeated => format!(
                "{path}: {count} line(s), from {} on, repeat the line before and are left out",
                first.line
            ),
            Omission::Empty => format!(
                "{path}: {count} line(s), from {} on, have zero in all six readings: they are lost samples and are left out",
                first.line
            ),
            Omission::Damaged => format!(
                "{path}: {count} line(s), from {} on, are damaged here or in another file: they are lost samples and are left out",
                first.line
            ),
            Omission::Unfinished => format!(
                "{path}:{}: the last line has no line end and is left out: it may be cut short",
                first.line
            ),
            _ => format!("{path}:{}: left out", first.line),
        }
    });
    told.collect()
}

fn gaps(rig: &Rig, summary: &LogSummary) -> Option<String> {
    let gaps = &summary.gaps;
    let longest = gaps.iter().max_by(|a: &&Gap, b| a.length.total_cmp(&b.length))?;
    let lost: f64 = gaps.iter().map(|gap| gap.length).sum();
    let rates = match &rig.log.format {
        LogFormat::Columns(columns) => {
            let is_rate = |reading| matches!(reading, Reading::Rate(_));
            let held = columns.gaps == Some(Gaps::Held);
            held || is_rate(columns.gyro.reading) && is_rate(columns.accel.reading)
        }
        LogFormat::Psins => false,
        _ => true,
    };
    let over = if rates || gaps.iter().all(|gap| gap.damaged) {
        "the mean rate of the sample after each is held over it"
    } else {
        "the increment after each is taken to cover it"
    };
    Some(format!(
        "{} gap(s), {lost:.3} s in all, the longest of {:.3} s after {:.3} s: {over}",
        gaps.len(),
        longest.length,
        longest.after
    ))
}

/// A text followed by the repairs and omissions made while reading its log.
pub(crate) fn with_repairs(mut text: String, repairs: &[String]) -> String {
    for repair in repairs {
        // Writing to a string cannot fail.
        let _ = writeln!(text, "  ! {repair}");
    }
    text
}

#[cfg(test)]
mod tests {
    use super::short_time;

    #[test]
    fn units_of_time_stamps_have_no_long_fractions() {
        for power in -9..0 {
            let unit = 10.0_f64.powi(power);
            for seconds in [unit, 1.0 / 10.0_f64.powi(-power), 0.5 * unit] {
                let shown = short_time(seconds);
                assert!(shown.len() <= "100 us".len(), "{seconds}: {shown}");
            }
        }
        assert_eq!(short_time(1e-7), "100 ns");
        assert_eq!(short_time(1e-4), "100 us");
        assert_eq!(short_time(0.01), "10 ms");
    }
}
