//! Files found by fuzzing, each of which once caused a panic or an endless loop.

use std::time::{Duration, Instant};

use crate::support::refusal;

const SITE: &str =
    "[site]\nlatitude = \"34.25 deg\"\nlongitude = \"108.9 deg\"\nheight = \"400 m\"\n\n[log]\n";

const COLUMNS: &str = "time = { column = \"t\", unit = \"ns\" }\n\
    gyro = { columns = [\"gx\", \"gy\", \"gz\"], unit = \"rad/s\" }\n\
    accel = { columns = [\"ax\", \"ay\", \"az\"], unit = \"m/s^2\" }\n";

fn said(name: &str, bytes: &[u8]) -> String {
    let rig = format!("{SITE}path = \"{name}\"\n{COLUMNS}");
    refusal(&[("rig.toml", rig.as_bytes()), (name, bytes)])
}

#[test]
fn damaged_parquet_files_are_refused() {
    assert_eq!(
        said("a.parquet", include_bytes!("../data/damaged/negative_place.parquet")),
        "a.parquet: not a Parquet file, or a damaged one: a column's place in the file is negative"
    );
    assert_eq!(
        said("a.parquet", include_bytes!("../data/damaged/no_dictionary.parquet")),
        "a.parquet: not a Parquet file, or a damaged one: Parquet error: a page without its dictionary"
    );
    assert_eq!(
        said("a.parquet", include_bytes!("../data/damaged/short_page.parquet")),
        "a.parquet: not a Parquet file, or a damaged one: Parquet error: a page with fewer numbers than declared"
    );
}

/// A page header contains a list of two billion items, and the file ends.
#[test]
fn a_list_without_an_end_is_not_skipped_item_by_item() {
    let start = Instant::now();
    let said = said("a.parquet", include_bytes!("../data/damaged/endless_list.parquet"));
    assert!(said.starts_with("a.parquet: not a Parquet file, or a damaged one: "), "{said}");
    assert!(start.elapsed() < Duration::from_secs(1), "{:?}", start.elapsed());
}

/// A MATLAB file with one matrix of doubles, `data`.
fn matrix(name: &str, rows: u32, columns: u32, data: &[u8]) -> Vec<u8> {
    let mut file = [b' '; 124].to_vec();
    file.extend([0, 1, b'I', b'M']);
    let name_length = u32::try_from(name.len()).unwrap();
    let padded = name_length.next_multiple_of(8);
    let length = u32::try_from(data.len()).unwrap();
    let words = |file: &mut Vec<u8>, words: &[u32]| {
        for word in words {
            file.extend(word.to_le_bytes());
        }
    };
    words(&mut file, &[14, 48 + padded + length, 6, 8, 6, 0, 5, 8, rows, columns]);
    words(&mut file, &[1, name_length]);
    file.extend(name.bytes());
    file.resize(file.len() + (padded - name_length) as usize, 0);
    words(&mut file, &[9, length]);
    file.extend(data);
    file
}

#[test]
fn four_billion_columns_of_no_rows_end_at_once() {
    let file = matrix("t", 0, u32::MAX - 1, &[]);
    let columns = COLUMNS.replace("\"gx\"", "\"t(:,1)\"");
    let rig = format!("{SITE}path = \"a.mat\"\n{columns}");
    let start = Instant::now();
    let said = refusal(&[("rig.toml", rig.as_bytes()), ("a.mat", &file)]);
    assert_eq!(said, "a.mat: more than 4096 columns");
    assert!(start.elapsed() < Duration::from_secs(1));
}

#[test]
fn names_without_an_end_are_not_all_shown() {
    let said = said("a.mat", &matrix(&"x".repeat(60_000), 2, 1, &[0; 16]));
    assert!(said.starts_with("a.mat: no column \"gx\"; the columns are \"xxxx"), "{said}");
    assert!(said.len() < 200, "{}", said.len());
}
