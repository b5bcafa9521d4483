//! What the start is nearest to where the model leaves it open: the coordinates of the joints that carry bodies, at zero.
//!
//! The joints are those that carry bodies in joint coordinates, so that the start does not depend on the formulation, nor on
//! what is observed. A body that no joint carries stays near the place where assembly begins to look.

use symdiff::{Builder, Expr};

use crate::grammar::JointCoordinate;
use crate::model::TimeOrder;
use crate::multibody::{Context, rotation, space};

use super::error::BuildError;
use super::mechanism::{Mechanism, Owner};
use super::system::{Distance, Start};
use super::tree::Tree;

impl Mechanism<'_> {
    /// The distances that are smallest at the start: of coordinates that `start` does not keep.
    ///
    /// # Errors
    /// A formula with a name that cannot stand in it.
    pub fn distances(&self, g: &Builder, length: f64, start: &Start) -> Result<Vec<Distance>, BuildError> {
        let tree = Tree::spanning(self.description, |mobilizer| self.is_time_independent(g, mobilizer));
        let guessed = self.guessed(g)?;
        let mut distances = Vec::new();
        let mut add = |owner: Owner, value: Expr, place: Option<usize>| {
            let is_open = |kept: &[Option<Expr>]| place.is_none_or(|place| kept[place].is_none());
            let distance = Distance {
                name: self.coordinate_name(owner),
                value,
                scale: if owner.is_length() { length } else { 1.0 },
                position: is_open(&start.position),
                velocity: is_open(&start.velocity),
            };
            distances.extend((distance.position || distance.velocity).then_some(distance));
        };
        for (place, &owner) in self.coordinates.iter().enumerate() {
            if matches!(owner, Owner::Body(body, _) if tree.carriers[body].is_none()) {
                add(owner, g.sub(self.q[place], start.guess[place]), Some(place));
            }
        }
        for carrier in tree.order.iter().filter(|&&body| !tree.merges(body)).filter_map(|&body| tree.carriers[body]) {
            let Some(mobilizer) = self.description.joints[carrier.joint].kind.mobilizer() else { continue };
            for coordinate in [JointCoordinate::Angle, JointCoordinate::Displacement] {
                // A screw's displacement follows from its angle.
                let follows = mobilizer.pitch().is_some() && coordinate == JointCoordinate::Displacement;
                if mobilizer.axis_of(coordinate).is_none() || follows {
                    continue;
                }
                let place = self.joint_coordinates.get(&(carrier.joint, coordinate)).copied();
                let mut value = self.coordinate_of_joint(g, carrier.joint, coordinate)?;
                if let Some(guess) = place.and_then(|place| guessed[place]) {
                    value = g.sub(value, guess);
                }
                add(Owner::Joint(carrier.joint, coordinate), value, place);
            }
        }
        Ok(distances)
    }

    /// A joint's coordinate, whether it is a coordinate of the mechanism or not; an angle of space between −π and π.
    fn coordinate_of_joint(
        &self,
        g: &Builder,
        joint: usize,
        coordinate: JointCoordinate,
    ) -> Result<Expr, BuildError> {
        let kind = &self.description.joints[joint].kind;
        let is_own = self.joint_coordinates.contains_key(&(joint, coordinate));
        let planar_angle = coordinate == JointCoordinate::Angle && !self.is_spatial();
        let (Some(between), Some(axis), false) = (kind.between(), kind.axis_of(coordinate), is_own || planar_angle)
        else {
            return Ok(self.joint_coordinate(g, joint, coordinate, TimeOrder::Position));
        };
        let axis = self.vector(g, axis, Context::Time)?;
        let axis = space::unit(g, axis);
        let pair = self.pair(g, between);
        Ok(match coordinate {
            JointCoordinate::Displacement => pair.displacement(g, axis),
            JointCoordinate::Angle => {
                // The same for q and −q, which are one rotation.
                let relative = pair.relative(g);
                let along = space::dot(g, rotation::vector_part(relative), axis);
                let tangent = g.div(along, relative[0]);
                let half = g.unary(symdiff::Unary::Atan, tangent);
                g.scale(2.0, half)
            }
        })
    }
}
