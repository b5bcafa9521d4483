//! Counts of a mechanism before any computation: freedoms of bodies, constraints of joints, mass.

use symdiff::{Builder, Formula, Interval, Ranges};

use super::mechanism::Mechanism;
use super::questions::Questions;
use crate::grammar::Coordinate;
use crate::model::{Body, Description, Symbol};
use crate::multibody::{BuildError, Context};

/// Bodies, joints and mass, with every body's coordinates its own.
#[derive(Clone, Debug, PartialEq)]
pub struct Inventory {
    /// Joints that constrain and are not drives.
    pub joints: usize,
    /// Constraints of these joints.
    pub constraints: usize,
    /// Freedoms that bodies lack because their coordinates are prescribed at constant values.
    pub held: usize,
    /// Constraints and prescribed coordinates that impose a motion: of motors, and those that depend on t.
    pub drives: usize,
    /// Mass of all bodies and beams, kg: at the nominal parameters, and between which values it lies over their box.
    pub mass: [f64; 3],
}

impl Inventory {
    /// Counts the parts of a description with its questions.
    ///
    /// # Errors
    /// For descriptions that were not checked, a name that its context does not allow.
    pub fn of(questions: &Questions) -> Result<Self, BuildError> {
        let description = questions.description;
        let builder = Builder::new();
        let m = Mechanism::new(&builder, questions, false)?;
        let mut inventory = Self { joints: 0, constraints: 0, held: 0, drives: 0, mass: m.mass_range()? };
        for (index, joint) in description.joints.iter().enumerate() {
            let mut rows = m.rows(index)?;
            if joint.kind.drives() {
                rows.extend(m.velocity_rows(index)?);
            }
            // A row without coordinates constrains nothing.
            let rows = rows.iter().filter(|row| !m.is_given(&[row.value])).count();
            // A joint that changes with t moves one of its freedoms; the rows of one on a body that is moved do not
            // say so.
            let changes = || joint.kind.formulas().into_iter().any(|formula| is_of_time(description, formula));
            let drives = usize::from(rows > 0 && (joint.kind.drives() || changes()));
            inventory.drives += drives;
            inventory.constraints += rows - drives;
            inventory.joints += usize::from(rows > drives);
        }
        for body in description.bodies[1..].iter().filter(|body| !body.is_ground_of_instance()) {
            let [held, driven] = held(description, body);
            inventory.held += held;
            inventory.drives += driven;
        }
        Ok(inventory)
    }
}

fn is_of_time(description: &Description, formula: &Formula) -> bool {
    formula.names().any(|(name, _)| matches!(description.symbol(name), Some(Symbol::Time | Symbol::Trajectory { .. })))
}

/// Numbers of freedoms that a body lacks: prescribed at a value, and prescribed as a function of t.
fn held(description: &Description, body: &Body) -> [usize; 2] {
    let all: usize = if description.space.spatial { 6 } else { 3 };
    let freedoms = |coordinate: &Coordinate| match coordinate {
        // The first of four stands for three rotations.
        Coordinate::Euler(0) => 3,
        Coordinate::Euler(_) => 0,
        _ => 1,
    };
    let own: usize = body.coordinates.iter().map(freedoms).sum();
    let driven = body.prescribed.iter().filter(|(_, value)| is_of_time(description, value)).count();
    [all.saturating_sub(own + driven), driven]
}

impl Mechanism<'_, '_> {
    /// The mass of all bodies and beams: nominal, least, most.
    fn mass_range(&self) -> Result<[f64; 3], BuildError> {
        let bodies = self.bodies.iter().map(|body| Ok(body.mass));
        let beams = self.line_masses.iter().map(|beam| {
            let length = self.formula(beam.length, Context::Parameters)?;
            Ok(length * self.formula(beam.mass_per_length, Context::Parameters)?)
        });
        let reduced = self
            .superelements
            .iter()
            .map(|of| Ok(of.carried.mass * self.formula(of.inertia.factor, Context::Parameters)?));
        let masses: Result<Vec<_>, BuildError> = bodies.chain(beams).chain(reduced).collect();
        let mass = self.g.sum(masses?);
        let [nominal] = self.nominal([mass]);
        let symbols: Vec<_> = self.uncertain.iter().map(|parameter| parameter.symbol).collect();
        let sides = self.uncertain.iter().map(|parameter| Interval::new(parameter.lower, parameter.upper));
        let sides: Vec<Interval> = sides.collect();
        let ranges = Ranges::new(&self.g.graph(), &symbols, &[mass.expr()]);
        let mut memory = Vec::new();
        let range = ranges.enclose(&sides, &mut memory).next();
        // A certain mass is one number, not the two floating-point numbers next to it.
        let is_certain = self.g.graph().symbols_of(&[mass.expr()]).is_empty();
        Ok(match range.filter(|_| !is_certain) {
            Some(range) => [nominal, range.lower(), range.upper()],
            None => [nominal; 3],
        })
    }
}
