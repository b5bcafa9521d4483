//! Descriptions in a few lines.

use symdiff::Formula;

use crate::assemble::{self, System};
use crate::elements::joints::Revolute;
use crate::grammar::Axis;
use crate::grammar::{Components, Direction};
use crate::model::force::ForceFrame;
use crate::model::torque::{AboutAxes, TorqueOn};
use crate::model::*;

pub fn formula(text: &str) -> Formula {
    Formula::parse(text).unwrap()
}

pub fn vector(components: [&str; 3]) -> [Formula; 3] {
    components.map(formula)
}

/// A vector of the plane.
pub fn pair(x: &str, y: &str) -> [Formula; 3] {
    vector([x, y, "0"])
}

fn coordinates(letter: char) -> Vec<Coordinate> {
    match letter {
        'x' => vec![Coordinate::X],
        'y' => vec![Coordinate::Y],
        'z' => vec![Coordinate::Z],
        'a' => vec![Coordinate::Angle],
        'o' => Coordinate::ORIENTATION.to_vec(),
        _ => panic!("coordinates are x, y, z, a and o"),
    }
}

pub struct Model(pub Description);

impl Model {
    /// Only the ground.
    pub fn new() -> Self {
        let mut model = Self(Description::empty("test".to_owned()));
        model.body("ground", "0", "0", "", &[]);
        model
    }

    /// Only the ground, in space.
    pub fn spatial() -> Self {
        let mut model = Self::new();
        model.0.mechanism_mut().space.spatial = true;
        model
    }

    pub fn parameter(&mut self, name: &str, value: &str) {
        let value = ParameterValue::Formula(formula(value));
        self.0.parameters.push(Parameter { name: name.to_owned(), unit: String::new(), value });
    }

    pub fn interval(&mut self, name: &str, [lower, nominal, upper]: [f64; 3]) {
        let value = ParameterValue::Interval { nominal, lower, upper };
        self.0.parameters.push(Parameter { name: name.to_owned(), unit: String::new(), value });
    }

    /// `letters` are coordinates, of `xyzao`.
    pub fn body(&mut self, name: &str, mass: &str, inertia: &str, letters: &str, points: &[(&str, &str, &str)]) {
        let point =
            |&(name, x, y): &(&str, &str, &str)| Point { name: name.to_owned(), position: pair(x, y), rotation: None };
        let points = points.iter().map(point).collect();
        self.0.mechanism_mut().bodies.push(Body {
            name: name.to_owned(),
            mass: Some(formula(mass)),
            inertia: Some(Inertia::scalar(&formula(inertia))),
            center_of_mass: None,
            coordinates: letters.chars().flat_map(coordinates).collect(),
            prescribed: Vec::new(),
            prescribed_orientation: None,
            points,
            standing: None,
            shapes: Vec::new(),
        });
    }

    /// A body of mass 2 in space with a full inertia tensor and its centre of mass off the origin.
    pub fn lump(&mut self, name: &str) {
        self.body(name, "2", "1", "xyzo", &[]);
        let [xx, yy, zz, xy, xz, yz] = ["0.4", "0.5", "0.7", "0.05", "-0.1", "0.08"].map(formula);
        let body = self.0.mechanism_mut().bodies.last_mut().unwrap();
        body.inertia = Some(Inertia { xx, yy, zz, xy, xz, yz });
        body.center_of_mass = Some(vector(["0.1", "-0.2", "0.3"]));
    }

    /// A point of the last body.
    pub fn frame(&mut self, name: &str, position: [&str; 3], rotation: Option<Rotation>) {
        let point = Point { name: name.to_owned(), position: vector(position), rotation };
        self.0.mechanism_mut().bodies.last_mut().unwrap().points.push(point);
    }

    pub fn ground_point(&mut self, name: &str, x: &str, y: &str) {
        self.0.mechanism_mut().bodies[0].points.push(Point {
            name: name.to_owned(),
            position: pair(x, y),
            rotation: None,
        });
    }

    /// Sets the centre of mass of the last body.
    pub fn center_of_mass(&mut self, x: &str, y: &str) {
        self.0.mechanism_mut().bodies.last_mut().unwrap().center_of_mass = Some(pair(x, y));
    }

