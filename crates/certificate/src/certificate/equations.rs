//! Equations as a list of operations, each of earlier ones.

use symdiff::{Binary, Spline, Unary};

/// One number of a list.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Node {
    /// A constant.
    Number(f64),
    /// t, s.
    Time,
    /// An uncertain parameter.
    Parameter(usize),
    /// A position.
    Position(usize),
    /// A velocity.
    Velocity(usize),
    /// An acceleration.
    Acceleration(usize),
    /// A multiplier.
    Multiplier(usize),
    /// A function of an earlier node.
    Unary(Unary, usize),
    /// A function of two.
    Binary(Binary, usize, usize),
    /// A number of which nothing is known.
    Unknown,
}

/// All that holds for a motion, and its outputs.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Equations {
    /// Every node names earlier ones only.
    pub nodes: Vec<Node>,
    /// Number of coordinates n.
    pub coordinates: usize,
    /// Number of multipliers m.
    pub multipliers: usize,
    /// Zero at all times: the equations of motion and Φ̈, n + m nodes.
    pub motion: Vec<usize>,
    /// Zero at t = 0: n nodes that determine the positions, and n that determine the velocities then.
    pub start: [Vec<usize>; 2],
    /// Nodes of the outputs.
    pub outputs: Vec<usize>,
}

/// Names of functions of one number.
const UNARY: [(&str, Unary); 14] = [
    ("neg", Unary::Neg),
    ("sin", Unary::Sin),
    ("cos", Unary::Cos),
    ("tan", Unary::Tan),
    ("asin", Unary::Asin),
    ("acos", Unary::Acos),
    ("atan", Unary::Atan),
    ("sqrt", Unary::Sqrt),
    ("exp", Unary::Exp),
    ("log", Unary::Log),
    ("abs", Unary::Abs),
    ("tanh", Unary::Tanh),
    ("sign", Unary::Sign),
    ("floor", Unary::Floor),
];

/// Names of functions of two numbers.
const BINARY: [(&str, Binary); 10] = [
    ("add", Binary::Add),
    ("sub", Binary::Sub),
    ("mul", Binary::Mul),
    ("div", Binary::Div),
    ("pow", Binary::Pow),
    ("atan2", Binary::Atan2),
    ("min", Binary::Min),
    ("max", Binary::Max),
    ("select", Binary::Select),
    ("select_else", Binary::SelectElse),
];

impl Node {
    /// Earlier nodes that it is made of.
    pub fn children(self) -> impl Iterator<Item = usize> {
        let (a, b) = match self {
            Self::Unary(_, a) => (Some(a), None),
            Self::Binary(_, a, b) => (Some(a), Some(b)),
            _ => (None, None),
        };
        a.into_iter().chain(b)
    }

    /// Text of the node in the file; `tables` are those of the file.
    pub(super) fn text(self, tables: &[Spline]) -> String {
        let name = |known: Option<&str>| known.unwrap_or("unknown").to_owned();
        match self {
            Self::Number(value) => super::hexadecimal::write(value),
            Self::Time => "t".to_owned(),
            Self::Parameter(index) => format!("p {index}"),
            Self::Position(index) => format!("q {index}"),
            Self::Velocity(index) => format!("v {index}"),
            Self::Acceleration(index) => format!("w {index}"),
            Self::Multiplier(index) => format!("lambda {index}"),
            Self::Unary(Unary::Spline(table, order), a) => {
                let known = tables.iter().position(|own| *own == table);
                known.map_or_else(|| name(None), |table| format!("spline {table} {order} {a}"))
            }
            Self::Unary(function, a) => {
                let known = UNARY.iter().find(|(_, own)| *own == function);
                known.map_or_else(|| name(None), |(own, _)| format!("{own} {a}"))
            }
            Self::Binary(function, a, b) => {
                let known = BINARY.iter().find(|(_, own)| *own == function);
                known.map_or_else(|| name(None), |(own, _)| format!("{own} {a} {b}"))
            }
            Self::Unknown => name(None),
        }
    }

