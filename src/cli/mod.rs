//! The command line. Arguments are read (`args`), checked and built once into what a command needs, and carried out
//! by one file a command.
//!
//! Exit status: 0 done; 1 the run failed; 2 the command or the model is wrong; 3 done, but
//! at some time no method resolves an output; 130 interrupted.

mod args;
mod check;
mod console;
mod cost;
mod effects;
mod explain;
mod interrupt;
mod joints;
mod load;
mod methods;
mod new;
mod progress;
mod run;
mod scenes;
mod table;
mod tree;

use std::ffi::OsString;
use std::process::ExitCode;

use clap::{ColorChoice, CommandFactory, FromArgMatches};

use self::args::{Cli, Color, Command};
use self::console::Console;

/// How a command ended; the worse, the greater.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
enum Status {
    Done,
    Unresolved,
    Failed,
    Interrupted,
    Wrong,
}

impl From<Status> for ExitCode {
    fn from(status: Status) -> Self {
        Self::from(match status {
            Status::Done => 0,
            Status::Failed => 1,
            Status::Wrong => 2,
            Status::Unresolved => 3,
            // A shell's number for what SIGINT ends.
            Status::Interrupted => interrupt::STATUS,
        })
    }
}

/// Why a command came to an end before its time, in words for the user.
#[derive(Debug)]
enum Failure {
    /// The command or the model is wrong.
    Wrong(String),
    /// It was right, and failed all the same.
    Failed(String),
}

/// The program: reads the process' arguments, does what they say and tells how it went.
pub fn main() -> ExitCode {
    let arguments: Vec<OsString> = std::env::args_os().collect();
    // Before the arguments are read, for the errors and help texts that reading them gives.
    let color = color(&arguments);
    color.stream().write_global();

    let command = Cli::command().color(color.clap());
    let parsed = command.try_get_matches_from(arguments).and_then(|matches| Cli::from_arg_matches(&matches));
    let cli = match parsed {
        Ok(cli) => cli,
        // Help and version come this way too, with status 0. A closed pipe is no error.
        Err(error) => {
            let _ = error.print();
            return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2));
        }
    };

    let mut console = Console::default();
    let status = carry_out(cli.command, &mut console).unwrap_or_else(|failure| {
        let (message, status) = match failure {
            Failure::Wrong(message) => (message, Status::Wrong),
            Failure::Failed(message) => (message, Status::Failed),
        };
        console.error(&message);
        status
    });
    ExitCode::from(status)
}

fn carry_out(command: Command, console: &mut Console) -> Result<Status, Failure> {
    match command {
        Command::Run(args) => run::run(args, console),
        Command::Check(args) => check::check(&args, console),
        Command::Cost(args) => cost::cost(args, console),
        Command::Explain(args) => explain::explain(&args, console),
        Command::Schema => console.print(&crate::model::schema()).map(|()| Status::Done),
        Command::New(args) => new::new(&args, console),
        Command::Completions(args) => {
            let mut script = Vec::new();
            clap_complete::generate(args.shell, &mut Cli::command(), "mbint", &mut script);
            console.print(&String::from_utf8_lossy(&script)).map(|()| Status::Done)
        }
    }
}

/// The last `--color` among the arguments; `auto` where it is missing or wrong (reading the arguments complains).
fn color(arguments: &[OsString]) -> Color {
    let mut color = Color::Auto;
    let mut arguments = arguments.iter().filter_map(|argument| argument.to_str()).take_while(|a| *a != "--");
    while let Some(argument) = arguments.next() {
        let value = match argument.strip_prefix("--color") {
            Some("") => arguments.next().unwrap_or(""),
            Some(value) => value.trim_start_matches('='),
            None => continue,
        };
        color = clap::ValueEnum::from_str(value, false).unwrap_or(Color::Auto);
    }
    color
}

impl Color {
    fn clap(self) -> ColorChoice {
        match self {
            Self::Auto => ColorChoice::Auto,
            Self::Always => ColorChoice::Always,
            Self::Never => ColorChoice::Never,
        }
    }

    fn stream(self) -> anstream::ColorChoice {
        match self {
            Self::Auto => anstream::ColorChoice::Auto,
            Self::Always => anstream::ColorChoice::Always,
            Self::Never => anstream::ColorChoice::Never,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_command_line_is_consistent() {
        Cli::command().debug_assert();
    }

    #[test]
    fn color_is_known_before_the_arguments_are_read() {
        let color = |text: &str| color(&text.split(' ').map(OsString::from).collect::<Vec<_>>());
        assert_eq!(color("mbint run a"), Color::Auto);
        assert_eq!(color("mbint --color never run a"), Color::Never);
        assert_eq!(color("mbint run --color=always"), Color::Always);
        assert_eq!(color("mbint run -- --color=always"), Color::Auto);
        assert_eq!(color("mbint run --color"), Color::Auto);
    }
}
