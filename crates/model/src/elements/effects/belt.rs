//! An endless belt or chain between two pulleys: two strands that pull, and do not push.
//!
//! ```text
//! u = r₁ θ₁ − σ r₂ (θ₂ − offset)          m, σ = 1 of an open belt, −1 of a crossed one
//! x₁ = F₀/k + ΔL + u,   x₂ = F₀/k + ΔL − u          stretch of the strand that pulls against θ₁, and of the other
//! Tᵢ = ⟨k p(xᵢ) + c p'(xᵢ) ẋᵢ⟩,   V = k Σ ∫p dx          N, J
//! τ₁ = −r₁ (T₁ − T₂),   τ₂ = σ r₂ (T₁ − T₂)          N m
//! ```
//!
//! p is the positive part with its corner rounded (`positive_part`). The belt does not slip: while both strands are
//! taut and at rest, T₁ − T₂ is the torque over the radius, T₁ + T₂ = 2 F₀, and θ₂ follows σ (r₁/r₂) θ₁ but for the
//! stretch u. With `centers` the strands also pull the shafts together, and stretch as the centres part:
//!
//! ```text
//! L = √(d² − (r₁ − σ r₂)²),   ΔL = L(d) − L(distance),   F = (T₁ + T₂) d/L along the line of centres          m, N
//! ```
//!
//! Angles are those of two bodies about z, or of two joints: then the line of centres may turn with the joints' first
//! bodies.

use mbint_derive::{Choice, Element};
use symdiff::{Binary, Formula};

use super::laws::positive_part::{PositivePart, clipped};
use super::{ForceElement, Forces, TypedSensor};
use crate::elements::Glyph;
use crate::elements::tuning::TUNING;
use crate::grammar::quantity::Dimension;
use crate::grammar::{
    Checked, Fields, JointCoordinate, OnJoint, PointRef, Reader, Rotating, Sensor, SymbolTable, TimeOrder,
};
use crate::multibody::BuildError;
use crate::syntax::codes::Code;

/// An endless belt or chain between two pulleys, without slip.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "belt",
    what = "a belt",
    equation = "Tᵢ = ⟨k p(xᵢ) + c p'(xᵢ) ẋᵢ⟩, x = F₀/k + ΔL ± (r₁ θ₁ − σ r₂ (θ₂ − offset))",
    equation = "τ₁ = −r₁ (T₁ − T₂), τ₂ = σ r₂ (T₁ − T₂), σ = 1 of an open belt, −1 of a crossed one",
    source = "Johnson, Contact Mechanics (1985), ch. 8; without slip",
    example = "{ between: [pinion, wheel], first_radius: 20 mm, second_radius: 50 mm, stiffness: 1e5, damping: 20, preload: 200 N }",
    checked
)]
pub struct Belt {
    /// Two bodies (their angles about z) or two joints.
    between: [Rotating; 2],
    /// Radius of the first pulley.
    #[quantity(unit = "m", constant, positive)]
    first_radius: Formula,
    /// Radius of the second pulley.
    #[quantity(unit = "m", constant, positive)]
    second_radius: Formula,
    /// How the strands run.
    #[key(default = Run::Open)]
    run: Run,
    /// Angle of the second where that of the first is zero.
    #[quantity(unit = "rad", constant, default = 0)]
    #[key(image = Turning)]
    offset: Formula,
    /// Stiffness of each strand: tension by stretch.
    #[quantity(unit = "N/m", constant, positive)]
    stiffness: Formula,
    /// Damping of each strand while taut: tension by rate of stretch.
    #[quantity(unit = "N*s/m", default = 0)]
    damping: Formula,
    /// Tension of both strands where no torque is carried.
    #[quantity(unit = "N", constant, nonnegative, default = 0)]
    preload: Formula,
    /// Centres of the pulleys, which the strands pull together; each `body.point` or `body`.
    #[key(otherwise = "the shafts do not feel the belt, and their distance does not change it")]
    centers: Option<[PointRef; 2]>,
    /// Distance of the centres at which the preload holds; goes with `centers`.
    #[quantity(unit = "m", constant, positive)]
    distance: Option<Formula>,
    /// Stretch over which a strand becomes taut, either way.
    #[quantity(
        unit = "m",
        constant,
        positive,
        default_with("a ten-thousandth of `first_radius`", Formula::number(TUNING.taut_belt).combined(Binary::Mul, &first_radius))
    )]
    transition: Formula,
}

