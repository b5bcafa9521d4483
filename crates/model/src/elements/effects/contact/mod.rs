//! Contact of a surface on the first body with circles, spheres, a cylinder or mere points (radius r) on the second.
//!
//! ```text
//! plane through A, normal n:    gap = n · (r_B − r_A) − r
//! round, radius R:              gap = |d| − R − r,     n = d/|d|,      d = r_B − r_A
//! hollow, radius R > r:         gap = R − r − |d|,     n = −d/|d|
//! height h(x, t):               see `ground`
//! edges, rounding ρ:            see `outline`
//! capsule, block, rounding ρ:   see `solid`
//! hull, rounding ρ:             see `hull`
//! of the second, a line:        see `rod`
//! cylinder:                     see `cylinder`, `cylinder_touches`
//! box, polyhedron:              see `polyhedron`
//! F_B = f(−gap) n − R_μ v_t,    F_A = −F_B          N, both at r_B − r n
//! ```
//!
//! f is that of `impact`, R_μ that of `dry_friction` under the load f, v_t the tangential part of the velocity of the
//! second surface against the first. In space round surfaces are spheres, or cylinders with parallel axes if an axis is
//! given: d is then taken across it. Centres that coincide have no direction between them: inside a hollow |d| is
//! √(d² + ε²), ε = 10⁻⁴ (R − r), which moves the wall by half of 10⁻⁸ of the clearance. A round body inside another, or
//! two with coincident centres, is not recognised as a contact. Apart the force and its derivatives are exactly zero,
//! and for a tile of samples that all are apart only the sign of the gap is computed: without a root, from squares.

mod along_hull;
mod arc;
mod beside;
pub(super) mod course;
mod cylinder;
mod cylinder_touches;
mod facets;
pub(super) mod felt;
mod ground;
pub(super) mod hull;
mod outline;
mod polyhedron;
mod rod;
pub(super) mod solid;
mod surfaces;
pub(super) mod touch;

use std::rc::Rc;

use mbint_derive::Element;
use symdiff::{Formula, Scalar};

use self::course::{ContactLine, Points, placed};
use self::cylinder::ContactCylinder;
use self::felt::{Felt, SENSORS};
use self::ground::Ground;
use self::hull::Hull;
use self::outline::ContactEdges;
use self::polyhedron::Polyhedron;
use self::rod::Rod;
use self::solid::Solid;
use self::touch::{ContactLaw, ContactSurface, Touch};
use super::laws::impact::Push;
use super::{ForceElement, Forces, Friction, FrictionAlong, Impact, TypedSensor};
use crate::elements::{Shape, SurfaceAt, Surroundings};
use crate::grammar::{Axis, Checked, Components, Direction, Fields, OfPlace, PointRef, Reader, SymbolTable};
use crate::multibody::{BuildError, Pair, Vector};
use crate::syntax::codes::Code;

