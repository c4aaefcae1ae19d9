//! The journal of a campaign: the finished chunks, appended line by line.

use std::collections::BTreeMap;
use std::fmt::Write as _;
use std::fs::{self, File, OpenOptions};
use std::io::{self, BufRead, BufReader, Read, Seek, SeekFrom, Write};
use std::path::{Path, PathBuf};

use flate2::Crc;
use rins_campaign::RunFailure;

use super::table::Identity;
use crate::error::IoError;
use crate::output::{Overwrite, write_file};

/// The numbers of a run, as many for each run of a campaign, or why it has none.
pub type JournalRun = Result<Vec<f64>, RunFailure>;

/// The journal of a campaign, with which an interrupted campaign can be resumed.
///
/// The first line identifies the campaign. A chunk consists of a line with its index, a line for each run with
/// the bits of its numbers, and a final line with the CRC-32 of the others. A chunk without final line, or with a wrong
/// checksum, does not count. The runs stay on the disk; only the positions of the chunks are in memory.
#[derive(Debug)]
pub struct Journal {
    path: PathBuf,
    file: File,
    chunks: Places,
    /// The position of the next chunk \[bytes\].
    end: u64,
    /// How many numbers a run has.
    numbers: usize,
}

/// The position of each finished chunk \[bytes\], and its number of runs.
type Places = BTreeMap<u64, (u64, u64)>;

/// The maximum length of a stored failure reason \[characters\].
const LONGEST_REASON: usize = 1 << 13;

/// The longest line of a chunk \[bytes\]: 61,000 numbers, more than the largest model has.
const LONGEST_LINE: u64 = 1 << 20;

impl Journal {
    /// Creates a journal at `path` of runs with this number of numbers, and replaces an existing one if that is permitted.
    ///
    /// # Errors
    /// [`IoError::Output`] if an existing file must not be replaced, [`IoError::File`] on a system error; no journal of this
    /// campaign exists then.
    pub fn create(
        path: &Path,
        identity: &Identity,
        numbers: usize,
        overwrite: Overwrite,
    ) -> Result<Self, IoError> {
        let failed = || IoError::file("write", path);
        write_file(path, overwrite, |out| writeln!(out, "{}", identity.line()).map_err(failed()))?;
        let file = OpenOptions::new().read(true).append(true).open(path).map_err(failed())?;
        let end = file.metadata().map_err(failed())?.len();
        Ok(Self { path: path.into(), file, chunks: Places::new(), end, numbers })
    }

    /// Opens the journal at `path` to be continued.
    ///
    /// Data after its last finished chunk are cut off. `None` if the journal belongs to another campaign.
    ///
    /// # Errors
    /// [`IoError::File`] on a system error.
    pub fn resume(
        path: &Path,
        identity: &Identity,
        numbers: usize,
    ) -> Result<Option<Self>, IoError> {
        let failed = || IoError::file("read", path);
        let file = OpenOptions::new().read(true).append(true).open(path).map_err(failed())?;
        let Some((chunks, end)) = places(&file, &identity.line(), numbers).map_err(failed())?
        else {
            return Ok(None);
        };
        file.set_len(end).map_err(failed())?;
        Ok(Some(Self { path: path.into(), file, chunks, end, numbers }))
    }

    /// The number of runs of a finished chunk; `None` if it is not finished.
    pub fn len_of(&self, chunk: u64) -> Option<u64> {
        self.chunks.get(&chunk).map(|(_, runs)| *runs)
    }

    /// The results of the runs of a finished chunk.
    ///
    /// # Errors
    /// [`IoError::File`] on a system error, or if the chunk no longer exists.
    pub fn runs(&mut self, chunk: u64) -> Result<Vec<JournalRun>, IoError> {
        let failed = || IoError::file("read", &self.path);
        let lost = || failed()(io::Error::new(io::ErrorKind::InvalidData, "portion lost"));
        let (place, _) = self.chunks.get(&chunk).ok_or_else(lost)?;
        self.file.seek(SeekFrom::Start(*place)).map_err(failed())?;
        match next_chunk(&mut Lines::of(&self.file), self.numbers).map_err(failed())? {
            Some((index, runs)) if index == chunk => Ok(runs),
            _ => Err(lost()),
        }
    }

    /// Appends a finished chunk.
    ///
    /// # Errors
    /// [`IoError::File`] on a system error.
    pub fn add(&mut self, chunk: u64, runs: &[JournalRun]) -> Result<(), IoError> {
        let mut text = format!("chunk {chunk} {}\n", runs.len());
        for run in runs {
            match run {
                Ok(numbers) => {
                    for number in numbers {
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

    /// Synchronizes the journal with the disk.
    ///
    /// # Errors
    /// [`IoError::File`] on a system error.
    pub fn synchronise(&self) -> Result<(), IoError> {
        self.file.sync_data().map_err(IoError::file("write", &self.path))
    }

    /// Removes the journal of a campaign whose results are written.
    ///
    /// # Errors
    /// [`IoError::File`] on a system error.
    pub fn remove(self) -> Result<(), IoError> {
        fs::remove_file(&self.path).map_err(IoError::file("remove", &self.path))
    }
}

/// The lines of a journal, and the position of the next line \[bytes\].
struct Lines<R> {
    reader: R,
    place: u64,
}

impl<'f> Lines<BufReader<&'f File>> {
    /// The lines from the current position of the file.
    fn of(file: &'f File) -> Self {
        Self { reader: BufReader::new(file), place: 0 }
    }
}

impl<R: BufRead> Lines<R> {
    /// The next line, including its line end; a line longer than `longest` is truncated and therefore invalid.
    fn next(&mut self, longest: u64) -> io::Result<String> {
        let mut bytes = Vec::new();
        self.place += self.reader.by_ref().take(longest).read_until(b'\n', &mut bytes)? as u64;
        // A line that was cut within a character is invalid, like a line that was cut elsewhere.
        Ok(String::from_utf8(bytes).unwrap_or_default())
    }
}

/// The finished chunks, and the end of the last one; `None` if the first line belongs to another campaign.
fn places(file: &File, identity: &str, numbers: usize) -> io::Result<Option<(Places, u64)>> {
    let mut lines = Lines::of(file);
    let first = lines.next(LONGEST_LINE.max(identity.len() as u64 + 1))?;
    if first.strip_suffix('\n') != Some(identity) {
        return Ok(None);
    }
    let mut chunks = Places::new();
    let mut end = lines.place;
    while let Some((index, runs)) = next_chunk(&mut lines, numbers)? {
        chunks.insert(index, (end, runs.len() as u64));
        end = lines.place;
    }
    Ok(Some((chunks, end)))
}

/// The next chunk with its index; `None` if it is incomplete.
fn next_chunk(
    lines: &mut Lines<impl BufRead>,
    numbers: usize,
) -> io::Result<Option<(u64, Vec<JournalRun>)>> {
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
        match run(&line, numbers) {
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

fn run(line: &str, numbers: usize) -> Option<JournalRun> {
    let line = line.strip_suffix('\n')?;
    if let Some(reason) = line.strip_prefix("failed ") {
        return Some(Err(RunFailure { reason: reason.into() }));
    }
    let read = line.split_whitespace().map(|bits| {
        (bits.len() == 16).then_some(())?;
        u64::from_str_radix(bits, 16).ok().map(f64::from_bits)
    });
    let read = read.collect::<Option<Vec<f64>>>()?;
    (read.len() == numbers).then_some(Ok(read))
}
