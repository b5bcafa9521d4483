//! The order in which parameters are evaluated.

use super::ParameterDraft;
use crate::model::names::Reader;
use crate::syntax::codes::Code;
use crate::syntax::diagnostic::Diagnostic;
use crate::syntax::suggest;

/// An order in which every parameter stands behind those it uses: the file's, where that is one. Circles are
/// reported, and broken where they close.
pub fn in_order(reader: &mut Reader, drafts: &[ParameterDraft]) -> Vec<usize> {
    #[derive(Clone, Copy, PartialEq)]
    enum Mark {
        New,
        Open,
        Done,
    }
    let mut marks = vec![Mark::New; drafts.len()];
    let mut order = Vec::with_capacity(drafts.len());
    // Uncertain parameters keep the file's order among themselves, whatever uses them.
    let in_file_order = drafts.iter().enumerate().all(|(index, draft)| draft.uses.iter().all(|&used| used < index));
    let (mut roots, rest): (Vec<usize>, Vec<usize>) =
        (0..drafts.len()).partition(|&index| in_file_order || drafts[index].spec.is_uncertain());
    roots.extend(rest);
    for root in roots {
        let mut path: Vec<(usize, usize)> = vec![(root, 0)];
        if marks[root] != Mark::New {
            continue;
        }
        marks[root] = Mark::Open;
        while let Some((index, next)) = path.last_mut() {
            let index = *index;
            match drafts[index].uses.get(*next) {
                None => {
                    marks[index] = Mark::Done;
                    order.push(index);
                    path.pop();
                }
                Some(&used) => {
                    *next += 1;
                    match marks[used] {
                        Mark::New => {
                            marks[used] = Mark::Open;
                            path.push((used, 0));
                        }
                        Mark::Open => {
                            let start = path.iter().position(|(index, _)| *index == used).unwrap_or(0);
                            let circle: Vec<usize> = path[start..].iter().map(|(index, _)| *index).collect();
                            report_circle(reader, drafts, &circle);
                        }
                        Mark::Done => {}
                    }
                }
            }
        }
    }
    order
}

fn report_circle(reader: &mut Reader, drafts: &[ParameterDraft], circle: &[usize]) {
    let name = |index: usize| suggest::clip(&reader.model.parameters[index].name);
    let shown: Vec<String> = circle.iter().take(8).map(|&index| name(index)).collect();
    let more = if circle.len() > 8 { " → …" } else { "" };
    let message = format!("parameters depend on each other in a circle: {}{more} → {}", shown.join(" → "), shown[0]);
    let mut diagnostic = Diagnostic::error(Code::Circle, drafts[circle[0]].name_span.clone(), message);
    for &index in circle.iter().skip(1).take(3) {
        diagnostic = diagnostic.also(drafts[index].name_span.clone(), "also in it");
    }
    reader.diagnostics.push(diagnostic);
}