/// Contact of a plane, a circle, a sphere, a cylinder, a capsule, a block, a hull or edges on one body with a circle,
/// sphere, capsule, cylinder or point on another.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "contact",
    what = "a contact",
    equation = "f = K ⟨δ⟩ⁿ ⟨1 + χ δ̇⟩, δ = −gap; friction μ f s(u) u/√(u² + u₀²)",
    source = "Hunt & Crossley, J. Appl. Mech. 42 (1975) 440; Lankarani & Nikravesh, J. Mech. Des. 112 (1990) 369",
    example = "{ between: [ground, ball], plane: y, radius: 0.1, impact: { stiffness: 1e6, restitution: 0.8, impact_velocity: 3 }, friction: { coefficient: 0.3 } }",
    checked
)]
pub struct Contact {
    /// A point of the first surface or its centre, then the centre of the second; each `body.point` or `body`.
    pub between: [PointRef; 2],
    /// Normal of a plane in the first point's frame, to the side where the second body is.
    pub plane: Option<Direction>,
    /// Instead of `plane`: radius of a circle, sphere or cylinder.
    #[quantity(unit = "m", constant, positive)]
    pub circle: Option<Formula>,
    /// Radius of the second body's surface; with 0 it is a point.
    #[quantity(unit = "m", constant, nonnegative, default = 0)]
    pub radius: Formula,
    /// Instead of `plane`: radius of a hollow circle, sphere or cylinder that the second is in.
    #[quantity(unit = "m", constant, positive, above = radius)]
    pub hollow: Option<Formula>,
    /// Instead of `plane`: points of a line in x and y of the first point's frame; both of its sides are surfaces.
    /// `{ to: [x, y], radius: R }` is an arc to a point.
    #[quantity(unit = "m", constant)]
    pub path: Option<ContactLine>,
    /// Instead of `plane`: corners of a closed line, in their order, with arcs as in `path`.
    #[quantity(unit = "m", constant)]
    pub polygon: Option<ContactLine>,
    /// Instead of `plane`: height of the ground over the first point, a formula of `x` along x of its frame and of t;
    /// up is y, in space z.
    #[quantity(unit = "m", time)]
    pub height: Option<OfPlace>,
    /// Instead of `plane`: both ends of the line in the middle of a capsule, in the first point's frame; its radius is
    /// the `rounding`.
    #[quantity(unit = "m", constant)]
    pub capsule: Option<Points>,
    /// Instead of `plane`: lengths of a block along the axes of the first point's frame, about that point.
    #[quantity(unit = "m", constant)]
    #[key(image = Same)]
    pub block: Option<Components>,
    /// Instead of `plane`: in space, points whose convex hull it is, in the first point's frame.
    #[quantity(unit = "m", constant)]
    pub hull: Option<Points>,
    /// How far the surface lies outside of a `path`, `polygon`, `capsule`, `block` or `hull`.
    #[quantity(unit = "m", constant, nonnegative, default = 0)]
    pub rounding: Formula,
    /// Points of the second point's frame that touch, each with the `radius`.
    #[quantity(unit = "m", constant, otherwise = "the second point itself")]
    pub corners: Option<Points>,
    /// Both ends of the line in the middle of a capsule on the second body, in the second point's frame; its radius is
    /// the `radius`.
    #[quantity(unit = "m", constant, otherwise = "no capsule")]
    pub line: Option<Points>,
    /// In space: centres of both faces of a cylinder on the second body, in the second point's frame; its radius is the
    /// `radius`.
    #[quantity(unit = "m", constant, otherwise = "no cylinder")]
    pub cylinder: Option<Points>,
    /// In space: lengths of a box on the second body along the axes of the second point's frame, about that point; its
    /// surface is the `radius` outside.
    #[quantity(unit = "m", constant, otherwise = "no box")]
    #[key(image = Same)]
    pub r#box: Option<Components>,
    /// In space: points whose convex hull is on the second body, in the second point's frame; its surface is the
    /// `radius` outside.
    #[quantity(unit = "m", constant, otherwise = "no polyhedron")]
    pub polyhedron: Option<Points>,
    /// In space: axis of two parallel cylinders, in the first point's frame.
    #[key(otherwise = "they are spheres")]
    pub axis: Option<Axis>,
    /// How the surfaces push each other apart.
    pub impact: Impact,
    /// How they resist sliding.
    #[key(otherwise = "not at all")]
    pub friction: Option<Friction>,
    /// Another coefficient of friction along one direction.
    #[key(otherwise = "all directions are alike")]
    pub friction_along: Option<FrictionAlong>,
}

/// Keys of the first body's surface.
const SURFACES: [&str; 9] = ["plane", "circle", "hollow", "path", "polygon", "height", "capsule", "block", "hull"];

impl ForceElement for Contact {
    const RESISTS: bool = true;
    const SENSORS: &'static [TypedSensor] = SENSORS;

    fn surfaces(&self, surroundings: Surroundings) -> Vec<SurfaceAt> {
        let [first, second] = self.between;
        let first = surfaces::of_first(self, surroundings).map(|form| (first, Shape::in_place(form)));
        let second = surfaces::of_second(self, surroundings).into_iter().map(|shape| (second, shape));
        first.into_iter().chain(second).collect()
    }

