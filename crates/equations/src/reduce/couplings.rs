//! Couplings of a mechanism: which bodies, joints and effects act on, or refer to, one another.
//!
//! The ground and the bodies merged with it couple nothing: they do not move, whatever is attached to them. Gravity
//! acts on every body alike and couples none, unless its formula refers to the motion. A dependency couples both ways:
//! a force on B that depends on A couples A and B, although A's motion does not depend on B.

use symdiff::Formula;

use super::sets::Sets;
use crate::grammar::ReactionComponent;
use crate::model::{Description, Effect, Joint, Reference, Scope, Symbol};

/// A part of a mechanism, by its index in the description.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub enum Member {
    /// A body, by index.
    Body(usize),
    /// A joint, by index.
    Joint(usize),
    /// An effect, by index.
    Effect(usize),
}

/// The parts of a mechanism that formulas refer to.
#[derive(Clone, Debug, Default, PartialEq, Eq)]
pub struct Dependencies {
    /// Parts whose motion, reaction or sensor they refer to.
    pub parts: Vec<Member>,
    /// Named points of bodies: body and point.
    pub points: Vec<(usize, usize)>,
    /// Parameters, by index.
    pub parameters: Vec<usize>,
    /// Whether they refer to an energy, to which every body adds.
    pub everything: bool,
}

impl Dependencies {
    /// Adds those of a formula.
    pub fn add(&mut self, description: &Description, formula: &Formula) {
        for (name, _) in formula.names() {
            let symbol = description.symbol(name);
            match symbol {
                Some(Symbol::Parameter(index)) => self.parameters.push(index),
                Some(
                    Symbol::Coordinate { body, .. }
                    | Symbol::AngularMotion { body, .. }
                    | Symbol::RollPitchYaw { body, .. },
                ) => self.parts.push(Member::Body(body)),
                Some(Symbol::Point { body, point, .. }) => {
                    self.parts.push(Member::Body(body));
                    self.points.push((body, point));
                }
                Some(Symbol::JointCoordinate { joint, .. } | Symbol::Reaction { joint, .. }) => {
                    self.parts.push(Member::Joint(joint));
                    if let Some(Symbol::Reaction { component: ReactionComponent::TorqueAt(place, _), .. }) = symbol {
                        self.parts.push(Member::Body(place.body));
                        self.points.extend(place.point.map(|point| (place.body, point)));
                    }
                }
                Some(Symbol::Sensor { effect, .. }) => self.parts.push(Member::Effect(effect)),
                Some(Symbol::Trajectory { trajectory, .. }) => {
                    let formulas = description.trajectories[trajectory].formulas();
                    formulas.for_each(|formula| self.add(description, formula));
                }
                Some(Symbol::Energy(_)) => self.everything = true,
                Some(Symbol::Time | Symbol::BlackBox { .. }) | None => {}
            }
        }
    }

    /// Dependencies of several formulas.
    pub fn by<'f>(description: &Description, formulas: impl IntoIterator<Item = &'f Formula>) -> Self {
        let mut named = Self::default();
        formulas.into_iter().for_each(|formula| named.add(description, formula));
        named
    }

    /// Dependencies of a joint or an effect: of its formulas, and the bodies and points between which it acts.
    fn by_part<'f>(
        description: &Description,
        formulas: impl IntoIterator<Item = &'f Formula>,
        references: Vec<Reference>,
    ) -> Self {
        let mut named = Self::by(description, formulas);
        for reference in references {
            match reference {
                Reference::Body(body) => named.parts.push(Member::Body(*body)),
                Reference::Point(place) => {
                    named.parts.push(Member::Body(place.body));
                    named.points.extend(place.point.map(|point| (place.body, point)));
                }
                Reference::Joint(joint) => named.parts.push(Member::Joint(*joint)),
            }
        }
        named
    }

    /// Adds other dependencies.
    pub fn extend(&mut self, other: &Self) {
        self.parts.extend(&other.parts);
        self.points.extend(&other.points);
        self.parameters.extend(&other.parameters);
        self.everything |= other.everything;
    }
}

/// Sets of coupled parts.
pub struct Couplings {
    sets: Sets,
    /// Dependencies of each joint.
    pub joints: Vec<Dependencies>,
    /// Dependencies of each effect.
    pub effects: Vec<Dependencies>,
    /// Dependencies of each output.
    pub outputs: Vec<Dependencies>,
    /// Whether each effect acts on every body without coupling them.
    pub fields: Vec<bool>,
    /// The joint towards the ground, for each body that is merged with the ground, directly or through others.
    pub grounded: Vec<Option<usize>>,
    /// Whether each joint is such a joint.
    joins_ground: Vec<bool>,
}

