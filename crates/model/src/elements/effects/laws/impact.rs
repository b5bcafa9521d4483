//! The force between two surfaces by the depth δ to which they overlap.
//!
//! ```text
//! f = K ⟨δ⟩ⁿ ⟨1 + χ δ̇⟩ ≥ 0,   ⟨x⟩ = max(x, 0),   V = K ⟨δ⟩ⁿ⁺¹/(n + 1)          N, J
//! ```
//!
//! Hertz's n = 3/2 has a continuous derivative where the
//! surfaces first touch, and the damping grows with the depth, so the force has no jump there. Surfaces do not stick:
//! where 1 + χ δ̇ is negative they have parted already. Apart the force is exactly zero, and so is its derivative: the
//! law is written for δ > 0 alone, and the caller guards it by that condition.
//!
//! Whatever K and n, an impact at v ends with the speed e v of
//!
//! ```text
//! d − ln(1 + d) = −d e − ln(1 − d e),   d = χ v          Marhefka & Orin, IEEE Trans. Syst. Man Cybern. 29 (1999) 566
//! ```
//!
//! which gives χ of the `restitution` e at v: d = (1 − e)/e k(e), where k goes from 1 at e = 0 to 3/2 at e = 1, as a
//! polynomial by which e is met to 1e-5. Both laws of the literature hold for e near 1. At e = 0.5, they leave 0.66 and
//! 0.73:
//!
//! ```text
//! χ = 3 (1 − e)/(2 v)          Hunt & Crossley, J. Appl. Mech. 42 (1975) 440
//! χ = 3 (1 − e²)/(4 v)         Lankarani & Nikravesh, J. Mech. Des. 112 (1990) 369
//! ```

use mbint_derive::{Choice, Element};
use schemars::{Schema, SchemaGenerator};
use symdiff::{Formula, Scalar};

use super::positive_part::clipped;
use crate::elements::effects::Forces;
use crate::grammar::motions::dimensions_of;
use crate::grammar::quantity::Dimension;
use crate::grammar::{
    Checked, Fields, JointCoordinate, Node, Quantity, Reader, Requirement, Span, SymbolTable, Value, values,
};
use crate::multibody::BuildError;
use crate::syntax::codes::Code;

const RESTITUTION: Requirement =
    Requirement { holds: |value| value > 0.0 && value <= 1.0, message: "must be above 0 and at most 1" };

/// How surfaces push each other apart: K*depth^n*(1 + dissipation*rate).
#[derive(Clone, Debug, Element)]
#[element(what = "`impact`", checked)]
pub struct Impact {
    /// n, from 1 to 3: 1 is a linear spring, 1.5 Hertz's contact of curved surfaces.
    #[key(default = Exponent(1.5))]
    pub exponent: Exponent,
    /// K.
    #[quantity(
        unit = "N/m^n or N*m/rad^n",
        dimension = stiffness_dimension(exponent, units),
        constant,
        positive
    )]
    pub stiffness: Formula,
    /// χ, the loss coefficient.
    #[quantity(unit = "s/m or s/rad", constant, nonnegative, otherwise = "0: no energy is lost")]
    pub dissipation: Option<Formula>,
    /// Instead of `dissipation`: speed after over speed before, above 0 and at most 1.
    #[quantity(unit = "1", constant, requires = RESTITUTION)]
    pub restitution: Option<Formula>,
    /// Speed of the impact for which the restitution holds.
    #[quantity(unit = "m/s or rad/s", constant, positive)]
    pub impact_velocity: Option<Formula>,
    /// Whose formula makes dissipation of restitution.
    #[key(default = RestitutionLaw::Exact)]
    pub law: RestitutionLaw,
}

/// k(e) by Chebyshev's polynomials of 2 e − 1, from the equation's solutions at their nodes.
const BY_RESTITUTION: [f64; 21] = [
    1.336969552,
    0.241253578,
    -0.093513248,
    0.013803945,
    0.004669372,
    -0.004988693,
    0.002370352,
    -0.000513995,
    -0.000271200,
    0.000402059,
    -0.000272333,
    0.000108669,
    0.000000547,
    -0.000045389,
    0.000046847,
    -0.000029490,
    0.000010310,
    0.000002809,
    -0.000008457,
    0.000008351,
    -0.000004886,
];

/// Whose formula gives χ.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Choice)]
pub enum RestitutionLaw {
    /// An impact at that speed leaves the restitution
    Exact,
    /// 3 (1 - e)/(2 v), which leaves more
    HuntCrossley,
    /// 3 (1 - e^2)/(4 v), which leaves more
    LankaraniNikravesh,
}

/// n
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Exponent(pub f64);

