//! The lines of a log, one by one, in bounded memory.

use std::io::{BufRead, BufReader, Read};
use std::path::{Path, PathBuf};

use super::container::Container;
use super::problem::LogProblem;
use crate::error::{IoError, LogError};
use crate::source::{self, Source};

/// The maximum length of a line \[bytes\].
const LONGEST: u64 = 1 << 20;

/// The lines of a log with numbers or names; blank lines and comments are skipped.
#[derive(Debug)]
pub(crate) struct Lines<R> {
    reader: R,
    path: PathBuf,
    buffer: Vec<u8>,
    number: u64,
    unfinished: Option<u64>,
    /// The number of lines that were passed over.
    skipped: u64,
    comment: Option<String>,
    /// Whether lines that begin with `#`, `%` or `//` are comments.
    commented: bool,
}

impl Lines<BufReader<Source>> {
    pub(crate) fn open(path: &Path) -> Result<Self, IoError> {
        let failed = || IoError::file("read", path);
        let file = source::open(path).map_err(failed())?;
        let mut reader = BufReader::with_capacity(1 << 16, file);
        let beginning = reader.fill_buf().map_err(failed())?;
        if let Some(Container { name, remedy }) = Container::of(beginning) {
            return Err(LogError::of(path, LogProblem::Container { name, remedy }));
        }
        Ok(Self::new(reader, path))
    }

    /// The lines of a log whose messages begin with a character that elsewhere marks a comment.
    pub(crate) fn messages(path: &Path) -> Result<Self, IoError> {
        Ok(Self { commented: false, ..Self::open(path)? })
    }
}

impl<R: BufRead> Lines<R> {
    pub(crate) fn new(reader: R, path: &Path) -> Self {
        Self {
            reader,
            path: path.into(),
            buffer: Vec::new(),
            number: 0,
            unfinished: None,
            skipped: 0,
            comment: None,
            commented: true,
        }
    }

    /// The lines after the first `number` ones of a log.
    pub(crate) fn after(reader: R, path: &Path, number: u64) -> Self {
        Self { number, ..Self::new(reader, path) }
    }

    /// The next line's number, from 1, and its text; `None` at the end.
    ///
    /// A last line without a line end is not returned: it may be truncated.
    pub(crate) fn next(&mut self) -> Result<Option<(u64, &str)>, IoError> {
        while self.fill()? {
            let text = self.text()?;
            let trimmed = text.trim();
            let mark = trimmed.strip_prefix(['#', '%']).or_else(|| trimmed.strip_prefix("//"));
            let comment = mark.filter(|_| self.commented);
            if self.unfinished.is_some() {
                self.unfinished =
                    self.unfinished.filter(|_| comment.is_none() && !trimmed.is_empty());
                return Ok(None);
            } else if let Some(comment) = comment {
                self.comment = Some(comment.trim().to_string());
            } else if !trimmed.is_empty() {
                let number = self.number;
                // Read again from the buffer, because a borrow cannot be returned from a loop that continues.
                return Ok(Some((number, self.text()?)));
            }
        }
        Ok(None)
    }

    /// Passes over this number of lines, whatever is in them.
    pub(crate) fn skip(&mut self, lines: u64) -> Result<(), IoError> {
        self.skipped = lines;
        for _ in 0..lines {
            if !self.fill()? {
                break;
            }
        }
        Ok(())
    }

    /// The last comment so far, without its comment mark.
    pub(super) fn comment(&self) -> Option<&str> {
        self.comment.as_deref()
    }

    pub(super) fn path(&self) -> &Path {
        &self.path
    }

    /// The last line, if it has content but no line end.
    pub(super) fn unfinished(&self) -> Option<u64> {
        self.unfinished
    }

    /// The reason why a log has no readable line.
    pub(super) fn emptiness(&self) -> LogProblem {
        match (self.unfinished, self.skipped) {
            (_, lines @ 1..) => LogProblem::AllSkipped { lines },
            (Some(_), 0) => LogProblem::NoLineEnd,
            (None, 0) => LogProblem::Empty,
        }
    }

    /// The number of lines so far.
    pub(super) fn number(&self) -> u64 {
        self.number
    }

    fn fill(&mut self) -> Result<bool, IoError> {
        self.buffer.clear();
        let mut limited = (&mut self.reader).take(LONGEST + 2);
        let read = limited.read_until(b'\n', &mut self.buffer);
        let length = read.map_err(IoError::file("read", &self.path))?;
        if length == 0 {
            return Ok(false);
        }
        self.number += 1;
        if self.buffer.last() == Some(&b'\n') {
            self.buffer.pop();
        } else {
            self.unfinished = Some(self.number);
        }
        if self.buffer.last() == Some(&b'\r') {
            self.buffer.pop();
        }
        if self.buffer.len() as u64 > LONGEST {
            return Err(self.refuse(LogProblem::LongLine { most: LONGEST }));
        }
        if self.number == 1 && self.buffer.starts_with(b"\xef\xbb\xbf") {
            self.buffer.drain(..3);
        }
        Ok(true)
    }

    fn text(&self) -> Result<&str, IoError> {
        let text = std::str::from_utf8(&self.buffer).ok().filter(|text| !text.contains('\0'));
        text.ok_or_else(|| self.refuse(LogProblem::NotText))
    }

    fn refuse(&self, problem: LogProblem) -> IoError {
        LogError::at(&self.path, self.number, problem)
    }
}
