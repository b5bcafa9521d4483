//! Motor: a joint's coordinate moves as is prescribed.
//!
//! ```text
//! Φ = s − s(t) = 0          1 row, rad or m
//!
//! position     s(t), a formula
//! speed        s(t) = from + ∫ v(t) dt                                     where `Graph::integral` knows it
//!              Ψ = ṡ − v(t, q, y) = 0      1 row, rad/s or m/s
//!              where it follows positions q or states y, from where `initial` says
//! move         s(t) = from + (to − from) σ(u)                              u = (t − start)/duration, clipped to 0 … 1
//! run-up       s(t) = from + v [duration Σ(u) + ⟨t − start − duration⟩]    Σ = ∫σ, so that ṡ = v σ(u)
//!
//! cycloidal    σ = u − sin(2π u)/2π                       Σ = u²/2 + (cos(2π u) − 1)/4π²
//! quintic      σ = u³ (10 − 15 u + 6 u²)                  Σ = u⁴ (5/2 − 3 u + u²)
//! trapezoidal  σ = [u² − ⟨u − r⟩² − ⟨u − 1 + r⟩²]/(2 r (1 − r))      Σ = [u³ − ⟨u − r⟩³ − ⟨u − 1 + r⟩³]/(6 r (1 − r))
//! ```
//!
//! −Φ_qᵀ λ is the force or torque −λ on the coordinate: along or about the joint's axis on its second body, the
//! opposite on its first. The motor's reaction is the force or torque it must provide. Cycloidal and quintic moves have
//! continuous accelerations; trapezoidal ones jump, and with them the forces. Profiles: Biagiotti & Melchiorri,
//! *Trajectory Planning for Automatic Machines and Robots* (2008), ch. 2 and 3.

use std::convert::Infallible;
use std::f64::consts::{PI, TAU};

use mbint_derive::{Choice, Element};
use symdiff::{Builder, Formula, Scalar};

use crate::elements::Glyph;
use crate::grammar::{Checked, Context, Fields, JointCoordinate, OnJoint, Reader, Requirement, SymbolTable, one_of};
use crate::multibody::{BuildError, Vector};
use crate::syntax::codes::Code;

use super::{Joint, JointElement, Kinematics, Row, RowDocs, Rows};

/// A joint's coordinate moves as is prescribed.
#[derive(Clone, Debug, Element)]
#[element(
    keyword = "motor",
    what = "a motor",
    equation = "s − s(t) = 0",
    equation = "ṡ − v(t, q, y) = 0 of a speed that follows positions or states",
    equation = "position: s(t); speed: s(t) = from + ∫ v dt; move: s(t) = from + (to − from) σ(u), u = (t − start)/duration",
    source = "Biagiotti & Melchiorri, Trajectory Planning for Automatic Machines and Robots (2008), ch. 2 and 3",
    example = "{ on: pivot, speed: 60 rpm }",
    checked
)]
pub struct Motor {
    /// The joint, and which of its coordinates.
    #[group]
    on: OnJoint,
    /// The coordinate over time: a formula of t, twice differentiable.
    #[quantity(unit = "m or rad", time)]
    #[key(image = Turning)]
    position: Option<Formula>,
    /// From the beginning, also as a formula of t, positions and states, or, with a `profile`, from rest within the
    /// `duration`.
    #[quantity(unit = "m/s or rad/s", command)]
    #[key(image = Turning)]
    speed: Option<Formula>,
    /// Where a move from rest to rest ends.
    #[quantity(unit = "m or rad", constant)]
    #[key(image = Turning)]
    to: Option<Formula>,
    /// Where the motion begins.
    #[quantity(unit = "m or rad", default = 0, constant)]
    #[key(image = Turning)]
    from: Formula,
    /// How the coordinate (of a move) or the speed (of a run-up) gets from the one to the other.
    profile: Option<Profile>,
    /// When a move or a run-up begins.
    #[quantity(unit = "s", default = 0, constant)]
    start: Formula,
    /// How long a move or a run-up takes.
    #[quantity(unit = "s", positive, constant)]
    duration: Option<Formula>,
    /// Part of the duration that a trapezoidal profile takes to its full rate, and again to rest.
    #[quantity(unit = "1", default = 0.25, requires = RAMP, constant)]
    ramp: Formula,
}

/// Requirement on `ramp`.
const RAMP: Requirement =
    Requirement { holds: |value| value > 0.0 && value <= 0.5, message: "must be above 0 and at most 0.5" };

