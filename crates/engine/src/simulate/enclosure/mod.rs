//! Certified motions: the solution of the scheme's equations, enclosed for a whole box of parameters at once.
//!
//! With q̂ and v̂ for the parts of q₊ and v₊ that do not depend on w₊ (`compile/newton_matrix.rs`), a step takes (q̂,
//! v̂, w) to the next by
//!
//! ```text
//! q₊ = q̂ + b x,   v₊ = v̂ + c x,   F(x, λ₊; q̂, v̂, ξ) = 0
//! F = (M w₊ + Φ_qᵀ λ₊ − Q, Φ/b) at (t₊, q₊, v₊, w₊ = x)
//! ```
//!
//! and linear updates. Enclosed is the exact solution of these equations in real numbers, with the step size and the
//! scheme's coefficients as they stand in `f64`: rounding and Newton's tolerance are bounded, the distance to the
//! differential equation's solution is not.
//!
//! The state is stored as polynomials P(ξ) and a remainder A(ξ) z, |zᵢ| ≤ rᵢ, in a frame A(ξ) of polynomials
//! ([`frame`]). A step ([`step`]) finds polynomials X(ξ) by Newton's iteration, bounds F at them in Taylor models (ρ),
//! and proves by Krawczyk's operator that for every ξ and z there is a solution x = X + Y z + y with small y:
//!
//! ```text
//! y = −C (ρ + (J Y + G) z) + (I − C J) y,      J ∋ ∂F/∂x,  G ∋ ∂F/∂(q̂, v̂) A over the enclosure,  C ≈ J⁻¹,  Y ≈ −C G
//! ```
//!
//! Brouwer's theorem gives a solution where the right side maps a box |y| ≤ g into itself, ‖I − C J‖ < 1 that there is
//! but one. C, X, Y and A need no proof: their errors are in the bounds. The next z contains the z before, transformed
//! into the next frame, and y.

mod frame;
pub(super) mod motion;
mod start;
mod step;
pub(crate) mod tuning;

use symdiff::taylor_model::ModelSpace;
use symdiff::{Interval, ModelMemory};

use super::control::Schedule;
use super::simulator::Simulator;
use crate::assemble::System;
use crate::certificate::matrix::Models;
use crate::certificate::{Certified, Equations};
use crate::compile::{AtStart, Coefficients, EquationsProgram, Tapes, compile_equations, list_equations};
use frame::{EnclosureFrame, Units};
pub use motion::{MotionEnclosure, MotionSpaces};
use tuning::TUNING;

/// Why an enclosure fails.
#[derive(Clone, Copy, Debug, PartialEq, Eq, thiserror::Error)]
pub enum EnclosureError {
    /// The given start values determine too few or too many unknowns.
    #[error("the start is not the solution of as many equations as unknowns")]
    Undetermined,
    /// Krawczyk's operator does not contract.
    #[error("no solution could be proven")]
    Unproven,
    /// Polynomials of the order that is taken do not follow the box.
    #[error("the box is too wide for polynomials of the parameters")]
    TooWide,
}

/// The equations of a mechanism, compiled for enclosures over any box.
#[derive(Clone, Debug)]
pub struct Certifier<'s> {
    simulator: &'s Simulator,
    /// The system, with the given values of the start that constraints do not determine.
    system: System,
    program: EquationsProgram,
}

impl<'s> Certifier<'s> {
    /// Compiles the equations of a mechanism.
    pub fn new(simulator: &'s Simulator) -> Self {
        let mut system = simulator.system.clone();
        start::leave_to_normalisations(&mut system, &simulator.nominal[simulator.program.layout.q.clone()]);
        let program = compile_equations(&system);
        Self { simulator, system, program }
    }

    /// The equations, for a certificate.
    fn equations(&self) -> Equations {
        let Self { system, program, .. } = self;
        let layout = &program.layout;
        let starts = [(&system.start.position, layout.q.start), (&system.start.velocity, layout.v.start)];
        let mut level = 0..;
        let at_start = starts.map(|(given, first)| {
            let is_at_nominal =
                level.next().is_some_and(|level| start::is_at_nominal(self.simulator, &self.program, level));
            let of = |(index, given): (usize, &Option<symdiff::Expr>)| match given {
                Some(value) => AtStart::Given(*value),
                None if is_at_nominal => AtStart::Number(self.simulator.nominal[first + index]),
                None => AtStart::Closure,
            };
            given.iter().enumerate().map(of).collect()
        });
        list_equations(system, &at_start)
    }

    /// A certificate of nothing yet: names, the box and the equations.
    pub fn certified(&self) -> Certified {
        let system = &self.simulator.system;
        let parameters = &system.parameters;
        Certified {
            parameters: parameters.iter().map(|parameter| parameter.name.clone()).collect(),
            lower: parameters.iter().map(|parameter| parameter.lower).collect(),
            upper: parameters.iter().map(|parameter| parameter.upper).collect(),
            outputs: system.outputs.iter().map(|output| output.name.clone()).collect(),
            equations: self.equations(),
            order: 0,
            times: Vec::new(),
            bounds: Vec::new(),
            pieces: Vec::new(),
        }
    }
}

/// The scheme's coefficients for one step size, each the exact number that the step's tapes compute with.
#[derive(Clone, Copy, Debug)]
struct Gains {
    h: Interval,
    b: Interval,
    c: Interval,
    /// q̂ = q + h v + q_a a − q_w w,   v̂ = v + v_a a − v_w w,   a₊ = a_x x − a_w w.
    q_a: Interval,
    q_w: Interval,
    v_a: Interval,
    v_w: Interval,
    a_x: Interval,
    a_w: Interval,
}

