//! Surfaces of a contact for pictures: the forms that its forces are computed with.

use symdiff::{Binary, Formula};

use crate::elements::effects::{Contact, ContactLine};
use crate::elements::tuning::TUNING;
use crate::elements::{Form, Shape, Surroundings};
use crate::grammar::OfPlace;

fn number(value: f64) -> Formula {
    Formula::number(value)
}

/// Surface of the first body, in the first point's frame.
pub fn of_first(contact: &Contact, surroundings: Surroundings) -> Option<Form<Formula>> {
    let radius = contact.rounding.clone();
    let axis = contact.axis.as_ref().filter(|_| surroundings.spatial).map(|axis| axis.0.clone());
    let outline = |course: &ContactLine, is_closed: bool| Form::Outline {
        points: course.bends(),
        is_closed,
        thickness: number(0.0),
        radius: contact.rounding.clone(),
    };
    if let Some(normal) = &contact.plane {
        Some(Form::HalfSpace { normal: normal.0.clone() })
    } else if let Some(outer) = &contact.circle {
        Some(round(axis, outer))
    } else if let Some(bore) = &contact.hollow {
        Some(Form::Bore { axis: axis.unwrap_or([0.0, 0.0, 1.0].map(number)), radius: bore.clone() })
    } else if let Some(course) = &contact.path {
        Some(outline(course, false))
    } else if let Some(course) = &contact.polygon {
        Some(outline(course, true))
    } else if let Some(height) = &contact.height {
        Some(Form::Ground { points: ground(height, surroundings)? })
    } else if let Some(ends) = &contact.capsule {
        Some(Form::Capsule { ends: two(ends)?, radius })
    } else if let Some(size) = &contact.block {
        Some(Form::Box { size: size.0.clone(), radius })
    } else {
        contact.hull.as_ref().map(|points| Form::Hull { points: points.to_vec(), radius })
    }
}

/// Surfaces of the second body, in the second point's frame.
pub fn of_second(contact: &Contact, surroundings: Surroundings) -> Vec<Shape> {
    let radius = contact.radius.clone();
    let form = if let Some(ends) = &contact.line {
        two(ends).map(|ends| Form::Capsule { ends, radius })
    } else if let Some(ends) = &contact.cylinder {
        return two(ends).map(|ends| between(ends, radius)).into_iter().collect();
    } else if let Some(size) = &contact.r#box {
        Some(Form::Box { size: size.0.clone(), radius })
    } else if let Some(points) = &contact.polyhedron {
        Some(Form::Hull { points: points.to_vec(), radius })
    } else if let Some(corners) = contact.corners.as_ref().filter(|corners| corners.len() > 2) {
        // A rigid body that touches with its corners also contains the space between them.
        Some(Form::Hull { points: corners.to_vec(), radius })
    } else if contact.radius.as_number() == Some(0.0) {
        None
    } else if let Some(corners) = &contact.corners {
        let ball = |corner: &[Formula; 3]| Shape::at(corner.clone(), Form::Sphere { radius: radius.clone() });
        return corners.iter().map(ball).collect();
    } else {
        let axis = contact.axis.as_ref().filter(|_| surroundings.spatial).map(|axis| axis.0.clone());
        Some(round(axis, &radius))
    };
    form.map(Shape::in_place).into_iter().collect()
}

/// A ball, or a cylinder if it has an axis; nothing determines the cylinder's length.
fn round(axis: Option<[Formula; 3]>, radius: &Formula) -> Form<Formula> {
    match axis {
        Some(axis) => {
            let length = radius.combined(Binary::Mul, &number(2.0));
            Form::Cylinder { axis, length, radius: radius.clone() }
        }
        None => Form::Sphere { radius: radius.clone() },
    }
}

/// A cylinder between the centres of its faces.
fn between([start, end]: [[Formula; 3]; 2], radius: Formula) -> Shape {
    let each = |function: Binary| [0, 1, 2].map(|axis: usize| end[axis].combined(function, &start[axis]));
    let axis = each(Binary::Sub);
    let square = |part: &Formula| part.combined(Binary::Mul, part);
    let [x, y, z] = axis.each_ref().map(square);
    let square = x.combined(Binary::Add, &y).combined(Binary::Add, &z);
    let length = square.combined(Binary::Pow, &number(0.5));
    let middle = each(Binary::Add).map(|sum| sum.combined(Binary::Mul, &number(0.5)));
    Shape::at(middle, Form::Cylinder { axis, length, radius })
}

fn two(ends: &[[Formula; 3]]) -> Option<[[Formula; 3]; 2]> {
    Some([ends.first()?.clone(), ends.last()?.clone()])
}

/// Points of ground, whose height is a formula of x.
fn ground(height: &OfPlace, surroundings: Surroundings) -> Option<Vec<[Formula; 3]>> {
    let [from, to] = surroundings.along?;
    let at = |piece: u32| {
        let x = number(from + (to - from) * f64::from(piece) / f64::from(TUNING.pieces_of_ground));
        let height = height.0.with_names(|name| (name == OfPlace::VARIABLE).then(|| x.clone()));
        if surroundings.spatial { [x, number(0.0), height] } else { [x, height, number(0.0)] }
    };
    Some((0..=TUNING.pieces_of_ground).map(at).collect())
}
