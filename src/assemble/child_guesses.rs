//! Guesses of bodies that have no coordinates of their own, in joint coordinates.
//!
//! Such a guess says where its body would be looked for if every body had coordinates: walked from the ground with what is named, as in
//! absolute coordinates. What its inboard joint measures there is where the joint's coordinate is looked for.

use std::collections::BTreeSet;

use symdiff::{Builder, Expr};

use super::mechanism::Mechanism;
use crate::grammar::{JointCoordinate, OnJoint};
use crate::model::{Description, StartValue};
use crate::multibody::BuildError;

impl Mechanism<'_, '_> {
    /// Notes where to look for the inboard joints' coordinates of children that `guess` names.
    ///
    /// # Errors
    /// A formula with a name that cannot stand in it.
    pub fn guess_children(&mut self, description: &Description) -> Result<(), BuildError> {
        let named = description.guess.iter().filter_map(|value| match value {
            StartValue::Coordinate { body, .. } | StartValue::Orientation { body, .. } => Some(*body),
            _ => None,
        });
        let children: BTreeSet<usize> = named.filter(|&body| self.is_child(body)).collect();
        if children.is_empty() {
            return Ok(());
        }
        let builder = Builder::new();
        let absolute = Mechanism::new(&builder, description, false)?;
        let guess = absolute.start(description)?.guess;
        let nominal = |symbol: Expr| {
            let parameter = absolute.uncertain.iter().find(|parameter| parameter.symbol == symbol);
            parameter.map_or(0.0, |parameter| parameter.nominal)
        };
        let places = builder.graph().evaluate(&guess, nominal);
        let at_guess = |symbol: Expr| {
            let place = absolute.q.iter().position(|q| q.expr() == symbol);
            place.map_or_else(|| nominal(symbol), |place| places[place])
        };
        for joint in
            children.into_iter().filter_map(|body| self.tree.inboard[body].as_ref()).map(|inboard| inboard.joint)
        {
            for coordinate in [JointCoordinate::Angle, JointCoordinate::Displacement] {
                let Some(&place) = self.joint_coordinates.get(&(joint, coordinate)) else { continue };
                let measured = absolute.measured_coordinate(OnJoint { joint, coordinate })?.expr();
                let value = builder.graph().evaluate(&[measured], at_guess)[0];
                self.child_guesses.push((place, value));
            }
        }
        Ok(())
    }
}
