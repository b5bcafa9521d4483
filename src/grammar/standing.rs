//! Names in formulas of instances that are placed or mirrored.

use symdiff::{Formula, Unary};

use super::reader::Reader;
use super::symbols::{JointCoordinate, Sensor, Symbol, SymbolTable};
use crate::syntax::scope::{Scope, Stands};
use crate::syntax::yaml::Node;

/// What effects measure along a joint's angle: in a mirror it counts the other way.
const COUNT_BACK: [&str; 4] = [Sensor::ANGLE.name(), "integral", "filtered_rate", "current"];

impl<S: SymbolTable> Reader<'_, S> {
    /// A formula of a mirrored instance, in which angles of joints count the other way.
    pub(super) fn in_mirror(&self, formula: &Formula) -> Formula {
        formula.with_names(|name| match self.symbol(name)? {
            Symbol::JointCoordinate { coordinate: JointCoordinate::Angle, .. } => {
                Some(Formula::name(name).applied(Unary::Neg))
            }
            _ => None,
        })
    }

    /// Whether a name is of a number that is another in the frame of the instance that the formula is in.
    pub(super) fn is_of_frame(&self, node: &Node, symbol: Symbol) -> bool {
        let scope = node.scalar().and_then(|scalar| scalar.scope.as_deref());
        match (scope.map_or(Stands::AsWritten, Scope::stands), symbol) {
            (Stands::AsWritten, _) => false,
            (_, Symbol::Coordinate { .. } | Symbol::Point { .. } | Symbol::AngularMotion { .. }) => true,
            (Stands::Mirrored, Symbol::Sensor { measure, .. }) => COUNT_BACK.contains(&measure.name()),
            _ => false,
        }
    }
}
