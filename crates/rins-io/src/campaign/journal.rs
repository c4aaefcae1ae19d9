//! What is done of a campaign so far: lines that are added as chunks are finished.

use std::fmt::Write as _;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufRead, BufReader, Read, Write};
use std::path::{Path, PathBuf};

use rins_calibration::Estimate;
use rins_campaign::{RunFailure, RunResult};

use super::table::Identity;
use crate::error::IoError;
use crate::output::{Overwrite, write_file};

/// A campaign's journal, which outlives an interruption.
///
/// The first line says which campaign it is. A chunk is a line that names it, a line for each run with
/// the bits of its numbers, and a line that ends it; a chunk without its end does not count.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    file: File,
}

/// The finished chunks of a journal, by their index.
type Done = Vec<(u64, Vec<RunResult>)>;

/// The letters of a failure's reason that are kept.
const LONGEST_REASON: usize = 1 << 13;

/// The longest line of a chunk \[bytes\].
const LONGEST_LINE: u64 = 1 << 16;

/// The numbers of a run: three estimates, their covariance, and the NIS.
const NUMBERS: usize = 13;

impl Journal {
    /// A new journal at `path`, where there must be no other.
    ///
    /// # Errors
    /// [`IoError::Output`] if there is one, [`IoError::File`] if the system refuses; there is then none
    /// of this campaign.
    pub fn create(path: &Path, identity: &Identity) -> Result<Self, IoError> {
        let failed = || IoError::file("write", path);
        write_file(path, Overwrite::Refuse, |out| {
            writeln!(out, "{}", identity.line()).map_err(failed())
        })?;
        let file = OpenOptions::new().append(true).open(path).map_err(failed())?;
        Ok(Self { path: path.into(), file })
    }

    /// The journal at `path`, to be continued, and what it holds.
    ///
    /// What follows its last finished chunk is cut off. `None` if it is another campaign's.
    ///
    /// # Errors
    /// [`IoError::File`] if the system refuses.
    pub fn resume(path: &Path, identity: &Identity) -> Result<Option<(Self, Done)>, IoError> {
        let failed = || IoError::file("read", path);
        let reader = BufReader::new(File::open(path).map_err(failed())?);
        let Some((done, length)) = parse(reader, &identity.line()).map_err(failed())? else {
            return Ok(None);
        };
        let mut file = OpenOptions::new().write(true).open(path).map_err(failed())?;
        file.set_len(length).map_err(failed())?;
        io::Seek::seek(&mut file, io::SeekFrom::End(0)).map_err(failed())?;
        Ok(Some((Self { path: path.into(), file }, done)))
    }

    /// Adds a finished chunk.
    ///
    /// # Errors
    /// [`IoError::File`] if the system refuses.
    pub fn add(&mut self, chunk: u64, runs: &[RunResult]) -> Result<(), IoError> {
        let mut text = format!("chunk {chunk} {}\n", runs.len());
        for run in runs {
            match run {
                Ok(estimate) => {
                    let numbers = estimate.value.iter().chain(estimate.covariance.iter());
                    for number in numbers.chain([&estimate.nis_ratio]) {
                        let _ = write!(text, "{:016x} ", number.to_bits());
                    }
                    text.push('\n');
                }
                Err(failure) => {
                    text += "failed ";
                    text.extend(
                        failure.reason.replace(['\n', '\r'], " ").chars().take(LONGEST_REASON),
                    );
                    text.push('\n');
                }
            }
        }
        text += "end\n";
        let failed = IoError::file("write", &self.path);
        self.file.write_all(text.as_bytes()).map_err(failed)
    }

    /// Makes sure that the disk has all that was added.
    ///
    /// # Errors
    /// [`IoError::File`] if the system refuses.
    pub fn synchronise(&self) -> Result<(), IoError> {
        self.file.sync_data().map_err(IoError::file("write", &self.path))
    }

    /// Removes the journal of a campaign whose results are written.
    ///
    /// # Errors
    /// [`IoError::File`] if the system refuses.
    pub fn remove(self) -> Result<(), IoError> {
        fs::remove_file(&self.path).map_err(IoError::file("remove", &self.path))
    }
}

/// The finished chunks, and where the last of them ends; `None` if the first line is another.
fn parse(mut reader: impl BufRead, identity: &str) -> io::Result<Option<(Done, u64)>> {
    let mut line = String::new();
    let longest = LONGEST_LINE.max(identity.len() as u64 + 1);
    let mut next = |line: &mut String| {
        let mut bytes = Vec::new();
        let length = reader.by_ref().take(longest).read_until(b'\n', &mut bytes)?;
        // What was cut within a letter is no line, as what was cut elsewhere is none.
        *line = String::from_utf8(bytes).unwrap_or_default();
        io::Result::Ok(length as u64)
    };
    let mut place = next(&mut line)?;
    if line.strip_suffix('\n') != Some(identity) {
        return Ok(None);
    }
    let mut done = Vec::new();
    let mut end = place;
    'chunks: loop {
        place += next(&mut line)?;
        let mut words = line.split_whitespace();
        let (Some("chunk"), Some(Ok(index)), Some(Ok(count))) = (
            words.next(),
            words.next().map(str::parse::<u64>),
            words.next().map(str::parse::<usize>),
        ) else {
            break;
        };
        let mut runs = Vec::new();
        for _ in 0..count {
            place += next(&mut line)?;
            match run(&line) {
                Some(run) => runs.push(run),
                None => break 'chunks,
            }
        }
        place += next(&mut line)?;
        if line != "end\n" {
            break;
        }
        done.push((index, runs));
        end = place;
    }
    Ok(Some((done, end)))
}

fn run(line: &str) -> Option<RunResult> {
    let line = line.strip_suffix('\n')?;
    if let Some(reason) = line.strip_prefix("failed ") {
        return Some(Err(RunFailure { reason: reason.into() }));
    }
    let numbers = line.split_whitespace().map(|bits| {
        (bits.len() == 16).then_some(())?;
        u64::from_str_radix(bits, 16).ok().map(f64::from_bits)
    });
    let numbers: [f64; NUMBERS] = numbers.collect::<Option<Vec<_>>>()?.try_into().ok()?;
    Some(Ok(Estimate {
        value: nalgebra::Vector3::from_column_slice(&numbers[..3]),
        covariance: nalgebra::Matrix3::from_column_slice(&numbers[3..12]),
        nis_ratio: numbers[12],
    }))
}
