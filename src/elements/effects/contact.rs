//! Contact of a surface on the first body with a circle, sphere, cylinder or mere point (radius r) on the second.
//!
//! ```text
//! plane through A, normal n:    gap = n · (r_B − r_A) − r
//! round, radius R:              gap = |d| − R − r,     n = d/|d|,      d = r_B − r_A
//! hollow, radius R > r:         gap = R − r − |d|,     n = −d/|d|
//! F_B = f(−gap) n − R_μ v_t,    F_A = −F_B          N, both at r_B − r n
//! ```
//!
//! f is that of `impact`, R_μ that of `dry_friction` under the load f, v_t the tangential part of the velocity of the second
//! surface against the first. In space round surfaces are spheres, or cylinders with parallel axes where an axis is
//! given: d is then taken across it. Centres that coincide have no direction between them: inside a hollow |d| is
//! √(d² + ε²), ε = 10⁻⁴ (R − r), which moves the wall by half of 10⁻⁸ of the clearance. One round body in another, or two whose
//! centres meet, is no contact that this can tell. Apart the force and its slopes are exactly zero, and of a tile of samples that
//! all are apart only the sign of the gap is computed: without a root, from squares.

use mbint_derive::Element;
use symdiff::Formula;

use super::{ForceElement, Friction, Impact, Sensor};
use crate::grammar::quantity::Dimension;
use crate::grammar::{Axis, Checked, Direction, Fields, Measure, PointRef, Reader, SymbolTable};

/// Contact of a plane, circle, sphere or cylinder on one body with a circle, sphere, cylinder or point on another.
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
    /// Of the second; with 0 it is a point.
    #[quantity(unit = "m", constant, nonnegative, default = 0)]
    pub radius: Formula,
    /// Instead of `plane`: radius of a hollow circle, sphere or cylinder that the second is in.
    #[quantity(unit = "m", constant, positive, above = radius)]
    pub hollow: Option<Formula>,
    /// In space: axis of two parallel cylinders, in the first point's frame.
    #[key(otherwise = "they are spheres")]
    pub axis: Option<Axis>,
    /// How the surfaces push each other apart.
    pub impact: Impact,
    /// How they resist sliding.
    #[key(otherwise = "not at all")]
    pub friction: Option<Friction>,
}

/// What two surfaces measure.
pub(super) const SENSORS: &[Sensor] = &[
    (Measure::GAP, Dimension::LENGTH),
    (Measure::RATE, Dimension::VELOCITY),
    (Measure::FORCE, Dimension::FORCE),
    (Measure::FRICTION, Dimension::FORCE),
];

impl ForceElement for Contact {
    const SENSORS: &'static [Sensor] = SENSORS;
}

impl Checked for Contact {
    fn check_keys<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        let given = ["plane", "circle", "hollow"].into_iter().filter(|key| fields.get(key).is_some());
        match given.collect::<Vec<_>>().as_slice() {
            [] => {
                let help = "say what the first body's surface is, e.g. `plane: y`".to_owned();
                reader.error(fields.at.clone(), "a contact needs `plane`, `circle` or `hollow`", help);
            }
            [_] => {}
            [_, second, ..] => {
                let message = "`plane`, `circle` and `hollow` exclude one another";
                reader.error(fields.key_span(second), message, None);
            }
        }
    }
}
