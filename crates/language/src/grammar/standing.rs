//! Names in formulas of placed or mirrored instances, where they have their meaning in the assembly.
//!
//! An assembly's formula is written in the assembly's frame. The formula of an instance has the coordinates of the
//! model instead: for a position s = D Rᵀ (r − g), and so on ([`crate::syntax::frame`]).

use symdiff::{Formula, Unary};

use super::reader::Reader;
use super::symbols::{Coordinate, JointCoordinate, Symbol, SymbolTable, TimeOrder};
use crate::syntax::frame::{InstanceFrame, PLACE, Turned, signed};
use crate::syntax::scope::Scope;
use crate::syntax::yaml::Node;

impl<S: SymbolTable> Reader<'_, S> {
    /// Converts a formula of an instance to one of the model.
    pub(super) fn in_model(&self, formula: Formula, scope: &Scope) -> Formula {
        match scope.frame() {
            Some(frame) => formula.with_names(|name| self.of_model(name, frame, &scope.full(PLACE))),
            None => formula,
        }
    }

    /// The formula that replaces a name of an instance in the model; `None` if the name stays. `place` is the prefix of
    /// the frame's names.
    fn of_model(&self, name: &str, frame: InstanceFrame, place: &str) -> Option<Formula> {
        let text = match self.symbol(name)? {
            Symbol::JointCoordinate { coordinate: JointCoordinate::Angle, .. } if frame.mirrors.is_odd() => {
                return Some(Formula::name(name).applied(Unary::Neg));
            }
            Symbol::Sensor { measure, .. } if frame.mirrors.is_odd() && measure.is_along_joint() => {
                let (effect, _) = name.rsplit_once('.')?;
                return self.model.is_on_turning_joint(effect).then(|| Formula::name(name).applied(Unary::Neg));
            }
            Symbol::Coordinate { coordinate: Coordinate::Angle, order, .. } => {
                let from = match (order, frame.turned) {
                    (TimeOrder::Position, Turned::ByAngle) => format!("{name} - {place}angle"),
                    _ => name.to_owned(),
                };
                signed(&from, frame.mirrors.turns_back(2))
            }
            Symbol::Coordinate { coordinate, order, .. } | Symbol::Point { coordinate, order, .. } => {
                let axis =
                    [Coordinate::X, Coordinate::Y, Coordinate::Z].iter().position(|known| *known == coordinate)?;
                let origin =
                    if order == TimeOrder::Position { frame.origin(place) } else { ["0"; 3].map(str::to_owned) };
                let parts = self.parts_of_vector(name);
                let from = |axis: usize| match origin[axis].as_str() {
                    "0" => parts[axis].clone(),
                    origin => format!("{} - {origin}", parts[axis]),
                };
                frame.turn_back(place, &[0, 1, 2].map(from), axis)
            }
            Symbol::AngularMotion { axis, in_body: false, .. } => {
                // An axial vector: −D for an odd number of mirrors.
                signed(&frame.turn_back(place, &self.parts_of_vector(name), axis), frame.mirrors.is_odd())
            }
            Symbol::AngularMotion { axis, in_body: true, .. } => signed(name, frame.mirrors.turns_back(axis)),
            _ => return None,
        };
        // It is made of names, and so well formed.
        (text != name).then(|| Formula::parse(&text).ok()).flatten()
    }

    /// The names of a vector's components, from the name of one of them; z is zero in the plane.
    fn parts_of_vector(&self, name: &str) -> [String; 3] {
        let stem = &name[..name.len() - 1];
        ["x", "y", "z"]
            .map(|axis| if axis == "z" && !self.model.is_spatial() { "0".to_owned() } else { format!("{stem}{axis}") })
    }

    /// Whether a symbol has no formula in the frame of the node's instance.
    pub(super) fn is_of_model(&self, node: &Node, symbol: Symbol) -> bool {
        let Some(frame) = node.scalar().and_then(|scalar| scalar.scope.as_deref()?.frame()) else { return false };
        let is_other = frame.is_turned() || frame.mirrors.axes().next().is_some();
        match symbol {
            Symbol::Coordinate { coordinate: Coordinate::Euler(_), .. } => is_other,
            Symbol::Coordinate { coordinate: Coordinate::Angle, .. } => frame.turned == Turned::InSpace,
            _ => false,
        }
    }
}
