//! Calibration of a log while it is written: where its bytes come from, and what is shown of it.

use std::fs::File;
use std::io::{self, Read, Write as _};
use std::path::{Path, PathBuf};
use std::sync::atomic::Ordering;
use std::sync::mpsc::{Receiver, RecvTimeoutError, sync_channel};
use std::time::{Duration, Instant};

use anyhow::Context;
use rins::ModelChoice;
use rins::live::{LiveCalibration, LiveEnd, LiveOptions};
use rins_io::{Rig, ensure_replaceable, open_input, shown};

use crate::args::{Arguments, Calibrate, LiveSource};
use crate::deliver::deliver;
use crate::interrupt;
use crate::serve::Server;

/// The time after which a source without new bytes is looked at again.
const PAUSE: Duration = Duration::from_millis(50);

/// The largest number of bytes that are taken at once.
const PORTION: usize = 1 << 16;

/// The name of standard input in messages.
const STANDARD_INPUT: &str = "standard input";

/// A checkpoint is not written before this many times the duration of writing the last one.
const SPARING: u32 = 20;

/// Where the bytes of a log come from.
enum Source {
    /// A file that grows; it may not exist yet.
    File { path: PathBuf, file: Option<File>, length: u64 },
    /// Standard input, which a thread reads.
    Stdin(Receiver<io::Result<Vec<u8>>>),
}

/// What a source has.
enum Portion {
    Bytes(Vec<u8>),
    Nothing,
    End,
}

impl Source {
    fn stdin() -> Self {
        // Some portions are read ahead; a writer that is faster waits.
        let (sender, receiver) = sync_channel(16);
        std::thread::spawn(move || {
            let mut input = io::stdin().lock();
            loop {
                let mut bytes = vec![0; PORTION];
                let read = input.read(&mut bytes).map(|length| {
                    bytes.truncate(length);
                    bytes
                });
                let is_last = read.as_ref().map_or(true, Vec::is_empty);
                if sender.send(read).is_err() || is_last {
                    return;
                }
            }
        });
        Self::Stdin(receiver)
    }

    /// Refuses a file that does not exist yet.
    fn ensure_there(&self) -> anyhow::Result<()> {
        match self {
            Self::File { path, file: None, .. } => {
                let opened = open_input(path);
                opened.map(drop).with_context(|| format!("cannot read {}", shown(path)))
            }
            Self::File { .. } | Self::Stdin(_) => Ok(()),
        }
    }

    /// The next bytes, after a pause if there are none yet.
    fn next(&mut self) -> anyhow::Result<Portion> {
        match self {
            Self::Stdin(receiver) => match receiver.recv_timeout(PAUSE) {
                Ok(read) => {
                    let bytes = read.context("cannot read standard input")?;
                    Ok(if bytes.is_empty() { Portion::End } else { Portion::Bytes(bytes) })
                }
                Err(RecvTimeoutError::Timeout) => Ok(Portion::Nothing),
                Err(RecvTimeoutError::Disconnected) => Ok(Portion::End),
            },
            Self::File { path, file, length } => {
                let failed = || format!("cannot read {}", shown(path));
                if file.is_none() && path.exists() {
                    *file = Some(open_input(path).with_context(failed)?);
                }
                let mut bytes = vec![0; PORTION];
                let read = match file {
                    Some(file) => {
                        let now = file.metadata().with_context(failed)?.len();
                        anyhow::ensure!(
                            now >= *length,
                            "{}: the log has been cut from {length} to {now} bytes while it was read",
                            shown(path)
                        );
                        file.read(&mut bytes).with_context(failed)?
                    }
                    None => 0,
                };
                if read == 0 {
                    std::thread::sleep(PAUSE);
                    return Ok(Portion::Nothing);
                }
                *length += read as u64;
                bytes.truncate(read);
                Ok(Portion::Bytes(bytes))
            }
        }
    }
}

/// What is shown and stored of a calibration while it goes on.
struct Display<'a> {
    arguments: &'a Arguments,
    every: Duration,
    checkpoint: Option<&'a Path>,
    server: Option<Server>,
    shown: Instant,
    stored: Instant,
    sparing: Duration,
}

