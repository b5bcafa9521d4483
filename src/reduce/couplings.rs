//! What of a mechanism hangs together: bodies, joints and effects that touch, or name, one another.
//!
//! The ground connects nothing, nor does what is merged with it: it does not move, whatever is attached to it. Gravity acts on every body alike and
//! connects none, unless its formula names a part of the motion. A dependency is taken both ways: a force on B that follows A keeps A and B
//! together, though A would not miss B.

use symdiff::Formula;

use super::sets::Sets;
use crate::model::{Description, Effect, Joint, Reference, Referent, Scope};

/// A part of a mechanism, by its index in the description.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
#[allow(missing_docs)]
pub enum Part {
    Body(usize),
    Joint(usize),
    Effect(usize),
}

/// What a formula speaks of.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Named {
    /// Parts whose motion, reaction or measure it names.
    pub parts: Vec<Part>,
    /// Named points of bodies: body and point.
    pub points: Vec<(usize, usize)>,
    /// Parameters, by index.
    pub parameters: Vec<usize>,
    /// Whether it names an energy, to which every body adds.
    pub everything: bool,
}

impl Named {
    /// By a formula of a description.
    pub fn add(&mut self, description: &Description, formula: &Formula) {
        for (name, _) in formula.names() {
            match description.referent(name) {
                Some(Referent::Parameter(index)) => self.parameters.push(index),
                Some(
                    Referent::Coordinate { body, .. }
                    | Referent::AngularMotion { body, .. }
                    | Referent::RollPitchYaw { body, .. },
                ) => self.parts.push(Part::Body(body)),
                Some(Referent::Point { body, point, .. }) => {
                    self.parts.push(Part::Body(body));
                    self.points.push((body, point));
                }
                Some(Referent::JointCoordinate { joint, .. } | Referent::Reaction { joint, .. }) => {
                    self.parts.push(Part::Joint(joint));
                }
                Some(Referent::Measure { effect, .. }) => self.parts.push(Part::Effect(effect)),
                Some(Referent::Energy(_)) => self.everything = true,
                Some(Referent::Time) | None => {}
            }
        }
    }

    /// By many formulas.
    pub fn by<'f>(description: &Description, formulas: impl IntoIterator<Item = &'f Formula>) -> Self {
        let mut named = Self::default();
        formulas.into_iter().for_each(|formula| named.add(description, formula));
        named
    }

    /// By a joint or an effect: its formulas, and what it stands between.
    fn by_part<'f>(
        description: &Description,
        formulas: impl IntoIterator<Item = &'f Formula>,
        references: Vec<Reference>,
    ) -> Self {
        let mut named = Self::by(description, formulas);
        for reference in references {
            match reference {
                Reference::Body(body) => named.parts.push(Part::Body(*body)),
                Reference::Point(place) => {
                    named.parts.push(Part::Body(place.body));
                    named.points.extend(place.point.map(|point| (place.body, point)));
                }
                Reference::Joint(joint) => named.parts.push(Part::Joint(*joint)),
            }
        }
        named
    }

    /// Takes in what something else names.
    pub fn take(&mut self, other: &Self) {
        self.parts.extend(&other.parts);
        self.points.extend(&other.points);
        self.parameters.extend(&other.parameters);
        self.everything |= other.everything;
    }
}

/// Which parts hang together.
pub struct Couplings {
    sets: Sets,
    /// What each joint, effect and output names.
    pub joints: Vec<Named>,
    #[allow(missing_docs)]
    pub effects: Vec<Named>,
    #[allow(missing_docs)]
    pub outputs: Vec<Named>,
    /// Whether each effect acts on every body without connecting them.
    pub fields: Vec<bool>,
    /// Of each body that is merged with the ground, directly or through others, the joint towards it.
    pub still: Vec<Option<usize>>,
    /// Whether each joint is such a one.
    holds: Vec<bool>,
}