/// How a value changes from one to another.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Choice)]
pub enum Profile {
    /// The acceleration is a sine.
    Cycloidal,
    /// A polynomial with rates and accelerations zero at the ends.
    Quintic,
    /// A constant rate between constant accelerations.
    Trapezoidal,
}

impl JointElement for Motor {
    const COUPLES: bool = true;
    const ROWS: &'static [RowDocs] = &[RowDocs {
        name: "",
        unit: "rad or m; rad/s or m/s",
        multiplier: "N m or N: −λ is the torque about or the force along the joint's axis on its second body",
    }];
}

impl Joint for Motor {
    fn coordinates(&self, _own: usize) -> Vec<OnJoint> {
        vec![self.on]
    }

    fn driven(&self) -> Option<OnJoint> {
        Some(self.on)
    }

    fn glyph(&self) -> Glyph {
        Glyph::Motor
    }

    fn rows<'g>(&self, _own: usize, k: &dyn Kinematics<'g>) -> Rows<'g> {
        match self.followed(k) {
            Some(_) => Ok(Vec::new()),
            None => Ok(vec![self.row(k, k.coordinate(self.on) - self.prescribed(k)?)?]),
        }
    }

    fn speed(&self) -> Option<&Formula> {
        self.speed.as_ref()
    }

    fn velocity_rows<'g>(&self, k: &dyn Kinematics<'g>) -> Rows<'g> {
        match self.followed(k) {
            Some(speed) => Ok(vec![self.row(k, k.rate(self.on)? - k.command(speed)?)?]),
            None => Ok(Vec::new()),
        }
    }
}

impl Motor {
    /// The speed, where it follows the motion.
    fn followed(&self, k: &dyn Kinematics) -> Option<&Formula> {
        self.speed.as_ref().filter(|speed| !k.is_prescribed(speed))
    }

    /// Row of the constraint that `value`, of the coordinate, is zero.
    fn row<'g>(&self, k: &dyn Kinematics<'g>, value: Scalar<'g>) -> Result<Row<'g>, BuildError> {
        let axis = k.axis(self.on)?;
        let (push, none) = (-axis, Vector::zero(k.graph()));
        Ok(match self.on.coordinate {
            JointCoordinate::Angle => Row { name: "", value, force: none, torque: push },
            JointCoordinate::Displacement => Row { name: "", value, force: push, torque: none },
        })
    }

    /// s(t). The reader lets no motor through without `position`, `speed` or `to`; one stays at `from`.
    fn prescribed<'g>(&self, k: &dyn Kinematics<'g>) -> Result<Scalar<'g>, BuildError> {
        if let Some(position) = &self.position {
            return k.number(position);
        }
        let from = k.number(&self.from)?;
        let Some(end) = self.speed.as_ref().or(self.to.as_ref()) else { return Ok(from) };
        let end = k.number(end)?;
        let (Some(profile), Some(duration)) = (self.profile, &self.duration) else {
            return Ok(from + end.integral(k.time()).ok_or(BuildError::Speed)?);
        };
        let (start, duration) = (k.number(&self.start)?, k.number(duration)?);
        let part = clipped((k.time() - start) / duration).min(k.graph().number(1.0));
        let [shape, integral] = self.shape(k, profile, part)?;
        if self.speed.is_none() {
            return Ok(from + (end - from) * shape);
        }
        let running_up = duration * integral;
        let running = clipped(k.time() - (start + duration));
        Ok(from + end * (running_up + running))
    }

    /// σ and Σ at u.
    fn shape<'g>(
        &self,
        k: &dyn Kinematics<'g>,
        profile: Profile,
        u: Scalar<'g>,
    ) -> Result<[Scalar<'g>; 2], BuildError> {
        let one = k.graph().number(1.0);
        Ok(match profile {
            Profile::Cycloidal => {
                let turn = TAU * u;
                let (sin, cos) = (turn.sin(), turn.cos());
                let sway = 1.0 / TAU * sin;
                let half = 0.5 * (u * u);
                let bend = 0.25 / (PI * PI) * (cos - one);
                [u - sway, half + bend]
            }
            Profile::Quintic => {
                let polynomial = |power: i32, coefficients: [f64; 3]| {
                    let [a, b, c] = coefficients.map(|coefficient| k.graph().number(coefficient));
                    let inner = a + (b + c * u) * u;
                    u.powi(power) * inner
                };
                [polynomial(3, [10.0, -15.0, 6.0]), polynomial(4, [2.5, -3.0, 1.0])]
            }
            Profile::Trapezoidal => {
                let ramp = k.number(&self.ramp)?;
                let rest = one - ramp;
                let (after, last) = (u - ramp, u - rest);
                let (after, last) = (clipped(after), clipped(last));
                let area = ramp * rest;
                let truncated = |power: i32, divisor: f64| {
                    let [all, after, last] = [u, after, last].map(|part| part.powi(power));
                    (all - after - last) / (divisor * area)
                };
                [truncated(2, 2.0), truncated(3, 6.0)]
            }
        })
    }
}

