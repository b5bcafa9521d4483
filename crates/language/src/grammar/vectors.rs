//! Vectors, directions and rotations: `[x, y, z]`, `x`, `{ rpy: … }`, `{ axis: …, angle: … }`, `{ quaternion: … }`.

use symdiff::Formula;

use super::formulas::Written;
use super::names::Context;
use super::plane;
use super::quantity::Dimension;
use super::reader::Reader;
use super::rotation::Rotation;
use super::symbols::SymbolTable;
use crate::syntax::codes::Code;
use crate::syntax::source::Span;
use crate::syntax::yaml::{Node, Value};

impl<S: SymbolTable> Reader<'_, S> {
    /// Reads components of a dimension: two, with z = 0, or three; in a planar model z is 0.
    pub fn components(&mut self, node: &Node, context: Context, wanted: Dimension) -> Option<[Formula; 3]> {
        if let Value::Sequence(items) = &node.value
            && let [_, _, third] = items.as_slice()
            && !self.model.is_spatial()
            && plane::leaves_plane(node)
        {
            self.leaves_the_plane(third);
        }
        self.components_in_space(node, context, wanted)
    }

    /// The same for values that may leave the plane, such as those of a picture.
    pub fn components_in_space(&mut self, node: &Node, context: Context, wanted: Dimension) -> Option<[Formula; 3]> {
        let items = self.two_or_three(node, "a list of two or three numbers")?;
        let mut read = items.iter().map(|item| self.formula(item, context, wanted)).collect::<Vec<_>>().into_iter();
        let [x, y] = [read.next()?, read.next()?];
        let z = read.next().unwrap_or_else(|| Some(Formula::number(0.0)));
        Some([x?, y?, z?])
    }

    /// A list of a vector's components.
    fn two_or_three<'n>(&mut self, node: &'n Node, wanted: &str) -> Option<&'n [Node]> {
        let found = match &node.value {
            Value::Sequence(items) if (2..=3).contains(&items.len()) => return Some(items),
            Value::Sequence(items) => format!("a list of {}", items.len()),
            _ => node.kind().to_owned(),
        };
        self.error(Code::WrongShape, node.span.clone(), format!("{wanted} belongs here, but here is {found}"), None);
        None
    }

    /// Reports a value that a model with `space: planar` cannot have.
    pub fn leaves_the_plane(&mut self, node: &Node) {
        let help = "write `space: spatial`, or leave `space` out".to_owned();
        self.error(Code::NotPlanar, node.span.clone(), "this leaves the plane, but the model is planar", help);
    }

    /// Reads three formulas of a dimension.
    pub fn three(&mut self, node: &Node, context: Context, wanted: Dimension) -> Option<[Formula; 3]> {
        let [x, y, z] = self.list_of(node, 3)? else { return None };
        let [x, y, z] = [x, y, z].map(|node| self.formula(node, context, wanted));
        Some([x?, y?, z?])
    }

    /// Reads a direction of a translation, in the plane if the mechanism is planar.
    pub fn direction(&mut self, node: &Node) -> Option<[Formula; 3]> {
        if !self.model.is_spatial() && plane::points_out(node) {
            self.leaves_the_plane(node);
        }
        self.axis(node)
    }

    /// Reads an axis of a rotation, z if the mechanism is planar.
    pub fn rotation_axis(&mut self, node: &Node) -> Option<[Formula; 3]> {
        if !self.model.is_spatial() && plane::rotates_out(node) {
            self.leaves_the_plane(node);
        }
        self.axis(node)
    }

    /// Reads `x`, `y`, `z` or components of any length but zero.
    pub fn axis(&mut self, node: &Node) -> Option<[Formula; 3]> {
        let along = |axis: usize| [0, 1, 2].map(|other| Formula::number(f64::from(u8::from(axis == other))));
        match node.scalar().map(|scalar| scalar.text.as_str()) {
            Some("x") => return Some(along(0)),
            Some("y") => return Some(along(1)),
            Some("z") => return Some(along(2)),
            _ => {}
        }
        let items = self.two_or_three(node, "`x`, `y`, `z` or a list of two or three numbers")?;
        let mut component = |node: &Node| match self.written(node)? {
            Written::Quantity { value, unit } => Some(Formula::number(unit.to_si(value))),
            Written::Formula(formula) => self.check_names(node, &formula, 0, Context::Constant).then(|| {
                self.kind(node, &formula, 0);
                self.require(node, &formula, |_| true, "");
                formula
            }),
        };
        let mut read = items.iter().map(&mut component).collect::<Vec<_>>().into_iter();
        let [x, y] = [read.next()?, read.next()?];
        let z = read.next().unwrap_or_else(|| Some(Formula::number(0.0)));
        let axis = [x?, y?, z?];
        for corner in 0..self.corners.len() {
            if axis.iter().all(|formula| self.evaluate(formula, corner) == Some(0.0)) {
                let label = &self.corners[corner].label;
                let message = format!("a direction of length zero points nowhere{label}");
                self.error(Code::ZeroDirection, node.span.clone(), message, None);
                break;
            }
        }
        Some(axis)
    }

    /// Reads a rotation of parameters; missing keys are reported at `at`.
    pub fn rotation(&mut self, node: &Node, at: Span) -> Option<Rotation> {
        self.rotation_about(node, at, Self::rotation_axis)
    }

    /// The same for values that may leave the plane, such as those of a picture.
    pub fn rotation_in_space(&mut self, node: &Node, at: Span) -> Option<Rotation> {
        self.rotation_about(node, at, Self::axis)
    }

    fn rotation_about(
        &mut self,
        node: &Node,
        at: Span,
        axis: fn(&mut Self, &Node) -> Option<[Formula; 3]>,
    ) -> Option<Rotation> {
        let (kind, fields) = self.kind_of_rotation(node, at)?;
        let value = fields.get(kind)?;
        match kind {
            "rpy" => Some(Rotation::RollPitchYaw(self.three(value, Context::Constant, Dimension::ANGLE)?)),
            "axis" => {
                let axis = axis(self, value);
                let angle = self.required(&fields, "angle");
                let angle = angle.and_then(|node| self.formula(node, Context::Constant, Dimension::ANGLE));
                Some(Rotation::AxisAngle(axis?, angle?))
            }
            _ => self.quaternion(value),
        }
    }

    fn quaternion(&mut self, node: &Node) -> Option<Rotation> {
        let items = match &node.value {
            Value::Sequence(items) if items.len() == 4 => items,
            _ => {
                let help = "the cosine of half the angle first, then the axis times the sine of it".to_owned();
                self.error(Code::WrongShape, node.span.clone(), "a quaternion is a list of four numbers", help);
                return None;
            }
        };
        let mut read = items.iter().map(|item| self.formula(item, Context::Constant, Dimension::NUMBER));
        let [a, b, c, d] = [read.next()?, read.next()?, read.next()?, read.next()?];
        let p: [Formula; 4] = [a?, b?, c?, d?];
        if p.iter().all(|formula| self.evaluate(formula, 0) == Some(0.0)) {
            self.error(Code::ZeroDirection, node.span.clone(), "a quaternion of length zero is no rotation", None);
            return None;
        }
        Some(Rotation::Quaternion(p))
    }
}
