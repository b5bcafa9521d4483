//! Exit codes: one table for the process' status, `--help` and the reference page.

use std::process::ExitCode;

use serde::Serialize;

/// Outcome of a command; the worse, the greater.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub(super) enum Status {
    Done,
    Unresolved,
    NotMet,
    Deferred,
    Failed,
    Interrupted,
    Wrong,
}

/// An exit code, its meaning and the contents of the results' folder afterwards.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize)]
pub(super) struct StatusDocs {
    pub code: u8,
    pub meaning: &'static str,
    pub results: &'static str,
}

impl Status {
    /// All statuses, by their codes.
    pub const ALL: [Self; 7] =
        [Self::Done, Self::Failed, Self::Wrong, Self::Unresolved, Self::NotMet, Self::Deferred, Self::Interrupted];

    pub const fn docs(self) -> StatusDocs {
        let (code, meaning, results) = match self {
            Self::Done => (0, "success", "all results"),
            Self::Failed => (
                1,
                "a run failed, or a bound ended early; the message says where",
                "finished results; the rest is `NaN`",
            ),
            Self::Wrong => (
                2,
                "the command or a model has errors, and nothing was run; or a run was refused because it would take long",
                "no files are written for it",
            ),
            Self::Unresolved => (
                3,
                "success, but no method resolves something that was asked: an output at some time, a reduced output, a statistic; or a requirement is undecided and none violated",
                "all results; unreliable rows are marked",
            ),
            Self::NotMet => (
                4,
                "a condition does not hold: a requirement is violated; with `mbint fit`, no parameters agree with all rows; with `mbint design`, no values meet the requirements; with `mbint verify`, errors do not fall as theory tells; with `mbint verify-certificate`, a bound does not follow; with `mbint snapshot --check`, a bound is not as it was recorded, or nothing is recorded",
                "all results; `mbint snapshot --check` writes nothing",
            ),
            // EX_TEMPFAIL of sysexits.h.
            Self::Deferred => (
                75,
                "`mbint merge`: another round of shards is needed; `mbint status`: shards are missing",
                "results of the models that are complete",
            ),
            // 128 and SIGINT's number, as a shell reports it.
            Self::Interrupted => (
                130,
                "interrupted by Ctrl-C, SIGTERM or SIGHUP; a second one ends the program at once",
                "finished results; the rest is `NaN`",
            ),
        };
        StatusDocs { code, meaning, results }
    }

    pub const fn code(self) -> u8 {
        self.docs().code
    }
}

impl From<Status> for ExitCode {
    fn from(status: Status) -> Self {
        Self::from(status.code())
    }
}

/// The exit codes for `--help`.
pub(super) fn help() -> String {
    let line = |status: Status| format!("  {}  {}\n", status.code(), status.docs().meaning);
    let lines: String = Status::ALL.map(line).concat();
    format!("Exit codes:\n{lines}\nBegin with `mbint new NAME`, which writes a small model to change.")
}
