//! `rins merge`: the shards of a campaign as a whole, the same bytes as if it had been run at once.

use std::path::PathBuf;

use rins_io::{Heading, Overwrite, Part, read_part};

use crate::args::Merge;
use crate::commands::campaign_runs::Found;
use crate::outcome::Outcome;
use crate::view::campaign::deliver;

pub(crate) fn run(arguments: &Merge, overwrite: Overwrite) -> anyhow::Result<Outcome> {
    let parts: Vec<(PathBuf, Part)> = arguments
        .parts
        .iter()
        .map(|path| Ok((path.clone(), read_part(path)?)))
        .collect::<anyhow::Result<_>>()?;
    let Part { heading, rows } = joined(parts)?;
    let names: Vec<String> =
        arguments.parts.iter().map(|path| path.display().to_string()).collect();
    let found = Found::of_rows(&rows)?;
    drop(rows);
    let source = (&*names.join(", "), "merge");
    deliver((&heading, &found), &arguments.output, source, overwrite)
}

/// The parts as one, if they are all of one campaign.
fn joined(mut parts: Vec<(PathBuf, Part)>) -> anyhow::Result<Part> {
    parts.sort_by_key(|(_, part)| part.heading.identity.shard);
    let (first_path, first) = &parts[0];
    let identity = first.heading.identity.whole();
    let of = first.heading.identity.shard.1;
    for (expected, (path, part)) in (1..).zip(&parts) {
        anyhow::ensure!(
            part.heading.identity.whole() == identity
                && part.heading.identity.shard.1 == of
                && part.heading.keys == first.heading.keys,
            "{}: not of the campaign of {}",
            path.display(),
            first_path.display()
        );
        anyhow::ensure!(
            part.heading.identity.shard.0 == expected,
            "{}: shard {} of {of}; expected shard {expected}, which is missing or given twice",
            path.display(),
            part.heading.identity.shard.0
        );
    }
    anyhow::ensure!(
        parts.len() as u64 == of,
        "{} of {of} shards are given; shard {} is missing",
        parts.len(),
        parts.len() + 1
    );
    let keys = first.heading.keys.clone();
    let n_cells = parts.iter().map(|(_, part)| part.heading.values.len()).max().unwrap_or_default();
    let mut values = vec![Vec::new(); n_cells];
    let mut rows = Vec::new();
    for (_, part) in parts {
        for row in &part.rows {
            let cell = usize::try_from(row.cell)?;
            values[cell].clone_from(&part.heading.values[cell]);
        }
        rows.extend(part.rows);
    }
    // Stable: the parameters of a run keep their order.
    rows.sort_by_key(|row| (row.cell, row.run));
    Ok(Part { heading: Heading { identity, keys, values }, rows })
}
