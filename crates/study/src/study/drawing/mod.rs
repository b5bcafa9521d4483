//! The assembled mechanism at its start, for a drawing: where bodies, points, joints and effects are.
//!
//! The data of a drawing are requested as outputs of the model, and so use the same equations as all else.

pub(super) mod asked;
mod solids;
pub(crate) mod tuning;

use std::collections::BTreeSet;

use nalgebra::Vector3;

use super::RunError;
use super::black_box::needs_mechanism;
use super::formulation::{assembled, assembled_alike};
use crate::assemble::Questions;
use crate::elements::effects::Scope;
use crate::elements::{Glyph, Surroundings};
use crate::grammar::{Coordinate, PointRef, Reference};
use crate::model::{Body, Description};
use crate::numerics::Sample;
use crate::results::{Drawing, DrawnBody, DrawnElement, DrawnLength, DrawnPoint};
use crate::simulate::{Assembled, Simulator};
use asked::{AskedBody, AskedVector, DrawingOutputs, DrawingValues, RelativeFrame};
use tuning::TUNING;

/// Draws a model's nominal start.
///
/// # Errors
/// If the mechanism cannot be built or assembled.
pub fn drawing(description: &Description) -> Result<Drawing, RunError> {
    let drawing = drawn(description, None, None)?;
    if !has_ground(description) {
        return Ok(drawing);
    }
    let places = drawing.bodies.iter().flat_map(|body| {
        let points = body.points.iter().map(|point| point.position);
        points.chain(body.center_of_mass).chain([body.position])
    });
    let along = extent(places.map(|place| place[0]));
    drawn(description, Some(along), None)
}

/// Whether effects act on ground of which a drawing shows a part.
pub(super) fn has_ground(description: &Description) -> bool {
    let surfaces = |along: Option<[f64; 2]>| {
        let surroundings = Surroundings { spatial: description.space.spatial, along };
        description.effects.iter().map(|effect| effect.kind.surfaces(surroundings).len()).sum::<usize>()
    };
    surfaces(None) < surfaces(Some([0.0, 1.0]))
}

/// Range of numbers, with a margin.
pub(super) fn extent(numbers: impl Iterator<Item = f64>) -> [f64; 2] {
    let (least, most) = numbers.fold((0.0_f64, 0.0_f64), |(least, most), x| (least.min(x), most.max(x)));
    let margin = if most > least { 0.3 * (most - least) } else { 1.0 };
    [least - margin, most + margin]
}

/// Draws it, with its ground between two positions along x, m. `known`: its program for other questions, if there is
/// one, whose start is taken.
pub(super) fn drawn(
    description: &Description,
    along: Option<[f64; 2]>,
    known: Option<&Simulator>,
) -> Result<Drawing, RunError> {
    needs_mechanism(description, "a drawing")?;
    let mut asked = DrawingOutputs::default();
    let bodies = description.bodies.iter().enumerate();
    let bodies: Vec<AskedBody> = bodies.map(|(index, body)| asked.body(description, index, body)).collect();
    let joints = description.joints.iter().map(|joint| joint.kind.direction());
    let effects = description.effects.iter().map(|effect| effect.kind.direction());
    let directions: Vec<Option<AskedVector>> =
        joints.chain(effects).map(|direction| direction.map(|direction| asked.vector(direction))).collect();
    let surroundings = Surroundings { spatial: description.space.spatial, along };
    let asked_solids = solids::asked(description, surroundings, &mut asked);
    let first_length = asked.0.len();
    let pairs = pairs_of_points(description, &mut asked);

    let questions = Questions { outputs: asked.0.into(), ..Questions::of(description) };
    let assembled = match known {
        Some(known) => assembled_alike(&questions, known)?,
        None => assembled(&questions)?,
    };
    let nominal: Sample = assembled.system.parameters.iter().map(|parameter| parameter.nominal).collect();
    let values = DrawingValues(assembled.outputs_at_start(0..first_length, &nominal));
    let frames = bodies.iter().map(|body| values.frame(body)).collect();
    let solids = solids::solids(description, &asked_solids, &bodies, &values);
    let mut scene = Scene { description, bodies, frames, values, origins: BTreeSet::new() };
    let lengths = scene.lengths(&assembled, first_length, &pairs);
    let gravity = scene.gravity(&directions);
    let elements = scene.elements(&directions);
    Ok(Drawing {
        model: description.name.clone(),
        spatial: description.space.spatial,
        bodies: scene.drawn_bodies(),
        elements,
        solids,
        gravity,
        lengths,
    })
}

