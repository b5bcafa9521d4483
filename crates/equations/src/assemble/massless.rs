//! Coordinates without inertia that no constraint moves: they are where their forces balance.
//!
//! M has nothing in the row of such a coordinate i, so its equation of motion is Q_i = 0. It is written as a
//! constraint as well,
//!
//! ```text
//! Φ_i = Q_i(q, t)/k = 0      k = max_j |∂Q_i/∂q_j| at the guess of the start: Φ_i is in metres or radians
//! ```
//!
//! so that the start, velocities and accelerations follow it. In the rows of these coordinates m then stands Q_m = 0 =
//! (∂Φ/∂q_m)ᵀ μ: where the stiffness ∂Q_m/∂q_m is regular the multipliers μ are zero, and the constraint pushes on
//! nothing else. That is static condensation (Guyan, AIAA J. 3 (1965) 380), without its linearisation.

use rustc_hash::FxHashSet;
use symdiff::{Expr, Scalar};

use super::at_guess::AtGuess;
use super::constraints::Constraints;
use super::mechanism::Mechanism;
use super::system::{ConstraintInfo, ResidualUnit, Start};
use crate::multibody::BuildError;

impl<'g> Constraints<'g> {
    /// Adds a constraint for each coordinate without inertia that is in no other constraint: its force is zero.
    /// `is_massive` says which have inertia, `force` is Q.
    ///
    /// # Errors
    /// A force that depends on velocities, accelerations or reactions, or on no such coordinate.
    pub fn add_balances(
        &mut self,
        m: &Mechanism<'g, '_>,
        is_massive: &[bool],
        force: &[Scalar<'g>],
        start: &Start,
    ) -> Result<(), BuildError> {
        if is_massive.iter().all(|&massive| massive) {
            return Ok(());
        }
        let constrained: FxHashSet<Expr> = symbols(m, &self.positions.values).into_iter().collect();
        let is_balanced = |index: &usize| !is_massive[*index] && !constrained.contains(&m.q[*index].expr());
        let balanced: Vec<usize> = (0..m.q.len()).filter(is_balanced).collect();
        let unknown: Vec<Scalar<'g>> = balanced.iter().map(|&index| m.q[index]).collect();
        let multipliers = [&self.positions.lambda[..], &self.velocities.lambda].concat();
        let start = AtGuess::of(m, &m.g.graph(), &start.guess);
        for index in balanced {
            let balance = Balance { m, index, force: force[index] };
            balance.check(&unknown, &multipliers)?;
            let stiffness = balance.stiffness(&start);
            let unit = if m.coordinates[index].is_length() { ResidualUnit::Length } else { ResidualUnit::Angle };
            let info = ConstraintInfo { name: balance.name().to_owned(), joint: balance.owner().to_owned(), unit };
            self.positions.add(info, stiffness.recip() * force[index]);
        }
        Ok(())
    }
}

/// The force on a coordinate without inertia.
struct Balance<'m, 'g, 'd> {
    m: &'m Mechanism<'g, 'd>,
    index: usize,
    force: Scalar<'g>,
}

impl<'g> Balance<'_, 'g, '_> {
    /// Whether the force determines where the coordinate is.
    fn check(&self, unknown: &[Scalar<'g>], multipliers: &[Scalar<'g>]) -> Result<(), BuildError> {
        let found: FxHashSet<Expr> = symbols(self.m, &[self.force]).into_iter().collect();
        let depends = |on: &[Scalar<'g>]| on.iter().any(|symbol| found.contains(&symbol.expr()));
        let why = if depends(&self.m.v) || depends(&self.m.w) {
            "its force depends on velocities, so that no position balances it; give the body a small mass"
        } else if depends(multipliers) {
            "its force depends on reactions; give the body a small mass"
        } else if !depends(unknown) {
            "no spring and no joint determines where it is; give the body a mass, or leave the coordinate out of its `coordinates`"
        } else {
            return Ok(());
        };
        Err(BuildError::Massless { coordinate: self.name().to_owned(), why })
    }

    /// The largest derivative of the force by a coordinate, near the start; 1 where all are zero there.
    fn stiffness(&self, start: &AtGuess) -> f64 {
        let coordinates = Scalar::exprs(&self.m.q);
        self.m.g.with(|graph| {
            let derivatives: Vec<Expr> =
                graph.jacobian(&[self.force.expr()], &coordinates).entries().map(|(_, _, value)| value).collect();
            let values = start.values(graph, &derivatives).into_iter();
            let largest = values.map(f64::abs).filter(|value| value.is_finite()).fold(0.0, f64::max);
            if largest > 0.0 { largest } else { 1.0 }
        })
    }

    fn name(&self) -> &str {
        &self.m.coordinate_names[self.index]
    }

    fn owner(&self) -> &str {
        self.name().rsplit_once('.').map_or(self.name(), |(owner, _)| owner)
    }
}

fn symbols<'g>(m: &Mechanism<'g, '_>, of: &[Scalar<'g>]) -> Vec<Expr> {
    m.g.graph().symbols_of(&Scalar::exprs(of))
}
