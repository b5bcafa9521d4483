//! Symbols of joints and effects, after ISO 3952.

use svg::node::element::path::Data;
use svg::node::element::{Circle, Group, Line, Path, Rectangle, Title};

use super::view::{Px, View};
use crate::elements::Glyph;
use crate::results::DrawnElement;

/// Half the length of a guide, px.
const GUIDE: f64 = 34.0;

/// Fewest teeth of a spring, and their distance in a long one, px.
const TEETH: usize = 7;
const PITCH: f64 = 14.0;

/// Half a spring's width, px.
const SWING: f64 = 6.0;

/// A coordinate rounded for the document.
pub(super) fn px(value: f64) -> f64 {
    // No −0.
    (10.0 * value).round() / 10.0 + 0.0
}

/// The symbol of an element; `None` if it has no symbol or no ends.
pub(super) fn glyph(element: &DrawnElement, view: &View) -> Option<Group> {
    let ends: Vec<Px> = element.ends.iter().map(|&end| view.px(end)).collect();
    let (&first, &last) = (ends.first()?, ends.last()?);
    let axis = element.axis.and_then(|axis| view.direction(axis));
    let along = axis.unwrap_or_else(|| Px::new(1.0, 0.0));
    let group = Group::new().add(Title::new(format!("{}: {}", element.name, element.kind)));
    let drawn = match element.glyph {
        Glyph::Nothing => return None,
        Glyph::Pin => group.add(circle(last, 5.0)),
        Glyph::Weld => group.add(block(last, along, Px::new(9.0, 9.0)).set("class", "filled")),
        Glyph::Ball => group.add(circle(last, 8.0)).add(circle(last, 4.5)),
        Glyph::Universal => [Px::new(5.7, 5.7), Px::new(5.7, -5.7)]
            .into_iter()
            .fold(group.add(circle(last, 8.0)), |group, arm| group.add(line(last - arm, last + arm))),
        Glyph::Slider => guide(group, first, along).add(block(last, along, Px::new(26.0, 16.0))),
        Glyph::Plane => guide(group, first, across(along)).add(block(last, across(along), Px::new(18.0, 12.0))),
        Glyph::Cylinder => guide(group, first, along)
            .add(block(last, along, Px::new(26.0, 16.0)))
            .add(line(last - 16.0 * along, last + 16.0 * along)),
        Glyph::Screw => [-8.0, -3.0, 2.0, 7.0].into_iter().fold(
            guide(group, first, along).add(block(last, along, Px::new(26.0, 16.0))),
            |group, at| {
                let foot = last + at * along - 8.0 * across(along);
                group.add(line(foot, foot + 3.0 * along + 16.0 * across(along)))
            },
        ),
        Glyph::Slot => [-7.0, 7.0]
            .into_iter()
            .fold(group, |group, side| {
                let middle = last + side * across(along);
                group.add(line(middle - GUIDE * along, middle + GUIDE * along))
            })
            .add(circle(last, 5.0)),
        Glyph::Rod => group.add(line(first, last)).add(circle(first, 4.0)).add(circle(last, 4.0)),
        Glyph::Gear => ends.iter().fold(group.add(line(first, last).set("class", "thin")), |group, &end| {
            group.add(circle(end, 12.0).set("class", "teeth"))
        }),
        Glyph::Motor => bent_arrow(group, last, 13.0),
        Glyph::Torque => bent_arrow(group, last, 17.0),
        Glyph::Spring => group.add(zigzag(first, last)),
        Glyph::TorsionSpring => group.add(spiral(last)),
        Glyph::Cable => group.add(line(first, last).set("class", "thin")),
        Glyph::Belt => group.add(line(first, last).set("class", "teeth")),
        Glyph::Beam => group.add(line(first, last).set("class", "beam")),
        Glyph::Force => arrow(group, last - 40.0 * along, last),
    };
    Some(drawn.set("class", "element"))
}

/// Hatching on the ground's side of a point.
pub(super) fn hatching(at: Px, along: Px) -> Group {
    let down = if across(along).y >= 0.0 { across(along) } else { -across(along) };
    let middle = at + 9.0 * down;
    (-2..=2).fold(
        Group::new().set("class", "ground").add(line(middle - 15.0 * along, middle + 15.0 * along)),
        |group, step| {
            let from = middle + 6.0 * f64::from(step) * along;
            group.add(line(from, from + 6.0 * down - 5.0 * along))
        },
    )
}

