//! Description → [`Reduction`]: the parts of a mechanism that have to be simulated for the requested outputs.
//!
//! - `welds`: bodies that are welded together become one, unless an output needs the weld's reaction;
//! - `couplings`: which bodies, joints and effects are coupled; the ground couples nothing;
//! - parts that no output depends on are omitted;
//! - coupled parts are a subsystem, a model of its own (`extract`), with the uncertain parameters that it refers to,
//!   and those of the `questions` whose outputs it has.
//!
//! A model of one subsystem without omitted parts stays as it is.

mod couplings;
mod extract;
mod questions;
mod sets;
mod welds;

use std::collections::HashSet;

use crate::model::Description;

use couplings::{Couplings, Member};
use extract::SubsystemQuestions;
use questions::{Question, questions, tie};

pub use extract::{narrow, required};
pub use welds::Weld;

/// Reductions that are applied; all by default.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Choices {
    /// Whether welded bodies are merged.
    pub merge: bool,
    /// Whether parts that no output depends on are omitted.
    pub prune: bool,
    /// Whether subsystems become models of their own.
    pub part: bool,
}

impl Default for Choices {
    fn default() -> Self {
        Self { merge: true, prune: true, part: true }
    }
}

/// A part of a model that moves independently of the rest.
#[derive(Clone, Debug)]
pub struct Subsystem {
    /// A model of its own, with the name of the whole model.
    pub description: Description,
    /// Whether each joint's bodies move as one, so that there is no reaction between them.
    pub merged: Vec<bool>,
    /// Numbers of its outputs in the whole model.
    pub outputs: Vec<usize>,
    /// Numbers of its reduced outputs in the whole model.
    pub reduced: Vec<usize>,
    /// Numbers of its requirements in the whole model.
    pub requirements: Vec<usize>,
    /// Numbers of its uncertain parameters among those of the whole model.
    pub parameters: Vec<usize>,
}

/// The parts of a model that are simulated.
#[derive(Clone, Debug)]
pub struct Reduction {
    /// Subsystems in the order of their first outputs.
    pub subsystems: Vec<Subsystem>,
    /// Parts that no output depends on, by kind and name: `body pendulum`.
    pub left_out: Vec<String>,
    /// Names of the simulated fixed joints, and why their bodies are not merged, if they are not.
    pub welds: Vec<(String, Option<String>)>,
}

impl Reduction {
    /// Reduces a model.
    pub fn of(description: &Description, choices: Choices) -> Self {
        if description.black_box.is_some() {
            return Self::whole(description);
        }
        let welds = if choices.merge { welds::welds(description) } else { Vec::new() };
        let mut merged = vec![false; description.joints.len()];
        welds.iter().for_each(|weld| merged[weld.joint] = weld.obstacle.is_none());
        let mut couplings = Couplings::of(description, &merged);
        let movable = couplings.movable();
        if choices.merge && !movable.iter().any(is_body) {
            // A model needs a coordinate.
            return Self::of(description, Choices { merge: false, ..choices });
        }
        let questions = questions(description);
        let sets = sets_of_outputs(&mut couplings, &movable, &questions, choices);
        let mut subsystems: Vec<(Option<usize>, SubsystemQuestions)> = Vec::new();
        for (output, set) in sets.into_iter().enumerate() {
            match subsystems.iter_mut().find(|(known, _)| *known == set) {
                Some((_, asked)) => asked.outputs.push(output),
                None => subsystems.push((set, SubsystemQuestions::output(output))),
            }
        }
        if subsystems.is_empty() {
            // A robot without joints has no outputs.
            subsystems.push((movable.first().map(|&part| couplings.set(part)), SubsystemQuestions::default()));
        }
        for (question, places) in questions {
            let has = |(_, asked): &(_, SubsystemQuestions)| {
                places.first().is_some_and(|index| asked.outputs.contains(index))
            };
            // Outputs of parameters alone belong to the first subsystem.
            let index = subsystems.iter().position(has).unwrap_or(0);
            match question {
                Question::Reduced(number) => subsystems[index].1.reduced.push(number),
                Question::Requirement(number) => subsystems[index].1.requirements.push(number),
            }
        }
        let kept: HashSet<usize> = subsystems.iter().filter_map(|(set, _)| *set).collect();
        let left_out: Vec<Member> = movable.into_iter().filter(|&part| !kept.contains(&couplings.set(part))).collect();
        let subsystems = subsystems
            .into_iter()
            .map(|(set, asked)| extract::extract(description, &merged, &mut couplings, set, asked));
        let subsystems = subsystems.collect();
        let name = |part: &Member| match *part {
            Member::Body(body) => format!("body {}", description.bodies[body].name),
            Member::Joint(joint) => format!("joint {}", description.joints[joint].name),
            Member::Effect(effect) => format!("effect {}", description.effects[effect].name),
        };
        let moves =
            |part: &&Member| !matches!(part, Member::Body(body) if description.bodies[*body].is_ground_of_instance());
        let simulated = |joint: &Weld| !left_out.contains(&Member::Joint(joint.joint));
        let welds = welds.into_iter().filter(simulated);
        Self {
            left_out: left_out.iter().filter(moves).map(name).collect(),
            welds: welds.map(|weld| (description.joints[weld.joint].name.clone(), weld.obstacle)).collect(),
            subsystems,
        }
    }

