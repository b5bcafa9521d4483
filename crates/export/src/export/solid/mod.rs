//! Forms for pictures: flat faces, or points with a radius around their hull.

mod faces;
mod flat;
mod frame;

pub(super) use faces::{Face, faces, moved_out};
pub(super) use flat::{normal, polyline, triangulated};
pub(super) use frame::SolidFrame;

use crate::elements::Form;

/// Points of which a form is the convex hull, with all points within a radius of it; `None` if the form is no such
/// hull.
pub(super) fn core(form: &Form<f64>) -> Option<(Vec<[f64; 3]>, f64)> {
    match form {
        Form::Sphere { radius } => Some((vec![[0.0; 3]], *radius)),
        Form::Capsule { ends, radius } => Some((ends.to_vec(), *radius)),
        Form::Hull { points, radius } => Some((points.clone(), *radius)),
        Form::Box { size, radius } => Some((faces::corners(*size).to_vec(), *radius)),
        _ => None,
    }
}

/// Points whose convex hull contains a form, in its frame.
pub(super) fn reach(form: &Form<f64>) -> Vec<[f64; 3]> {
    let around = |point: [f64; 3], radius: f64| {
        (0..3).flat_map(move |axis| {
            [-radius, radius].map(|step| {
                let mut beside = point;
                beside[axis] += step;
                beside
            })
        })
    };
    if let Some((points, radius)) = core(form) {
        return points.into_iter().flat_map(|point| around(point, radius)).collect();
    }
    match form {
        Form::Outline { points, is_closed, radius, .. } => {
            polyline(points, *is_closed).into_iter().flat_map(|point| around(point, *radius)).collect()
        }
        Form::Bore { radius, .. } => around([0.0; 3], *radius).collect(),
        Form::HalfSpace { .. } => vec![[0.0; 3]],
        Form::Ground { points } => points.clone(),
        _ => faces(form).into_iter().flatten().collect(),
    }
}
