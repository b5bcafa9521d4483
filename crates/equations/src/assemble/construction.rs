//! From a description to a mechanism: symbols, parameters and bodies.

use std::cell::Cell;
use std::collections::BTreeMap;

use symdiff::{Builder, Formula};

use super::coordinates;
use super::inputs::{inputs, random_symbols};
use super::mechanism::{Mechanism, Owner, dof};
use super::names::DescriptionNames;
use super::questions::Questions;
use super::superelement::superelements;
use super::system::UncertainParameter;
use super::tree::Tree;
use crate::elements::Trajectory;
use crate::elements::joints::Mobilizer;
use crate::model::{self, Parameter, ParameterValue};
use crate::multibody::{
    Body, BuildError, Context, DEGREES_OF_FREEDOM, EULER, Matrix, Quaternion, RotationCoordinates, Vector,
};

impl<'g, 'd> Mechanism<'g, 'd> {
    /// The symbols and bodies of a description with its questions; with `by_joints`, as many bodies as can be are
    /// children, without coordinates of their own.
    pub fn new(g: &'g Builder, questions: &'d Questions<'d>, by_joints: bool) -> Result<Self, BuildError> {
        let description = questions.description;
        let time = g.variable("t");
        let mut mechanism = Self {
            g,
            questions,
            names: DescriptionNames::of(description),
            is_spatial: description.space.spatial,
            joints: &description.joints,
            line_masses: description.effects.iter().filter_map(|effect| effect.kind.inertia()).collect(),
            superelements: superelements(description),
            time,
            inputs: inputs(g, questions, time),
            is_excited: Cell::new(false),
            random: random_symbols(g, questions),
            uncertain: Vec::new(),
            child_guesses: Vec::new(),
            starts_assembled: false,
            parameters: Vec::new(),
            q: Vec::new(),
            v: Vec::new(),
            w: Vec::new(),
            coordinates: Vec::new(),
            coordinate_names: Vec::new(),
            bodies: Vec::new(),
            tree: Tree::absolute(questions),
            joint_coordinates: BTreeMap::new(),
            normalisations: BTreeMap::new(),
            body_guesses: BTreeMap::new(),
            reactions: Vec::new(),
            multipliers: Vec::new(),
            potentials: Vec::new(),
            teeth: Vec::new(),
            kinetic_energy_of_flexible: g.number(0.0),
            modes: BTreeMap::new(),
            states: BTreeMap::new(),
            sensors: BTreeMap::new(),
            thrusts: Vec::new(),
        };
        for parameter in &description.parameters {
            mechanism.add_parameter(parameter)?;
        }
        if by_joints {
            mechanism.tree = Tree::spanning(questions, |mobilizer| mechanism.is_time_independent(mobilizer));
        }
        for (index, body) in description.bodies.iter().enumerate() {
            let body = mechanism.body(index, body)?;
            mechanism.bodies.push(body);
        }
        for body in mechanism.tree.order.clone() {
            if let Some(inboard) = mechanism.tree.inboard[body] {
                mechanism.place_child(body, inboard)?;
            }
        }
        mechanism.merge();
        for (joint, coordinate) in coordinates::called_for(questions) {
            if !mechanism.joint_coordinates.contains_key(&(joint, coordinate)) {
                mechanism.add_joint_coordinate(joint, coordinate);
            }
        }
        mechanism.add_modes(&description.effects);
        mechanism.add_states(&description.effects);
        Ok(mechanism)
    }

    fn add_parameter(&mut self, parameter: &Parameter) -> Result<(), BuildError> {
        let value = match &parameter.value {
            ParameterValue::Formula(formula) => self.formula(formula, Context::Parameters)?,
            &ParameterValue::Interval { nominal, lower, upper } => {
                let variable = self.g.variable(&format!("p:{}", parameter.name));
                let (name, unit, symbol) = (parameter.name.clone(), parameter.unit.clone(), variable.expr());
                let mut random = self.questions.description.trajectories.iter().filter_map(Trajectory::random);
                let is_seed = random.any(|own| own.is_chosen_by(&name));
                self.uncertain.push(UncertainParameter { name, unit, symbol, nominal, lower, upper, is_seed });
                variable
            }
        };
        self.parameters.push(value);
        Ok(())
    }

    pub fn is_time_independent(&self, mobilizer: &Mobilizer) -> bool {
        mobilizer.formulas().all(|formula| self.formula(formula, Context::Parameters).is_ok())
    }

    fn body(&mut self, index: usize, body: &model::Body) -> Result<Body<'g>, BuildError> {
        let zero = self.g.number(0.0);
        let rotation_coordinates =
            if body.has_orientation() { RotationCoordinates::Euler } else { RotationCoordinates::Angle };
        let mut built = Body {
            rotation_coordinates,
            position: [zero; DEGREES_OF_FREEDOM],
            velocity: [zero; DEGREES_OF_FREEDOM],
            acceleration: [zero; DEGREES_OF_FREEDOM],
            index: [None; DEGREES_OF_FREEDOM],
            relative_motion: None,
            attitude: None,
            mass: match &body.mass {
                Some(mass) => self.formula(mass, Context::Parameters)?,
                None => zero,
            },
            inertia: self.inertia(body, rotation_coordinates)?,
            center: match &body.center_of_mass {
                Some(center) => self.vector(center, Context::Parameters)?,
                None => Vector::zero(self.g),
            },
            points: Vec::with_capacity(body.points.len()),
            frames: Vec::with_capacity(body.points.len()),
        };
        if rotation_coordinates == RotationCoordinates::Euler {
            let prescribed = match &body.prescribed_orientation {
                Some(rotation) => self.rotation(rotation)?,
                None => Quaternion::identity(self.g),
            };
            built.position[EULER..].copy_from_slice(&prescribed.components());
        }
        let is_child = self.tree.inboard[index].is_some();
        for &coordinate in body.coordinates.iter().filter(|_| !is_child) {
            let dof = dof(coordinate);
            let index = self.add_coordinate(Owner::Body(index, coordinate), &body.name);
            built.index[dof] = Some(index);
            built.position[dof] = self.q[index];
            built.velocity[dof] = self.v[index];
            built.acceleration[dof] = self.w[index];
        }
        for (coordinate, value) in &body.prescribed {
            let dof = dof(*coordinate);
            let value = self.formula(value, Context::Time)?;
            built.position[dof] = value;
            built.velocity[dof] = value.derivative(self.time);
            built.acceleration[dof] = built.velocity[dof].derivative(self.time);
        }
        for point in &body.points {
            built.points.push(self.vector(&point.position, Context::Parameters)?);
            let frame = point.rotation.as_ref().map(|rotation| self.rotation(rotation)).transpose()?;
            built.frames.push(frame);
        }
        Ok(built)
    }

    /// J; of a body that turns about z only, no more than J_zz.
    fn inertia(&self, body: &model::Body, by: RotationCoordinates) -> Result<Matrix<'g>, BuildError> {
        let mut tensor = Matrix::zero(self.g);
        let Some(model::Inertia { xx, yy, zz, xy, xz, yz }) = &body.inertia else { return Ok(tensor) };
        let elements: &[(usize, usize, &Formula)] = match by {
            RotationCoordinates::Angle => &[(2, 2, zz)],
            RotationCoordinates::Euler => &[(0, 0, xx), (1, 1, yy), (2, 2, zz), (0, 1, xy), (0, 2, xz), (1, 2, yz)],
        };
        for &(row, column, element) in elements {
            let element = self.formula(element, Context::Parameters)?;
            (tensor[row][column], tensor[column][row]) = (element, element);
        }
        Ok(tensor)
    }
}
