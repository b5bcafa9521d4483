//! Known values at the start.

use symdiff::{Formula, Scalar};

use super::mechanism::{Mechanism, Owner, dof};
use super::placement::PlanarPoses;
use super::pose::Poses;
use super::system::Start;
use crate::grammar::JointCoordinate;
use crate::model::{Coordinate, Description, StartValue, TimeOrder};
use crate::multibody::{BuildError, Context, EULER, Quaternion};

/// Relation between the angle of a child and that of its inboard joint.
pub struct InboardAngle<'g, 'd> {
    /// Index of the joint's angle in q.
    index: usize,
    /// Rotation of the child per joint angle: 1 or −1.
    rotation: Scalar<'g>,
    /// The angle of the parent; `None` for the ground.
    parent: Option<&'d Formula>,
}

/// The list in which the start names a value.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Named {
    /// `initial`.
    Kept,
    /// `guess`.
    Guessed,
}

impl<'g> Mechanism<'g, '_> {
    /// Given values, and the guesses of the others: the guess of the model if there is one, else the result of placing
    /// the bodies by their joints, from the ground on ([`PlanarPoses`], [`Poses`]), with the nominal parameters.
    pub fn start(&self, description: &Description) -> Result<Start, BuildError> {
        let position = self.values_at_start(description, &description.initial, Named::Kept, TimeOrder::Position)?;
        let velocity = self.values_at_start(description, &description.initial, Named::Kept, TimeOrder::Velocity)?;
        let mut guessed = self.values_at_start(description, &description.guess, Named::Guessed, TimeOrder::Position)?;
        for &(index, value) in &self.child_guesses {
            let found = guessed[index].filter(|_| !self.starts_assembled);
            guessed[index] = Some(found.unwrap_or_else(|| self.g.number(value)));
        }
        let known: Vec<_> = position.iter().zip(guessed).map(|(kept, guess)| kept.or(guess)).collect();
        let placed = self.placed(description, &known)?;
        let guess = known.iter().zip(placed).map(|(known, placed)| known.unwrap_or_else(|| self.g.number(placed)));
        let guess = guess.map(Scalar::expr).collect();
        let mut conditions = self.start_of_beams(description)?;
        conditions.extend(self.start_of_superelements(description));
        conditions.extend(self.start_conditions(description)?);
        let exprs = |values: Vec<Option<Scalar>>| values.into_iter().map(|value| value.map(Scalar::expr)).collect();
        Ok(Start {
            position: exprs(position),
            velocity: exprs(velocity),
            guess,
            fulfils_velocity_constraints: false,
            conditions,
            at_equilibrium: description.starts_at_equilibrium,
            nearest: None,
        })
    }

    /// Values of the coordinates once the joints have placed the bodies.
    fn placed(&self, description: &Description, known: &[Option<Scalar<'g>>]) -> Result<Vec<f64>, BuildError> {
        let standing: Vec<_> = description.bodies.iter().map(|body| body.standing).collect();
        if self.is_spatial {
            return Poses::of(self, known, &standing)?.coordinates();
        }
        let placement = PlanarPoses::of(self, known, &standing)?;
        let value = |&owner: &Owner| match owner {
            Owner::Body(body, coordinate) => placement.value(body, coordinate),
            Owner::Joint(joint, coordinate) => placement.joint(self, joint, coordinate),
            // Joints of the plane have one axis.
            Owner::Relative(..) | Owner::Mode | Owner::State => 0.0,
        };
        Ok(self.coordinates.iter().map(value).collect())
    }

    fn values_at_start(
        &self,
        description: &Description,
        values: &[StartValue],
        named: Named,
        wanted: TimeOrder,
    ) -> Result<Vec<Option<Scalar<'g>>>, BuildError> {
        let mut found = vec![None; self.q.len()];
        for value in values {
            match value {
                StartValue::Coordinate { body, coordinate, order, value } if *order == wanted => {
                    if let Some(index) = self.bodies[*body].index[dof(*coordinate)] {
                        found[index] = Some(self.formula(value, Context::Parameters)?);
                    } else if let Some(joint) =
                        self.angle_of_inboard_joint(description, named, *body, *coordinate, *order)
                    {
                        let own = self.formula(value, Context::Parameters)?;
                        let parent = match joint.parent {
                            Some(parent) => self.formula(parent, Context::Parameters)?,
                            None => self.g.number(0.0),
                        };
                        found[joint.index] = Some(joint.rotation * (own - parent));
                    }
                }
                StartValue::Joint { joint, coordinate, order, value } if *order == wanted => {
                    if let Some(&index) = self.joint_coordinates.get(&(*joint, *coordinate)) {
                        found[index] = Some(self.formula(value, Context::Parameters)?);
                    }
                }
                StartValue::Orientation { body, rotation } if wanted == TimeOrder::Position => {
                    self.set_euler(*body, self.rotation(rotation)?, &mut found);
                }
                StartValue::AngularVelocity { body, value, in_body } if wanted == TimeOrder::Velocity => {
                    let omega = self.vector(value, Context::Parameters)?;
                    let p = self.bodies[*body].euler();
                    let rates = if *in_body { p.body_rates() } else { p.ground_rates() };
                    self.set_euler(*body, rates.transposed_times(0.5, omega), &mut found);
                }
                _ => {}
            }
        }
        self.states_at_start(description, wanted, &mut found)?;
        Ok(found)
    }

    /// The coordinate that stands for an angle at the start of a child in the plane: its inboard joint's, where the
    /// angle of the parent is named too or is the ground's. A value in `initial` needs one in `initial`.
    pub fn angle_of_inboard_joint<'d>(
        &self,
        description: &'d Description,
        named: Named,
        body: usize,
        coordinate: Coordinate,
        order: TimeOrder,
    ) -> Option<InboardAngle<'g, 'd>> {
        let motion = self.bodies[body].relative_motion.as_ref()?;
        let [dof] = motion.dofs.as_slice() else { return None };
        let rotates = self.joints[motion.joint].kind.axis_of(JointCoordinate::Angle).is_some();
        if coordinate != Coordinate::Angle || !rotates {
            return None;
        }
        if motion.parent == 0 {
            return Some(InboardAngle { index: dof.index, rotation: *dof.rotation.first()?, parent: None });
        }
        let guess: &[StartValue] = if named == Named::Guessed { &description.guess } else { &[] };
        let named = description.initial.iter().chain(guess).find_map(|value| match value {
            StartValue::Coordinate { body, coordinate: Coordinate::Angle, order: of, value } => {
                (*body == motion.parent && *of == order).then_some(value)
            }
            _ => None,
        });
        Some(InboardAngle { index: dof.index, rotation: *dof.rotation.first()?, parent: Some(named?) })
    }

    fn set_euler(&self, body: usize, values: Quaternion<'g>, found: &mut [Option<Scalar<'g>>]) {
        for (value, index) in values.components().into_iter().zip(&self.bodies[body].index[EULER..]) {
            if let Some(index) = *index {
                found[index] = Some(value);
            }
        }
    }
}
