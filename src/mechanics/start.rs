//! What is known at the start, and the model's size.

use symdiff::{Expr, Formula, Graph};

use crate::model::{Coordinate, JointKind, StartValue, TimeOrder};

use super::error::BuildError;
use super::mechanism::{Context, Mechanism, freedom};
use super::placement::Placement;
use super::system::Start;

impl Mechanism<'_> {
    /// Values that are kept, and where assembly begins to look for the others: at a guess where one is given, else
    /// where the joints put the bodies when they are walked from the ground ([`Placement`]), with the nominal
    /// parameters.
    pub fn start(&self, g: &mut Graph) -> Result<Start, BuildError> {
        let description = self.description;
        let position = self.values_at_start(g, &description.initial, TimeOrder::Position)?;
        let velocity = self.values_at_start(g, &description.initial, TimeOrder::Velocity)?;
        let guessed = self.values_at_start(g, &description.guess, TimeOrder::Position)?;
        let known: Vec<Option<Expr>> = position.iter().zip(guessed).map(|(kept, guess)| kept.or(guess)).collect();
        let placed = Placement::of(g, self, &known)?;
        let guess = known
            .iter()
            .zip(&self.coordinates)
            .map(|(known, &(body, coordinate))| {
                known.unwrap_or_else(|| g.constant(placed.pose(body)[freedom(coordinate)]))
            })
            .collect();
        Ok(Start { position, velocity, guess })
    }

    fn values_at_start(
        &self,
        g: &mut Graph,
        values: &[StartValue],
        order: TimeOrder,
    ) -> Result<Vec<Option<Expr>>, BuildError> {
        let mut found = vec![None; self.q.len()];
        for value in values.iter().filter(|value| value.order == order) {
            if let Some(index) = self.bodies[value.body].index[freedom(value.coordinate)] {
                found[index] = Some(self.formula(g, &value.value, Context::Parameters)?);
            }
        }
        Ok(found)
    }

    /// The largest length that the model names, m, at its nominal parameters: coordinates of points, distances, held
    /// and initial positions; 1 where it names none.
    pub fn characteristic_length(&self, g: &mut Graph) -> Result<f64, BuildError> {
        let mut lengths: Vec<Expr> = Vec::new();
        for body in &self.bodies {
            lengths.extend(body.points.iter().flatten());
            lengths.extend(body.center);
            // A coordinate's symbol counts as zero here.
            lengths.extend(&body.position[..2]);
        }
        for joint in &self.description.joints {
            if let JointKind::Distance { length, .. } = &joint.kind {
                lengths.push(self.formula(g, length, Context::Time)?);
            }
        }
        let starts = self.description.initial.iter().chain(&self.description.guess);
        let positions =
            starts.filter(|value| value.order == TimeOrder::Position && value.coordinate != Coordinate::Angle);
        let formulas: Vec<&Formula> = positions.map(|value| &value.value).collect();
        for formula in formulas {
            lengths.push(self.formula(g, formula, Context::Parameters)?);
        }
        let largest = self.nominal(g, &lengths).into_iter().map(f64::abs).filter(|length| length.is_finite());
        let largest = largest.fold(0.0, f64::max);
        Ok(if largest > 0.0 { largest } else { 1.0 })
    }
}