/// A straight arrow.
pub(super) fn arrow(group: Group, from: Px, to: Px) -> Group {
    let along = (to - from).try_normalize(0.0).unwrap_or_else(|| Px::new(1.0, 0.0));
    group.add(line(from, to)).add(head(to, along))
}

/// The head of an arrow.
pub(super) fn head(tip: Px, along: Px) -> Path {
    let (left, right) = (tip - 8.0 * along + 3.5 * across(along), tip - 8.0 * along - 3.5 * across(along));
    let data = Data::new().move_to(pair(tip)).line_to(pair(left)).line_to(pair(right)).close();
    Path::new().set("d", data).set("class", "filled")
}

/// A straight line.
pub(super) fn line(from: Px, to: Px) -> Line {
    Line::new().set("x1", px(from.x)).set("y1", px(from.y)).set("x2", px(to.x)).set("y2", px(to.y))
}

/// A direction turned by a right angle.
pub(super) fn across(along: Px) -> Px {
    Px::new(-along.y, along.x)
}

/// A point of a path.
pub(super) fn pair(at: Px) -> (f64, f64) {
    (px(at.x), px(at.y))
}

fn circle(at: Px, radius: f64) -> Circle {
    Circle::new().set("cx", px(at.x)).set("cy", px(at.y)).set("r", radius)
}

/// A rectangle about a point, turned to a direction.
pub(super) fn block(at: Px, along: Px, size: Px) -> Rectangle {
    let turned = [along.x, along.y, -along.y, along.x].map(|entry| format!("{:.4}", entry + 0.0));
    Rectangle::new()
        .set("x", -0.5 * size.x)
        .set("y", -0.5 * size.y)
        .set("width", size.x)
        .set("height", size.y)
        .set("transform", format!("matrix({} {} {})", turned.join(" "), px(at.x), px(at.y)))
}

fn guide(group: Group, through: Px, along: Px) -> Group {
    group.add(line(through - GUIDE * along, through + GUIDE * along).set("class", "thin"))
}

/// Three quarters of a circle about a point, with a head.
fn bent_arrow(group: Group, about: Px, radius: f64) -> Group {
    let (start, end) = (about + Px::new(radius, 0.0), about + Px::new(0.0, radius));
    let arc = Data::new().move_to(pair(start)).elliptical_arc_to((radius, radius, 0, 1, 0, px(end.x), px(end.y)));
    group.add(Path::new().set("d", arc).set("class", "open")).add(head(end, Px::new(1.0, 0.0)))
}

/// A spring from end to end, or a ring if they coincide.
fn zigzag(from: Px, to: Px) -> Path {
    let whole = to - from;
    let Some(along) = whole.try_normalize(4.0 * SWING) else {
        let ring = (SWING, SWING, 0, 1, 1, px(from.x), px(from.y + 0.1));
        let data = Data::new().move_to(pair(from)).elliptical_arc_to(ring);
        return Path::new().set("d", data).set("class", "open");
    };
    let teeth = TEETH.max((0.7 * whole.norm() / PITCH) as usize);
    let tooth = |tooth: usize| {
        let share = 0.15 + 0.7 * (tooth as f64 + 0.5) / teeth as f64;
        let side = if tooth.is_multiple_of(2) { SWING } else { -SWING };
        from + share * whole + side * across(along)
    };
    let data = Data::new().move_to(pair(from)).line_to(pair(from + 0.15 * whole));
    let data = (0..teeth).fold(data, |data, number| data.line_to(pair(tooth(number))));
    Path::new().set("d", data.line_to(pair(from + 0.85 * whole)).line_to(pair(to))).set("class", "open")
}

/// A spiral of two turns, of quarter circles.
fn spiral(about: Px) -> Path {
    let corners = [Px::new(1.0, 0.0), Px::new(0.0, -1.0), Px::new(-1.0, 0.0), Px::new(0.0, 1.0)];
    let at = |quarter: usize| about + (3.0 + 1.4 * quarter as f64) * corners[quarter % 4];
    let data = (1..=8).fold(Data::new().move_to(pair(at(0))), |data, quarter| {
        let (radius, end) = (3.0 + 1.4 * quarter as f64, at(quarter));
        data.elliptical_arc_to((px(radius), px(radius), 0, 0, 0, px(end.x), px(end.y)))
    });
    Path::new().set("d", data).set("class", "open")
}
