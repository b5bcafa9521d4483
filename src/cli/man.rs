//! `mbint man`: manual pages, from the same definitions as the help texts.

use clap::{Command, CommandFactory};
use clap_mangen::Man;

use super::args::{Cli, ManArgs};
use super::console::Console;
use super::{Failure, Status};
use crate::export::write_pages;

pub(super) fn man(args: &ManArgs, console: &mut Console) -> Result<Status, Failure> {
    let mut program = Cli::command();
    program.build();
    let Some(folder) = &args.output else {
        let command = match &args.command {
            None => &program,
            Some(name) => program
                .find_subcommand(name)
                .ok_or_else(|| Failure::wrong(format!("there is no command `{name}`; `mbint --help` lists them")))?,
        };
        return console.print(&page(command)?).map(|()| Status::Done);
    };
    let all = std::iter::once(&program).chain(program.get_subcommands().filter(|command| !command.is_hide_set()));
    let pages = all.map(|command| Ok((format!("{}.1", name(command)), page(command)?)));
    let pages = pages.collect::<Result<Vec<_>, _>>()?;
    let written = write_pages(folder, &pages).map_err(|error| Failure::failed(&error).of(&error))?;
    let lines: String = written.iter().map(|path| format!("{}\n", path.display())).collect();
    console.print(&lines)?;
    Ok(Status::Done)
}

/// `mbint-run` for the command `run`.
fn name(command: &Command) -> &str {
    command.get_display_name().unwrap_or_else(|| command.get_name())
}

fn page(command: &Command) -> Result<String, Failure> {
    let mut page = Vec::new();
    let rendered = Man::new(command.clone()).render(&mut page);
    rendered.map_err(|error| Failure::failed(format!("cannot write the page: {error}")))?;
    Ok(String::from_utf8_lossy(&page).into_owned())
}
