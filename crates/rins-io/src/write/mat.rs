//! Recordings as MATLAB level 5 matrices (‹matfile5›).

use std::io::{self, Write};

use rins_motion::Recording;

use super::failure::Failure;
use super::signals::{channel, others};
use crate::error::WriteProblem;

const MATRIX: u32 = 14;
const DOUBLES: u32 = 9;
const SIGNED_WORDS: u32 = 5;
const WORDS: u32 = 6;
const CHARACTERS: u32 = 1;
const DOUBLE_CLASS: u32 = 6;

/// Writes `time`, the matrices `gyro` and `accel`, and the other signals.
pub(super) fn write(recording: &Recording, out: &mut dyn Write) -> Result<(), Failure> {
    // The length of an element is a 32-bit word.
    if recording.len() > (u32::MAX / 32) as usize {
        let why = "a matrix has less than 4 GB; choose parquet";
        return Err(WriteProblem::TooMuch { what: "so long a log", format: "mat", why }.into());
    }
    let mut header = [b' '; 128];
    let text = b"MATLAB 5.0 MAT-file, written by rins";
    header[..text.len()].copy_from_slice(text);
    header[116..124].fill(0);
    header[124..].copy_from_slice(&[0, 1, b'I', b'M']);
    out.write_all(&header)?;
    let rows = recording.len();
    matrix(out, "time", rows, 1, recording.times.iter().copied())?;
    for (name, first) in [("gyro", 0), ("accel", 3)] {
        let columns = (first..first + 3).flat_map(|place| channel(recording, place));
        matrix(out, name, rows, 3, columns)?;
    }
    for (name, list) in others(recording) {
        matrix(out, name, rows, 1, list.iter().copied())?;
    }
    Ok(())
}

fn tag(out: &mut dyn Write, kind: u32, length: usize) -> io::Result<()> {
    out.write_all(&kind.to_le_bytes())?;
    let length = u32::try_from(length).map_err(|_| io::ErrorKind::InvalidInput)?;
    out.write_all(&length.to_le_bytes())
}

/// One matrix, column by column.
fn matrix(
    out: &mut dyn Write,
    name: &str,
    rows: usize,
    columns: usize,
    numbers: impl Iterator<Item = f64>,
) -> io::Result<()> {
    let padded = name.len().next_multiple_of(8);
    let bytes = 8 * rows * columns;
    tag(out, MATRIX, 16 + 16 + 8 + padded + 8 + bytes)?;
    tag(out, WORDS, 8)?;
    out.write_all(&u64::from(DOUBLE_CLASS).to_le_bytes())?;
    tag(out, SIGNED_WORDS, 8)?;
    for length in [rows, columns] {
        let length = u32::try_from(length).map_err(|_| io::ErrorKind::InvalidInput)?;
        out.write_all(&length.to_le_bytes())?;
    }
    tag(out, CHARACTERS, name.len())?;
    out.write_all(name.as_bytes())?;
    out.write_all(&[0; 8][..padded - name.len()])?;
    tag(out, DOUBLES, bytes)?;
    for number in numbers {
        out.write_all(&number.to_le_bytes())?;
    }
    Ok(())
}
