//! A hydraulic cylinder between two points A and B, with a valve between supply and tank: its pressures are states.
//!
//! ```text
//! f = p₁ A₁ − p₂ A₂                                            N, pushes the points apart
//! ṗ₁ = E/V₁ (Q₁ − A₁ ℓ̇ − Q_L),    V₁ = V₀ + A₁ (ℓ − ℓ₀)            A₁ = π/4 D²
//! ṗ₂ = E/V₂ (Q₂ + A₂ ℓ̇ + Q_L),    V₂ = V₀ + A₂ (ℓ₀ + h − ℓ)        A₂ = π/4 (D² − d²)
//! Q₁ = K (⟨x⟩ φ(p_S − p₁) − ⟨−x⟩ φ(p₁ − p_T)),    Q_L = c (p₁ − p₂)
//! Q₂ = K (⟨−x⟩ φ(p_S − p₂) − ⟨x⟩ φ(p₂ − p_T)),    K = Q_N/√Δp_N
//! φ(Δp) = Δp/(Δp² + δ²)^¼,    ⟨x⟩ = 0 below 0, x²/4ε to 2ε, x − ε beyond
//! ```
//!
//! Chamber 1 is that of the piston's full face, 2 that of the rod. x is the valve's opening: with x > 0 oil flows from
//! the supply to chamber 1 and from 2 to the tank. Flow through an edge grows with the root of its drop of pressure
//! (Merritt, *Hydraulic Control Systems* (1967), sec. 3.2, 5.1, 6.1), below δ with the drop itself, so that its
//! derivative is finite; ε is the overlap of the edges. The cylinder has no ends: a `stop` limits it. Where a pressure
//! would be negative, oil would boil, which this model does not describe.

use std::f64::consts::FRAC_PI_4;

use mbint_derive::Element;
use symdiff::{Formula, Scalar};

use super::laws::positive_part::PositivePart;
use super::{ForceElement, Forces, StateVariable, TypedSensor};
use crate::elements::Glyph;
use crate::grammar::quantity::Dimension;
use crate::grammar::{PointRef, Sensor};
use crate::multibody::BuildError;

/// p₁.
const PISTON_PRESSURE: Sensor = Sensor::of_motion("piston_pressure");

/// p₂.
const ROD_PRESSURE: Sensor = Sensor::of_motion("rod_pressure");

/// Q₁ and Q₂.
const FLOWS: [Sensor; 2] = [Sensor::of_force("piston_flow"), Sensor::of_force("rod_flow")];

/// A cylinder that oil drives.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "hydraulic_cylinder",
    what = "a hydraulic cylinder",
    equation = "f = p₁ A₁ − p₂ A₂",
    equation = "ṗ₁ = E/V₁ (Q₁ − A₁ ℓ̇ − Q_L),  ṗ₂ = E/V₂ (Q₂ + A₂ ℓ̇ + Q_L)",
    equation = "Q₁ = K (⟨x⟩ φ(p_S − p₁) − ⟨−x⟩ φ(p₁ − p_T)),  Q₂ = K (⟨−x⟩ φ(p_S − p₂) − ⟨x⟩ φ(p₂ − p_T)),  K = Q_N/√Δp_N",
    source = "Merritt, Hydraulic Control Systems (1967), sec. 3.2, 5.1 and 6.1",
    example = "{ between: [arm.tip, cart.hook], bore: 40 mm, rod: 25 mm, retracted: 0.5, stroke: 1, dead_volume: 0.1 L, valve: 0.5*sin(20*t), rated_flow: 20 L/min, rated_drop: 35 bar, supply: 100 bar }"
)]
pub struct HydraulicCylinder {
    /// Two points, each `body.point` or `body`.
    pub between: [PointRef; 2],
    /// Diameter of the rod.
    #[quantity(unit = "m", constant, nonnegative, default = 0)]
    pub rod: Formula,
    /// Diameter of the piston.
    #[quantity(unit = "m", constant, positive, above = rod)]
    pub bore: Formula,
    /// Distance of the points where the piston is at the end of its way in.
    #[quantity(unit = "m", constant, nonnegative)]
    pub retracted: Formula,
    /// The piston's way.
    #[quantity(unit = "m", constant, positive)]
    pub stroke: Formula,
    /// Volume of oil in each chamber in addition to the piston's way, with its hose.
    #[quantity(unit = "m^3", constant, positive)]
    pub dead_volume: Formula,
    /// Bulk modulus of the oil.
    #[quantity(unit = "Pa", constant, positive, default = 1.4e9)]
    pub modulus: Formula,
    /// Opening of the valve, from -1 to 1; a number or a formula of t, positions, velocities and states.
    #[quantity(unit = "1")]
    pub valve: Formula,
    /// Flow through one edge of the open valve at the rated drop of pressure.
    #[quantity(unit = "m^3/s", constant, positive)]
    pub rated_flow: Formula,
    /// Drop of pressure at one edge for which the rated flow holds.
    #[quantity(unit = "Pa", constant, positive)]
    pub rated_drop: Formula,
    /// Pressure of the supply.
    #[quantity(unit = "Pa")]
    pub supply: Formula,
    /// Pressure in the tank.
    #[quantity(unit = "Pa", constant, default = 0)]
    pub tank: Formula,
    /// Flow past the piston by the difference of the pressures.
    #[quantity(unit = "m^3/s/Pa", constant, nonnegative, default = 0)]
    pub leakage: Formula,
    /// Opening at which the valve's edges begin to pass oil.
    #[quantity(unit = "1", constant, positive, default = 1e-3)]
    pub overlap: Formula,
    /// Drop of pressure below which the flow grows with the drop itself.
    #[quantity(unit = "Pa", constant, positive, default = 1e3)]
    pub laminar_drop: Formula,
    /// Pressure on the piston's full face at the start.
    #[quantity(unit = "Pa", constant, default = 0)]
    pub piston_pressure: Formula,
    /// Pressure on the rod's side at the start.
    #[quantity(unit = "Pa", constant, default = 0)]
    pub rod_pressure: Formula,
}

