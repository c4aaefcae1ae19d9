//! Text above the header of a log.

use proptest::prelude::*;
use rins_io::Omission;

use crate::support::{RIG, log, read_files};

/// A line of a preamble, which has fewer fields than the log for any delimiter.
fn preamble_line() -> impl Strategy<Value = String> {
    prop_oneof![
        "[A-Z][a-z]{1,8} [a-z]{1,8}: [0-9]{1,4}(\\.[0-9])?",
        "[A-Z][a-z]{1,8},[0-9]{1,4}",
        "[A-Z][a-z]{1,8};[a-z]{1,5};[0-9]{1,4}",
        "\\[[a-z]{3,9}\\]",
        "// [A-Z][a-z]{1,8}: [0-9]{1,3}\\.[0-9]Hz",
        "# [a-z, ]{0,20}",
        "[0-9]{1,3}\t[a-z]{1,5}",
        Just(String::new()),
        Just("Start Time,2021-07-05 10:00:00,UTC".to_owned()),
    ]
}

proptest! {
    /// Text above the header, or above the first row, has no effect.
    #[test]
    fn preambles_are_passed_over(
        above in prop::collection::vec(preamble_line(), 0..12),
        delimiter in prop::sample::select(vec![",", ";", "\t", "  "]),
        has_header in any::<bool>(),
        has_units in any::<bool>(),
        ends_with_delimiter in any::<bool>(),
    ) {
        let right = log(40);
        let expected = read_files(&[("rig.toml", RIG.as_bytes()), ("run.csv", right.as_bytes())]).unwrap();
        let (header, rows) = right.split_once('\n').unwrap();
        let rig = if has_header {
            RIG.to_owned()
        } else {
            RIG.replace("column = \"t\"", "column = \"1\"")
                .replace("[\"gx\", \"gy\", \"gz\"]", "[\"2\", \"3\", \"4\"]")
                .replace("[\"ax\", \"ay\", \"az\"]", "[\"5\", \"6\", \"7\"]")
                .replace("column = \"table\"", "column = \"8\"")
        };
        let mut table = String::new();
        if has_header {
            table = header.to_owned() + "\n";
            if has_units {
                table += "s,rad/s,rad/s,rad/s,m/s2,m/s2,m/s2,deg\n";
            }
        }
        let rows = if ends_with_delimiter && delimiter != "  " { rows.replace('\n', ",\n") } else { rows.into() };
        let table = (table + &rows).replace(',', delimiter);
        let above: String = above.iter().map(|line| format!("{line}\n")).collect();
        let text = above + &table;
        let loaded = read_files(&[("rig.toml", rig.as_bytes()), ("run.csv", text.as_bytes())]);
        let loaded = loaded.map_err(|error| TestCaseError::fail(format!("{error}: {text}")))?;
        prop_assert_eq!(loaded.recording, expected.recording);
    }
}

/// A truncated first row is a damaged row, not a preamble.
#[test]
fn damaged_first_row_is_no_preamble() {
    let right = log(40);
    let (header, rows) = right.split_once('\n').unwrap();
    let (first, others) = rows.split_once('\n').unwrap();
    let cut = first.rsplit_once(',').unwrap().0;
    // The gyro that is constant otherwise had its other number in the first row.
    let others = others.replacen(",2.5e-6,", ",3e-6,", 1);
    let text = format!("{header}\n{cut}\n{others}");
    let loaded = read_files(&[("rig.toml", RIG.as_bytes()), ("run.csv", text.as_bytes())]).unwrap();
    let left_out = &loaded.summary.left_out;
    assert_eq!((left_out[0].line, left_out[0].reason), (2, Omission::Damaged));
    assert_eq!((left_out.len(), loaded.recording.len()), (1, 39));
}
