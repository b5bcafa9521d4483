//! Solids in a drawing: shapes of bodies, surfaces of effects, and the appearance of links of a robot.

use nalgebra::{UnitQuaternion, Vector3};

use super::asked::{
    AskedBody, AskedRotation, AskedVector, DrawingOutputs, DrawingValues, RelativeFrame, roll_pitch_yaw,
};
use crate::elements::{Form, Shape, Surroundings};
use crate::grammar::{Mesh, PointRef};
use crate::model::{self, Description, Visual};
use crate::results::DrawnSolid;

/// A solid whose numbers are asked.
pub(super) struct AskedSolid {
    /// The frame that it is in.
    at: PointRef,
    /// The effect that it is a surface of.
    surface: Option<String>,
    position: AskedVector,
    rotation: AskedRotation,
    form: Form<usize>,
}

/// Asks all of a model.
pub(super) fn asked(
    description: &Description,
    surroundings: Surroundings,
    asked: &mut DrawingOutputs,
) -> Vec<AskedSolid> {
    let mut ask = |at: PointRef, surface: Option<&String>, shape: &Shape| AskedSolid {
        at,
        surface: surface.cloned(),
        position: asked.vector(&shape.position),
        rotation: shape.rotation.as_ref().map_or(AskedRotation::None, |rotation| asked.rotation(rotation)),
        form: shape.form.map(|formula| asked.formula(formula.clone())),
    };
    let mut found = Vec::new();
    for (body, known) in description.bodies.iter().enumerate() {
        let at = PointRef { body, point: None };
        found.extend(known.shapes.iter().map(|kind| ask(at, None, &kind.shape())));
    }
    for effect in &description.effects {
        let surfaces = effect.kind.surfaces(surroundings).into_iter();
        found.extend(surfaces.map(|(at, shape)| ask(at, Some(&effect.name), &shape)));
    }
    found
}

/// The solids in numbers, with those of a robot's links.
pub(super) fn solids(
    description: &Description,
    asked: &[AskedSolid],
    bodies: &[AskedBody],
    values: &DrawingValues,
) -> Vec<DrawnSolid> {
    let own = asked.iter().map(|solid| {
        let frame =
            RelativeFrame { position: values.vector(solid.position), rotation: values.rotation(solid.rotation) };
        let form = solid.form.map(|&output| values.0[output]);
        DrawnSolid { surface: solid.surface.clone(), ..placed(solid.at, frame, form, bodies, values) }
    });
    let links = description.robot.iter().flat_map(|robot| &robot.links);
    let visuals = links.filter_map(|link| Some((link.place?, &link.visuals)));
    let visuals = visuals.flat_map(|(index, visuals)| visuals.iter().map(move |visual| (index, visual)));
    let all = own.chain(visuals.map(|(index, visual)| of_link(index, visual, bodies, values))).filter(is_finite);
    let mut found: Vec<DrawnSolid> = Vec::new();
    for solid in all {
        // A ball that touches several things is one.
        if solid.surface.is_none() || !found.iter().any(|known| is_same(known, &solid)) {
            found.push(solid);
        }
    }
    found
}

fn is_same(one: &DrawnSolid, other: &DrawnSolid) -> bool {
    let frame = |solid: &DrawnSolid| (solid.body, solid.position, solid.orientation);
    frame(one) == frame(other) && one.form == other.form
}

/// A form in a frame that is in a point's.
fn placed(
    at: PointRef,
    own: RelativeFrame,
    form: Form<f64>,
    bodies: &[AskedBody],
    values: &DrawingValues,
) -> DrawnSolid {
    let outer = at.point.map_or_else(
        || RelativeFrame { position: Vector3::zeros(), rotation: UnitQuaternion::identity() },
        |point| {
            let (position, rotation) = bodies[at.body].points[point];
            RelativeFrame { position: values.vector(position), rotation: values.rotation(rotation) }
        },
    );
    let turned = (outer.rotation * own.rotation).into_inner();
    DrawnSolid {
        body: at.body,
        surface: None,
        position: outer.place(own.position).into(),
        orientation: [turned.w, turned.i, turned.j, turned.k],
        color: None,
        form,
    }
}

fn of_link(place: PointRef, visual: &Visual, bodies: &[AskedBody], values: &DrawingValues) -> DrawnSolid {
    let form = match &visual.shape {
        model::VisualShape::Box(size) => Form::Box { size: *size, radius: 0.0 },
        model::VisualShape::Cylinder { radius, length } => {
            Form::Cylinder { axis: [0.0, 0.0, 1.0], length: *length, radius: *radius }
        }
        model::VisualShape::Sphere(radius) => Form::Sphere { radius: *radius },
        model::VisualShape::Mesh { file, scale } => Form::Mesh { mesh: Mesh::unread(file), scale: *scale },
    };
    let frame = RelativeFrame { position: visual.xyz.into(), rotation: roll_pitch_yaw(visual.rpy) };
    DrawnSolid { color: visual.color, ..placed(place, frame, form, bodies, values) }
}

fn is_finite(solid: &DrawnSolid) -> bool {
    let mut finite = solid.position.iter().chain(&solid.orientation).all(|number| number.is_finite());
    solid.form.map(|number| finite &= number.is_finite());
    finite
}