impl Display<'_> {
    /// Shows a line and writes the checkpoint, where it is time.
    fn update(&mut self, live: &LiveCalibration) -> anyhow::Result<()> {
        if self.shown.elapsed() >= self.every {
            self.shown = Instant::now();
            self.line(&live.line())?;
            if let Some(server) = &self.server {
                server.show(live);
            }
        }
        if self.stored.elapsed() >= self.every.max(self.sparing) {
            self.store(live)?;
        }
        Ok(())
    }

    /// With a JSON result on standard output, lines go to standard error.
    fn line(&self, line: &str) -> anyhow::Result<()> {
        if self.arguments.json {
            // Where nobody listens, nothing is lost.
            let _ = writeln!(io::stderr(), "{line}");
            return Ok(());
        }
        match writeln!(io::stdout(), "{line}") {
            Err(error) if error.kind() != io::ErrorKind::BrokenPipe => {
                Err(error).context("cannot write to standard output")
            }
            _ => Ok(()),
        }
    }

    fn store(&mut self, live: &LiveCalibration) -> anyhow::Result<()> {
        let Some(path) = self.checkpoint else { return Ok(()) };
        let start = Instant::now();
        live.write_checkpoint(path)?;
        self.stored = Instant::now();
        self.sparing = start.elapsed() * SPARING;
        Ok(())
    }
}

/// `rins calibrate --live`.
pub(crate) fn run_live(
    arguments: &Arguments,
    calibrate: &Calibrate,
    source: LiveSource,
) -> anyhow::Result<()> {
    let rig = &calibrate.rigs[0];
    let own = &calibrate.live_options;
    let options = LiveOptions {
        model: calibrate.model.clone().unwrap_or(ModelChoice::Full),
        duration: own.duration,
        start: own.start,
    };
    if let Some(checkpoint) = own.checkpoint.as_deref().filter(|_| !own.resume) {
        ensure_replaceable(checkpoint, arguments.overwrite())?;
    }
    let name = (source == LiveSource::Stdin).then(|| Path::new(STANDARD_INPUT));
    let mut live = match &own.checkpoint {
        Some(checkpoint) if own.resume => LiveCalibration::resume(rig, name, options, checkpoint)?,
        _ => LiveCalibration::new(rig, name, options)?,
    };
    let mut source = match source {
        LiveSource::Stdin => Source::stdin(),
        LiveSource::Log => Source::File { path: Rig::read(rig)?.log.path, file: None, length: 0 },
    };
    let now = Instant::now();
    let mut display = Display {
        arguments,
        every: Duration::from_secs_f64(own.every),
        checkpoint: own.checkpoint.as_deref(),
        server: own.serve.map(Server::start).transpose()?,
        shown: now,
        stored: now,
        sparing: Duration::ZERO,
    };
    let idle = Duration::from_secs_f64(own.idle);
    let end = match follow(&mut live, &mut source, &mut display, idle) {
        Ok(end) => end,
        Err(error) => {
            // What was read until then is not lost.
            display.store(&live)?;
            return Err(error);
        }
    };
    display.store(&live)?;
    deliver(arguments, &live.end(end)?, "")
}

/// Feeds a calibration until its source ends.
fn follow(
    live: &mut LiveCalibration,
    source: &mut Source,
    display: &mut Display<'_>,
    idle: Duration,
) -> anyhow::Result<LiveEnd> {
    let stopped = interrupt::stopped();
    let mut last = Instant::now();
    while !stopped.load(Ordering::Relaxed) {
        match source.next()? {
            Portion::Bytes(bytes) => {
                live.feed(&bytes)?;
                last = Instant::now();
            }
            Portion::Nothing if last.elapsed() >= idle => {
                source.ensure_there()?;
                return Ok(LiveEnd::Idle);
            }
            Portion::Nothing => {}
            Portion::End => return Ok(LiveEnd::Closed),
        }
        display.update(live)?;
    }
    Ok(LiveEnd::Interrupted)
}