    pub(super) fn of_text(text: &str, tables: &[Spline]) -> Option<Self> {
        let mut words = text.split(' ');
        let name = words.next()?;
        let indices = words.map(|word| word.parse().ok()).collect::<Option<Vec<usize>>>()?;
        let unary = || UNARY.iter().find(|(own, _)| *own == name).map(|(_, function)| *function);
        let binary = || BINARY.iter().find(|(own, _)| *own == name).map(|(_, function)| *function);
        Some(match (name, &indices[..]) {
            ("t", []) => Self::Time,
            ("unknown", []) => Self::Unknown,
            (_, []) => Self::Number(super::hexadecimal::read(name)?),
            ("p", &[index]) => Self::Parameter(index),
            ("q", &[index]) => Self::Position(index),
            ("v", &[index]) => Self::Velocity(index),
            ("w", &[index]) => Self::Acceleration(index),
            ("lambda", &[index]) => Self::Multiplier(index),
            (_, &[a]) => Self::Unary(unary()?, a),
            (_, &[a, b]) => Self::Binary(binary()?, a, b),
            ("spline", &[table, order, a]) => {
                Self::Unary(Unary::Spline(*tables.get(table)?, u8::try_from(order).ok()?), a)
            }
            _ => return None,
        })
    }
}

impl Equations {
    /// Whether all indices exist, rows and unknowns are equal in number, and no table jumps with the motion.
    pub fn is_sound(&self, parameters: usize) -> bool {
        let (n, m) = (self.coordinates, self.multipliers);
        let is_sound = |(own, node): (usize, &Node)| match *node {
            Node::Parameter(index) => index < parameters,
            Node::Position(index) | Node::Velocity(index) | Node::Acceleration(index) => index < n,
            Node::Multiplier(index) => index < m,
            node => node.children().all(|child| child < own),
        };
        let rows = [&self.motion, &self.start[0], &self.start[1], &self.outputs];
        let lengths = [self.motion.len() == n + m, self.start[0].len() == n, self.start[1].len() == n];
        self.nodes.iter().enumerate().all(is_sound)
            && lengths.iter().all(|&is_right| is_right)
            && rows.iter().all(|row| row.iter().all(|&node| node < self.nodes.len()))
            && !self.jumps_with_the_motion()
    }

    /// Tables of the nodes, each once.
    pub(super) fn tables(&self) -> Vec<Spline> {
        let mut tables = Vec::new();
        for node in &self.nodes {
            match node {
                Node::Unary(Unary::Spline(table, _), _) if !tables.contains(table) => tables.push(*table),
                _ => {}
            }
        }
        tables
    }

    /// Whether a table, or a derivative of one, that jumps is of the motion: no derivative shows it.
    fn jumps_with_the_motion(&self) -> bool {
        let mut is_of_motion: Vec<bool> = Vec::with_capacity(self.nodes.len());
        self.nodes.iter().any(|node| {
            let of_children = node.children().any(|child| is_of_motion[child]);
            is_of_motion.push(
                of_children
                    || matches!(
                        node,
                        Node::Position(_) | Node::Velocity(_) | Node::Acceleration(_) | Node::Multiplier(_)
                    ),
            );
            let jumps = matches!(node, Node::Unary(Unary::Spline(table, order), _)
                if table.rounding_jumps(*order).is_none());
            jumps && of_children
        })
    }

    /// Nodes that some rows need, ascending.
    pub fn needed(&self, rows: &[usize]) -> Vec<usize> {
        let mut is_needed = vec![false; self.nodes.len()];
        rows.iter().for_each(|&row| is_needed[row] = true);
        for index in (0..self.nodes.len()).rev() {
            if is_needed[index] {
                self.nodes[index].children().for_each(|child| is_needed[child] = true);
            }
        }
        (0..self.nodes.len()).filter(|&index| is_needed[index]).collect()
    }
}
