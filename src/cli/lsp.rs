//! `mbint lsp`: the language server.

use super::Failure;
use super::args::LspArgs;
use super::status::Status;

pub(super) fn lsp(args: LspArgs) -> Result<Status, Failure> {
    mbint_lsp::serve(args.root.root).map(|()| Status::Done).map_err(|error| Failure::failed(&error))
}
