//! A draft of a rig file from a log: its columns, as far as names and numbers identify them.

mod channels;
mod clock_keys;
mod evidence;
mod findings;
mod indexed;
mod label;
mod layout;
mod novatel;
mod pace;
mod page;
mod place;
mod psins;
mod sample;
mod sections;
mod spin;
mod split_pace;
mod stated;
mod table_keys;
mod units;

use std::path::Path;

pub use page::{Draft, Guess, ToFillIn};

use channels::Channels;
use findings::Findings;
use label::Label;
use layout::Layout;
use pace::Pace;
use page::Page;
use sample::Sample;

use crate::error::IoError;

const HOW_TO_GO_ON: [&str; 3] = [
    "Confirm each line marked GUESS. Fill in those marked TO FILL IN and remove their leading #;",
    "optional ones may stay as they are. Then run `rins check` on this file.",
    "Quantities are texts with units, such as \"0.05 deg/h\"; paths are relative to this file.",
];

/// Drafts the rig file of the log at `log`, for a rig file in `folder`.
///
/// Columns are identified by their names or, if these are not meaningful, by their numbers. Units are those of the header or, if
/// it states none, those that give plausible values of gravity, the Earth rate and the table motion. Every such guess is marked
/// `# GUESS: …; confirm` on its line. What cannot be determined is a comment marked `# TO FILL IN: …`, so that [`Rig::read`]
/// reports the key until it is filled in; no value is invented.
///
/// At most about 2000 rows are read: the first ones, and others from positions distributed over the log.
///
/// [`Rig::read`]: crate::Rig::read
///
/// # Errors
/// [`IoError::File`] if the log cannot be read, [`IoError::Log`] if it contains no columns of numbers.
///
/// # Examples
/// ```
/// # let folder = tempfile::tempdir()?;
/// let log = folder.path().join("run.csv");
/// std::fs::write(&log, "Time (s),Gyro X (deg/s),Gyro Y (deg/s),Gyro Z (deg/s),ax,ay,az\n\
///     0.01,0.1,0.2,0.1,0.00,0.02,9.81\n0.02,0.1,0.3,0.1,0.01,0.02,9.82\n")?;
/// let draft = rins_io::draft_rig(&log, folder.path())?;
/// assert!(draft.text.contains("gyro.unit = \"deg/s\"\n"));
/// assert!(draft.text.contains("accel.unit = \"m/s^2\"  # GUESS: "));
/// // Where the table stands, no log of columns says.
/// assert_eq!(draft.to_fill_in[0].key, "site.latitude");
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
pub fn draft_rig(log: &Path, folder: &Path) -> Result<Draft, IoError> {
    let mut page = Page::default();
    let name =
        log.file_name().map_or_else(String::new, |name| crate::shown::shown(Path::new(name)));
    page.remark(&format!("The rig of {name}, drafted by `rins init`."));
    for line in HOW_TO_GO_ON {
        page.remark(line);
    }
    if let Some(sample) = Sample::of_binary(log)? {
        columns(&mut page, log, folder, &sample);
    } else if let Some(header) = psins::header(log)? {
        psins::write(&mut page, log, folder, &header);
    } else if let Some(messages) = novatel::messages(log)? {
        novatel::write(&mut page, log, folder, messages);
    } else {
        let sample = Sample::read(log)?;
        columns(&mut page, log, folder, &sample);
    }
    Ok(page.finish())
}

/// Drafts the rig file of a log with columns.
fn columns(page: &mut Page, log: &Path, folder: &Path, sample: &Sample) {
    let names = sample.names.as_deref().unwrap_or_default();
    let indexed = indexed::with_axes(names);
    let label = |column: usize| match (names.get(column), indexed.get(column)) {
        // That an index counts axes is a guess.
        (_, Some(Some(name))) => Label { sure: false, ..Label::of(name) },
        (Some(name), _) => Label::of(name),
        _ => Label::default(),
    };
    let labels: Vec<Label> = (0..sample.count).map(label).collect();
    let pace = split_pace::find(sample, &labels).or_else(|| Pace::find(sample, &labels));
    let layout = Layout::find(log, sample, &labels, pace.as_ref());
    let findings =
        Findings { log, folder, sample, labels: &labels, pace: pace.as_ref(), layout: &layout };
    let channels = Channels::find(findings);

    sections::site(page);
    page.section("log");
    place::path(page, log, folder);
    if channels.looks_like_kf_gins(sample) {
        sections::kf_gins(page);
        sections::shape(page, sample);
        if let Some(pace) = &pace {
            clock_keys::write_rate(page, pace);
        }
        clock_keys::gaps(page, pace.as_ref());
    } else {
        page.known("format", &page::text(sample.format));
        sections::shape(page, sample);
        clock_keys::write(page, sample, pace.as_ref(), channels.table.is_some());
        channels.write(page, findings);
    }
    table_keys::write(page, findings, channels.table.as_ref());
    sections::attitude(page);
    sections::imu(page);
    spin::spin(page, sample, &channels);
}