    fn apply<'g>(&self, forces: &mut dyn Forces<'g>) -> Result<(), BuildError> {
        let radius = forces.prescribed(&self.radius)?;
        let Some(surface) = self.surface(forces, radius)? else { return Ok(()) };
        let impact = Push::of(forces, &self.impact)?;
        let friction = self.friction.as_ref().map(|friction| friction.resistance(forces)).transpose()?;
        let along = match &self.friction_along {
            Some(along) => Some((direction(forces, &along.direction)?, forces.value(&along.coefficient)?)),
            None => None,
        };
        let pair = forces.pair(self.between);
        let felt: Vec<Felt<'g>> = if let ContactSurface::Edges(outline) = &surface {
            let centres = self.corners(forces, &pair)?.into_iter();
            centres.map(|centre| outline.apply(forces, &pair, centre, &impact, friction.as_ref())).collect()
        } else {
            let law = ContactLaw { impact, friction, along };
            let touches = self.touches(forces, &surface, radius, &pair)?.into_iter();
            touches.map(|touch| law.act(forces, &pair, touch)).collect()
        };
        if let Some(felt) = felt.into_iter().reduce(Felt::and) {
            if let Some(deepest) = self.deepest(forces, &surface, radius)? {
                forces.overlaps_to(felt.gap, deepest);
            }
            felt.measured(forces);
        }
        Ok(())
    }
}

/// A unit vector.
fn direction<'g>(forces: &dyn Forces<'g>, formulas: &[Formula; 3]) -> Result<Vector<'g>, BuildError> {
    forces.prescribed_vector(formulas).map(Vector::unit)
}

