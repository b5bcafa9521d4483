//! A parameter as it is written, in one piece or by keys.

use crate::grammar::report::Fields;
use crate::grammar::tolerance::{self, Deviation, Toleranced};
use crate::grammar::unit::number_and_unit;
use crate::keys;
use crate::model::names::Reader;
use crate::syntax::codes::Code;
use crate::syntax::source::Span;
use crate::syntax::yaml::{Entry, Node, Value};

/// A parameter as it is written.
#[derive(Clone, Default)]
pub struct Spec {
    pub value: Option<Node>,
    pub unit: Option<Node>,
    pub tolerance: Option<Node>,
    pub interval: Option<Node>,
    pub plus: Option<Node>,
    pub minus: Option<Node>,
    /// Name of a tolerance class.
    pub class: Option<Node>,
    pub distribution: Option<Node>,
    pub cost: Option<Node>,
    /// Spec of the file, if value or deviation is replaced and a law or a cost of the file stays.
    pub before: Option<Box<Spec>>,
    /// The deviation is given twice, which has been reported; there is none to go on with.
    pub contradictory: bool,
    /// Value and deviation stand in one piece.
    in_one_piece: bool,
}

impl Spec {
    /// Spec of which nothing but the unit is written.
    pub fn of_unit(unit: Option<Node>) -> Self {
        Self { unit, ..Self::default() }
    }

    /// Reads a parameter of the file.
    pub fn read(reader: &mut Reader, entry: &Entry) -> Self {
        let mut spec = Self::default();
        if matches!(entry.value.value, Value::Mapping(_)) {
            if let Some(fields) = reader.fields::<keys::Parameter>(&entry.value, entry.key_span.clone()) {
                spec.keys(reader, &fields);
            }
        } else {
            spec.first(reader, &entry.value);
        }
        spec
    }

    /// A number in one piece that deviates from no other: errors of a percentage are reported of values.
    fn first(&mut self, reader: &mut Reader, node: &Node) {
        self.whole(reader, node);
        if self.value.is_none() && self.tolerance.as_ref().is_some_and(|tolerance| tolerance.span == node.span) {
            *self = Self { value: Some(node.clone()), ..Self::default() };
        }
    }

    /// Takes the specification of the command line instead: all of it, or the deviation alone.
    pub fn replace(&mut self, reader: &mut Reader, node: &Node) {
        let kept = Self {
            unit: self.unit.take(),
            distribution: self.distribution.take(),
            cost: self.cost.take(),
            ..Self::default()
        };
        let before = std::mem::replace(self, kept);
        self.whole(reader, node);
        if self.value.is_none() && self.interval.is_none() {
            self.value.clone_from(&before.value);
        }
        self.before = self.distribution.is_some().then(|| Box::new(before));
        if !self.is_uncertain() {
            // A parameter set to one number varies no more.
            (self.distribution, self.cost) = (None, None);
        }
    }

    pub fn is_uncertain(&self) -> bool {
        self.contradictory
            || [&self.tolerance, &self.interval, &self.plus, &self.minus, &self.class].into_iter().any(Option::is_some)
    }

    /// The long form.
    fn keys(&mut self, reader: &mut Reader, fields: &Fields) {
        match fields.get("value") {
            // That a list is no value is reported of values.
            Some(node) if node.scalar().is_none() => self.value = Some(node.clone()),
            Some(node) => self.first(reader, node),
            None => {}
        }
        self.unit = fields.get("unit").cloned();
        self.distribution = fields.get("distribution").cloned();
        self.cost = fields.get("cost").cloned();
        if let Some(description) = fields.get("description") {
            reader.scalar(description, "a text");
        }
        let in_value = self.is_uncertain();
        let [tolerance, interval, plus, minus] = ["tolerance", "interval", "plus", "minus"].map(|key| fields.get(key));
        let mut ways = [tolerance, interval, plus.or(minus)].into_iter().flatten();
        let second = if in_value { ways.next() } else { ways.nth(1) };
        if let Some(second) = second {
            let message = "`tolerance`, `interval` and `plus`/`minus` say the same thing";
            reader.error(Code::ExclusiveKeys, second.span.clone(), message, "give one of them".to_owned());
            self.contradictory = true;
            return;
        }
        if let Some(node) = tolerance {
            self.tolerance(reader, node);
        }
        if let Some(node) = interval {
            let between = tolerance::read(node).ok().and_then(|found| found.deviation);
            // Anything else is reported where the ends are read.
            let Some(Deviation::Between(ends)) = between else {
                self.interval = Some(node.clone());
                return;
            };
            self.interval = Some(ends);
        }
        self.plus = self.plus.take().or(plus.cloned());
        self.minus = self.minus.take().or(minus.cloned());
    }

