//! Actuators: their targets, their law, memory and ranges.

use super::couplings::CouplingReader;
use super::document::{Attribute, Item};
use super::robot::{Actuator, ActuatorLaw, Length, Memory};
use super::values::Values;
use crate::syntax::codes::Code;

impl CouplingReader<'_, '_, '_> {
    /// Reads an actuator.
    pub fn actuator(&mut self, item: &Item) -> Option<()> {
        let name = self.name(item, format!("actuator_{}", self.robot.actuators.len()));
        let class = self.values.class_of(item, None, "class");
        let tags = [item.tag.as_str(), "general"];
        let get = |values: &Values, key: &str| {
            let found = values.get(item, class, &tags, key)?;
            Some(Attribute {
                name: found.name.clone(),
                value: found.value.clone(),
                span: found.span.clone(),
                own: false,
            })
        };
        let on =
            match (get(self.values, "joint").or_else(|| get(self.values, "jointinparent")), get(self.values, "tendon"))
            {
                (Some(joint), _) => Length { terms: vec![(self.joint(&joint)?, 1.0)] },
                (None, Some(tendon)) => self.tendon_length(&tendon)?,
                (None, None) => {
                    self.needs(item, "`joint` or `tendon`");
                    return None;
                }
            };
        let offset = on.terms.iter().map(|&(joint, by)| by * self.robot.joints[joint].reference).sum();
        let memory = self.memory(item, &get)?;
        let law = self.law(item, &get, &name)?;
        let damping_ratio = self.damping_ratio(item, &get, &law);
        let gear = get(self.values, "gear");
        let first = gear.as_ref().and_then(|found| self.values.parsed(found, 6)).map_or(1.0, |gear| gear[0]);
        let gear = self.values.number(item, gear.as_ref(), format!("actuator.{name}.gear"), first, "");
        let control = self.range(item, &get, "ctrlrange", "ctrllimited");
        let inherited = self.inherited(&get, &on);
        let control = inherited.or(control).filter(|_| self.values.settings.flags.clamps_controls);
        let force = self.range(item, &get, "forcerange", "forcelimited");
        self.robot.actuators.push(Actuator {
            name,
            span: item.span.clone(),
            on,
            offset,
            gear,
            law,
            damping_ratio,
            memory,
            control,
            force,
        });
        Some(())
    }

    fn law(
        &mut self,
        item: &Item,
        get: &dyn Fn(&Values, &str) -> Option<Attribute>,
        name: &str,
    ) -> Option<ActuatorLaw> {
        let values = &mut *self.values;
        let list = |values: &mut Values, key: &str, default: f64| numbers(values, get, key, default);
        let number = |values: &mut Values, key: &str, default: f64| {
            let value = list(values, key, default)[0];
            values.number(item, get(values, key).as_ref(), format!("actuator.{name}.{key}"), value, "")
        };
        Some(match item.tag.as_str() {
            "motor" => ActuatorLaw::Affine { gain: 1.0, bias: [0.0; 3] },
            "position" => ActuatorLaw::Position { kp: number(values, "kp", 1.0), kv: number(values, "kv", 0.0) },
            "velocity" => ActuatorLaw::Velocity { kv: number(values, "kv", 1.0) },
            "damper" => ActuatorLaw::Damper { kv: number(values, "kv", 1.0) },
            "cylinder" => {
                let area = list(values, "area", 1.0)[0];
                let of_diameter = |diameter: f64| std::f64::consts::FRAC_PI_4 * diameter * diameter;
                let gain = get(values, "diameter").map_or(area, |_| of_diameter(list(values, "diameter", 0.0)[0]));
                let bias = list(values, "bias", 0.0);
                ActuatorLaw::Affine { gain, bias: [0, 1, 2].map(|index| bias.get(index).copied().unwrap_or(0.0)) }
            }
            _ => {
                let mut plain = |key: &str, words: &[(&str, bool)]| match get(values, key) {
                    Some(found) => values.word(&found, words),
                    None => Some(false),
                };
                plain("gaintype", &[("fixed", false)])?;
                let is_affine = plain("biastype", &[("none", false), ("affine", true)])?;
                let (gain, bias) = (list(values, "gainprm", 1.0)[0], list(values, "biasprm", 0.0));
                let at = |index: usize| bias.get(index).copied().filter(|_| is_affine).unwrap_or(0.0);
                ActuatorLaw::Affine { gain, bias: [at(0), at(1), at(2)] }
            }
        })
    }

    /// The damping ratio of a law that holds a position: `dampratio`, or the third bias of a general law if that is
    /// positive.
    fn damping_ratio(
        &mut self,
        item: &Item,
        get: &dyn Fn(&Values, &str) -> Option<Attribute>,
        law: &ActuatorLaw,
    ) -> Option<f64> {
        match law {
            ActuatorLaw::Position { kv, .. } => {
                let found = get(self.values, "dampratio")?;
                let [ratio] = self.values.exact::<1>(&found)?;
                if ratio < 0.0 {
                    self.values.error(
                        Code::BadXmlValue,
                        found.span,
                        "the damping ratio of this actuator is negative",
                        None,
                    );
                } else if ratio > 0.0 && kv.value != 0.0 {
                    let help = "both say how large the damping is: give one".to_owned();
                    self.values.error(Code::MissingXml, item.span.clone(), "an actuator has `kv` or `dampratio`", help);
                }
                Some(ratio).filter(|ratio| *ratio > 0.0)
            }
            ActuatorLaw::Affine { gain, bias: [_, by_length, by_rate] } => {
                Some(*by_rate).filter(|by_rate| *by_rate > 0.0 && *gain == -by_length)
            }
            ActuatorLaw::Velocity { .. } | ActuatorLaw::Damper { .. } => None,
        }
    }

    /// Memory between the actuator's command and its activation: none, an integrator or a lag.
    fn memory(&mut self, item: &Item, get: &dyn Fn(&Values, &str) -> Option<Attribute>) -> Option<Option<Memory>> {
        let values = &mut *self.values;
        let first = |values: &mut Values, key: &str, default: f64| numbers(values, get, key, default)[0];
        let time = match item.tag.as_str() {
            "position" => first(values, "timeconst", 0.0),
            "cylinder" => first(values, "timeconst", 1.0),
            "general" => {
                // Filters differ in how MuJoCo steps them.
                let words =
                    [("none", None), ("integrator", Some(true)), ("filter", Some(false)), ("filterexact", Some(false))];
                let kind = match get(values, "dyntype") {
                    Some(found) => values.word(&found, &words)?,
                    None => None,
                };
                match kind {
                    None => return Some(None),
                    Some(true) => return Some(Some(Memory::Integrator)),
                    Some(false) => first(values, "dynprm", 1.0),
                }
            }
            _ => 0.0,
        };
        if time < 0.0 {
            values.error(Code::BadXmlValue, item.span.clone(), "the time constant of this actuator is negative", None);
        }
        Some((time > 0.0).then_some(Memory::Lag(time)))
    }

    /// The range of commands that is a part of the joint's range.
    fn inherited(&mut self, get: &dyn Fn(&Values, &str) -> Option<Attribute>, on: &Length) -> Option<[f64; 2]> {
        let found = get(self.values, "inheritrange")?;
        let [part] = self.values.exact(&found)?;
        if part <= 0.0 {
            return None;
        }
        let joint = match on.terms.as_slice() {
            [(joint, _)] => &self.robot.joints[*joint],
            _ => {
                self.values.error(
                    Code::BadXmlValue,
                    found.span,
                    "only a joint has a range that `inheritrange` could mean",
                    None,
                );
                return None;
            }
        };
        let Some(ends) = joint.range.as_ref() else {
            let message = format!("joint `{}` has no range that `inheritrange` could mean", joint.name);
            self.values.error(Code::BadXmlValue, found.span, message, None);
            return None;
        };
        let [lower, upper] = ends.each_ref().map(|end| end.value + joint.reference);
        let (middle, half) = ((lower + upper) / 2.0, part * (upper - lower) / 2.0);
        Some([middle - half, middle + half])
    }

    /// A range that holds.
    fn range(
        &mut self,
        item: &Item,
        get: &dyn Fn(&Values, &str) -> Option<Attribute>,
        key: &str,
        limited: &str,
    ) -> Option<[f64; 2]> {
        let words = [("true", Some(true)), ("false", Some(false)), ("auto", None)];
        let limited = get(self.values, limited).and_then(|found| self.values.word(&found, &words)).flatten();
        let ends = get(self.values, key).and_then(|found| self.values.exact::<2>(&found));
        let holds = limited.unwrap_or(self.values.settings.autolimits && ends.is_some());
        let ends = ends.filter(|_| holds)?;
        if ends[0] >= ends[1] {
            self.values.error(Code::BadXmlValue, item.span.clone(), format!("the ends of `{key}` are reversed"), None);
        }
        Some(ends)
    }
}

/// The numbers of an attribute, at least one; the default if there are none.
fn numbers(values: &mut Values, get: &dyn Fn(&Values, &str) -> Option<Attribute>, key: &str, default: f64) -> Vec<f64> {
    let given = get(values, key).and_then(|found| values.parsed(&found, 10));
    given.unwrap_or_else(|| vec![default])
}
