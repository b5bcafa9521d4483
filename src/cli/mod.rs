//! The command line: `args` reads the arguments, and one file per command checks and executes them. `status` has the
//! exit codes.

mod allocate;
mod answer_fmu;
mod args;
mod certificate;
mod check;
mod console;
mod cost;
mod design;
mod effects;
mod explain;
mod export_code;
mod failure;
mod fit;
mod gradient;
mod interrupt;
mod job;
mod joints;
mod kept_run;
mod listing;
mod load;
mod lsp;
mod man;
mod methods;
mod new;
mod profile;
mod progress;
mod question;
mod record;
mod report;
mod request;
mod resolution;
mod run;
mod run_command;
mod sample;
mod scenes;
mod shards;
mod show;
mod snapshot;
mod status;
mod structure;
mod studio;
mod sweep;
mod tree;
pub(crate) mod tuning;
mod verdicts;
mod verify;
mod version;
mod watch;

use std::ffi::OsString;
use std::path::Path;
use std::process::ExitCode;

use clap::{CommandFactory, FromArgMatches};

use self::args::{Cli, Color, Command};
use self::console::Console;
use self::failure::Failure;
use self::status::Status;
use crate::model::shown;
use crate::study;
use crate::syntax::harmless;

/// The program: reads the process' arguments, executes the command and returns its exit code.
pub fn main() -> ExitCode {
    study::record_panics();
    let arguments: Vec<OsString> = std::env::args_os().collect();
    // Before the arguments are read, because errors and help texts are coloured too.
    let color = color(&arguments);
    color.stream().write_global();

    if version::is_asked(&arguments) {
        let printed = Console::default().print(&version::verbose());
        return ExitCode::from(printed.map_or_else(|failure| failure.status(), |()| Status::Done));
    }
    let cli = match parsed(&arguments, color) {
        Ok(cli) => cli,
        // Help and version are errors of clap too, with status 0. A closed pipe is not an error.
        Err(error) => {
            let _ = error.print();
            return ExitCode::from(u8::try_from(error.exit_code()).unwrap_or(2));
        }
    };

    interrupt::listen();
    let mut console = Console::default();
    let executed = study::caught("the command", || execute(cli.command, &mut console));
    let executed = executed.unwrap_or_else(|error| Err(Failure::failed(error.to_string())));
    let status = executed.unwrap_or_else(|failure| console.failure(&failure));
    let status = if console.has_failed() { status.max(Status::Failed) } else { status };
    if status != Status::Done {
        console.more();
    }
    ExitCode::from(status)
}

/// The command. Errors quote harmless forms of the arguments, since clap's messages have colours.
fn parsed(arguments: &[OsString], color: Color) -> Result<Cli, clap::Error> {
    let parse = |arguments: &[OsString]| {
        let matches = Cli::command().color(color.clap()).try_get_matches_from(arguments)?;
        Cli::from_arg_matches(&matches)
    };
    parse(arguments).map_err(|error| {
        let shown: Vec<OsString> = arguments.iter().map(|argument| shown(Path::new(argument)).into()).collect();
        parse(&shown).err().unwrap_or_else(|| clap::Error::raw(error.kind(), harmless(&error.to_string())))
    })
}

fn execute(command: Command, console: &mut Console) -> Result<Status, Failure> {
    match command {
        Command::Run(args) => run_command::run(args, console),
        Command::Sweep(args) => sweep::sweep(args, console),
        Command::Allocate(args) => allocate::allocate(args, console),
        Command::Gradient(args) => gradient::gradient(args, console),
        Command::Design(args) => design::design(args, console),
        Command::Fit(args) => fit::fit(args, console),
        Command::Verify(args) => verify::verify(&args, console),
        Command::VerifyCertificate(args) => certificate::verify(&args, console),
        Command::Check(args) => check::check(&args, console),
        Command::Snapshot(args) => snapshot::snapshot(args, console),
        Command::Cost(args) => cost::cost(args, console),
        Command::Explain(args) => explain::explain(&args, console),
        Command::Report(args) => report::report(&args, console),
        Command::Show(args) => show::show(&args, console),
        Command::Export(args) => export_code::export(&args, console),
        Command::Sample(args) => sample::sample(args, console),
        Command::Plan(args) => shards::plan(args, console),
        Command::Shard(args) => shards::shard(&args, console),
        Command::Status(args) => shards::status(&args, console),
        Command::Merge(args) => shards::merge(args, console),
        Command::Submit(args) => shards::submit(&args, console),
        Command::Schema => console.print(&crate::model::schema()).map(|()| Status::Done),
        Command::Lsp(args) => lsp::lsp(args),
        Command::Studio(args) => studio::studio(args, console),
        Command::New(args) => new::new(&args, console),
        Command::Man(args) => man::man(&args, console),
        Command::AnswerFmu(args) => answer_fmu::answer(&args),
        Command::Completions(args) => {
            let mut script = Vec::new();
            clap_complete::generate(args.shell, &mut Cli::command(), "mbint", &mut script);
            console.print(&String::from_utf8_lossy(&script)).map(|()| Status::Done)
        }
    }
}

/// The last `--color` among the arguments; `auto` if it is missing or wrong, which clap reports.
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
