//! Files in memory, for fuzzing at a million reads per minute.

use std::cell::RefCell;
use std::collections::BTreeMap;
use std::io::{self, Cursor};
use std::path::{Path, PathBuf};

use bytes::Bytes;

thread_local! {
    static FILES: RefCell<BTreeMap<PathBuf, Bytes>> = const { RefCell::new(BTreeMap::new()) };
}

/// Sets the content of a file for reads by this thread.
pub fn put(path: &Path, bytes: &[u8]) {
    FILES.with_borrow_mut(|files| files.insert(path.into(), Bytes::copy_from_slice(bytes)));
}

pub(crate) type Source = Cursor<Bytes>;

pub(crate) fn open(path: &Path) -> io::Result<Source> {
    chunks(path).map(Cursor::new)
}

pub(crate) type Chunks = Bytes;

pub(crate) fn chunks(path: &Path) -> io::Result<Chunks> {
    let found = FILES.with_borrow(|files| files.get(path).cloned());
    found.ok_or_else(|| io::ErrorKind::NotFound.into())
}

pub(crate) fn length(path: &Path) -> io::Result<u64> {
    chunks(path).map(|bytes| bytes.len() as u64)
}
