//! Guesses of inboard joints' coordinates if joints close loops or `guess` names a child, in joint coordinates.
//!
//! A guess of a body without coordinates of its own gives its pose as if every body had coordinates: poses are
//! propagated from the ground with the named coordinates, as in absolute coordinates. The inboard joints' coordinates
//! are measured there and start from these values: those of all children, so that a loop is closed from the same
//! configuration, and those of joints whose coordinates have no names, so that they start from the given coordinates of
//! their bodies. The loop is closed in the same branch if the assembled start in absolute coordinates is known.

use symdiff::{Builder, Scalar};

use super::at_guess::AtGuess;
use super::mechanism::{Mechanism, RelativeCoordinate};
use crate::grammar::{JointCoordinate, OnJoint};
use crate::model::StartValue;
use crate::multibody::BuildError;

impl Mechanism<'_, '_> {
    /// Stores guesses of the inboard joints' coordinates, if `guess` names a child or joints close loops. `assembled`
    /// are the coordinates of an assembled start in absolute coordinates, if it is known.
    ///
    /// # Errors
    /// A formula with a name that cannot stand in it.
    pub fn guess_children(&mut self, assembled: Option<&[f64]>) -> Result<(), BuildError> {
        let description = self.questions.description;
        let mut named = description.guess.iter().filter_map(|value| match value {
            StartValue::Coordinate { body, .. } | StartValue::Orientation { body, .. } => Some(*body),
            _ => None,
        });
        let unnamed: Vec<(usize, RelativeCoordinate, usize)> = self.unnamed_coordinates().collect();
        if !self.tree.closes_loops(description) && unnamed.is_empty() && !named.any(|body| self.is_child(body)) {
            return Ok(());
        }
        let builder = Builder::new();
        let absolute = Mechanism::new(&builder, self.questions, false)?;
        let guess = absolute.start(description)?.guess;
        let mut at_guess = AtGuess::of(&absolute, &builder.graph(), &guess);
        if let Some(assembled) = assembled {
            at_guess.set(&absolute.q, assembled.to_vec());
            self.starts_assembled = true;
        }
        for joint in self.tree.inboard.iter().flatten().map(|inboard| inboard.joint) {
            for coordinate in [JointCoordinate::Angle, JointCoordinate::Displacement] {
                let Some(&index) = self.joint_coordinates.get(&(joint, coordinate)) else { continue };
                let measured = absolute.measured_coordinate(OnJoint { joint, coordinate })?.expr();
                let value = at_guess.values(&builder.graph(), &[measured])[0];
                self.child_guesses.push((index, value));
            }
        }
        for (joint, coordinate, index) in unnamed {
            let kind = &self.joints[joint].kind;
            let (Some(between), Some(mobilizer)) = (kind.between(), kind.mobilizer()) else { continue };
            let pair = absolute.pair(between);
            let offset = pair.first.orientation.matrix().transposed() * pair.offset();
            let measured = absolute.relative_coordinate(&mobilizer, coordinate, pair.relative(), offset)?.expr();
            self.child_guesses.push((index, at_guess.values(&builder.graph(), &[measured])[0]));
        }
        for (body, inboard) in self.tree.inboard.iter().enumerate() {
            if inboard.is_some_and(|inboard| self.has_no_names(inboard.joint)) {
                let position = Scalar::exprs(&absolute.bodies[body].position);
                let values = at_guess.values(&builder.graph(), &position);
                let guess = std::array::from_fn(|index| values[index]);
                self.body_guesses.insert(body, guess);
            }
        }
        Ok(())
    }
}