/// Dimension of K: force over a power of the depth, or a plain number in SI if no unit has that power.
fn stiffness_dimension(exponent: Option<Exponent>, units: usize) -> Dimension {
    let coordinates = [JointCoordinate::Displacement, JointCoordinate::Angle];
    let [depth, _, effort] = dimensions_of(coordinates[units]);
    let power = exponent.and_then(|Exponent(exponent)| depth.to_the(exponent));
    power.map_or(Dimension::NUMBER, |power| effort.per(power))
}

impl Checked for Impact {
    fn check_keys<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        let given = |key: &str| fields.get(key).is_some();
        if !["restitution", "impact_velocity", "law"].into_iter().any(given) {
            return;
        }
        reader.required(fields, "restitution");
        reader.required(fields, "impact_velocity");
        if given("dissipation") {
            let message = "`dissipation` and `restitution` exclude each other";
            reader.error(Code::MisplacedKey, fields.key_span("dissipation"), message, None);
        }
    }
}

impl Value for Exponent {
    fn read<S: SymbolTable>(reader: &mut Reader<'_, S>, node: &Node, _: Span, _: &Quantity) -> Option<Self> {
        let exponent = reader.number(node, Dimension::NUMBER)?;
        if (1.0..=3.0).contains(&exponent) {
            return Some(Self(exponent));
        }
        let help = "1 is a linear spring, 1.5 Hertz's contact of curved surfaces".to_owned();
        reader.error(
            Code::OutOfRange,
            node.span.clone(),
            format!("an exponent from 1 to 3 belongs here, not {exponent}"),
            help,
        );
        None
    }

    fn schema(generator: &mut SchemaGenerator) -> Schema {
        generator.subschema_for::<values::Number>()
    }

    fn to_json(&self) -> Option<serde_json::Value> {
        Some(self.0.into())
    }
}

/// The law's numbers.
#[derive(Clone, Copy, Debug)]
pub struct Push<'g> {
    /// K, N/mⁿ
    pub stiffness: Scalar<'g>,
    exponent: f64,
    dissipation: Scalar<'g>,
}

impl<'g> Push<'g> {
    pub fn of(forces: &dyn Forces<'g>, impact: &Impact) -> Result<Self, BuildError> {
        let stiffness = forces.value(&impact.stiffness)?;
        let dissipation = match (&impact.restitution, &impact.impact_velocity, &impact.dissipation) {
            (None, _, Some(dissipation)) => forces.value(dissipation)?,
            (Some(restitution), Some(velocity), _) => {
                let (restitution, velocity) = (forces.value(restitution)?, forces.value(velocity)?);
                match impact.law {
                    RestitutionLaw::Exact => relative_dissipation(restitution) / velocity,
                    RestitutionLaw::HuntCrossley => 1.5 * ((1.0 - restitution) / velocity),
                    RestitutionLaw::LankaraniNikravesh => 0.75 * ((1.0 - restitution * restitution) / velocity),
                }
            }
            _ => forces.graph().number(0.0),
        };
        Ok(Self { stiffness, exponent: impact.exponent.0, dissipation })
    }

    /// f, by δ > 0 and δ̇.
    pub fn force(&self, depth: Scalar<'g>, rate: Scalar<'g>) -> Scalar<'g> {
        let damping = clipped(1.0 + self.dissipation * rate);
        self.stiffness * power(depth, self.exponent) * damping
    }

    /// V, by δ > 0.
    pub fn potential(&self, depth: Scalar<'g>) -> Scalar<'g> {
        let exponent = self.exponent + 1.0;
        1.0 / exponent * (self.stiffness * power(depth, exponent))
    }
}

/// d of the restitution that an impact is to leave.
fn relative_dissipation<'g>(restitution: Scalar<'g>) -> Scalar<'g> {
    let zero = restitution.builder().number(0.0);
    let twice = 2.0 * (2.0 * restitution - 1.0);
    // Clenshaw's recurrence.
    let step = |[first, second]: [Scalar<'g>; 2], &coefficient: &f64| [coefficient + twice * first - second, first];
    let [first, second] = BY_RESTITUTION[1..].iter().rev().fold([zero; 2], step);
    let factor = BY_RESTITUTION[0] + 0.5 * twice * first - second;
    factor * ((1.0 - restitution) / restitution)
}

/// Half powers are products with a root, which are evaluated for whole tiles at once.
fn power(depth: Scalar<'_>, exponent: f64) -> Scalar<'_> {
    let whole = exponent.floor();
    if exponent - whole == 0.5 {
        return depth.powi(whole as i32) * depth.sqrt();
    }
    depth.pow(depth.builder().number(exponent))
}
