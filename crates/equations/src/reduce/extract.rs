//! Extraction of a subsystem as a model of its own.

use super::Subsystem;
use super::couplings::{Couplings, Dependencies, Member};
use crate::grammar::TimeOrder;
use crate::model::{Description, ParameterValue, PointRef, Reference, Standing, StartValue};

/// The parts of a description that are kept, by index.
struct Kept {
    bodies: Vec<bool>,
    /// Body by body.
    points: Vec<Vec<bool>>,
    joints: Vec<bool>,
    effects: Vec<bool>,
    parameters: Vec<bool>,
}

/// Whether `initial` gives the position and orientation of each body.
fn placed(d: &Description) -> Vec<bool> {
    let mut coordinates = vec![0; d.bodies.len()];
    let mut is_turned = vec![!d.space.spatial; d.bodies.len()];
    for value in &d.initial {
        match value {
            StartValue::Coordinate { body, order: TimeOrder::Position, .. } => coordinates[*body] += 1,
            StartValue::Orientation { body, .. } => is_turned[*body] = true,
            _ => {}
        }
    }
    coordinates.into_iter().zip(is_turned).map(|(count, is_turned)| count == 3 && is_turned).collect()
}

/// Questions to a subsystem; indices refer to the whole model.
#[derive(Default)]
pub struct SubsystemQuestions {
    pub outputs: Vec<usize>,
    pub reduced: Vec<usize>,
    pub requirements: Vec<usize>,
}

impl SubsystemQuestions {
    /// An output alone.
    pub fn output(number: usize) -> Self {
        Self { outputs: vec![number], ..Self::default() }
    }

    /// Replaces a description's questions by these, with the new indices of their outputs.
    fn ask(&self, part: &mut Description) {
        part.outputs = self.outputs.iter().map(|&output| part.outputs[output].clone()).collect();
        part.reduced = self.reduced.iter().map(|&number| part.reduced[number].clone()).collect();
        part.requirements = self.requirements.iter().map(|&number| part.requirements[number].clone()).collect();
        let reduced = part.reduced.iter_mut().flat_map(|own| &mut own.outputs);
        let required = part.requirements.iter_mut().flat_map(|own| &mut own.outputs);
        for place in reduced.chain(required) {
            // Questions come with their outputs.
            *place = self.outputs.iter().position(|output| output == place).unwrap_or(*place);
        }
    }
}

/// The new index of each kept part.
fn places(kept: &[bool]) -> Vec<Option<usize>> {
    let mut next = 0..;
    kept.iter().map(|&kept| if kept { next.next() } else { None }).collect()
}

fn retain<T>(list: &mut Vec<T>, kept: &[bool]) {
    let mut kept = kept.iter();
    list.retain(|_| *kept.next().unwrap_or(&true));
}

/// The model of the parts in `set`, with the questions `asked`. Every other part is omitted, and so are parameters that
/// no kept part refers to. `merged`: by joint, whether its bodies move as one.
pub fn extract(
    description: &Description,
    merged: &[bool],
    couplings: &mut Couplings,
    set: Option<usize>,
    asked: SubsystemQuestions,
) -> Subsystem {
    let mut part = description.clone();
    asked.ask(&mut part);
    let kept = Kept::of(description, couplings, set, &asked, &required(&part));
    let (bodies, joints) = (places(&kept.bodies), places(&kept.joints));
    let points: Vec<Vec<Option<usize>>> = kept.points.iter().map(|points| places(points)).collect();
    let moved = |place: PointRef| {
        let point = match place.point {
            Some(point) => Some(points[place.body][point]?),
            None => None,
        };
        Some(PointRef { body: bodies[place.body]?, point })
    };
    // Kept parts refer to kept parts only.
    let follow = |reference: Reference| match reference {
        Reference::Body(body) => *body = bodies[*body].unwrap_or(0),
        Reference::Point(place) => *place = moved(*place).unwrap_or(PointRef { body: 0, point: None }),
        Reference::Joint(joint) => *joint = joints[*joint].unwrap_or(0),
    };
    retain(&mut part.parameters, &kept.parameters);
    let own = part.mechanism_mut();
    for (body, points) in own.bodies.iter_mut().zip(&kept.points) {
        retain(&mut body.points, points);
    }
    retain(&mut own.bodies, &kept.bodies);
    for body in &mut own.bodies {
        body.standing =
            body.standing.and_then(|standing| Some(Standing { ground: bodies[standing.ground]?, ..standing }));
    }
    retain(&mut own.joints, &kept.joints);
    retain(&mut own.effects, &kept.effects);
    own.joints.iter_mut().flat_map(|joint| joint.kind.references()).for_each(follow);
    own.effects.iter_mut().flat_map(|effect| effect.kind.references()).for_each(follow);
    for values in [&mut own.initial, &mut own.guess] {
        values.retain(|value| kept.starts(value));
        values.iter_mut().map(StartValue::reference).for_each(follow);
    }
    for link in own.robot.iter_mut().flat_map(|robot| &mut robot.links) {
        link.place = link.place.and_then(moved);
    }
    let numbered = description.uncertain().enumerate();
    let left: Vec<usize> =
        numbered.filter(|&(_, (index, _))| kept.parameters[index]).map(|(number, _)| number).collect();
    narrow(&mut part, &left);
    let mut merged = merged.to_vec();
    retain(&mut merged, &kept.joints);
    let SubsystemQuestions { outputs, reduced, requirements } = asked;
    Subsystem { description: part, merged, outputs, reduced, requirements, parameters: left }
}

