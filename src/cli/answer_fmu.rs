//! `mbint answer-fmu`: the process that runs a unit of FMI for a black box, so that a crash of the unit is one failed
//! sample.

use super::args::AnswerFmuArgs;
use super::{Failure, Status};

pub(super) fn answer(args: &AnswerFmuArgs) -> Result<Status, Failure> {
    let answered = mbint_fmu::answer(&args.folder, std::io::stdin().lock(), std::io::stdout().lock());
    answered.map(|()| Status::Done).map_err(|error| Failure::failed(&error))
}
