//! Outputs that stand in place of a model's own: formulas by names, from outside its file.

use crate::syntax::diagnostic::Diagnostics;
use crate::syntax::yaml::{Entry, Node, Scalar, Value};

/// The model's tree with these outputs in place of its `outputs`; messages call their text `outputs`.
pub fn write_out(mut root: Node, outputs: &[(String, String)], diagnostics: &mut Diagnostics) -> Node {
    let Value::Mapping(sections) = &mut root.value else { return root };
    let lines: Vec<String> = outputs.iter().map(|(name, formula)| format!("{name}: {formula}\n")).collect();
    let text = lines.concat();
    let start = diagnostics.sources.add("outputs", text.clone());
    let span = start..start + text.len();
    let mut at = start;
    let entries = outputs.iter().zip(&lines).map(|((name, formula), line)| {
        let (key, behind) = (at..at + name.len(), at + name.len() + ": ".len());
        at += line.len();
        let value = Value::Scalar(Scalar::plain(formula.as_str(), Some(behind)));
        let value = Node { span: behind..behind + formula.len(), value };
        Entry { key: name.clone(), key_span: key, value }
    });
    let value = Node { span: span.clone(), value: Value::Mapping(entries.collect()) };
    sections.retain(|entry| entry.key != "outputs");
    sections.push(Entry { key: "outputs".to_owned(), key_span: span, value });
    root
}