    /// A model that has no parts.
    fn whole(description: &Description) -> Self {
        let subsystem = Subsystem {
            outputs: (0..description.outputs.len()).collect(),
            reduced: (0..description.reduced.len()).collect(),
            requirements: (0..description.requirements.len()).collect(),
            parameters: (0..description.uncertain().count()).collect(),
            merged: vec![false; description.joints.len()],
            description: description.clone(),
        };
        Self { subsystems: vec![subsystem], left_out: Vec::new(), welds: Vec::new() }
    }

    /// The simulated parts as one model.
    pub fn joined(description: &Description) -> Subsystem {
        let mut subsystems = Self::of(description, Choices { part: false, ..Choices::default() }).subsystems;
        subsystems.swap_remove(0)
    }
}

fn is_body(part: &Member) -> bool {
    matches!(part, Member::Body(_))
}

/// The set of parts that each output needs; all parts that an output refers to, or a question, are in one set.
fn sets_of_outputs(
    couplings: &mut Couplings,
    movable: &[Member],
    questions: &[(Question, Vec<usize>)],
    choices: Choices,
) -> Vec<Option<usize>> {
    let mut named: Vec<Vec<Member>> = couplings.outputs.iter().map(|named| named.parts.clone()).collect();
    tie(questions, &mut named);
    let mut needed: Vec<Member> = Vec::new();
    for parts in &named {
        couplings.unite(parts);
        needed.extend(parts.iter().filter(|&&part| !couplings.is_grounded(part)));
    }
    // Every body adds to an energy; and if no output refers to anything that moves, nothing can be omitted.
    if couplings.outputs.iter().any(|named| named.everything) || needed.is_empty() || !choices.prune {
        needed = movable.to_vec();
        couplings.unite(movable);
    }
    if !choices.part {
        couplings.unite(&needed);
    }
    // A part that acts on nothing movable joins a part that does move.
    let bodies: Vec<Member> = movable.iter().copied().filter(is_body).collect();
    let moving: HashSet<usize> = bodies.iter().map(|&body| couplings.set(body)).collect();
    let (moves, alone): (Vec<Member>, Vec<Member>) =
        needed.into_iter().partition(|&part| moving.contains(&couplings.set(part)));
    let partner = moves.first().or(bodies.first()).copied();
    for part in alone {
        partner.map(|partner| couplings.unite(&[partner, part]));
    }
    // So does an output that refers to nothing movable.
    let first = partner.map(|part| couplings.set(part));
    named.iter().map(|parts| couplings.unite(parts).or(first)).collect()
}
