//! What an interrupt does: nothing unfinished is left, or a command that can be continued stops.

use std::process::exit;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

use anyhow::Context;

/// The exit code of a program that Ctrl-C interrupts, as shells have it.
const INTERRUPTED: i32 = 130;

/// Shells have 128 and the signal's number for a program that a signal ended.
#[cfg(unix)]
const SIGNALLED: i32 = 128;

/// What is set by an interrupt, where a command looks at it.
static STOPPED: OnceLock<Arc<AtomicBool>> = OnceLock::new();

/// Listens for an interrupt from now on.
///
/// A terminal that hangs up (SIGHUP) is one, unless that is ignored already, as `nohup` has it.
pub(crate) fn listen() -> anyhow::Result<()> {
    ctrlc::set_handler(|| end(INTERRUPTED)).context("cannot listen for an interrupt")?;
    #[cfg(unix)]
    {
        use signal_hook::consts::{SIGHUP, SIGTERM};
        let heard = if is_hanging_up_ignored() { vec![SIGTERM] } else { vec![SIGTERM, SIGHUP] };
        let signals = signal_hook::iterator::Signals::new(heard);
        let mut signals = signals.context("cannot listen for a signal to end")?;
        std::thread::spawn(move || signals.forever().for_each(|signal| end(SIGNALLED + signal)));
    }
    Ok(())
}

/// Whether the program was started with SIGHUP ignored, by what Linux says of the process; where nothing is said it counts as
/// ignored.
#[cfg(unix)]
fn is_hanging_up_ignored() -> bool {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let ignored = status.lines().find_map(|line| line.strip_prefix("SigIgn:"));
    // The lowest bit is signal 1, SIGHUP.
    let mask = ignored.and_then(|mask| u64::from_str_radix(mask.trim(), 16).ok());
    mask.is_none_or(|mask| mask & 1 != 0)
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
