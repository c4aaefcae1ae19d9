//! What an interrupt does: nothing unfinished is left, or a command that can be continued stops.

use std::process::exit;
use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, OnceLock};

use anyhow::Context;

/// The exit code of a program that is interrupted, as shells have it.
const INTERRUPTED: i32 = 130;

/// What is set by an interrupt, where a command looks at it.
static STOPPED: OnceLock<Arc<AtomicBool>> = OnceLock::new();

/// Listens for an interrupt from now on.
pub(crate) fn listen() -> anyhow::Result<()> {
    ctrlc::set_handler(|| match STOPPED.get() {
        Some(stopped) => stopped.store(true, Ordering::Relaxed),
        None => {
            let _abandoned = rins_io::abandon();
            exit(INTERRUPTED);
        }
    })
    .context("cannot listen for an interrupt")
}

/// What tells a command that it is to stop, which it does by itself from now on.
pub(crate) fn stopped() -> Arc<AtomicBool> {
    Arc::clone(STOPPED.get_or_init(Arc::default))
}
