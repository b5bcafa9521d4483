//! The names of a description.

use symdiff::Formula;

use super::description::Description;
use crate::elements::joints::Mobilizer;
use crate::grammar::quantity::Dimension;
use crate::grammar::{self, FrictionMode, JointCoordinate, MeshKind, PointRef, Sensor, Symbol, SymbolTable, TimeOrder};

/// Reads a description.
pub type Reader<'d> = grammar::reader::Reader<'d, Description>;

impl Description {
    /// Symbol that a name in a formula stands for; `None` if there is none.
    pub fn symbol(&self, name: &str) -> Option<Symbol> {
        grammar::names::symbol(self, name)
    }
}

impl SymbolTable for Description {
    fn is_spatial(&self) -> bool {
        self.space.spatial
    }

    fn is_robot(&self) -> bool {
        self.robot.is_some()
    }

    fn parameters(&self) -> impl Iterator<Item = &str> + Clone {
        self.parameters.iter().map(|parameter| parameter.name.as_str())
    }

    fn bodies(&self) -> impl Iterator<Item = &str> + Clone {
        self.bodies.iter().map(|body| body.name.as_str())
    }

    fn points(&self, body: usize) -> impl Iterator<Item = &str> + Clone {
        self.bodies[body].points.iter().map(|point| point.name.as_str())
    }

    fn joints(&self) -> impl Iterator<Item = &str> + Clone {
        self.joints.iter().map(|joint| joint.name.as_str())
    }

    fn parameter(&self, name: &str) -> Option<usize> {
        let list = &self.parameters;
        self.parameter_index.find(name, list.len(), |index| &list[index].name)
    }

    fn body(&self, name: &str) -> Option<usize> {
        let list = &self.bodies;
        self.body_index.find(name, list.len(), |index| &list[index].name)
    }

    fn joint(&self, name: &str) -> Option<usize> {
        let list = &self.joints;
        self.joint_index.find(name, list.len(), |index| &list[index].name)
    }

    fn effects(&self) -> usize {
        self.effects.len()
    }

    fn effect(&self, name: &str) -> Option<usize> {
        self.effects.iter().position(|effect| effect.name == name)
    }

    fn state(&self, name: &str) -> Option<usize> {
        self.states.contains(name).then(|| self.effect(name)).flatten()
    }

    fn trajectory(&self, name: &str) -> Option<usize> {
        self.trajectories.iter().position(|trajectory| trajectory.name == name)
    }

    fn trajectory_dimension(&self, trajectory: usize) -> Option<Dimension> {
        self.trajectories[trajectory].dimension
    }

    fn derivatives(&self, trajectory: usize) -> Option<TimeOrder> {
        let class = &self.trajectories[trajectory].excitation()?.class;
        Some(if class.jumps() { TimeOrder::Position } else { TimeOrder::Velocity })
    }

    fn black_box(&self, name: &str) -> Option<usize> {
        self.black_box.as_ref()?.outputs.iter().position(|output| output.name == name)
    }

    fn black_box_dimension(&self, output: usize) -> Dimension {
        self.black_box.as_ref().map_or(Dimension::NUMBER, |own| own.outputs[output].unit.dimension())
    }

    fn black_box_outputs(&self) -> impl Iterator<Item = &str> + Clone {
        self.black_box.iter().flat_map(|own| own.outputs.iter().map(|output| output.name.as_str()))
    }

    fn measures(&self, effect: usize) -> Vec<(Sensor, Dimension)> {
        self.effects[effect].kind.measures()
    }

    fn link(&self, name: &str) -> Option<PointRef> {
        let links = &self.robot.as_ref()?.links;
        let link = |name: &str| links.iter().find(|link| link.name == name);
        if let Some(link) = link(name) {
            return link.place;
        }
        // A point that the model gives to a link: one that is welded to another is a point itself.
        let (owner, own) = name.rsplit_once('.')?;
        let place = link(owner)?.place?;
        let called = if place.point.is_some() { name } else { own };
        let point = self.bodies[place.body].points.iter().position(|point| point.name == called)?;
        Some(PointRef { body: place.body, point: Some(point) })
    }

    fn parts_of_beam(&self, beam: &str) -> Option<String> {
        self.named_parts_of_beam(beam)
    }

    fn instances(&self) -> impl Iterator<Item = &str> + Clone {
        self.instances.iter().map(|instance| instance.name.as_str())
    }

    fn port(&self, name: &str) -> Option<&str> {
        self.ports.get(name).map(String::as_str)
    }

    fn is_on_turning_joint(&self, effect: &str) -> bool {
        // The parts of an effect on many are named after it.
        let mut ends = effect.match_indices('.').map(|(end, _)| end).chain([effect.len()]);
        !self.turning_effects.is_empty() && ends.any(|end| self.turning_effects.contains(&effect[..end]))
    }

    fn parts_of(&self, instance: &str) -> Vec<String> {
        let names = self.ports.keys().map(String::as_str).chain(self.bodies());
        let within = names.filter_map(|name| name.strip_prefix(instance)?.strip_prefix('.'));
        within.filter(|name| !name.contains('.')).map(str::to_owned).collect()
    }

    fn has_orientation(&self, body: usize) -> bool {
        self.bodies[body].has_orientation()
    }

    fn has_coordinate(&self, joint: usize, coordinate: JointCoordinate) -> bool {
        self.joints[joint].kind.axis_of(coordinate).is_some()
    }

    fn has_place(&self, joint: usize) -> bool {
        self.joints[joint].kind.between().is_some()
    }

    fn has_axis(&self, joint: usize) -> bool {
        let kind = &self.joints[joint].kind;
        let drives = || kind.coordinates(joint).iter().any(|on| self.has_coordinate(on.joint, on.coordinate));
        kind.reaction_axis().is_some() || kind.between().is_none() && drives()
    }

    fn has_axial_force(&self, joint: usize) -> bool {
        self.has_axis(joint) || self.joints[joint].kind.axial_by_multiplier().is_some()
    }

    fn friction_mode(&self, joint: usize) -> Option<FrictionMode> {
        match self.joints[joint].kind.mobilizer()? {
            Mobilizer::Rotation { .. } => Some(FrictionMode::Rotating),
            Mobilizer::Translation { .. } => Some(FrictionMode::Sliding),
            Mobilizer::RotationAndTranslation { .. } => Some(FrictionMode::Both),
            _ => None,
        }
    }

    fn mesh_kind(&self, joint: usize) -> Option<MeshKind> {
        self.joints[joint].kind.mesh_kind()
    }

    fn equated(&self, joint: usize) -> Option<&Formula> {
        let [left, _] = self.joints[joint].kind.equation()?;
        Some(left)
    }
}