/// Restricts the requested orders, nodes and points to these uncertain parameters.
pub fn narrow(description: &mut Description, left: &[usize]) {
    description.bounds.methods_mut().into_iter().for_each(|(_, method)| method.narrow(left));
}

/// Whether a requirement of numbers of a motion or of results names each parameter, which no equation may: `stroke <=
/// room`. All are required by a black box.
pub fn required(description: &Description) -> Vec<bool> {
    if description.black_box.is_some() {
        // The program gets all of them.
        return vec![true; description.parameters.len()];
    }
    let of_numbers = description.requirements.iter().filter(|own| own.times.is_none()).flat_map(|own| &own.slacks);
    let of_results = description.outputs.iter().filter(|own| own.of_results).map(|own| &own.formula);
    let named = Dependencies::by(description, of_numbers.chain(of_results)).parameters;
    let mut required = vec![false; description.parameters.len()];
    named.into_iter().for_each(|parameter| required[parameter] = true);
    with_earlier(description, &mut required);
    required
}

/// Adds the parameters that those depend on.
fn with_earlier(description: &Description, parameters: &mut [bool]) {
    // Each parameter depends on earlier ones only.
    for index in (0..parameters.len()).rev() {
        if let (true, ParameterValue::Formula(formula)) = (parameters[index], &description.parameters[index].value) {
            let earlier = Dependencies::by(description, [formula]).parameters;
            earlier.into_iter().for_each(|earlier| parameters[earlier] = true);
        }
    }
}

impl Kept {
    fn of(
        d: &Description,
        couplings: &mut Couplings,
        set: Option<usize>,
        asked: &SubsystemQuestions,
        required: &[bool],
    ) -> Self {
        let mut has = |part: Member| !couplings.is_grounded(part) && set.is_some_and(|set| couplings.set(part) == set);
        let mut bodies: Vec<bool> = (0..d.bodies.len()).map(|body| has(Member::Body(body))).collect();
        let mut joints: Vec<bool> = (0..d.joints.len()).map(|joint| has(Member::Joint(joint))).collect();
        let effects: Vec<bool> = (0..d.effects.len()).map(|effect| has(Member::Effect(effect))).collect();
        let effects: Vec<bool> = effects.iter().zip(&couplings.fields).map(|(has, field)| *has || *field).collect();
        bodies[0] = true;

        let chosen = |kept: &[bool]| (0..kept.len()).filter(|&index| kept[index]).collect::<Vec<_>>();
        let mut named = Dependencies::default();
        asked.outputs.iter().for_each(|&output| named.extend(&couplings.outputs[output]));
        chosen(&joints).into_iter().for_each(|joint| named.extend(&couplings.joints[joint]));
        chosen(&effects).into_iter().for_each(|effect| named.extend(&couplings.effects[effect]));
        // A body whose position or orientation is not given starts from the ground of its instance.
        let placed = placed(d);
        let standing = chosen(&bodies).into_iter().filter(|&body| !placed[body]);
        named.parts.extend(standing.filter_map(|body| Some(Member::Body(d.bodies[body].standing?.ground))));
        // Bodies that are merged with the ground and have something attached, with the joints towards the ground.
        while let Some(part) = named.parts.pop() {
            let joint = match part {
                Member::Body(body) if !bodies[body] => {
                    bodies[body] = true;
                    couplings.grounded[body]
                }
                Member::Joint(joint) => Some(joint),
                _ => None,
            };
            if let Some(joint) = joint.filter(|&joint| !joints[joint]) {
                joints[joint] = true;
                named.extend(&couplings.joints[joint]);
            }
        }

        let mut kept =
            Self { points: Vec::new(), parameters: vec![false; d.parameters.len()], bodies, joints, effects };
        kept.points = kept.points(d, couplings, &named.points);
        for index in chosen(&kept.bodies) {
            let mut body = d.bodies[index].clone();
            retain(&mut body.points, &kept.points[index]);
            named.parameters.extend(Dependencies::by(d, body.formulas()).parameters);
        }
        let starts = d.initial.iter().chain(&d.guess).filter(|value| kept.starts(value));
        named.parameters.extend(Dependencies::by(d, starts.flat_map(StartValue::formulas)).parameters);
        named.parameters.iter().for_each(|&parameter| kept.parameters[parameter] = true);
        required.iter().zip(&mut kept.parameters).for_each(|(required, kept)| *kept |= required);
        with_earlier(d, &mut kept.parameters);
        kept
    }

    /// Points: all points of bodies that move. Of grounded bodies, which other subsystems may use too, the points that
    /// are used here, and those that are used nowhere.
    fn points(&self, d: &Description, couplings: &Couplings, used: &[(usize, usize)]) -> Vec<Vec<bool>> {
        let grounded = |body: usize| couplings.is_grounded(Member::Body(body));
        let mut points: Vec<Vec<bool>> = d.bodies.iter().map(|body| vec![true; body.points.len()]).collect();
        let joints = couplings.joints.iter().zip(&self.joints).filter(|(_, kept)| !**kept).map(|(named, _)| named);
        let effects = couplings.effects.iter().zip(&self.effects).filter(|(_, kept)| !**kept).map(|(named, _)| named);
        for &(body, point) in joints.chain(effects).chain(&couplings.outputs).flat_map(|named| &named.points) {
            points[body][point] &= !grounded(body);
        }
        used.iter().for_each(|&(body, point)| points[body][point] = true);
        points
    }

    /// Whether a value at the start belongs to a kept part.
    fn starts(&self, value: &StartValue) -> bool {
        match value.clone().reference() {
            Reference::Body(body) => self.bodies[*body],
            Reference::Point(place) => self.bodies[place.body],
            Reference::Joint(joint) => self.joints[*joint],
        }
    }
}
