//! Forces that effects apply at points, as pictures show them: the sum for each pair of bodies, where it acts on the
//! whole.

use symdiff::Scalar;

use super::mechanism::Mechanism;
use super::thrust::Thrust;
use crate::grammar::Sensor;
use crate::multibody::Vector;

impl<'g> Mechanism<'g, '_> {
    /// One of [`Sensor::THRUSTS`]; `None` where the effect has no such force. Nothing of it is in the graph before it
    /// is asked for.
    pub fn thrust(&self, effect: usize, measure: Sensor) -> Option<Scalar<'g>> {
        let index = |parts: &[Sensor; 6]| parts.iter().position(|part| *part == measure);
        let (pair, part) = Sensor::THRUSTS.iter().enumerate().find_map(|(pair, parts)| Some((pair, index(parts)?)))?;
        let all = self.thrusts.get(effect)?;
        let mut pairs: Vec<[usize; 2]> = Vec::new();
        for thrust in all {
            if !pairs.contains(&thrust.bodies) {
                pairs.push(thrust.bodies);
            }
        }
        let bodies = *pairs.get(pair)?;
        let of_pair: Vec<&Thrust> = all.iter().filter(|thrust| thrust.bodies == bodies).collect();
        let [at, force] = self.sum_of_thrusts(&of_pair);
        Some(if part < 3 { at[part] } else { force[part - 3] })
    }

    /// The mean of the positions, weighted by the squares of the forces, and the sum of the forces.
    fn sum_of_thrusts(&self, thrusts: &[&Thrust<'g>]) -> [Vector<'g>; 2] {
        let g = self.g;
        let force = |thrust: &Thrust<'g>| {
            let parts = thrust.force.components();
            let zero = g.number(0.0);
            Vector::from(parts.map(|part| thrust.condition.map_or(part, |condition| condition.select(part, zero))))
        };
        if let [one] = thrusts {
            return [one.at, force(one)];
        }
        let mut sums = [Vector::zero(g), Vector::zero(g)];
        let mut weights = g.number(f64::MIN_POSITIVE);
        for thrust in thrusts {
            let force = force(thrust);
            let weight = force.dot(force);
            weights += weight;
            sums[0] += weight * thrust.at;
            sums[1] += force;
        }
        [sums[0] / weights, sums[1]]
    }
}
