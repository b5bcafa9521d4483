//! STAND-IN of the mechanics branch, to be dropped at merge: the model stage owns this file.

use super::{Coordinate, Description, EnergyKind, ReactionComponent, Referent, TimeOrder};

impl Description {
    /// What a name in a formula stands for.
    pub fn referent(&self, name: &str) -> Option<Referent> {
        let parts: Vec<&str> = name.split('.').collect();
        let body_named = |wanted: &str| self.bodies.iter().position(|body| body.name == wanted);
        let joint_named = |wanted: &str| self.joints.iter().position(|joint| joint.name == wanted);
        let coordinate_named = |wanted: &str| {
            Some(match wanted {
                "x" => (Coordinate::X, TimeOrder::Position),
                "y" => (Coordinate::Y, TimeOrder::Position),
                "angle" => (Coordinate::Angle, TimeOrder::Position),
                "vx" => (Coordinate::X, TimeOrder::Velocity),
                "vy" => (Coordinate::Y, TimeOrder::Velocity),
                "angular_velocity" => (Coordinate::Angle, TimeOrder::Velocity),
                "ax" => (Coordinate::X, TimeOrder::Acceleration),
                "ay" => (Coordinate::Y, TimeOrder::Acceleration),
                "angular_acceleration" => (Coordinate::Angle, TimeOrder::Acceleration),
                _ => return None,
            })
        };
        match parts.as_slice() {
            ["t"] => Some(Referent::Time),
            ["energy"] => Some(Referent::Energy(EnergyKind::Total)),
            ["kinetic_energy"] => Some(Referent::Energy(EnergyKind::Kinetic)),
            ["potential_energy"] => Some(Referent::Energy(EnergyKind::Potential)),
            [name] => self.parameters.iter().position(|parameter| parameter.name == *name).map(Referent::Parameter),
            [joint, rest @ ..] if joint_named(joint).is_some() => {
                let component = match rest {
                    ["force"] => ReactionComponent::Force,
                    ["force", "x"] => ReactionComponent::ForceX,
                    ["force", "y"] => ReactionComponent::ForceY,
                    ["torque"] => ReactionComponent::Torque,
                    _ => return None,
                };
                Some(Referent::Reaction { joint: joint_named(joint)?, component })
            }
            [body, coordinate] => {
                let (coordinate, order) = coordinate_named(coordinate)?;
                Some(Referent::Coordinate { body: body_named(body)?, coordinate, order })
            }
            [body, point, coordinate] => {
                let body = body_named(body)?;
                let point = self.bodies[body].points.iter().position(|known| known.name == *point)?;
                let (coordinate, order) = coordinate_named(coordinate)?;
                Some(Referent::Point { body, point, coordinate, order })
            }
            _ => None,
        }
    }
}