impl Couplings {
    /// The couplings of a description; `merged`: by joint, whether its bodies move as one.
    pub fn of(description: &Description, merged: &[bool]) -> Self {
        let joint =
            |Joint { kind, .. }: &Joint| Dependencies::by_part(description, kind.formulas(), kind.clone().references());
        let joints: Vec<Dependencies> = description.joints.iter().map(joint).collect();
        let effect = |Effect { kind, .. }: &Effect| {
            Dependencies::by_part(description, kind.formulas(), kind.clone().references())
        };
        let effects: Vec<Dependencies> = description.effects.iter().map(effect).collect();
        let outputs =
            description.outputs.iter().map(|output| Dependencies::by(description, [&output.formula])).collect();
        let on_every_body = |effect: usize| description.effects[effect].kind.scope() == Scope::EveryBody;
        let fields: Vec<bool> =
            effects.iter().enumerate().map(|(effect, named)| on_every_body(effect) && named.parts.is_empty()).collect();
        let grounded = grounded(description, merged);
        let mut joins_ground = vec![false; joints.len()];
        grounded.iter().flatten().for_each(|&joint| joins_ground[joint] = true);
        let parts = description.bodies.len() + joints.len() + effects.len();
        let mut couplings = Self { sets: Sets::new(parts), joints, effects, outputs, fields, grounded, joins_ground };
        for joint in 0..description.joints.len() {
            let parts = couplings.joints[joint].parts.clone();
            couplings.join(Member::Joint(joint), &parts);
        }
        for effect in (0..description.effects.len()).filter(|&effect| !couplings.fields[effect]).collect::<Vec<_>>() {
            let mut parts = couplings.effects[effect].parts.clone();
            if on_every_body(effect) {
                parts.extend((1..description.bodies.len()).map(Member::Body));
            }
            couplings.join(Member::Effect(effect), &parts);
        }
        couplings
    }

    /// Parts that may move, and the joints and effects that act on them.
    pub fn movable(&self) -> Vec<Member> {
        let bodies = (0..self.grounded.len()).map(Member::Body);
        let joints = (0..self.joints.len()).map(Member::Joint);
        let effects = (0..self.effects.len()).filter(|&effect| !self.fields[effect]).map(Member::Effect);
        bodies.chain(joints).chain(effects).filter(|&part| !self.is_grounded(part)).collect()
    }

    /// Whether a part couples nothing: the ground, and bodies merged with it.
    pub fn is_grounded(&self, part: Member) -> bool {
        match part {
            Member::Body(body) => body == 0 || self.grounded[body].is_some(),
            Member::Joint(joint) => self.joins_ground[joint],
            Member::Effect(_) => false,
        }
    }

    fn place(&self, part: Member) -> usize {
        match part {
            Member::Body(body) => body,
            Member::Joint(joint) => self.grounded.len() + joint,
            Member::Effect(effect) => self.grounded.len() + self.joints.len() + effect,
        }
    }

    /// The set that a part is in.
    pub fn set(&mut self, part: Member) -> usize {
        let place = self.place(part);
        self.sets.of(place)
    }

    fn join(&mut self, part: Member, with: &[Member]) {
        if !self.is_grounded(part) {
            for &other in with {
                if !self.is_grounded(other) {
                    let (a, b) = (self.place(part), self.place(other));
                    self.sets.join(a, b);
                }
            }
        }
    }

    /// Unites the sets of these parts and returns the united set; `None` where all are grounded.
    pub fn unite(&mut self, parts: &[Member]) -> Option<usize> {
        let first = parts.iter().copied().find(|&part| !self.is_grounded(part))?;
        self.join(first, parts);
        Some(self.set(first))
    }
}

/// The joint towards the ground, for each body that is merged with the ground.
fn grounded(description: &Description, merged: &[bool]) -> Vec<Option<usize>> {
    let mut welds = vec![Vec::new(); description.bodies.len()];
    for (index, (joint, &merged)) in description.joints.iter().zip(merged).enumerate() {
        if let (true, Some([a, b])) = (merged, joint.kind.between()) {
            welds[a.body].push((index, b.body));
            welds[b.body].push((index, a.body));
        }
    }
    let mut grounded = vec![None; description.bodies.len()];
    let mut next = vec![0];
    while let Some(body) = next.pop() {
        for &(joint, other) in &welds[body] {
            if other != 0 && grounded[other].is_none() && grounded[body] != Some(joint) {
                grounded[other] = Some(joint);
                next.push(other);
            }
        }
    }
    grounded
}
