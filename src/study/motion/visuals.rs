//! What a robot's bodies look like, in their frames.

use nalgebra::{Quaternion, UnitQuaternion, Vector3};
use symdiff::math;

use crate::grammar::PointRef;
use crate::model::{Description, Shape, Visual};
use crate::results::MovingVisual;
use crate::study::drawing::asked::{AskedBody, Frame, Values};

/// Of all links that the model has, with its parameters at their nominal values.
pub(super) fn visuals(description: &Description, bodies: &[AskedBody], values: &Values) -> Vec<MovingVisual> {
    let links = description.robot.iter().flat_map(|robot| &robot.links);
    let placed = links.filter_map(|link| Some((link.place?, &link.visuals)));
    placed
        .flat_map(|(place, visuals)| visuals.iter().map(move |visual| (place, visual)))
        .map(|(place, visual)| of_link(place, visual, bodies, values))
        .collect()
}

fn of_link(place: PointRef, visual: &Visual, bodies: &[AskedBody], values: &Values) -> MovingVisual {
    let frame = place.point.map_or_else(
        || Frame { position: Vector3::zeros(), rotation: UnitQuaternion::identity() },
        |point| {
            let (position, rotation) = bodies[place.body].points[point];
            Frame { position: values.vector(position), rotation: values.rotation(rotation) }
        },
    );
    let turned = (frame.rotation * roll_pitch_yaw(visual.rpy)).into_inner();
    let (shape, size, file) = match &visual.shape {
        Shape::Box(sides) => ("box", sides.to_vec(), None),
        Shape::Cylinder { radius, length } => ("cylinder", vec![*radius, *length], None),
        Shape::Sphere(radius) => ("sphere", vec![*radius], None),
        Shape::Mesh { file, scale } => ("mesh", scale.to_vec(), Some(file.clone())),
    };
    MovingVisual {
        body: place.body,
        position: frame.place(visual.xyz.into()).into(),
        orientation: [turned.w, turned.i, turned.j, turned.k],
        shape,
        size,
        color: visual.color,
        file,
    }
}

/// About the fixed x, then y, then z, by sines and cosines that are the same bits everywhere.
fn roll_pitch_yaw([roll, pitch, yaw]: [f64; 3]) -> UnitQuaternion<f64> {
    let about = |axis: Vector3<f64>, angle: f64| {
        let half = 0.5 * angle;
        UnitQuaternion::new_unchecked(Quaternion::from_parts(math::cos(half), math::sin(half) * axis))
    };
    about(Vector3::z(), yaw) * about(Vector3::y(), pitch) * about(Vector3::x(), roll)
}