    /// Prescribes a coordinate of the last body.
    pub fn hold(&mut self, letter: char, value: &str) {
        self.0.mechanism_mut().bodies.last_mut().unwrap().prescribed.push((coordinates(letter)[0], formula(value)));
    }

    pub fn body_index(&self, name: &str) -> usize {
        self.0.bodies.iter().position(|body| body.name == name).unwrap()
    }

    /// `body` or `body.point`.
    pub fn point(&self, name: &str) -> PointRef {
        let (body, point) = name.split_once('.').map_or((name, None), |(body, point)| (body, Some(point)));
        let body = self.body_index(body);
        let points = &self.0.bodies[body].points;
        PointRef { body, point: point.map(|point| points.iter().position(|known| known.name == point).unwrap()) }
    }

    pub fn between(&self, first: &str, second: &str) -> [PointRef; 2] {
        [self.point(first), self.point(second)]
    }

    pub fn joint(&mut self, name: &str, kind: JointKind) {
        self.0.mechanism_mut().joints.push(Joint::new(name.to_owned(), kind));
    }

    pub fn revolute(&mut self, name: &str, first: &str, second: &str) {
        let between = self.between(first, second);
        self.joint(name, JointKind::Revolute(Revolute { between, axis: Axis(vector(["0", "0", "1"])) }));
    }

    pub fn effect(&mut self, kind: impl Into<EffectKind>) {
        let effects = &mut self.0.mechanism_mut().effects;
        effects.push(Effect { name: format!("effect{}", effects.len()), kind: kind.into() });
    }

    pub fn gravity(&mut self) {
        self.effect(Gravity { acceleration: Components(pair("0", "-9.81")) });
    }

    pub fn initial(&mut self, body: &str, letter: char, order: TimeOrder, value: &str) {
        let (body, coordinate) = (self.body_index(body), coordinates(letter)[0]);
        self.0.mechanism_mut().initial.push(StartValue::Coordinate { body, coordinate, order, value: formula(value) });
    }

    pub fn output(&mut self, text: &str) {
        let output = Output {
            name: text.to_owned(),
            formula: formula(text),
            unit: String::new(),
            dimension: None,
            of_results: false,
        };
        self.0.outputs.push(output);
    }

    pub fn build(&self) -> System {
        assemble::build(&assemble::Questions::of(&self.0)).unwrap()
    }
}

/// The slider crank of the design.
pub fn slider_crank() -> Model {
    let mut m = Model::new();
    m.interval("l1", [0.1485, 0.15, 0.1515]);
    for (name, value) in [("l2", "0.56"), ("m1", "0.37"), ("m2", "0.77"), ("m3", "0.45"), ("c", "1"), ("k", "5")] {
        m.parameter(name, value);
    }
    m.interval("tau", [-0.505, -0.5, -0.495]);
    m.body("crank", "m1", "m1*l1^2/12", "xya", &[("A", "-l1/2", "0"), ("B", "l1/2", "0")]);
    m.body("rod", "m2", "m2*l2^2/12", "xya", &[("B", "-l2/2", "0"), ("C", "l2/2", "0")]);
    m.body("slider", "m3", "0", "x", &[]);
    m.revolute("pivot", "ground", "crank.A");
    m.revolute("pin", "crank.B", "rod.B");
    m.revolute("wrist", "rod.C", "slider");
    let value = AboutAxes(vector(["0", "0", "tau"]));
    m.effect(Torque { on: TorqueOn::Body(1), from: None, value, frame: ForceFrame::Ground });
    let spring = SpringDamper {
        between: m.between("ground", "slider"),
        along: Some(Direction(pair("1", "0"))),
        stiffness: formula("k"),
        damping: formula("c"),
        free_length: formula("l1 + l2"),
        force: None,
    };
    m.effect(spring);
    m.initial("crank", 'a', TimeOrder::Position, "0");
    m.initial("crank", 'a', TimeOrder::Velocity, "0");
    m.output("slider.x");
    m
}