    /// A number in one piece, perhaps with its deviation.
    fn whole(&mut self, reader: &mut Reader, node: &Node) {
        match tolerance::read(node) {
            Ok(Toleranced { value, deviation }) => {
                self.in_one_piece = value.is_some() && deviation.is_some();
                self.value = value;
                self.deviate(deviation);
            }
            Err(error) => {
                reader.diagnostics.push(*error);
                self.contradictory = true;
            }
        }
    }

    /// Reads the value of `tolerance`.
    fn tolerance(&mut self, reader: &mut Reader, node: &Node) {
        match tolerance::read(node) {
            Ok(Toleranced { value: Some(number), deviation: None }) => self.tolerance = Some(number),
            Ok(Toleranced { value: None, deviation: Some(Deviation::Between(_)) }) => {
                let help = "write `interval: [lower, upper]`, or the deviations as `+0.01 -0.02`".to_owned();
                reader.error(
                    Code::BadTolerance,
                    node.span.clone(),
                    "a tolerance is a deviation, but here is an interval",
                    help,
                );
                self.contradictory = true;
            }
            Ok(Toleranced { value: None, deviation }) => self.deviate(deviation),
            Ok(Toleranced { value: Some(_), deviation: Some(_) }) => {
                let help = "write the value behind `value`".to_owned();
                reader.error(
                    Code::BadTolerance,
                    node.span.clone(),
                    "a tolerance is a deviation, but here is a value with one",
                    help,
                );
                self.contradictory = true;
            }
            Err(error) => {
                reader.diagnostics.push(*error);
                self.contradictory = true;
            }
        }
    }

    fn deviate(&mut self, deviation: Option<Deviation>) {
        match deviation {
            None => {}
            Some(Deviation::Either(either)) => self.tolerance = Some(either),
            Some(Deviation::Sides { plus, minus }) => (self.plus, self.minus) = (Some(plus), Some(minus)),
            Some(Deviation::Between(between)) => self.interval = Some(between),
            Some(Deviation::Class(class)) => self.class = Some(class),
        }
    }

    /// Reports `150 ± 1 mm`, which may mean 150 m, in a parameter that has no unit otherwise.
    pub fn check_units(&self, reader: &mut Reader) {
        let text =
            |node: &Option<Node>| node.as_ref().and_then(Node::scalar).map(|scalar| scalar.text.trim().to_owned());
        let Some(value) = text(&self.value).filter(|value| value.parse::<f64>().is_ok()) else { return };
        if !self.in_one_piece || self.unit.is_some() {
            return;
        }
        let deviations = [&self.tolerance, &self.plus];
        let mut units = deviations.iter().filter_map(|node| {
            let written = text(node)?;
            let (_, unit, _) = number_and_unit(&written)?;
            (unit != "%").then(|| unit.to_owned())
        });
        if let Some(unit) = units.next() {
            let place = self.place();
            let help = format!("write `{value} {unit} ± …`");
            reader.error(Code::MissingUnit, place, "the deviation has a unit, but the value has none", help);
        }
    }

    fn place(&self) -> Span {
        self.value.as_ref().map_or(0..0, |value| value.span.clone())
    }
}
