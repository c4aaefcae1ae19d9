//! Progress on standard error, for what takes longer than a second.

use std::sync::Mutex;
use std::time::Duration;

use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};
use rins::{Progress, Step};

/// Progress that is drawn on a terminal, a stage after the other.
pub(crate) fn drawn() -> Progress {
    let drawn: Mutex<Option<ProgressBar>> = Mutex::new(None);
    Progress::new(move |step| {
        // A panic elsewhere is told elsewhere.
        let Ok(mut drawn) = drawn.lock() else { return };
        match (step, drawn.as_ref()) {
            (Step::Begin(what, Some(length)), _) => *drawn = Some(bar(length, what)),
            (Step::Begin(what, None), _) => *drawn = Some(spinner(what)),
            (Step::Done(parts), Some(bar)) => bar.set_position(parts as u64),
            (Step::At(words), Some(bar)) => bar.set_message(words.to_owned()),
            (Step::End, Some(bar)) => {
                bar.finish_and_clear();
                *drawn = None;
            }
            (_, None) => {}
        }
    })
}

/// What `work` returns, with a sign of life while it goes on.
pub(crate) fn during<T>(what: &str, work: impl FnOnce() -> T) -> T {
    let spinner = spinner(what);
    let done = work();
    spinner.finish_and_clear();
    done
}

/// A progress bar that shows itself only on a terminal.
fn bar(length: usize, what: &str) -> ProgressBar {
    let bar = ProgressBar::new(length as u64).with_message(what.to_owned());
    bar.set_draw_target(ProgressDrawTarget::stderr_with_hz(10));
    let style = ProgressStyle::with_template("{msg} {bar:40} {percent:>3} %  {eta} left")
        .expect("the template is well-formed");
    bar.set_style(style);
    bar.enable_steady_tick(Duration::from_millis(200));
    bar
}

/// A sign of life for what cannot say how far it has come.
fn spinner(what: &str) -> ProgressBar {
    let spinner = ProgressBar::new_spinner().with_message(what.to_owned());
    spinner.set_draw_target(ProgressDrawTarget::stderr_with_hz(10));
    spinner.enable_steady_tick(Duration::from_millis(200));
    spinner
}
