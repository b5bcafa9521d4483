//! `mbint studio`: a local page on which a model is written, moved and bounded.

use std::process::{Command, Stdio};

use mbint_studio::{Options, StudioError, serve};

use super::args::StudioArgs;
use super::console::Console;
use super::status::Status;
use super::{Failure, interrupt};
use crate::model::{is_robot, is_standard_input};

pub(super) fn studio(args: StudioArgs, console: &mut Console) -> Result<Status, Failure> {
    if is_standard_input(&args.model) {
        return Err(Failure::wrong("standard input cannot be saved: `mbint studio` needs a file"));
    }
    if is_robot(&args.model) {
        let message = "a robot's file alone is not edited here: name it in a model, by `urdf:` or `mjcf:`";
        return Err(Failure::wrong(format!("{}: {message}", args.model.display())));
    }
    // From now on Ctrl-C ends the session, instead of the program at any point.
    interrupt::keep_results(true);
    let mut printed = Ok(());
    let mut started = |address: &str| {
        printed = console.print(&format!("{address}\nThe page is for this machine alone; Ctrl-C ends it\n"));
        if !args.no_open {
            open(address);
        }
    };
    let options = Options {
        model: &args.model,
        root: args.root.root,
        port: args.port,
        started: &mut started,
        is_ended: &interrupt::asked,
    };
    serve(options).map_err(|error| match error {
        StudioError::Folder(_) | StudioError::Random(_) => Failure::failed(error.to_string()),
        error => Failure::wrong(error.to_string()),
    })?;
    printed?;
    console.print("the studio has ended\n")?;
    Ok(Status::Done)
}

/// Opens the address in the browser of the desktop, if there is one: it is printed, too.
fn open(address: &str) {
    let (program, arguments): (&str, &[&str]) = if cfg!(target_os = "macos") {
        ("open", &[])
    } else if cfg!(windows) {
        ("cmd", &["/c", "start", ""])
    } else {
        ("xdg-open", &[])
    };
    let mut command = Command::new(program);
    command.args(arguments).arg(address).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    // A machine without a desktop has no such program.
    let _ = command.spawn();
}
