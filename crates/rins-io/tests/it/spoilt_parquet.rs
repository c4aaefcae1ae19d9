//! Parquet files in every encoding of their numbers, valid and damaged.

use std::fs;
use std::sync::Arc;

use parquet::basic::{Encoding, Repetition, Type};
use parquet::data_type::{DoubleType, Int64Type};
use parquet::file::properties::{WriterProperties, WriterVersion};
use parquet::file::writer::SerializedFileWriter;
use parquet::schema::types::Type as Schema;
use rins_io::{IoError, Loaded, read};

use crate::support::{SITE, folder};

const ROWS: u32 = 150;

const COLUMNS: &str = "[log]\npath = \"run.parquet\"\nrate = \"100 Hz\"\n\
    time = { column = \"t\", unit = \"ns\" }\n\
    gyro = { columns = [\"gx\", \"gy\", \"gz\"], unit = \"rad/s\" }\n\
    accel = { columns = [\"ax\", \"ay\", \"az\"], unit = \"m/s^2\" }\n";

/// The encoding of the columns of a file.
#[derive(Clone, Copy)]
struct Kept {
    version: WriterVersion,
    repetition: Repetition,
    /// That of the times, which are integers; a dictionary if it is `None`.
    times: Option<Encoding>,
}

/// All combinations that differ in the decoders that read them.
fn kinds() -> Vec<Kept> {
    let mut kinds = Vec::new();
    for version in [WriterVersion::PARQUET_1_0, WriterVersion::PARQUET_2_0] {
        for repetition in [Repetition::REQUIRED, Repetition::OPTIONAL] {
            for times in [None, Some(Encoding::PLAIN), Some(Encoding::DELTA_BINARY_PACKED)] {
                kinds.push(Kept { version, repetition, times });
            }
        }
    }
    kinds
}

/// The content of a sensor's column: a few numbers that repeat.
fn values(column: usize) -> Vec<f64> {
    (0..ROWS as usize).map(|row| (column * 100 + row % (5 + column)) as f64 * 1e-3).collect()
}

/// Times at uneven intervals \[ns\].
fn times() -> Vec<i64> {
    (1..=i64::from(ROWS)).map(|row| row * 10_000_000 + (row * row) % 1_000).collect()
}

/// The bytes of a file.
fn file(kept: Kept) -> Vec<u8> {
    let names = ["t", "gx", "gy", "gz", "ax", "ay", "az"];
    let column = |name: &&str| {
        let kind = if *name == "t" { Type::INT64 } else { Type::DOUBLE };
        let column =
            Schema::primitive_type_builder(name, kind).with_repetition(kept.repetition).build();
        Arc::new(column.unwrap())
    };
    let schema = Schema::group_type_builder("run")
        .with_fields(names.iter().map(column).collect())
        .build()
        .unwrap();
    let properties = WriterProperties::builder().set_writer_version(kept.version);
    let properties = match kept.times {
        None => properties,
        Some(encoding) => properties
            .set_column_dictionary_enabled("t".into(), false)
            .set_column_encoding("t".into(), encoding),
    };
    let mut bytes = Vec::new();
    let mut writer =
        SerializedFileWriter::new(&mut bytes, Arc::new(schema), Arc::new(properties.build()))
            .unwrap();
    let mut group = writer.next_row_group().unwrap();
    let levels = (kept.repetition == Repetition::OPTIONAL).then(|| vec![1; ROWS as usize]);
    let mut place = 0;
    while let Some(mut column) = group.next_column().unwrap() {
        if place == 0 {
            let writer = column.typed::<Int64Type>();
            writer.write_batch(&times(), levels.as_deref(), None).unwrap();
        } else {
            let writer = column.typed::<DoubleType>();
            writer.write_batch(&values(place), levels.as_deref(), None).unwrap();
        }
        column.close().unwrap();
        place += 1;
    }
    group.close().unwrap();
    writer.close().unwrap();
    bytes
}

/// A folder with a rig, whose log is written again for each of about ten thousand reads.
struct Rig(tempfile::TempDir);

impl Rig {
    fn new() -> Self {
        Self(folder(&[("rig.toml", format!("{SITE}{COLUMNS}").as_bytes())]))
    }

    fn read(&self, log: &[u8]) -> Result<Loaded, IoError> {
        let path = self.0.path().join("run.parquet");
        fs::write(&path, log).unwrap();
        let loaded = read(&self.0.path().join("rig.toml"));
        // Data written over an existing file go to the disk at once, which takes most of the time.
        fs::remove_file(path).unwrap();
        loaded
    }
}

#[test]
fn all_encodings_are_read_alike() {
    let rig = Rig::new();
    for kept in kinds() {
        let read = rig.read(&file(kept)).unwrap().recording;
        assert_eq!(read.len(), ROWS as usize);
        for row in 1..read.len() {
            let step = (times()[row] - times()[row - 1]) as f64 * 1e-9;
            assert!((read.times[row] - read.times[row - 1] - step).abs() < 1e-12);
            let turned = read.increments[row].angle.components().z - values(3)[row] * step;
            assert!(turned.abs() < 1e-12, "{turned}");
        }
    }
}

/// Variable-length integers, in the headers of runs and of differences, that are longer than permitted.
#[test]
fn numbers_without_an_end_are_refused_wherever_they_begin() {
    let rig = Rig::new();
    let mut endless = 0;
    for kept in kinds() {
        let whole = file(kept);
        for place in 0..whole.len() - 11 {
            let mut spoilt = whole.clone();
            spoilt[place..place + 11].fill(0xff);
            if let Err(error) = rig.read(&spoilt) {
                endless += usize::from(error.to_string().contains("an unterminated number"));
            }
        }
    }
    assert!(endless > 100, "{endless}");
}

/// The parser allocates memory for the number of values that a dictionary states, before it reads them.
#[test]
fn a_dictionary_has_the_numbers_that_it_says() {
    // The header of a dictionary page: a structure with the count.
    let (said, more) = ([0x4c, 0x15, 0xac, 0x02], [0x4c, 0x15, 0xfe, 0x7f]);
    let mut spoilt = file(kinds()[0]);
    let place = spoilt.windows(said.len()).position(|bytes| bytes == said).unwrap();
    spoilt[place..place + more.len()].copy_from_slice(&more);
    let refused = Rig::new().read(&spoilt).unwrap_err().to_string();
    assert!(refused.contains("a page with fewer numbers than declared"), "{refused}");
}