/// Asks the distances of each body's points, two and two.
fn pairs_of_points(description: &Description, asked: &mut DrawingOutputs) -> Vec<[PointRef; 2]> {
    let mut pairs = Vec::new();
    let few = |(_, body): &(usize, &Body)| body.points.len() <= TUNING.most_points;
    for (body, known) in description.bodies.iter().enumerate().filter(few) {
        for (second, point) in known.points.iter().enumerate() {
            for (first, other) in known.points[..second].iter().enumerate() {
                asked.distance(&other.position, &point.position);
                pairs.push([first, second].map(|point| PointRef { body, point: Some(point) }));
            }
        }
    }
    pairs
}

/// The axis along which a body's only coordinate is.
fn guide(body: &Body) -> Option<[f64; 3]> {
    match body.coordinates[..] {
        [Coordinate::X] => Some([1.0, 0.0, 0.0]),
        [Coordinate::Y] => Some([0.0, 1.0, 0.0]),
        [Coordinate::Z] => Some([0.0, 0.0, 1.0]),
        _ => None,
    }
}

/// The mechanism in numbers.
struct Scene<'d> {
    description: &'d Description,
    bodies: Vec<AskedBody>,
    frames: Vec<RelativeFrame>,
    values: DrawingValues,
    /// Bodies of which an element names the frame's origin.
    origins: BTreeSet<usize>,
}

/// An end of an element: point and body.
struct End {
    body: usize,
    position: Vector3<f64>,
}

fn drawn_element(
    name: &str,
    kind: &'static str,
    glyph: Glyph,
    ends: &[End],
    axis: Option<Vector3<f64>>,
) -> DrawnElement {
    DrawnElement {
        name: name.to_owned(),
        kind,
        glyph,
        ends: ends.iter().map(|end| end.position.into()).collect(),
        bodies: ends.iter().map(|end| end.body).collect(),
        axis: axis.map(Into::into),
    }
}

