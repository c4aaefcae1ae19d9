//! Calls that take time: without the GIL, with progress reports, and interruptible.

use std::any::Any;
use std::ffi::OsString;
use std::panic::{self, AssertUnwindSafe};
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Mutex, PoisonError, mpsc};
use std::thread;
use std::time::{Duration, Instant};

use pyo3::exceptions::{PyOSError, PyRuntimeError};
use pyo3::prelude::*;
use rins::{Progress, Step};

/// The longest time until a signal is noticed.
const POLL: Duration = Duration::from_millis(20);

/// The least time between two progress reports within a stage.
const BETWEEN_REPORTS: Duration = Duration::from_millis(50);

/// The time that a call with a flag of its own has to stop by itself.
const GRACE: Duration = Duration::from_millis(100);

/// The stack of the thread of a call, that of a main thread.
const STACK: usize = 8 << 20;

/// The reason why the thread of a call is unwound: nobody waits for its result any more.
struct Stopped;

/// What a call reports to, and what stops it.
pub(crate) struct Call {
    callback: Option<Py<PyAny>>,
    /// Set if the call is to stop.
    stopped: Arc<AtomicBool>,
    /// Whether the work looks at `stopped` by itself and returns.
    returns_by_itself: bool,
}

impl Call {
    /// A call with this function for progress reports: `callback(stage, done, total)`.
    pub(crate) fn new(callback: Option<Py<PyAny>>) -> Self {
        Self { callback, stopped: Arc::default(), returns_by_itself: false }
    }

    /// A call whose work looks at the returned flag and returns.
    pub(crate) fn with_flag(callback: Option<Py<PyAny>>) -> (Self, Arc<AtomicBool>) {
        let call = Self { returns_by_itself: true, ..Self::new(callback) };
        let flag = Arc::clone(&call.stopped);
        (call, flag)
    }

    /// Does `work` on another thread, without the GIL.
    ///
    /// # Errors
    /// The exception of a signal handler, as `KeyboardInterrupt`, or of the progress function. The work then stops at its next
    /// progress report, and its result is dropped.
    pub(crate) fn run<T: Send + 'static>(
        self,
        py: Python<'_>,
        work: impl FnOnce(&Progress) -> T + Send + 'static,
    ) -> PyResult<T> {
        let raised = Arc::new(Mutex::new(None));
        let Self { callback, stopped, returns_by_itself } = self;
        let progress = match (&callback, returns_by_itself) {
            (None, true) => Progress::default(),
            _ => reports(callback, Arc::clone(&stopped), Arc::clone(&raised), returns_by_itself),
        };
        let (sender, receiver) = mpsc::channel();
        let work = move || {
            let done = panic::catch_unwind(AssertUnwindSafe(|| work(&progress)));
            // Nobody may be waiting any more.
            let _ = sender.send(done);
        };
        let thread = thread::Builder::new().name("rins".into()).stack_size(STACK).spawn(work);
        thread.map_err(|error| PyOSError::new_err(error.to_string()))?;
        // Shared, since a receiver must not be used by two threads.
        let receiver = Mutex::new(receiver);
        let wait = |time| {
            let receiver = receiver.lock().unwrap_or_else(PoisonError::into_inner);
            receiver.recv_timeout(time)
        };
        loop {
            match py.detach(|| wait(POLL)) {
                Ok(done) => return ended(done, &raised),
                Err(mpsc::RecvTimeoutError::Timeout) => {
                    if let Err(interrupt) = py.check_signals() {
                        stopped.store(true, Ordering::Relaxed);
                        if returns_by_itself {
                            let _ = py.detach(|| wait(GRACE));
                        }
                        return Err(interrupt);
                    }
                }
                Err(mpsc::RecvTimeoutError::Disconnected) => {
                    return Err(PyRuntimeError::new_err("the computation ended without a result"));
                }
            }
        }
    }
}

/// The exception of the progress function.
type Raised = Arc<Mutex<Option<PyErr>>>;

fn ended<T>(done: Result<T, Box<dyn Any + Send>>, raised: &Raised) -> PyResult<T> {
    let exception = raised.lock().unwrap_or_else(PoisonError::into_inner).take();
    match (done, exception) {
        (_, Some(exception)) => Err(exception),
        (Ok(done), None) => Ok(done),
        (Err(payload), None) if payload.is::<Stopped>() => {
            Err(PyRuntimeError::new_err("the computation was stopped"))
        }
        (Err(payload), None) => panic::resume_unwind(payload),
    }
}

/// A listener that calls a Python function from the thread of the computation, and stops the computation if asked.
fn reports(
    callback: Option<Py<PyAny>>,
    stopped: Arc<AtomicBool>,
    raised: Raised,
    returns_by_itself: bool,
) -> Progress {
    struct Stage {
        name: String,
        total: Option<usize>,
        reported: Instant,
    }
    let stage: Mutex<Option<Stage>> = Mutex::new(None);
    Progress::new(move |step| {
        // The stages end while the thread unwinds.
        if thread::panicking() {
            return;
        }
        if stopped.load(Ordering::Relaxed) {
            if !returns_by_itself {
                // No panic that is reported: the hook is not called.
                panic::resume_unwind(Box::new(Stopped));
            }
            return;
        }
        let Some(callback) = &callback else { return };
        let mut current = stage.lock().unwrap_or_else(PoisonError::into_inner);
        let now = Instant::now();
        let (name, done, total) = match (step, current.as_mut()) {
            (Step::Begin(name, total), _) => {
                *current = Some(Stage { name: name.into(), total, reported: now });
                (name.to_owned(), Some(0), total)
            }
            (Step::End, Some(_)) => match current.take() {
                Some(Stage { name, total, .. }) => (name, total, total),
                None => return,
            },
            (_, Some(stage)) if now - stage.reported < BETWEEN_REPORTS => return,
            (Step::Done(parts), Some(stage)) => {
                stage.reported = now;
                (stage.name.clone(), Some(parts), stage.total)
            }
            (Step::At(words), Some(stage)) => {
                stage.reported = now;
                (words.to_owned(), None, stage.total)
            }
            (_, None) => return,
        };
        drop(current);
        let called = Python::attach(|py| callback.call1(py, (name, done, total)).map(drop));
        if let Err(exception) = called {
            *raised.lock().unwrap_or_else(PoisonError::into_inner) = Some(exception);
            stopped.store(true, Ordering::Relaxed);
            if !returns_by_itself {
                panic::resume_unwind(Box::new(Stopped));
            }
        }
    })
}

/// Runs the `rins` command with these words, the first of which is the name of the program, and returns its exit code.
///
/// It is for the main function of the console script: an interrupt ends the process.
#[pyfunction]
pub(crate) fn command(py: Python<'_>, words: Vec<OsString>) -> u8 {
    py.detach(|| rins_cli::run(words))
}