impl ForceElement for HydraulicCylinder {
    const GLYPH: Glyph = Glyph::Rod;
    const SENSORS: &'static [TypedSensor] = &[
        (Sensor::LENGTH, Dimension::LENGTH),
        (Sensor::RATE, Dimension::VELOCITY),
        (Sensor::FORCE, Dimension::FORCE),
        (Sensor::AXIAL, Dimension::FORCE),
        (PISTON_PRESSURE, Dimension::PRESSURE),
        (ROD_PRESSURE, Dimension::PRESSURE),
        (FLOWS[0], Dimension::VOLUME_FLOW),
        (FLOWS[1], Dimension::VOLUME_FLOW),
    ];

    fn states(&self) -> Vec<StateVariable<'_>> {
        vec![
            StateVariable { sensor: PISTON_PRESSURE, initial: &self.piston_pressure, period: None },
            StateVariable { sensor: ROD_PRESSURE, initial: &self.rod_pressure, period: None },
        ]
    }

    fn apply<'g>(&self, forces: &mut dyn Forces<'g>) -> Result<(), BuildError> {
        let [a, b] = self.between.map(|point| forces.point(point));
        let line = b.position - a.position;
        let length = line.norm();
        let direction = line / length;
        let rate = direction.dot(b.velocity - a.velocity);

        let [bore, rod] = [forces.value(&self.bore)?, forces.value(&self.rod)?].map(|d| FRAC_PI_4 * (d * d));
        let areas = [bore, bore - rod];
        let extended = length - forces.value(&self.retracted)?;
        let left = forces.value(&self.stroke)? - extended;
        let pressures = [forces.state(0), forces.state(1)];
        let flows = self.flows(forces, pressures)?;
        let leakage = forces.value(&self.leakage)? * (pressures[0] - pressures[1]);
        let (dead, modulus) = (forces.value(&self.dead_volume)?, forces.value(&self.modulus)?);
        let volumes = [dead + areas[0] * extended, dead + areas[1] * left];
        let gains = [flows[0] - areas[0] * rate - leakage, flows[1] + areas[1] * rate + leakage];
        for chamber in 0..2 {
            forces.state_rate(chamber, modulus * gains[chamber] / volumes[chamber]);
        }
        let push = pressures[0] * areas[0] - pressures[1] * areas[1];
        forces.between(&a, &b, push * direction);
        forces.sensors([(Sensor::LENGTH, length), (Sensor::RATE, rate), (Sensor::FORCE, push), (Sensor::AXIAL, -push)]);
        forces.sensors([(FLOWS[0], flows[0]), (FLOWS[1], flows[1])]);
        Ok(())
    }
}

impl HydraulicCylinder {
    /// Q₁ and Q₂.
    fn flows<'g>(&self, forces: &dyn Forces<'g>, pressures: [Scalar<'g>; 2]) -> Result<[Scalar<'g>; 2], BuildError> {
        let opening = forces.value(&self.valve)?;
        let gain = forces.value(&self.rated_flow)? / forces.value(&self.rated_drop)?.sqrt();
        let (supply, tank) = (forces.value(&self.supply)?, forces.value(&self.tank)?);
        let overlap = forces.value(&self.overlap)?;
        let laminar = forces.value(&self.laminar_drop)?;
        let laminar = laminar * laminar;
        let through = |drop: Scalar<'g>| drop / (drop * drop + laminar).sqrt().sqrt();
        let [open, back] = [opening, -opening].map(|x| gain * PositivePart::of(x - overlap, overlap).value);
        let flow = |fed: Scalar<'g>, drained: Scalar<'g>, pressure: Scalar<'g>| {
            fed * through(supply - pressure) - drained * through(pressure - tank)
        };
        Ok([flow(open, back, pressures[0]), flow(back, open, pressures[1])])
    }
}
