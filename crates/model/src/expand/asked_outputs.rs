//! Outputs that replace a model's own: formulas by names, from outside its file.

use crate::syntax::diagnostic::Diagnostics;
use crate::syntax::yaml::{Entry, Node, Scalar, Value};

/// The model's tree with these outputs instead of its `outputs`; messages call their text `outputs`.
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

#[cfg(test)]
mod tests {
    use crate::model::{Changes, Reading, read_text};

    const BAR: &str = "
bodies: { bar: { mass: 1, inertia: 0.01 } }
outputs: { angle: bar.angle }
simulation: { duration: 1 }
";

    fn read(outputs: &[(&str, &str)], more: &str) -> Reading {
        let outputs: Vec<_> = outputs.iter().map(|&(name, formula)| (name.to_owned(), formula.to_owned())).collect();
        read_text("x.yaml", &format!("{BAR}{more}"), Changes { overrides: &[], outputs: Some(&outputs) })
    }

    #[test]
    fn requested_outputs_replace_those_of_the_model() {
        let model = read(&[("place", "bar.x"), ("turn", "bar.angle")], "").description.unwrap();
        let found: Vec<[&str; 2]> = model.outputs.iter().map(|own| [own.name.as_str(), own.unit.as_str()]).collect();
        assert_eq!(found, [["place", "m"], ["turn", "rad"]]);
    }

    #[test]
    fn errors_in_requested_outputs_have_positions() {
        for (outputs, message, place) in [
            ([("x", "bar.x"), ("y", "1 + baz.x")], "unknown body or joint `baz`", (2, 8)),
            ([("a-b", "bar.x"), ("y", "bar.y")], "`a-b` cannot be the name of an output", (1, 1)),
        ] {
            let record = read(&outputs, "").diagnostics.records().remove(0);
            assert_eq!((record.message.as_str(), record.file.as_str()), (message, "outputs"));
            assert_eq!(record.line.zip(record.column), Some(place), "{message}");
        }
        let needs = "requirements: { turns: angle <= 1 }\n";
        assert!(read(&[("x", "bar.x")], needs).diagnostics.has_errors(), "a requirement needs what is left out");
    }
}
