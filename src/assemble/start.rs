//! What is known at the start.

use symdiff::{Builder, Expr, Formula};

use crate::grammar::JointCoordinate;
use crate::model::{Coordinate, StartValue, TimeOrder};

use super::body::EULER;
use super::error::BuildError;
use super::mechanism::{Context, Mechanism, Owner, dof};
use super::placement::PlanarPoses;
use super::pose::Poses;
use super::rotation;
use super::system::Start;

/// What the angle of a carried body says of its joint's.
pub struct CarrierAngle<'d> {
    /// Place of the joint's angle in q.
    index: usize,
    /// Turn of the body for one of it: 1 or −1.
    turn: Expr,
    /// The angle of the body that carries; `None` for the ground.
    parent: Option<&'d Formula>,
}

impl Mechanism<'_> {
    /// Values that are kept, and where assembly begins to look for the others: at a guess where one is given, else
    /// where the joints put the bodies when they are walked from the ground ([`PlanarPoses`], [`Poses`]), with the nominal
    /// parameters.
    pub fn start(&self, g: &Builder) -> Result<Start, BuildError> {
        let description = self.description;
        let position = self.values_at_start(g, &description.initial, TimeOrder::Position)?;
        let velocity = self.values_at_start(g, &description.initial, TimeOrder::Velocity)?;
        let guessed = self.guessed(g)?;
        let known: Vec<Option<Expr>> = position.iter().zip(guessed).map(|(kept, guess)| kept.or(guess)).collect();
        let placed = self.placed(g, &known)?;
        let guess = known.iter().zip(placed).map(|(known, placed)| known.unwrap_or_else(|| g.constant(placed)));
        let guess = guess.collect();
        let conditions = self.start_of_beams(g)?;
        Ok(Start { position, velocity, guess, conditions, nearest: None })
    }

    /// Positions that `guess` names.
    pub fn guessed(&self, g: &Builder) -> Result<Vec<Option<Expr>>, BuildError> {
        self.values_at_start(g, &self.description.guess, TimeOrder::Position)
    }

    /// Where the joints put the coordinates.
    fn placed(&self, g: &Builder, known: &[Option<Expr>]) -> Result<Vec<f64>, BuildError> {
        if self.is_spatial() {
            return Poses::of(g, self, known)?.coordinates(g);
        }
        let placement = PlanarPoses::of(g, self, known)?;
        let value = |&owner: &Owner| match owner {
            Owner::Body(body, coordinate) => placement.value(body, coordinate),
            Owner::Joint(joint, coordinate) => placement.joint(g, self, joint, coordinate),
        };
        Ok(self.coordinates.iter().map(value).collect())
    }

    fn values_at_start(
        &self,
        g: &Builder,
        values: &[StartValue],
        wanted: TimeOrder,
    ) -> Result<Vec<Option<Expr>>, BuildError> {
        let mut found = vec![None; self.q.len()];
        for value in values {
            match value {
                StartValue::Coordinate { body, coordinate, order, value } if *order == wanted => {
                    if let Some(index) = self.bodies[*body].index[dof(*coordinate)] {
                        found[index] = Some(self.formula(g, value, Context::Parameters)?);
                    } else if let Some(carrier) = self.angle_of_carrier(*body, *coordinate, *order) {
                        let own = self.formula(g, value, Context::Parameters)?;
                        let parent = match carrier.parent {
                            Some(parent) => self.formula(g, parent, Context::Parameters)?,
                            None => g.constant(0.0),
                        };
                        let angle = g.sub(own, parent);
                        found[carrier.index] = Some(g.mul(carrier.turn, angle));
                    }
                }
                StartValue::Joint { joint, coordinate, order, value } if *order == wanted => {
                    if let Some(&index) = self.joint_coordinates.get(&(*joint, *coordinate)) {
                        found[index] = Some(self.formula(g, value, Context::Parameters)?);
                    }
                }
                StartValue::Orientation { body, rotation } if wanted == TimeOrder::Position => {
                    let orientation = self.rotation(g, rotation)?;
                    self.set_euler(*body, orientation, &mut found);
                }
                StartValue::AngularVelocity { body, value, in_body } if wanted == TimeOrder::Velocity => {
                    let omega = self.vector(g, value, Context::Parameters)?;
                    let p = self.bodies[*body].euler();
                    let rates = if *in_body { rotation::body_rates(g, p) } else { rotation::ground_rates(g, p) };
                    let rate = rotation::transposed(g, 0.5, &rates, omega);
                    self.set_euler(*body, rate, &mut found);
                }
                _ => {}
            }
        }
        Ok(found)
    }

    /// The coordinate that an angle at the start, of a body of the plane that is carried, comes to: the joint's, where the
    /// angle of the body that carries is named too or is the ground's.
    pub fn angle_of_carrier(&self, body: usize, coordinate: Coordinate, order: TimeOrder) -> Option<CarrierAngle<'_>> {
        let carried = self.bodies[body].carried.as_ref()?;
        let [dof] = carried.dofs.as_slice() else { return None };
        let turns = self.description.joints[carried.joint].kind.axis_of(JointCoordinate::Angle).is_some();
        if coordinate != Coordinate::Angle || !turns {
            return None;
        }
        let named = self.description.initial.iter().chain(&self.description.guess).find_map(|value| match value {
            StartValue::Coordinate { body, coordinate: Coordinate::Angle, order: of, value } => {
                (*body == carried.parent && *of == order).then_some(value)
            }
            _ => None,
        });
        (named.is_some() || carried.parent == 0).then_some(CarrierAngle {
            index: dof.index,
            turn: dof.turn,
            parent: named,
        })
    }

    fn set_euler(&self, body: usize, values: rotation::Quaternion, found: &mut [Option<Expr>]) {
        for (value, index) in values.into_iter().zip(&self.bodies[body].index[EULER..]) {
            if let Some(index) = *index {
                found[index] = Some(value);
            }
        }
    }
}
