//! Description → [`Reduction`]: what of a mechanism has to be simulated for the outputs that are asked for.
//!
//! - `welds`: bodies that are welded together become one, unless an output asks for the weld's reaction;
//! - `couplings`: what hangs together; the ground does not connect;
//! - what no output depends on is left out;
//! - what hangs together is a subsystem, a model of its own (`extract`), with those of the uncertain parameters that it names.
//!
//! A model of one subsystem, of which nothing is left out, is itself.

mod couplings;
mod extract;
mod sets;
mod welds;

use std::collections::HashSet;

use crate::model::Description;

use couplings::{Couplings, Part};

pub use extract::narrow;
pub use welds::Weld;

/// What is done; everything by default.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Choices {
    /// Whether welded bodies are merged.
    pub merge: bool,
    /// Whether parts that no output depends on are left out.
    pub prune: bool,
    /// Whether subsystems are taken apart.
    pub part: bool,
}

impl Default for Choices {
    fn default() -> Self {
        Self { merge: true, prune: true, part: true }
    }
}

/// A part of a model that moves on its own.
#[derive(Clone, Debug)]
pub struct Subsystem {
    /// A model of its own, with the whole one's name.
    pub description: Description,
    /// Its outputs, by their numbers in the whole model.
    pub outputs: Vec<usize>,
    /// Its uncertain parameters, by their numbers among those of the whole model.
    pub parameters: Vec<usize>,
}

/// What of a model is simulated.
#[derive(Clone, Debug)]
pub struct Reduction {
    /// In the order of their first outputs.
    pub subsystems: Vec<Subsystem>,
    /// Parts that no output depends on, by kind and name: `body pendulum`.
    pub left_out: Vec<String>,
    /// Fixed joints of what is simulated: their names, and why their bodies stay two if they do.
    pub welds: Vec<(String, Option<String>)>,
}

impl Reduction {
    /// Of a model.
    pub fn of(description: &Description, choices: Choices) -> Self {
        let mut whole = description.clone();
        let welds = if choices.merge { welds::merge(&mut whole) } else { Vec::new() };
        let mut couplings = Couplings::of(&whole);
        let movable = couplings.movable();
        if choices.merge && !movable.iter().any(is_body) {
            // Something has to have coordinates.
            return Self::of(description, Choices { merge: false, ..choices });
        }
        let sets = sets_of_outputs(&mut couplings, &movable, choices);
        let mut subsystems: Vec<(Option<usize>, Vec<usize>)> = Vec::new();
        for (output, set) in sets.into_iter().enumerate() {
            match subsystems.iter_mut().find(|(known, _)| *known == set) {
                Some((_, outputs)) => outputs.push(output),
                None => subsystems.push((set, vec![output])),
            }
        }
        if subsystems.is_empty() {
            // A robot without joints has no outputs.
            subsystems.push((movable.first().map(|&part| couplings.set(part)), Vec::new()));
        }
        let kept: HashSet<usize> = subsystems.iter().filter_map(|(set, _)| *set).collect();
        let left_out: Vec<Part> = movable.into_iter().filter(|&part| !kept.contains(&couplings.set(part))).collect();
        let subsystems = subsystems.into_iter().map(|(set, outputs)| {
            let (description, parameters) = extract::extract(&whole, &mut couplings, set, &outputs);
            Subsystem { description, outputs, parameters }
        });
        let subsystems = subsystems.collect();
        let name = |part: &Part| match *part {
            Part::Body(body) => format!("body {}", whole.bodies[body].name),
            Part::Joint(joint) => format!("joint {}", whole.joints[joint].name),
            Part::Effect(effect) => format!("effect {}", whole.effects[effect].name),
        };
        let simulated = |joint: &Weld| !left_out.contains(&Part::Joint(joint.joint));
        let welds = welds.into_iter().filter(simulated);
        Self {
            left_out: left_out.iter().map(name).collect(),
            welds: welds.map(|weld| (whole.joints[weld.joint].name.clone(), weld.obstacle)).collect(),
            subsystems,
        }
    }

    /// What is simulated as one model.
    pub fn joined(description: &Description) -> Subsystem {
        let mut subsystems = Self::of(description, Choices { part: false, ..Choices::default() }).subsystems;
        subsystems.swap_remove(0)
    }
}

fn is_body(part: &Part) -> bool {
    matches!(part, Part::Body(_))
}

/// The set of parts that each output needs; what an output names is in one.
fn sets_of_outputs(couplings: &mut Couplings, movable: &[Part], choices: Choices) -> Vec<Option<usize>> {
    let named: Vec<Vec<Part>> = couplings.outputs.iter().map(|named| named.parts.clone()).collect();
    let mut needed: Vec<Part> = Vec::new();
    for parts in &named {
        couplings.together(parts);
        needed.extend(parts.iter().filter(|&&part| !couplings.is_still(part)));
    }
    // To an energy everything adds; and where no output names anything that moves, nothing says what is of no use.
    if couplings.outputs.iter().any(|named| named.everything) || needed.is_empty() || !choices.prune {
        needed = movable.to_vec();
        couplings.together(movable);
    }
    if !choices.part {
        couplings.together(&needed);
    }
    // What acts on nothing that moves goes with something that does.
    let bodies: Vec<Part> = movable.iter().copied().filter(is_body).collect();
    let moving: HashSet<usize> = bodies.iter().map(|&body| couplings.set(body)).collect();
    let (moves, alone): (Vec<Part>, Vec<Part>) =
        needed.into_iter().partition(|&part| moving.contains(&couplings.set(part)));
    let company = moves.first().or(bodies.first()).copied();
    for part in alone {
        company.map(|company| couplings.together(&[company, part]));
    }
    // So does what names nothing of the kind.
    let first = company.map(|part| couplings.set(part));
    named.iter().map(|parts| couplings.together(parts).or(first)).collect()
}
