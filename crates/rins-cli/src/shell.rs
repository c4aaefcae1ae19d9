//! What a shell knows of the command: completions and man pages.

use std::path::Path;

use clap::CommandFactory as _;
use clap_complete::Shell;
use clap_mangen::Man;
use rins_io::{IoError, shown, write_folder};
use serde_json::json;

use crate::args::Arguments;
use crate::deliver::print;

/// Prints the completion script of a shell.
pub(crate) fn print_completions(arguments: &Arguments, shell: Shell) -> anyhow::Result<()> {
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "rins", &mut script);
    let script = String::from_utf8(script)?;
    if !arguments.json {
        return print(&script);
    }
    let result = json!({
        "schema": rins::SCHEMA,
        "command": "completions",
        "shell": shell.to_string(),
        "script": script,
    });
    print(&format!("{result:#}\n"))
}

/// Writes a man page of the command, and one of each of its commands, to a new folder.
pub(crate) fn write_man_pages(arguments: &Arguments, folder: &Path) -> anyhow::Result<()> {
    let mut command = Arguments::command();
    command.build();
    let documented = command.get_subcommands().filter(|one| !one.is_hide_set());
    let pages: Vec<Man> =
        std::iter::once(&command).chain(documented).map(|one| Man::new(one.clone())).collect();
    write_folder(folder, arguments.overwrite(), |folder| {
        pages.iter().try_for_each(|page| {
            let failed = |source| IoError::File { action: "write", path: folder.into(), source };
            page.generate_to(folder).map(drop).map_err(failed)
        })
    })?;
    let names: Vec<String> = pages.iter().map(Man::get_filename).collect();
    print(&if arguments.json {
        format!("{:#}\n", json!({ "schema": rins::SCHEMA, "command": "man", "files": names }))
    } else {
        format!("{} man pages\n\nWritten: {}\n", names.len(), shown(folder))
    })
}