impl Contact {
    /// Largest overlap of the surfaces: up to the line or the edge that one of them surrounds. `None` if overlaps may
    /// be of any depth, or if the surfaces surround nothing with a radius.
    fn deepest<'g>(
        &self,
        forces: &dyn Forces<'g>,
        surface: &ContactSurface<'g>,
        radius: Scalar<'g>,
    ) -> Result<Option<Scalar<'g>>, BuildError> {
        let deepest = match surface {
            ContactSurface::Edges(_) => forces.prescribed(&self.rounding)? + radius,
            ContactSurface::Whole(touch::WholeSurface::Solid(_, reach) | touch::WholeSurface::Hull(_, reach)) => *reach,
            ContactSurface::Whole(touch::WholeSurface::Round(outer)) => *outer + radius,
            ContactSurface::Whole(
                touch::WholeSurface::Plane(_) | touch::WholeSurface::Hollow(_) | touch::WholeSurface::Ground(_),
            ) => return Ok(None),
        };
        Ok((!deepest.is_zero()).then_some(deepest))
    }

    /// Surface of the first body.
    fn surface<'g>(
        &self,
        forces: &dyn Forces<'g>,
        radius: Scalar<'g>,
    ) -> Result<Option<ContactSurface<'g>>, BuildError> {
        // A cylinder's axis is no line that all of it is about.
        let around = if self.cylinder.is_some() { forces.graph().number(0.0) } else { radius };
        Ok(Some(if let Some(normal) = &self.plane {
            ContactSurface::Whole(touch::WholeSurface::Plane(direction(forces, normal)?))
        } else if let Some(outer) = &self.circle {
            ContactSurface::Whole(touch::WholeSurface::Round(forces.prescribed(outer)?))
        } else if let Some(bore) = &self.hollow {
            ContactSurface::Whole(touch::WholeSurface::Hollow(forces.prescribed(bore)? - radius))
        } else if let Some(points) = &self.path {
            ContactSurface::Edges(self.outline(forces, points, false)?)
        } else if let Some(points) = &self.polygon {
            ContactSurface::Edges(self.outline(forces, points, true)?)
        } else if let Some(height) = &self.height {
            ContactSurface::Whole(touch::WholeSurface::Ground(Ground::of(forces, height, radius)?))
        } else if let Some(solid) = self.solid(forces)? {
            ContactSurface::Whole(touch::WholeSurface::Solid(solid, forces.prescribed(&self.rounding)? + around))
        } else if let Some(hull) = hull_of(forces, self.hull.as_ref())? {
            ContactSurface::Whole(touch::WholeSurface::Hull(hull, forces.prescribed(&self.rounding)? + around))
        } else {
            return Ok(None);
        }))
    }

    /// Where the surface touches the forms of the second body.
    fn touches<'g>(
        &self,
        forces: &dyn Forces<'g>,
        surface: &ContactSurface<'g>,
        radius: Scalar<'g>,
        pair: &Pair<'g>,
    ) -> Result<Vec<Touch<'g>>, BuildError> {
        if let Some(axis) = self.rod(forces, self.cylinder.as_ref())? {
            let near = surface.is_near(&axis, radius, pair);
            let touches = cylinder_touches::touches(surface, &ContactCylinder { axis, radius }, pair).into_iter();
            return Ok(touches.map(|touch| touch.only_within(near)).collect());
        }
        if let Some(lengths) = &self.r#box {
            let half = forces.prescribed_vector(lengths)?.map(|length| 0.5 * length).components();
            return Ok(Polyhedron::block(half, radius).touches(surface, pair));
        }
        if let Some(hull) = hull_of(forces, self.polyhedron.as_ref())? {
            return Ok(Polyhedron::hull(hull, radius).touches(surface, pair));
        }
        let axis = self.axis.as_ref().filter(|_| forces.is_spatial());
        let axis = axis.map(|axis| direction(forces, axis)).transpose()?;
        let line = self.rod(forces, self.line.as_ref())?;
        let centres = match &line {
            Some(line) => surface.centres_on(line, pair),
            None => self.corners(forces, pair)?,
        };
        let near = line.and_then(|line| surface.is_near(&line, forces.graph().number(0.0), pair));
        let ContactSurface::Whole(shape) = surface else { return Ok(Vec::new()) };
        Ok(centres.into_iter().map(|centre| shape.touch(pair, centre, radius, axis).only_within(near)).collect())
    }

    /// Points of the second body, in the ground's frame.
    fn corners<'g>(&self, forces: &dyn Forces<'g>, pair: &Pair<'g>) -> Result<Vec<Vector<'g>>, BuildError> {
        let centre = pair.second.point.position;
        let Some(corners) = &self.corners else { return Ok(vec![centre]) };
        let corners = placed(forces, corners)?.into_iter();
        Ok(corners.map(|corner| centre + pair.outward_of_second(corner)).collect())
    }

    fn rod<'g>(&self, forces: &dyn Forces<'g>, ends: Option<&Points>) -> Result<Option<Rod<'g>>, BuildError> {
        let ends = ends.map(|ends| placed(forces, ends)).transpose()?.unwrap_or_default();
        Ok(ends.first().zip(ends.last()).map(|(start, end)| Rod::between(*start, *end)))
    }

    fn solid<'g>(&self, forces: &dyn Forces<'g>) -> Result<Option<Solid<'g>>, BuildError> {
        if let Some(ends) = &self.capsule {
            let ends = placed(forces, ends)?;
            return Ok(ends.first().zip(ends.last()).map(|(start, end)| Solid::between(*start, *end)));
        }
        let Some(lengths) = &self.block else { return Ok(None) };
        let half = forces.prescribed_vector(lengths)?.map(|length| 0.5 * length).components().map(Some);
        let [x, y, z] = half;
        Ok(Some(Solid::Block { half: [x, y, z.filter(|_| forces.is_spatial())] }))
    }

    fn outline<'g>(
        &self,
        forces: &dyn Forces<'g>,
        course: &ContactLine,
        closed: bool,
    ) -> Result<ContactEdges<'g>, BuildError> {
        let corners = course.corners(forces)?;
        let (rounding, radius) = (forces.prescribed(&self.rounding)?, forces.prescribed(&self.radius)?);
        Ok(ContactEdges::through(&corners, closed, rounding, radius))
    }
}

