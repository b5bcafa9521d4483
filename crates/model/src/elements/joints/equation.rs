//! Equation: any holonomic constraint, drivers included.
//!
//! ```text
//! Φ = left − right = 0          1 row, in the unit of its sides
//! ```
//!
//! The formulas speak of positions, parameters and t, not of velocities. There is no second body, hence no reaction
//! force or torque: both are zero, and the multiplier λ itself (N for metres, N m for radians), with its sign, stands
//! for `joint.force`. −Φ_qᵀ λ acts: with `crank.angle = omega*t` the drive's torque on the crank is −λ.

use std::borrow::Cow;

use schemars::{JsonSchema, Schema, SchemaGenerator};
use symdiff::Formula;

use crate::grammar::{Context, Element, Fields, Group, Key, Node, Reader, Span, Symbol, SymbolTable};
use crate::multibody::Vector;
use crate::syntax::codes::Code;

use super::{Joint, JointElement, Kinematics, Row, RowDocs, Rows};

/// left = right, formulas of coordinates, points, parameters and t.
#[derive(Clone, Debug)]
pub struct Equation {
    /// The left side.
    pub left: Formula,
    /// The right side, of the same dimension.
    pub right: Formula,
}

impl JointElement for Equation {
    const COUPLES: bool = true;
    const ROWS: &'static [RowDocs] = &[RowDocs {
        name: "",
        unit: "that of its sides",
        multiplier: "λ stands for `joint.force`; −λ is the generalised force on the left side",
    }];
}

impl Joint for Equation {
    fn equation(&self) -> Option<[&Formula; 2]> {
        Some([&self.left, &self.right])
    }

    fn rows<'g>(&self, _own: usize, k: &dyn Kinematics<'g>) -> Rows<'g> {
        let (left, right) = (k.of_positions(&self.left)?, k.of_positions(&self.right)?);
        let value = left - right;
        let zero = Vector::zero(k.graph());
        Ok(vec![Row { name: "", value, force: zero, torque: zero }])
    }
}

/// It is one line of text, and has no keys.
impl Group for Equation {
    fn key_names() -> Vec<&'static str> {
        Vec::new()
    }

    fn keys(_: &mut SchemaGenerator) -> Vec<Key> {
        Vec::new()
    }

    fn read<S: SymbolTable>(reader: &mut Reader<'_, S>, fields: &Fields<'_>, _units: usize) -> Option<Self> {
        reader.error(Code::WrongShape, fields.at.clone(), "an equation is a text, but here is a mapping", None);
        None
    }

    fn formulas<'a>(&'a self, found: &mut Vec<&'a Formula>) {
        found.extend([&self.left, &self.right]);
    }
}

impl Element for Equation {
    const KEYWORD: &'static str = "equation";
    const WHAT: &'static str = "an equation";
    const DESCRIPTION: &'static str =
        "`left = right` between coordinates, parameters and t, e.g. `crank.angle = omega*t`.";
    const EQUATIONS: &'static [&'static str] = &["left − right = 0"];
    const SOURCE: &'static str = "Nikravesh, Computer-Aided Analysis of Mechanical Systems (1988), ch. 4";
    const EXAMPLE: &'static str = "crank.angle = 2*t";
    const SHORT: Option<&'static str> = None;

    fn read_node<S: SymbolTable>(reader: &mut Reader<'_, S>, node: &Node, _at: Span) -> Option<Self> {
        let scalar = reader.scalar(node, "an equation")?;
        let text = scalar.text.as_str();
        let Some(equals) = equals_sign(text) else {
            let help = "write `left = right`, e.g. `crank.angle = omega*t`".to_owned();
            reader.error(Code::BadEquation, node.span.clone(), "an equation has two sides", help);
            return None;
        };
        let mut side = |start: usize, end: usize| {
            let formula = reader.parse(node, scalar, start..end)?;
            reader.check_names(node, &formula, start, Context::Equation).then_some(())?;
            let kind = reader.kind(node, &formula, start);
            Some((formula, kind))
        };
        let left = side(0, equals);
        let right = side(equals + 1, text.len());
        let ((left, left_kind), (right, right_kind)) = (left?, right?);
        if let (Some(a), Some(b)) = (left_kind.dimension(), right_kind.dimension())
            && !a.fits(b)
        {
            reader.error(Code::BadEquation, node.span.clone(), format!("{a} cannot equal {b}"), None);
        }
        let moves = left.names().chain(right.names()).any(|(name, _)| {
            matches!(
                reader.symbol(name),
                Some(Symbol::Coordinate { .. } | Symbol::Point { .. } | Symbol::JointCoordinate { .. })
            )
        });
        if !moves {
            reader.error(
                Code::BadEquation,
                node.span.clone(),
                "the equation constrains nothing: no coordinate stands in it",
                None,
            );
        }
        Some(Self { left, right })
    }
}

/// Index of the `=` between the sides; an `=` of a comparison does not count.
fn equals_sign(text: &str) -> Option<usize> {
    let compares = |index: usize| text[..index].ends_with(['<', '>', '!', '=']) || text[index + 1..].starts_with('=');
    text.match_indices('=').map(|(index, _)| index).find(|&index| !compares(index))
}

impl JsonSchema for Equation {
    fn schema_name() -> Cow<'static, str> {
        "Equation".into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        schemars::json_schema!({ "type": "string" })
    }
}