/// How the strands of a belt run.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Choice)]
pub enum Run {
    /// Outside: both pulleys turn the same way.
    Open,
    /// Crossed between the pulleys: they turn against one another.
    Crossed,
}

impl Belt {
    /// Tension of the strand that pulls against the first angle.
    pub const FIRST_TENSION: Sensor = Sensor::of_force("first_tension");
    /// Tension of the other strand.
    pub const SECOND_TENSION: Sensor = Sensor::of_force("second_tension");
}

impl ForceElement for Belt {
    const GLYPH: Glyph = Glyph::Belt;
    const SENSORS: &'static [TypedSensor] =
        &[(Self::FIRST_TENSION, Dimension::FORCE), (Self::SECOND_TENSION, Dimension::FORCE)];

    fn coordinates(&self) -> Vec<OnJoint> {
        let joint = |rotating: &Rotating| match rotating {
            Rotating::Joint(joint) => Some(OnJoint { joint: *joint, coordinate: JointCoordinate::Angle }),
            Rotating::Body { .. } => None,
        };
        self.between.iter().filter_map(joint).collect()
    }

    fn apply<'g>(&self, forces: &mut dyn Forces<'g>) -> Result<(), BuildError> {
        let radius = [forces.value(&self.first_radius)?, forces.value(&self.second_radius)?];
        let (stiffness, damping) = (forces.value(&self.stiffness)?, forces.value(&self.damping)?);
        let (preload, corner) = (forces.value(&self.preload)?, forces.value(&self.transition)?);
        // −σ r₂
        let opposite = match self.run {
            Run::Open => -radius[1],
            Run::Crossed => radius[1],
        };
        let [first, second] = self
            .between
            .map(|pulley| [TimeOrder::Position, TimeOrder::Velocity].map(|order| forces.angle(pulley, order)));
        let shift = radius[0] * first[0] + opposite * (second[0] - forces.value(&self.offset)?);
        let rate = radius[0] * first[1] + opposite * second[1];

        let mut parting = preload / stiffness;
        let mut parting_rate = forces.graph().number(0.0);
        let mut line = None;
        if let (Some(centers), Some(distance)) = (self.centers, &self.distance) {
            let [a, b] = centers.map(|point| forces.point(point));
            let offset = b.position - a.position;
            let across = (radius[0] + opposite) * (radius[0] + opposite);
            let strand = (offset.dot(offset) - across).sqrt();
            let distance = forces.value(distance)?;
            parting += strand - (distance * distance - across).sqrt();
            // ∂L/∂r_B
            let direction = offset / strand;
            parting_rate = direction.dot(b.velocity - a.velocity);
            line = Some((a, b, direction));
        }
        // The longer strand is taut.
        let taut = parting + shift.abs() + corner;
        forces.only_where(taut);
        let strand = |stretch, rate| {
            let taut = PositivePart::of(stretch, corner);
            (clipped(stiffness * taut.value + damping * taut.derivative * rate), stiffness * taut.integral)
        };
        let (first, first_energy) = strand(parting + shift, parting_rate + rate);
        let (second, second_energy) = strand(parting - shift, parting_rate - rate);

        let carried = second - first;
        for (pulley, arm) in self.between.into_iter().zip([radius[0], opposite]) {
            forces.torque_about(pulley, arm * carried)?;
        }
        if let Some((a, b, direction)) = line {
            forces.between(&b, &a, (first + second) * direction);
        }
        let coefficients = [stiffness, preload, corner, radius[0], radius[1]];
        forces.potential(&coefficients, (first_energy + second_energy).only_where(taut));
        forces
            .sensors([(Self::FIRST_TENSION, first.only_where(taut)), (Self::SECOND_TENSION, second.only_where(taut))]);
        Ok(())
    }
}

impl Checked for Belt {
    fn check_keys<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        match ["centers", "distance"].map(|key| fields.get(key).is_some()) {
            [true, false] => {
                reader.required(fields, "distance");
            }
            [false, true] => {
                let message = "`distance` goes with `centers`, the centres of the pulleys";
                reader.error(Code::BadSurface, fields.key_span("distance"), message, None);
            }
            _ => {}
        }
    }
}