/// The convex hull of points; the reader lets numbers through only.
fn hull_of<'g>(forces: &dyn Forces<'g>, points: Option<&Points>) -> Result<Option<Rc<Hull>>, BuildError> {
    let Some(points) = points else { return Ok(None) };
    let number = |point: Vector| point.components().map(|part| part.as_constant().unwrap_or(f64::NAN));
    Ok(Hull::of(placed(forces, points)?.into_iter().map(number).collect()).map(Rc::new))
}

impl Checked for Contact {
    fn check_keys<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        let given = SURFACES.into_iter().filter(|key| fields.get(key).is_some());
        if fields.get("friction_along").is_some() {
            let at = fields.key_span("friction_along");
            if fields.get("friction").is_none() {
                reader.error(Code::MissingKey, at, "`friction_along` needs `friction`, which holds across it", None);
            } else if let Some(edges) = ["path", "polygon"].into_iter().find(|key| fields.get(key).is_some()) {
                reader.error(Code::MisplacedKey, at, format!("`friction_along` does not go with `{edges}`"), None);
            }
        }
        rod::check_keys(reader, fields, &SURFACES);
        match given.collect::<Vec<_>>().as_slice() {
            [] if !fields.lacks_all(&SURFACES) => {}
            [] => {
                let help = "give the first body's surface, e.g. `plane: y`".to_owned();
                let message = "a contact needs `plane`, `circle`, `hollow`, `path`, `polygon`, `height`, `capsule`, `block` or `hull`";
                reader.error(Code::IncompleteElement, fields.at.clone(), message, help);
            }
            ["capsule"] => {
                if fields.lacks_all(&["rounding"]) {
                    let message = "a `capsule` needs `rounding`, which is its radius";
                    reader.error(Code::MisplacedKey, fields.key_span("capsule"), message, None);
                }
            }
            [edges @ ("path" | "polygon" | "block" | "hull")] => {
                if fields.lacks_all(&["rounding", "radius"]) {
                    let message = format!("a `{edges}` needs `rounding`, or the other surface a `radius`");
                    let help = "surfaces are told apart to that depth".to_owned();
                    reader.error(Code::IncompleteElement, fields.key_span(edges), message, help);
                }
            }
            [surface] => {
                if fields.get("rounding").is_some() {
                    let message = format!(
                        "`rounding` goes with `path`, `polygon`, `capsule`, `block` or `hull`, not with `{surface}`"
                    );
                    reader.error(Code::MisplacedKey, fields.key_span("rounding"), message, None);
                }
            }
            [first, second, ..] => {
                reader.error(
                    Code::ExclusiveKeys,
                    fields.key_span(second),
                    format!("`{first}` and `{second}` exclude each other"),
                    None,
                );
            }
        }
    }

    fn check<S: SymbolTable>(&self, reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        for (key, points, least) in [("path", &self.path, 2), ("polygon", &self.polygon, 3)] {
            if let Some(points) = points {
                points.check_edges(reader, fields.key_span(key), key, least);
            }
        }
        if let Some(corners) = &self.corners {
            rod::check_corners(reader, fields, corners);
        }
        for (key, ends) in [("capsule", &self.capsule), ("line", &self.line), ("cylinder", &self.cylinder)] {
            if let Some(ends) = ends {
                solid::check_ends(reader, fields.key_span(key), key, ends);
            }
        }
        for (key, points) in [("hull", &self.hull), ("polyhedron", &self.polyhedron)] {
            if let Some(points) = points {
                hull::check(reader, fields, key, points);
            }
        }
        if let Some(key) = ["box", "polyhedron"].into_iter().find(|key| fields.get(key).is_some())
            && (self.block.is_some() || self.hull.is_some())
        {
            polyhedron::check_edges(reader, fields.key_span(key), self.hull.as_ref(), self.polyhedron.as_ref());
        }
        for (key, lengths) in [("block", &self.block), ("box", &self.r#box)] {
            if let Some(lengths) = lengths {
                solid::check_lengths(reader, fields.key_span(key), key, lengths);
            }
        }
    }
}