impl Scene<'_> {
    /// The frame at a point, in the ground's.
    fn frame(&self, of: PointRef) -> RelativeFrame {
        let frame = self.frames[of.body];
        let Some(point) = of.point else { return frame };
        let (position, rotation) = self.bodies[of.body].points[point];
        let rotation = frame.rotation * self.values.rotation(rotation);
        RelativeFrame { position: frame.place(self.values.vector(position)), rotation }
    }

    fn point(&mut self, of: PointRef) -> End {
        if of.point.is_none() {
            self.origins.insert(of.body);
        }
        End { body: of.body, position: self.frame(of).position }
    }

    /// A body's centre of mass.
    fn center(&self, body: usize) -> Vector3<f64> {
        let local = self.bodies[body].center_of_mass.map_or_else(Vector3::zeros, |center| self.values.vector(center));
        self.frames[body].place(local)
    }

    /// Ends of a joint: positions of its points, or of the joints that it couples.
    fn joint(&mut self, index: usize) -> Vec<End> {
        let kind = &self.description.joints[index].kind;
        if let Some(between) = kind.between() {
            return between.into_iter().map(|point| self.point(point)).collect();
        }
        let coupled: Vec<usize> = kind.coordinates(index).iter().map(|on| on.joint).filter(|&on| on != index).collect();
        coupled.into_iter().filter_map(|on| self.joint(on).pop()).collect()
    }

    /// Ends of an effect: the points, bodies and joints that it names.
    fn effect(&mut self, index: usize) -> Vec<End> {
        let mut kind = self.description.effects[index].kind.clone();
        let mut ends = Vec::new();
        for reference in kind.references() {
            match reference {
                Reference::Body(&mut body) => ends.push(End { body, position: self.center(body) }),
                Reference::Point(&mut point) => ends.push(self.point(point)),
                Reference::Joint(&mut joint) => ends.extend(self.joint(joint).pop()),
            }
        }
        ends
    }

    fn elements(&mut self, directions: &[Option<AskedVector>]) -> Vec<DrawnElement> {
        let (of_joints, of_effects) = directions.split_at(self.description.joints.len());
        let mut elements = Vec::with_capacity(directions.len());
        for (index, direction) in of_joints.iter().enumerate() {
            let ends = self.joint(index);
            let joint = &self.description.joints[index];
            let turned = joint.kind.between().map(|[first, _]| self.frame(first).rotation);
            let axis = direction.zip(turned).map(|(direction, turned)| turned * self.values.vector(direction));
            elements.push(drawn_element(&joint.name, joint.kind.keyword(), joint.kind.glyph(), &ends, axis));
        }
        for (index, direction) in of_effects.iter().enumerate() {
            let ends = self.effect(index);
            let effect = &self.description.effects[index];
            let axis = direction.map(|direction| self.values.vector(direction));
            elements.push(drawn_element(&effect.name, effect.kind.keyword(), effect.kind.glyph(), &ends, axis));
        }
        elements
    }

    /// The sum of the accelerations that act on every body.
    fn gravity(&self, directions: &[Option<AskedVector>]) -> Option<[f64; 3]> {
        let effects = self.description.effects.iter().zip(&directions[self.description.joints.len()..]);
        let everywhere = effects.filter(|(effect, _)| effect.kind.scope() == Scope::EveryBody);
        let accelerations = everywhere.filter_map(|(_, direction)| Some(self.values.vector((*direction)?)));
        accelerations.reduce(|a, b| a + b).map(Into::into)
    }

    fn drawn_bodies(&self) -> Vec<DrawnBody> {
        let drawn = |(index, body): (usize, &Body)| {
            let frame = self.frames[index];
            let named = body.points.iter().enumerate().map(|(point, known)| DrawnPoint {
                name: known.name.clone(),
                position: self.frame(PointRef { body: index, point: Some(point) }).position.into(),
            });
            let origin = self.origins.contains(&index);
            let origin = origin.then(|| DrawnPoint { name: String::new(), position: frame.position.into() });
            let quaternion = frame.rotation.quaternion();
            let spatial = self.description.space.spatial;
            DrawnBody {
                name: body.name.clone(),
                position: frame.position.into(),
                angle: self.values.angle(&self.bodies[index]).filter(|_| !spatial),
                orientation: spatial.then(|| [quaternion.w, quaternion.i, quaternion.j, quaternion.k]),
                guide: guide(body),
                center_of_mass: self.bodies[index].has_mass.then(|| self.center(index).into()),
                points: named.chain(origin).collect(),
            }
        };
        self.description.bodies.iter().enumerate().map(drawn).collect()
    }

    /// The pairs of points whose distance is an uncertain parameter, wherever in its interval that is.
    fn lengths(&self, assembled: &Assembled, first: usize, pairs: &[[PointRef; 2]]) -> Vec<DrawnLength> {
        let parameters = &assembled.system.parameters;
        let nominal: Vec<f64> = parameters.iter().map(|parameter| parameter.nominal).collect();
        let mut found = Vec::new();
        for (index, parameter) in parameters.iter().enumerate() {
            let ends = [parameter.lower, parameter.upper];
            let distances = ends.map(|end| {
                let mut sample = nominal.clone();
                sample[index] = end;
                assembled.outputs_at_start(first..first + pairs.len(), &sample.into())
            });
            let allowed = TUNING.same_length * (parameter.upper - parameter.lower);
            let is_it = |pair: &usize| (0..2).all(|end| (distances[end][*pair].sqrt() - ends[end]).abs() <= allowed);
            let Some(pair) = (0..pairs.len()).find(is_it) else { continue };
            found.push(DrawnLength {
                parameter: parameter.name.clone(),
                nominal: parameter.nominal,
                lower: parameter.lower,
                upper: parameter.upper,
                between: pairs[pair].map(|point| self.frame(point).position.into()),
            });
        }
        found
    }
}
