//! How far a long computation is, for whoever wants to know.

use std::fmt;
use std::sync::Arc;

/// What a computation says of how far it is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Step<'a> {
    /// A stage begins, of so many parts if that is known.
    Begin(&'a str, Option<usize>),
    /// So many parts of the stage are done.
    Done(usize),
    /// What the stage is at, in words.
    At(&'a str),
    /// The stage is over.
    End,
}

type Listener = dyn Fn(Step<'_>) + Send + Sync;

/// Who hears how far a computation is; by default nobody.
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
    /// Told to this function.
    pub fn new(listener: impl Fn(Step<'_>) + Send + Sync + 'static) -> Self {
        Self(Some(Arc::new(listener)))
    }

    /// Begins a stage, which is over when what is returned is dropped.
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
    /// So many parts are done.
    pub(crate) fn done(&self, parts: usize) {
        self.0.say(Step::Done(parts));
    }

    /// It is at this.
    pub(crate) fn at(&self, words: &str) {
        self.0.say(Step::At(words));
    }
}

impl Drop for Stage<'_> {
    fn drop(&mut self) {
        self.0.say(Step::End);
    }
}
