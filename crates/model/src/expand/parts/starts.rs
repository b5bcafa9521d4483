//! Start values of an assembly's parts, as they are in the model's frame.

use std::sync::Arc;

use super::in_model::InstanceEntries;
use super::placement::AXES;
use super::turned::{orient, replace, text, turn};
use super::{Writer, mirror};
use crate::syntax::codes::Code;
use crate::syntax::frame::{InstanceFrame, PLACE, TextVector, Turned, signed, sum};
use crate::syntax::scope::Scope;
use crate::syntax::yaml::Entry;

/// Kind of object that a start value belongs to.
enum Of {
    /// A body, or a point of one.
    Place,
    /// A body's rate of rotation, by its parts.
    Rate,
    Joint,
}

impl Writer<'_, '_> {
    /// Gives start values of bodies in the model's frame, and those of joints in a mirror.
    pub(super) fn starts(&mut self, places: &InstanceEntries, scope: &Arc<Scope>) {
        let Some(frame) = scope.frame() else { return };
        for (section, range) in &places.starts {
            let said = self.taken(section, range);
            let mut starts = said.clone();
            for (index, start) in starts.iter_mut().enumerate() {
                let Some((owner, _)) = said[index].key.rsplit_once('.') else { continue };
                match self.of(owner) {
                    Some(Of::Joint) => {
                        let is_angle = start.key.ends_with(".angle") || start.key.ends_with(".angular_velocity");
                        if is_angle && frame.mirrors.is_odd() {
                            mirror::negate(&mut start.value);
                        }
                    }
                    Some(of) => self.start(start, &of, &said, frame, scope),
                    None => {}
                }
            }
            self.put(section, range, starts);
        }
    }

    /// The body or the point that a port is; any other name as it is.
    fn held_by<'n>(&'n self, name: &'n str) -> &'n str {
        self.parts.port(name).unwrap_or(name)
    }

    /// Kind of an object by its name; `None` if it has no start values.
    fn of(&self, owner: &str) -> Option<Of> {
        let is_body = |name: &str| self.bodies.contains(self.held_by(name));
        if is_body(owner) {
            return Some(Of::Place);
        }
        if self.turning.contains_key(owner) {
            return Some(Of::Joint);
        }
        match owner.rsplit_once('.') {
            Some((body, "omega" | "omega_body")) if is_body(body) => Some(Of::Rate),
            _ => self.held_by(owner).rsplit_once('.').filter(|(body, _)| is_body(body)).map(|_| Of::Place),
        }
    }

    fn start(&mut self, start: &mut Entry, of: &Of, said: &[Entry], frame: InstanceFrame, scope: &Arc<Scope>) {
        let Some((owner, coordinate)) = start.key.rsplit_once('.').map(|(a, b)| (a.to_owned(), b.to_owned())) else {
            return;
        };
        let mirrors = frame.mirrors;
        match (of, coordinate.as_str()) {
            (Of::Place, "omega_body") | (Of::Rate, _)
                if coordinate == "omega_body" || owner.ends_with(".omega_body") =>
            {
                match AXES.iter().position(|axis| *axis == coordinate) {
                    Some(axis) if mirrors.turns_back(axis) => mirror::negate(&mut start.value),
                    Some(_) => {}
                    None => mirrors.axes().for_each(|axis| mirror::axial(&mut start.value, axis)),
                }
            }
            (Of::Place, "omega") => {
                mirrors.axes().for_each(|axis| mirror::axial(&mut start.value, axis));
                if frame.is_turned() {
                    turn(&mut start.value, frame, scope);
                }
            }
            (Of::Place, "orientation") => {
                mirrors.axes().for_each(|axis| mirror::rotation(&mut start.value, axis));
                if frame.is_turned() {
                    orient(&mut start.value, frame, scope);
                }
            }
            (Of::Place, "roll" | "pitch" | "yaw") if frame.is_turned() => {
                let name = own_name(start, scope);
                let message = format!("`{name}` is about an axis of the model, but the instance is turned");
                self.report.error(
                    Code::BadStart,
                    start.key_span.clone(),
                    message,
                    "give `orientation`, or coordinates of joints".to_owned(),
                );
            }
            (Of::Place, "roll" | "pitch" | "yaw") => {
                let axis = usize::from(coordinate == "pitch") + 2 * usize::from(coordinate == "yaw");
                if mirrors.turns_back(axis) {
                    mirror::negate(&mut start.value);
                }
            }
            (Of::Place, "angle" | "angular_velocity") => self.angle(start, coordinate == "angle", frame, scope),
            _ => self.component(start, &owner, &coordinate, said, frame, scope),
        }
    }