impl Couplings {
    /// Of a description whose welds are marked.
    pub fn of(description: &Description) -> Self {
        let joint =
            |Joint { kind, .. }: &Joint| Named::by_part(description, kind.formulas(), kind.clone().references());
        let joints: Vec<Named> = description.joints.iter().map(joint).collect();
        let effect =
            |Effect { kind, .. }: &Effect| Named::by_part(description, kind.formulas(), kind.clone().references());
        let effects: Vec<Named> = description.effects.iter().map(effect).collect();
        let outputs = description.outputs.iter().map(|output| Named::by(description, [&output.formula])).collect();
        let on_every_body = |effect: usize| description.effects[effect].kind.scope() == Scope::EveryBody;
        let fields: Vec<bool> =
            effects.iter().enumerate().map(|(effect, named)| on_every_body(effect) && named.parts.is_empty()).collect();
        let still = still(description);
        let mut holds = vec![false; joints.len()];
        still.iter().flatten().for_each(|&joint| holds[joint] = true);
        let parts = description.bodies.len() + joints.len() + effects.len();
        let mut couplings = Self { sets: Sets::new(parts), joints, effects, outputs, fields, still, holds };
        for joint in 0..description.joints.len() {
            let parts = couplings.joints[joint].parts.clone();
            couplings.join(Part::Joint(joint), &parts);
        }
        for effect in (0..description.effects.len()).filter(|&effect| !couplings.fields[effect]).collect::<Vec<_>>() {
            let mut parts = couplings.effects[effect].parts.clone();
            if on_every_body(effect) {
                parts.extend((1..description.bodies.len()).map(Part::Body));
            }
            couplings.join(Part::Effect(effect), &parts);
        }
        couplings
    }

    /// Everything that may move, and what moves it.
    pub fn movable(&self) -> Vec<Part> {
        let bodies = (0..self.still.len()).map(Part::Body);
        let joints = (0..self.joints.len()).map(Part::Joint);
        let effects = (0..self.effects.len()).filter(|&effect| !self.fields[effect]).map(Part::Effect);
        bodies.chain(joints).chain(effects).filter(|&part| !self.is_still(part)).collect()
    }

    /// Whether a part connects nothing: the ground and what is merged with it.
    pub fn is_still(&self, part: Part) -> bool {
        match part {
            Part::Body(body) => body == 0 || self.still[body].is_some(),
            Part::Joint(joint) => self.holds[joint],
            Part::Effect(_) => false,
        }
    }

    fn place(&self, part: Part) -> usize {
        match part {
            Part::Body(body) => body,
            Part::Joint(joint) => self.still.len() + joint,
            Part::Effect(effect) => self.still.len() + self.joints.len() + effect,
        }
    }

    /// The set that a part is in.
    pub fn set(&mut self, part: Part) -> usize {
        let place = self.place(part);
        self.sets.of(place)
    }

    fn join(&mut self, part: Part, with: &[Part]) {
        if !self.is_still(part) {
            for &other in with {
                if !self.is_still(other) {
                    let (a, b) = (self.place(part), self.place(other));
                    self.sets.join(a, b);
                }
            }
        }
    }

    /// The set that all of these are in from now on; `None` where they are still.
    pub fn together(&mut self, parts: &[Part]) -> Option<usize> {
        let first = parts.iter().copied().find(|&part| !self.is_still(part))?;
        self.join(first, parts);
        Some(self.set(first))
    }
}

/// Of each body that is merged with the ground, the joint towards it.
fn still(description: &Description) -> Vec<Option<usize>> {
    let mut welds = vec![Vec::new(); description.bodies.len()];
    for (index, joint) in description.joints.iter().enumerate() {
        if let (true, Some([a, b])) = (joint.merged, joint.kind.between()) {
            welds[a.body].push((index, b.body));
            welds[b.body].push((index, a.body));
        }
    }
    let mut still = vec![None; description.bodies.len()];
    let mut next = vec![0];
    while let Some(body) = next.pop() {
        for &(joint, other) in &welds[body] {
            if other != 0 && still[other].is_none() && still[body] != Some(joint) {
                still[other] = Some(joint);
                next.push(other);
            }
        }
    }
    still
}
