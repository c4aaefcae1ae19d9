//! What is done of a campaign so far: lines that are added as chunks are finished.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use flate2::Crc;
use rins_calibration::Estimate;
use rins_campaign::{RunFailure, RunResult};

use super::table::Identity;
use crate::error::IoError;
use crate::output::{Overwrite, write_file};

/// A campaign's journal, which outlives an interruption.
///
/// The first line says which campaign it is. A chunk is a line that names it, a line for each run with
/// the bits of its numbers, and a line that ends it with the CRC-32 of the others; a chunk without its end, or with another
/// checksum, does not count. The runs
/// stay on the disk; memory has the chunks' places only.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    file: File,
    chunks: Places,
    /// Where the next chunk goes \[bytes\].
    end: u64,
}

/// Where each finished chunk begins \[bytes\], and how many runs it has.
type Places = BTreeMap<u64, (u64, u64)>;

/// The letters of a failure's reason that are kept.
const LONGEST_REASON: usize = 1 << 13;

/// The longest line of a chunk \[bytes\].
const LONGEST_LINE: u64 = 1 << 16;

/// The numbers of a run: three estimates, their covariance, and the NIS.
const NUMBERS: usize = 13;

impl Journal {
    /// A new journal at `path`, in the place of one that is there if that may be replaced.
    ///
    /// # Errors
    /// [`IoError::Output`] if something is there that must not be replaced, [`IoError::File`] if the system refuses; there is then none
    /// of this campaign.
    pub fn create(path: &Path, identity: &Identity, overwrite: Overwrite) -> Result<Self, IoError> {
        let failed = || IoError::file("write", path);
        write_file(path, overwrite, |out| writeln!(out, "{}", identity.line()).map_err(failed()))?;
        let file = OpenOptions::new().read(true).append(true).open(path).map_err(failed())?;
        let end = file.metadata().map_err(failed())?.len();
        Ok(Self { path: path.into(), file, chunks: Places::new(), end })
    }

    /// The journal at `path`, to be continued.
    ///
    /// What follows its last finished chunk is cut off. `None` if it is another campaign's.
    ///
    /// # Errors
    /// [`IoError::File`] if the system refuses.
    pub fn resume(path: &Path, identity: &Identity) -> Result<Option<Self>, IoError> {
        let failed = || IoError::file("read", path);
        let file = OpenOptions::new().read(true).append(true).open(path).map_err(failed())?;
        let Some((chunks, end)) = places(&file, &identity.line()).map_err(failed())? else {
            return Ok(None);
        };
        file.set_len(end).map_err(failed())?;
        Ok(Some(Self { path: path.into(), file, chunks, end }))
    }

    /// How many runs a finished chunk has; `None` if it is not finished.
    pub fn len_of(&self, chunk: u64) -> Option<u64> {
        self.chunks.get(&chunk).map(|(_, runs)| *runs)
    }

    /// What the runs of a finished chunk found.
    ///
    /// # Errors
    /// [`IoError::File`] if the system refuses, or the chunk is not there any more.
    pub fn runs(&mut self, chunk: u64) -> Result<Vec<RunResult>, IoError> {
        let failed = || IoError::file("read", &self.path);
        let lost = || failed()(io::Error::new(io::ErrorKind::InvalidData, "portion lost"));
        let (place, _) = self.chunks.get(&chunk).ok_or_else(lost)?;
        self.file.seek(SeekFrom::Start(*place)).map_err(failed())?;
        match next_chunk(&mut Lines::of(&self.file)).map_err(failed())? {
            Some((index, runs)) if index == chunk => Ok(runs),
            _ => Err(lost()),
        }
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
        let sum = checksum(&text);
        let _ = writeln!(text, "end {sum:08x}");
        let failed = IoError::file("write", &self.path);
        self.file.write_all(text.as_bytes()).map_err(failed)?;
        self.chunks.insert(chunk, (self.end, runs.len() as u64));
        self.end += text.len() as u64;
        Ok(())
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

/// The lines of a journal, and where the next of them begins \[bytes\].
struct Lines<R> {
    reader: R,
    place: u64,
}

impl<'f> Lines<BufReader<&'f File>> {
    /// From where the file stands.
    fn of(file: &'f File) -> Self {
        Self { reader: BufReader::new(file), place: 0 }
    }
}

impl<R: BufRead> Lines<R> {
    /// The next line, with its end; what is longer is no line.
    fn next(&mut self, longest: u64) -> io::Result<String> {
        let mut bytes = Vec::new();
        self.place += self.reader.by_ref().take(longest).read_until(b'\n', &mut bytes)? as u64;
        // What was cut within a letter is no line, as what was cut elsewhere is none.
        Ok(String::from_utf8(bytes).unwrap_or_default())
    }
}

/// The finished chunks, and where the last of them ends; `None` if the first line is another.
fn places(file: &File, identity: &str) -> io::Result<Option<(Places, u64)>> {
    let mut lines = Lines::of(file);
    let first = lines.next(LONGEST_LINE.max(identity.len() as u64 + 1))?;
    if first.strip_suffix('\n') != Some(identity) {
        return Ok(None);
    }
    let mut chunks = Places::new();
    let mut end = lines.place;
    while let Some((index, runs)) = next_chunk(&mut lines)? {
        chunks.insert(index, (end, runs.len() as u64));
        end = lines.place;
    }
    Ok(Some((chunks, end)))
}

/// The chunk that comes next, and its index; `None` if it is not whole.
fn next_chunk(lines: &mut Lines<impl BufRead>) -> io::Result<Option<(u64, Vec<RunResult>)>> {
    let heading = lines.next(LONGEST_LINE)?;
    let mut words = heading.split_whitespace();
    let (Some("chunk"), Some(Ok(index)), Some(Ok(count))) =
        (words.next(), words.next().map(str::parse::<u64>), words.next().map(str::parse::<usize>))
    else {
        return Ok(None);
    };
    let mut runs = Vec::new();
    let mut sum = Crc::new();
    sum.update(heading.as_bytes());
    for _ in 0..count {
        let line = lines.next(LONGEST_LINE)?;
        sum.update(line.as_bytes());
        match run(&line) {
            Some(run) => runs.push(run),
            None => return Ok(None),
        }
    }
    let whole = lines.next(LONGEST_LINE)? == format!("end {:08x}\n", sum.sum());
    Ok(whole.then_some((index, runs)))
}

/// The CRC-32 of a chunk's lines.
fn checksum(lines: &str) -> u32 {
    let mut sum = Crc::new();
    sum.update(lines.as_bytes());
    sum.sum()
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
