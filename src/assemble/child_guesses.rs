//! Guesses of bodies that have no coordinates of their own, in joint coordinates.
//!
//! Such a guess says where its body would be looked for if every body had coordinates: walked from the ground with what is named, as in
//! absolute coordinates. What the inboard joints measure there is where their coordinates are looked for: those of all children, so that
//! a loop is closed from the same place, and in the same branch.

use symdiff::Builder;

use super::at_guess::AtGuess;
use super::mechanism::Mechanism;
use crate::grammar::{JointCoordinate, OnJoint};
use crate::model::{Description, StartValue};
use crate::multibody::BuildError;

impl Mechanism<'_, '_> {
    /// Notes where to look for the inboard joints' coordinates, if `guess` names a child.
    ///
    /// # Errors
    /// A formula with a name that cannot stand in it.
    pub fn guess_children(&mut self, description: &Description) -> Result<(), BuildError> {
        let mut named = description.guess.iter().filter_map(|value| match value {
            StartValue::Coordinate { body, .. } | StartValue::Orientation { body, .. } => Some(*body),
            _ => None,
        });
        if !named.any(|body| self.is_child(body)) {
            return Ok(());
        }
        let builder = Builder::new();
        let absolute = Mechanism::new(&builder, description, false)?;
        let guess = absolute.start(description)?.guess;
        let at_guess = AtGuess::of(&absolute, &builder.graph(), &guess);
        for joint in self.tree.inboard.iter().flatten().map(|inboard| inboard.joint) {
            for coordinate in [JointCoordinate::Angle, JointCoordinate::Displacement] {
                let Some(&place) = self.joint_coordinates.get(&(joint, coordinate)) else { continue };
                let measured = absolute.measured_coordinate(OnJoint { joint, coordinate })?.expr();
                let value = at_guess.values(&builder.graph(), &[measured])[0];
                self.child_guesses.push((place, value));
            }
        }
        Ok(())
    }
}
