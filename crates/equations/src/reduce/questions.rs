//! Reduced outputs and requirements: questions, each of which needs some outputs together.

use std::collections::HashSet;

use super::couplings::Member;
use crate::model::Description;

/// A question.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Question {
    /// A reduced output, by number.
    Reduced(usize),
    /// A requirement, by number.
    Requirement(usize),
}

/// All questions of a model whose questions refer to its outputs by index, each with the numbers of the outputs that it
/// needs. A requirement of reduced outputs needs the outputs that these need.
pub fn questions(description: &Description) -> Vec<(Question, Vec<usize>)> {
    let reduced = description.reduced.iter().enumerate();
    let reduced = reduced.map(|(number, own)| (Question::Reduced(number), own.outputs.clone()));
    let of_requirement = |(number, own): (usize, &crate::model::Requirement)| {
        let named: HashSet<&str> = own.slacks.iter().flat_map(|slack| slack.names()).map(|(name, _)| name).collect();
        let of_reduced =
            description.reduced.iter().filter(|known| own.times.is_none() && named.contains(known.name.as_str()));
        let places = own.outputs.iter().chain(of_reduced.flat_map(|known| &known.outputs));
        (Question::Requirement(number), places.copied().collect())
    };
    reduced.chain(description.requirements.iter().enumerate().map(of_requirement)).collect()
}

/// Has every output of a question refer to all parts that the question needs: these are simulated as one mechanism.
pub fn tie(questions: &[(Question, Vec<usize>)], outputs: &mut [Vec<Member>]) {
    for (_, places) in questions.iter().filter(|(_, places)| places.len() > 1) {
        let parts: Vec<Member> = places.iter().flat_map(|&index| outputs[index].clone()).collect();
        places.iter().for_each(|&index| outputs[index].clone_from(&parts));
    }
}