impl Gains {
    /// The gains of HHT, the scheme of all models: α = α_m − α_f with α_m = 0.
    fn new(coefficients: Coefficients, h: f64) -> Self {
        let Coefficients { beta, gamma, .. } = coefficients;
        let alpha = coefficients.shift();
        let h = Interval::point(h);
        let h2 = h.square();
        let number = Interval::point;
        Self {
            h,
            b: number(beta * (1.0 + alpha)) * h2,
            c: number(gamma * (1.0 + alpha)) * h,
            q_a: number(0.5 - beta) * h2,
            q_w: number(beta * alpha) * h2,
            v_a: number(1.0 - gamma) * h,
            v_w: number(gamma * alpha) * h,
            a_x: number(1.0 + alpha),
            a_w: number(alpha),
        }
    }
}

/// Gains of the next step's length; a becomes w + ratio (a − w) if the length changes.
#[derive(Clone, Copy, Debug)]
struct NextGains {
    gains: Gains,
    /// The next length over this one, where they differ.
    ratio: Option<f64>,
}

impl NextGains {
    fn same(gains: Gains) -> Self {
        Self { gains, ratio: None }
    }
}

/// A motion enclosed over a box of parameters, step by step.
#[derive(Debug)]
pub struct Enclosure<'s> {
    space: &'s ModelSpace,
    certifier: &'s Certifier<'s>,
    program: &'s EquationsProgram,
    /// Whether rows of output solve for their accelerations and multipliers.
    solves_accelerations: bool,
    memory: ModelMemory<'s>,
    gains: Gains,
    /// Gains of the next q̂ and v̂.
    next: NextGains,
    /// q̂, v̂, w in that order, 3n: polynomials only.
    state: Models,
    /// A, in units of `scale`.
    frame: EnclosureFrame,
    /// r.
    radii: Vec<f64>,
    units: Units,
    /// X of the last steps, the last first.
    before: Vec<Models>,
    /// C.
    inverse: Option<Models>,
    /// Bound of y, for the next step's first guess.
    spread: Vec<f64>,
}

impl<'s> Enclosure<'s> {
    /// Encloses the start over the box from `lower` to `upper` for steps of length `h`.
    ///
    /// # Errors
    /// Where the start cannot be proven to exist.
    pub fn start(
        certifier: &'s Certifier<'s>,
        space: &'s ModelSpace,
        lower: &[f64],
        upper: &[f64],
        h: f64,
    ) -> Result<Self, EnclosureError> {
        let (simulator, program) = (certifier.simulator, &certifier.program);
        let coefficients = simulator.program.coefficients;
        let mut memory = ModelMemory::new(space, program.registers(), program.constants());
        for (variable, register) in program.layout.parameters.clone().enumerate() {
            space.variable(variable, lower[variable], upper[variable], memory.model_mut(register));
        }
        memory.run(program.sample());
        start::assemble(simulator, program, space, &mut memory, coefficients.shift() * h)?;

        let n = program.layout.q.len();
        let unit = |size: f64| 2.0_f64.powi(symdiff::math::log2(size).round() as i32);
        let lengths = || simulator.system.coordinates.iter().map(|coordinate| coordinate.scale);
        let scale: Vec<f64> =
            [1.0, h, h * h].into_iter().flat_map(|time| lengths().map(move |length| unit(length / time))).collect();
        let units = Units { scale, step: h, motion: unit(TUNING.motion_time / h) };
        let gains = Gains::new(coefficients, h);
        let (tangent, push, independent) = start::tangent(simulator, program, space, &mut memory)?;
        let frame = EnclosureFrame::new(space, &units, &gains, &tangent, &push, independent);
        let mut enclosure = Self {
            space,
            certifier,
            program,
            solves_accelerations: simulator.solves_row_accelerations(),
            memory,
            gains,
            next: NextGains::same(gains),
            state: Models::zero(space, 3 * n, 1),
            frame,
            radii: vec![0.0; 3 * n],
            units,
            before: Vec::new(),
            inverse: None,
            spread: Vec::new(),
        };
        enclosure.begin()?;
        Ok(enclosure)
    }

    /// Outputs over the box now, a model each.
    ///
    /// # Errors
    /// Where outputs depend on accelerations that cannot be proven to exist.
    pub fn observe(&mut self, into: &mut Vec<f64>) -> Result<(), EnclosureError> {
        if self.solves_accelerations {
            start::accelerations(self.program).solve(self.space, &mut self.memory)?;
        }
        self.memory.run(self.program.observe());
        into.clear();
        self.program.outputs.iter().for_each(|&register| into.extend_from_slice(self.memory.model(register)));
        Ok(())
    }

    /// Steps up to a row of output, which follows the one before.
    ///
    /// # Errors
    /// Where a step's solution cannot be proven, with the time of its end.
    pub fn advance(&mut self, schedule: &Schedule, row: usize) -> Result<(), (f64, EnclosureError)> {
        let lengths = schedule.steps_to(row).chain(schedule.steps_to((row + 1).min(schedule.rows - 1))).skip(1);
        let next: Vec<f64> = lengths.map(|(length, _)| length).collect();
        for (index, (length, end)) in schedule.steps_to(row).enumerate() {
            let next = next.get(index).copied().unwrap_or(length);
            self.step(end, length, next).map_err(|lost| (end, lost))?;
        }
        Ok(())
    }
}
