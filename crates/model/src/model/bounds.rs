//! `bounds:`, which the methods' own files read.

use crate::methods::{BoundsRequest, keys};
use crate::model::names::Reader;
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::Diagnostic;
use crate::syntax::source::Span;
use crate::syntax::yaml::Node;

/// Reads the section; without one, the first method with its defaults.
pub fn read(reader: &mut Reader, section: Option<(&Node, Span)>) -> Option<BoundsRequest> {
    let uncertain: Vec<String> = reader
        .model
        .uncertain()
        .map(|(_, parameter)| parameter.name.clone())
        .filter(|name| !reader.idle.contains(name))
        .collect();
    let Some((node, at)) = section else { return Some(BoundsRequest::default_for(uncertain.len())) };
    let fields = reader.fields::<keys::Bounds>(node, at.clone())?;
    if uncertain.is_empty() && !reader.diagnostics.has_errors() {
        let message = "no parameter is uncertain: the bounds will all be the nominal motion";
        let help = "give a parameter a `tolerance` or an `interval`".to_owned();
        reader.diagnostics.push(Diagnostic::warning(Code::NothingUncertain, at, message).help(help));
    }
    Some(BoundsRequest::read(reader, &fields, &uncertain))
}