    /// The start of a body's angle or of its rate.
    fn angle(&mut self, start: &mut Entry, is_angle: bool, frame: InstanceFrame, scope: &Arc<Scope>) {
        if frame.turned == Turned::InSpace {
            let name = own_name(start, scope);
            let message = format!("`{name}` is about the model's z, but the instance is turned in space");
            self.report.error(Code::BadStart, start.key_span.clone(), message, "give coordinates of joints".to_owned());
            return;
        }
        if frame.mirrors.turns_back(2) {
            mirror::negate(&mut start.value);
        }
        if is_angle && frame.turned == Turned::ByAngle {
            let Some(text) = text(&start.value) else { return };
            replace(&mut start.value, &sum([format!("{PLACE}angle"), text].iter()), scope);
        }
    }

    /// Converts the start of a component of a position, of its velocity, or of a body's rate of rotation.
    fn component(
        &mut self,
        start: &mut Entry,
        owner: &str,
        coordinate: &str,
        said: &[Entry],
        frame: InstanceFrame,
        scope: &Arc<Scope>,
    ) {
        let (is_velocity, letter) = match coordinate.strip_prefix('v') {
            Some(letter) => (true, letter),
            None => (owner.ends_with(".omega"), coordinate),
        };
        let Some(axis) = AXES.iter().position(|axis| *axis == letter) else { return };
        let is_rate = owner.ends_with(".omega");
        let row = frame.rotation(PLACE)[axis].clone();
        let mut vector: TextVector = ["0"; 3].map(str::to_owned);
        for other in (0..3).filter(|&other| row[other] != "0") {
            let wanted = format!("{}{}", &coordinate[..coordinate.len() - 1], AXES[other]);
            let is_wanted = |known: &&Entry| {
                let of = known.key.rsplit_once('.').filter(|(_, coordinate)| *coordinate == wanted);
                of.is_some_and(|(other, _)| self.held_by(other) == self.held_by(owner))
            };
            let Some(found) = said.iter().find(is_wanted) else {
                let name = own_name(start, scope);
                let message = format!("`{name}` is given without `{wanted}`, but the instance is turned");
                let all = if frame.turned == Turned::InSpace { "all three" } else { "both" };
                self.report.error(
                    Code::BadStart,
                    start.key_span.clone(),
                    message,
                    format!("give {all}, or the coordinates of joints"),
                );
                return;
            };
            let is_negative = if is_rate { frame.mirrors.turns_back(other) } else { frame.mirrors.flips(other) };
            let Some(text) = text(&found.value) else { return };
            vector[other] = signed(&text, is_negative);
        }
        let origin = frame.origin(PLACE)[axis].clone();
        if !frame.is_turned() && (is_velocity || origin == "0") {
            // Nothing but its sign can be another.
            let is_negative = if is_rate { frame.mirrors.turns_back(axis) } else { frame.mirrors.flips(axis) };
            if is_negative {
                mirror::negate(&mut start.value);
            }
            return;
        }
        let origin = if is_velocity { "0".to_owned() } else { origin };
        let seen = frame.turn(PLACE, &vector)[axis].clone();
        replace(&mut start.value, &sum([origin, seen].iter()), scope);
    }
}

/// Name of the start value in the assembly.
fn own_name<'e>(start: &'e Entry, scope: &Scope) -> &'e str {
    start.key.strip_prefix(scope.prefix()).unwrap_or(&start.key)
}
