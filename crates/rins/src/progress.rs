//! Progress reports of a long computation.

use std::fmt;
use std::sync::Arc;

/// One progress report.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step<'a> {
    /// A stage begins, with its number of parts if that is known.
    Begin(&'a str, Option<usize>),
    /// The number of parts of the stage that are done.
    Done(usize),
    /// The current activity of the stage, in words.
    At(&'a str),
    /// The stage has ended.
    End,
}

type Listener = dyn Fn(Step<'_>) + Send + Sync;

/// The listener for progress reports of a computation; by default none.
///
/// ```
/// let progress = rins::Progress::new(|step| eprintln!("{step:?}"));
/// let options = rins::CalibrateOptions { progress, ..rins::CalibrateOptions::default() };
/// ```
#[derive(Clone, Default)]
pub struct Progress(Option<Arc<Listener>>);

impl fmt::Debug for Progress {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(if self.0.is_some() { "Progress(heard)" } else { "Progress(unheard)" })
    }
}

impl Progress {
    /// A listener that is this function.
    pub fn new(listener: impl Fn(Step<'_>) + Send + Sync + 'static) -> Self {
        Self(Some(Arc::new(listener)))
    }

    /// Begins a stage, which ends when the returned value is dropped.
    pub(crate) fn begin(&self, what: &str, length: Option<usize>) -> Stage<'_> {
        self.say(Step::Begin(what, length));
        Stage(self)
    }

    fn say(&self, step: Step<'_>) {
        if let Some(listener) = &self.0 {
            listener(step);
        }
    }
}

/// A stage of a computation.
pub(crate) struct Stage<'a>(&'a Progress);

impl Stage<'_> {
    /// Reports the number of parts that are done.
    pub(crate) fn done(&self, parts: usize) {
        self.0.say(Step::Done(parts));
    }

    /// Reports the current activity.
    pub(crate) fn at(&self, words: &str) {
        self.0.say(Step::At(words));
    }
}

impl Drop for Stage<'_> {
    fn drop(&mut self) {
        self.0.say(Step::End);
    }
}