/// max(x, 0).
fn clipped(x: Scalar<'_>) -> Scalar<'_> {
    x.max(x.builder().number(0.0))
}

/// Keys of moves and run-ups.
const PROFILED: [&str; 3] = ["start", "duration", "ramp"];

impl Checked for Motor {
    fn check_keys<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        let given = |key: &str| fields.get(key).is_some();
        let chosen: Vec<&str> = ["position", "speed", "to"].into_iter().filter(|key| given(key)).collect();
        let [chosen] = chosen.as_slice() else {
            let help = "e.g. `speed: 60 rpm`, `position: 0.1*sin(3*t)` or `to: 90 deg` with a `profile`".to_owned();
            reader.error(Code::BadMotor, fields.at.clone(), "a motor has one of `position`, `speed` and `to`", help);
            return;
        };
        if *chosen == "position" {
            for key in ["from", "profile", "start", "duration", "ramp"].into_iter().filter(|key| given(key)) {
                reader.error(
                    Code::MisplacedKey,
                    fields.key_span(key),
                    format!("`{key}` does not go with `position`"),
                    None,
                );
            }
            return;
        }
        if !given("profile") {
            for key in PROFILED.into_iter().filter(|key| given(key)) {
                reader.error(Code::MisplacedKey, fields.key_span(key), format!("`{key}` goes with a `profile`"), None);
            }
            if *chosen == "to" {
                let help = "cycloidal, quintic or trapezoidal".to_owned();
                reader.error(Code::BadMotor, fields.key_span("to"), "`to` needs a `profile` and a `duration`", help);
            }
            return;
        }
        reader.required(fields, "duration");
    }

    fn constrain(schema: &mut schemars::Schema) {
        one_of(schema, &["position", "speed", "to"]);
        let together = serde_json::json!({
            "profile": ["duration"],
            "to": ["profile", "duration"],
            "start": ["profile"],
            "duration": ["profile"],
            "ramp": ["profile"],
        });
        schema.insert("dependentRequired".to_owned(), together);
    }

    fn check<S: SymbolTable>(&self, reader: &mut Reader<'_, S>, fields: &Fields<'_>) {
        if self.profile.is_some_and(|profile| profile != Profile::Trapezoidal) && fields.get("ramp").is_some() {
            reader.error(Code::MisplacedKey, fields.key_span("ramp"), "`ramp` goes with the trapezoidal profile", None);
        }
        let (Some(node), Some(speed)) = (fields.get("speed"), &self.speed) else { return };
        if self.profile.is_some() {
            // The speed that a run-up ends at does not change in time.
            reader.check_names(node, speed, 0, Context::Constant);
        } else if speed.names().any(|(name, _)| reader.resolve(name, Context::Time).is_err()) {
            if fields.get("from").is_some() {
                let help = "say the coordinate at the start in `initial`".to_owned();
                reader.error(
                    Code::BadMotor,
                    fields.key_span("from"),
                    "`from` does not go with a speed that follows the motion",
                    help,
                );
            }
        } else if !is_integrable(speed) {
            let help = "polynomials, sin, cos, exp, sqrt, min, max, floor, smoothstep and `if` of straight lines with `and` and `or`, and their sums can be; or give it as `position`";
            reader.error(
                Code::BadMotor,
                node.span.clone(),
                "this speed cannot be integrated by formulas",
                help.to_owned(),
            );
        }
    }
}

/// Whether a formula of parameters and t has an integral over t ([`Scalar::integral`]).
fn is_integrable(speed: &Formula) -> bool {
    let graph = Builder::new();
    let time = graph.variable("t");
    let built = speed.build(&graph, |name| Ok::<_, Infallible>(graph.variable(name)));
    built.is_ok_and(|speed| speed.integral(time).is_some())
}
