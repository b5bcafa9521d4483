//! Rotations: `{ rpy: … }`, `{ axis: …, angle: … }` or `{ quaternion: … }`.

use symdiff::Formula;

use super::description::Rotation;
use super::file;
use super::names::Context;
use super::quantity::Dimension;
use super::reader::Reader;
use super::source::Span;
use super::yaml::{Node, Value};

impl Reader<'_> {
    /// A rotation of parameters; `at` is where to say that something is missing.
    pub fn rotation(&mut self, node: &Node, at: Span) -> Option<Rotation> {
        let fields = self.fields::<file::Rotation>(node, at)?;
        let given: Vec<&str> =
            ["rpy", "axis", "quaternion"].into_iter().filter(|key| fields.get(key).is_some()).collect();
        let [kind] = given.as_slice() else {
            let help = "e.g. `{ rpy: [0, 90 deg, 0] }`, `{ axis: z, angle: 30 deg }` or `{ quaternion: [1, 0, 0, 0] }`";
            let message = "a rotation is one of `rpy`, `axis` with `angle`, and `quaternion`";
            self.error(node.span.clone(), message, help.to_owned());
            return None;
        };
        if *kind != "axis" && fields.get("angle").is_some() {
            self.error(fields.key_span("angle"), format!("`angle` goes with `axis`, not with `{kind}`"), None);
            return None;
        }
        let value = fields.get(kind)?;
        match *kind {
            "rpy" => Some(Rotation::RollPitchYaw(self.three(value, Context::Constant, Dimension::ANGLE)?)),
            "axis" => {
                let axis = self.turning_axis(value);
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
                self.error(node.span.clone(), "a quaternion is a list of four numbers", help);
                return None;
            }
        };
        let mut read = items.iter().map(|item| self.formula(item, Context::Constant, Dimension::NUMBER));
        let [a, b, c, d] = [read.next()?, read.next()?, read.next()?, read.next()?];
        let p: [Formula; 4] = [a?, b?, c?, d?];
        if p.iter().all(|formula| self.evaluate(formula, 0) == Some(0.0)) {
            self.error(node.span.clone(), "a quaternion of length zero is no rotation", None);
            return None;
        }
        Some(Rotation::Quaternion(p))
    }
}
