//! Enclosures of a mechanism's motions over a piece of the box.

use symdiff::taylor_model::ModelSpace;
use symdiff::{Expr, Node, Unary};

use super::Motions;
use crate::assemble::System;
use crate::methods::{EnclosedRow, EnclosureEnd, Lost, Proof};
use crate::numerics::ParameterBox;
use crate::simulate::{Certifier, Enclosure, EnclosureError, MotionEnclosure, MotionSpaces, Simulator};

/// Reason that prevents a proof.
pub(super) fn obstacle(simulator: &Simulator, proof: Proof) -> Option<String> {
    let system = &simulator.system;
    if system.analysis.visits() {
        return Some(format!("`analysis: {}`", system.analysis.name()));
    }
    if simulator.equilibrium.is_some() {
        return Some("a start at an equilibrium".to_owned());
    }
    if !system.velocity_constraint.is_empty() {
        let joint = &system.constraints[system.constraint.len()].joint;
        return Some(format!("constraints of velocities, as of joint {joint}"));
    }
    if !system.sampled.is_empty() {
        return Some("states that change at instants, as of a controller with a period".to_owned());
    }
    let jump = if proof == Proof::Motion { jump_with_the_motion(system) } else { None };
    jump.map(|what| format!("{what} of positions or velocities, where the equations jump"))
}

/// A function of the motion in an equation that jumps, while no derivative shows it.
fn jump_with_the_motion(system: &System) -> Option<&'static str> {
    let jump = |expr: Expr, differentiated: u8| {
        let (argument, what) = match system.graph.node(expr) {
            Node::Unary(Unary::Floor, argument) => (argument, "`floor`"),
            Node::Unary(Unary::Spline(table, order), argument) => {
                let jumps = (order..=order + differentiated).any(|order| table.rounding_jumps(order).is_none());
                jumps.then_some((argument, "a table, or a derivative of one,"))?
            }
            _ => return None,
        };
        Some((argument, what))
    };
    let of = |roots: &[Expr], differentiated: u8| {
        let of_motion = system.graph.depending_on(roots, &system.motion_symbols());
        let jumps = system.graph.reachable(roots).into_iter().filter_map(|expr| jump(expr, differentiated));
        jumps.into_iter().find_map(|(argument, what)| of_motion.contains(&argument).then_some(what))
    };
    // Constraints hold with their second derivatives.
    of(&[&system.inertia[..], &system.force].concat(), 0).or_else(|| of(&system.constraint, 2))
}

/// Why an enclosure ended, with the parameter of which the piece is too wide, if it can be determined.
fn lost(simulator: &Simulator, time: f64, why: EnclosureError, axis: Option<usize>) -> Lost {
    let parameters = &simulator.system.parameters;
    let help = match (why, axis.and_then(|axis| parameters.get(axis))) {
        (EnclosureError::Undetermined, _) => {
            "let `initial:` give as many values as there are degrees of freedom, each once".to_owned()
        }
        (_, Some(parameter)) => format!("a smaller interval of `{}` would help most", parameter.name),
        (_, None) if parameters.is_empty() => "the equations are singular there, or switch".to_owned(),
        _ => "smaller intervals of the parameters would help, unless the equations are singular there".to_owned(),
    };
    Lost { time, why: why.to_string(), is_too_wide: why != EnclosureError::Undetermined, axis, help }
}

/// Rows of the true motion.
pub(super) fn motion(
    motions: &Motions,
    space: &ModelSpace,
    piece: &ParameterBox,
    row: &mut EnclosedRow,
) -> EnclosureEnd {
    let certifier = motions.certifier.get_or_init(|| Certifier::new(motions.simulator));
    let monomials = space.jets().monomials();
    let spaces = MotionSpaces::new(monomials.variables(), monomials.order());
    let mut enclosure = match MotionEnclosure::start(certifier, &spaces, &piece.lower, &piece.upper) {
        Ok(enclosure) => enclosure,
        Err(why) => return lost(motions.simulator, 0.0, why, None).into(),
    };
    let (mut models, mut ended) = (Vec::new(), None);
    for next in (0..motions.schedule.rows).take_while(|_| !motions.interruption.is_asked()) {
        if let Err((time, why)) = enclosure.observe(motions.schedule.time(next), &mut models) {
            ended = Some(lost(motions.simulator, time, why, enclosure.widest()));
            break;
        }
        row(&models, enclosure.since());
    }
    EnclosureEnd { lost: ended, piece: Some(enclosure.into_piece()) }
}

/// Rows of the scheme's motion.
pub(super) fn scheme(
    motions: &Motions,
    space: &ModelSpace,
    piece: &ParameterBox,
    row: &mut EnclosedRow,
) -> EnclosureEnd {
    let certifier = motions.certifier.get_or_init(|| Certifier::new(motions.simulator));
    let first_step = motions.schedule.first_step();
    let mut enclosure = match Enclosure::start(certifier, space, &piece.lower, &piece.upper, first_step) {
        Ok(enclosure) => enclosure,
        Err(why) => return lost(motions.simulator, 0.0, why, None).into(),
    };
    let mut models = Vec::new();
    for next in (0..motions.schedule.rows).take_while(|_| !motions.interruption.is_asked()) {
        if let Err((time, why)) = enclosure.advance(motions.schedule, next) {
            return lost(motions.simulator, time, why, None).into();
        }
        if let Err(why) = enclosure.observe(&mut models) {
            return lost(motions.simulator, motions.schedule.time(next), why, None).into();
        }
        row(&models, &[]);
    }
    EnclosureEnd::default()
}
