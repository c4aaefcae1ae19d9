//! What an interrupt does: nothing unfinished is left, or a command that can be continued stops.

use std::process::exit;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

use anyhow::Context;

/// The exit codes of a program that Ctrl-C interrupts and of one that is told to end (SIGTERM), as
/// shells have them.
const INTERRUPTED: i32 = 130;
#[cfg(unix)]
const TERMINATED: i32 = 143;

/// What is set by an interrupt, where a command looks at it.
static STOPPED: OnceLock<Arc<AtomicBool>> = OnceLock::new();

/// Listens for an interrupt from now on.
///
/// A terminal that hangs up (SIGHUP) is left to the system, so that `nohup` does what it says.
pub(crate) fn listen() -> anyhow::Result<()> {
    ctrlc::set_handler(|| end(INTERRUPTED)).context("cannot listen for an interrupt")?;
    #[cfg(unix)]
    {
        let signals = signal_hook::iterator::Signals::new([signal_hook::consts::SIGTERM]);
        let mut signals = signals.context("cannot listen for a signal to end")?;
        std::thread::spawn(move || signals.forever().for_each(|_| end(TERMINATED)));
    }
    Ok(())
}

/// Ends the program, or tells a command that it is to stop.
fn end(code: i32) {
    match STOPPED.get() {
        Some(stopped) => stopped.store(true, Ordering::Relaxed),
        None => {
            let _abandoned = rins_io::abandon();
            exit(code);
        }
    }
}

/// What tells a command that it is to stop, which it does by itself from now on.
pub(crate) fn stopped() -> Arc<AtomicBool> {
    Arc::clone(STOPPED.get_or_init(Arc::default))
}
