//! Random excitations: `random`, and `follows`.

use symdiff::Formula;

use super::names::Reader;
use super::tuning::TUNING;
use crate::elements::{RandomFunction, Timing, Trajectory};
use crate::grammar::dimension::KnownDimension;
use crate::grammar::quantity::Dimension;
use crate::grammar::report::Fields;
use crate::grammar::{Context, Symbol};
use crate::keys;
use crate::model::description::{Analysis, Joint, Parameter, ParameterValue};
use crate::model::parameters::seed_of;
use crate::numerics::Spectrum;
use crate::numerics::statistics::Normals;
use crate::syntax::codes::Code;
use crate::syntax::suggest::{self, clip};
use crate::syntax::yaml::{Entry, Node, Value};

/// Densities of classes of roads at the wavelength of 10 m, m³ (ISO 8608, geometric means).
const ROADS: [(&str, f64); 8] = [
    ("A", 16e-6),
    ("B", 64e-6),
    ("C", 256e-6),
    ("D", 1024e-6),
    ("E", 4096e-6),
    ("F", 16384e-6),
    ("G", 65536e-6),
    ("H", 262_144e-6),
];

/// Spatial frequency of these, 1/m.
const REFERENCE: f64 = 0.1;

/// Spatial frequencies for which roads are classified, 1/m.
const ROAD_BAND: [f64; 2] = [0.011, 2.83];

/// Examples of spectra.
const EXAMPLE: &str =
    "give `road: C` with a `speed`, `white: 4 N^2*s` with a `band`, or a table `density: [[0.1, 4 N^2*s], …]`";

/// Keys of limits, which a random function does not have.
const LIMITS: [&str; 6] = ["within", "rate", "held", "mean", "energy", "band"];

/// A random excitation, or one that follows another; `None` also where neither is asked for.
pub fn read(reader: &mut Reader, entry: &Entry, fields: &Fields) -> Option<Trajectory> {
    if let Some(key) = LIMITS.iter().find(|key| fields.get(key).is_some()) {
        let message = "a random excitation has no limits";
        reader.error(Code::ExclusiveKeys, fields.key_span(key), message, "leave out either of them".to_owned());
        return None;
    }
    if !matches!(reader.model.analysis, Analysis::Motion | Analysis::Modes(_)) {
        let message = format!(
            "`analysis: {}` does not know random excitations, which are of motions and modes",
            reader.model.analysis.name()
        );
        reader.error(Code::WrongAnalysis, entry.key_span.clone(), message, None);
        return None;
    }
    match (fields.get("random"), fields.get("follows")) {
        (Some(_), Some(_)) => {
            let message = "an excitation that follows another one has its spectrum";
            reader.error(
                Code::BadExcitation,
                fields.key_span("random"),
                message,
                "leave out `random`, or `follows`".to_owned(),
            );
            None
        }
        (Some(node), None) => {
            let fields = reader.fields::<keys::Random>(node, fields.key_span("random"))?;
            random(reader, entry, &fields)
        }
        (None, Some(node)) => follower(reader, entry, fields, node),
        (None, None) => {
            let help = "`after` goes with `follows: NAME`".to_owned();
            reader.error(
                Code::BadExcitation,
                fields.key_span("after"),
                "the excitation that it comes after is missing",
                help,
            );
            None
        }
    }
}

/// Whether an entry is one of a random function.
pub fn is_random(fields: &Fields) -> bool {
    ["random", "follows", "after"].iter().any(|key| fields.get(key).is_some())
}

/// A spectrum over its own frequency: density, level and speed.
struct Density {
    spectrum: Spectrum,
    level: Formula,
    speed: Formula,
    band: [f64; 2],
    dimension: Option<Dimension>,
}

fn random(reader: &mut Reader, entry: &Entry, fields: &Fields) -> Option<Trajectory> {
    let density = match (fields.get("road"), fields.get("white"), fields.get("density")) {
        (Some(node), None, None) => road(reader, fields, node)?,
        (None, Some(node), None) => white(reader, fields, node)?,
        (None, None, Some(node)) => table(reader, fields, node)?,
        (None, None, None) => {
            reader.error(
                Code::BadExcitation,
                entry.key_span.clone(),
                "a random excitation needs a spectrum",
                EXAMPLE.to_owned(),
            );
            return None;
        }
        _ => {
            reader.error(
                Code::BadExcitation,
                entry.key_span.clone(),
                "a random excitation has one spectrum",
                EXAMPLE.to_owned(),
            );
            return None;
        }
    };
    let lines = match fields.get("lines") {
        Some(node) => reader.count(node, 1, TUNING.most_lines)?,
        None => TUNING.lines,
    };
    let ramp = match fields.get("ramp") {
        Some(node) => {
            let ramp = reader.number(node, Dimension::TIME)?;
            if ramp <= 0.0 {
                reader.error(Code::OutOfRange, node.span.clone(), format!("a begin of {ramp} s is not positive"), None);
                return None;
            }
            ramp
        }
        None => 0.0,
    };
    let seed = match fields.get("seed") {
        Some(node) => reader.count(node, 0, TUNING.most_seeds)?,
        None => 1,
    };
    add_seed(reader, &entry.key, seed);
    let Density { spectrum, level, speed, band, dimension } = density;
    let function = RandomFunction {
        seed: Formula::name(&seed_of(&entry.key)),
        level,
        speed,
        delay: Formula::number(0.0),
        ramp,
        spectrum,
        band,
        lines,
    };
    let timing = Timing::Random(Box::new(function));
    Some(Trajectory { name: entry.key.clone(), points: Vec::new(), timing, dimension })
}

/// Adds the parameter of a realisation. Excitations of other names have others, whatever stands before them (the hash
/// of Fowler, Noll and Vo).
fn add_seed(reader: &mut Reader, name: &str, seed: usize) {
    let mixed = |hash: u64, byte: u8| (hash ^ u64::from(byte)).wrapping_mul(0x0100_0000_01b3);
    let hash = name.bytes().fold(0xcbf2_9ce4_8422_2325, mixed) % TUNING.most_seeds as u64;
    let number = Normals::new(seed * TUNING.most_seeds + hash as usize).uniform();
    let parameter =
        Parameter { name: seed_of(name), unit: String::new(), value: ParameterValue::Formula(Formula::number(number)) };
    reader.model.parameters.push(parameter);
    reader.kinds.push(KnownDimension::parameter(Dimension::NUMBER));
    reader.varies.push(false);
    reader.used.push(true);
    reader.used_by_parameters.push(false);
    reader.corners.iter_mut().for_each(|corner| corner.values.push(number));
}

fn road(reader: &mut Reader, fields: &Fields, node: &Node) -> Option<Density> {
    let text = node.scalar().map_or("", |scalar| scalar.text.trim()).to_owned();
    let class = ROADS.iter().find(|(name, _)| *name == text);
    if class.is_none() && text.chars().all(char::is_alphabetic) && reader.symbol(&text).is_none() {
        let message = format!("`{}` is no class of a road", clip(&text));
        reader.error(Code::BadExcitation, node.span.clone(), message, "those are `A` to `H`".to_owned());
        return None;
    }
    let level = match class {
        Some((_, level)) => Formula::number(*level),
        None => {
            reader.formula_that(node, Context::Constant, Dimension::VOLUME, |level| level > 0.0, "must be positive")?
        }
    };
    refuse(reader, fields, "filter", "a `filter` belongs to `white` noise")?;
    let speed = reader.required(fields, "speed")?;
    let speed =
        reader.formula_that(speed, Context::Constant, Dimension::VELOCITY, |speed| speed > 0.0, "must be positive")?;
    let band = match fields.get("band") {
        Some(node) => band(reader, node, Dimension::NUMBER.per(Dimension::LENGTH), true)?,
        None => ROAD_BAND,
    };
    let spectrum = Spectrum::Power { exponent: -2.0, at: REFERENCE };
    Some(Density { spectrum, level, speed, band, dimension: Some(Dimension::LENGTH) })
}

fn white(reader: &mut Reader, fields: &Fields, node: &Node) -> Option<Density> {
    refuse(reader, fields, "speed", "a `speed` belongs to a `road`")?;
    let (level, dimension) = reader.any_unit(node, Context::Constant)?;
    reader.require(node, &level, |level| level > 0.0, "must be positive");
    let band = reader.required(fields, "band")?;
    let band = band_of(reader, band)?;
    let spectrum = match fields.get("filter") {
        Some(node) => {
            let fields = reader.fields::<keys::SpectrumFilter>(node, fields.key_span("filter"))?;
            filter(reader, &fields)?
        }
        None => Spectrum::Power { exponent: 0.0, at: 1.0 },
    };
    Some(Density { spectrum, level, speed: Formula::number(1.0), band, dimension: dimension.and_then(of_value) })
}

fn filter(reader: &mut Reader, fields: &Fields) -> Option<Spectrum> {
    let node = reader.required(fields, "frequency")?;
    let frequency = positive(reader, node, Dimension::FREQUENCY)?;
    match fields.get("damping") {
        Some(node) => {
            Some(Spectrum::Vibration { natural: frequency, damping: positive(reader, node, Dimension::NUMBER)? })
        }
        None => Some(Spectrum::Lag { corner: frequency }),
    }
}

fn table(reader: &mut Reader, fields: &Fields, node: &Node) -> Option<Density> {
    refuse(reader, fields, "speed", "a `speed` belongs to a `road`")?;
    refuse(reader, fields, "filter", "a `filter` belongs to `white` noise")?;
    refuse(reader, fields, "band", "a table has its band")?;
    let rows = match &node.value {
        Value::Sequence(rows) if rows.len() >= 2 => rows,
        _ => {
            let help = "e.g. `[[0.1, 4 N^2*s], [20, 1 N^2*s]]`".to_owned();
            reader.error(Code::BadExcitation, node.span.clone(), "a table of two pairs or more belongs here", help);
            return None;
        }
    };
    let mut dimension = None;
    let mut points: Vec<[f64; 2]> = Vec::with_capacity(rows.len());
    for row in rows {
        let [frequency, density] = reader.two(row, "a pair of a frequency and a density")?;
        let at = positive(reader, frequency, Dimension::FREQUENCY)?;
        if points.last().is_some_and(|[before, _]| at <= *before) {
            reader.error(Code::BadExcitation, frequency.span.clone(), "frequencies ascend", None);
            return None;
        }
        let (formula, own) = reader.any_unit(density, Context::Constant)?;
        if let (Some(own), Some(known)) = (own, dimension) {
            reader.check_fits(&density.span, own, known).then_some(())?;
        }
        dimension = dimension.or(own);
        let size = known(reader, &formula).filter(|size| *size > 0.0);
        if size.is_none() {
            reader.error(
                Code::BadExcitation,
                density.span.clone(),
                "a density is a positive number, the same for all samples",
                None,
            );
        }
        points.push([at, size?]);
    }
    let band = [points[0][0], points[points.len() - 1][0]];
    let (level, speed) = (Formula::number(1.0), Formula::number(1.0));
    Some(Density { spectrum: Spectrum::Table(points), level, speed, band, dimension: dimension.and_then(of_value) })
}

/// A number that does not depend on uncertain parameters.
fn known(reader: &Reader, formula: &Formula) -> Option<f64> {
    if reader.is_uncertain(formula) { None } else { reader.evaluate(formula, 0) }
}

/// The dimension of a function, of that of its density.
fn of_value(density: Dimension) -> Option<Dimension> {
    density.times(Dimension::FREQUENCY).to_the(0.5)
}

fn positive(reader: &mut Reader, node: &Node, dimension: Dimension) -> Option<f64> {
    let value = reader.number(node, dimension)?;
    if value <= 0.0 {
        let text = node.scalar().map_or("this", |scalar| scalar.text.trim()).to_owned();
        reader.error(Code::OutOfRange, node.span.clone(), format!("`{}` must be positive", clip(&text)), None);
        return None;
    }
    Some(value)
}

/// Least and largest frequency, Hz.
pub fn band_of(reader: &mut Reader, node: &Node) -> Option<[f64; 2]> {
    band(reader, node, Dimension::FREQUENCY, false)
}

fn band(reader: &mut Reader, node: &Node, dimension: Dimension, begins_above_zero: bool) -> Option<[f64; 2]> {
    let [lower, upper] = reader.two(node, "a list of the least and the largest frequency")?;
    let (from, to) = (reader.number(lower, dimension), reader.number(upper, dimension));
    let (from, to) = (from?, to?);
    if from < 0.0 || begins_above_zero && from == 0.0 {
        let message =
            if begins_above_zero { "a road has no finite height at 0: begin above it" } else { "must not be negative" };
        reader.error(Code::BadExcitation, lower.span.clone(), message, None);
        return None;
    }
    if from >= to {
        reader.error(Code::BadExcitation, node.span.clone(), "this band is empty: its end lies below its begin", None);
        return None;
    }
    Some([from, to])
}

/// Reports a key that does not belong to the spectrum.
fn refuse(reader: &mut Reader, fields: &Fields, key: &str, message: &str) -> Option<()> {
    if fields.get(key).is_none() {
        return Some(());
    }
    reader.error(Code::BadExcitation, fields.key_span(key), message.to_owned(), None);
    None
}

/// One that repeats another one later.
fn follower(reader: &mut Reader, entry: &Entry, fields: &Fields, node: &Node) -> Option<Trajectory> {
    let name = reader.scalar(node, "the name of a random excitation")?.text.clone();
    let of_random = |own: &&Trajectory| own.random().is_some();
    let leader = reader.model.trajectories.iter().position(|own| own.name == name && own.random().is_some());
    let Some(index) = leader else {
        let names: Vec<String> =
            reader.model.trajectories.iter().filter(of_random).map(|own| own.name.clone()).collect();
        let help = suggest::help(&name, "random excitations before it", names.iter().map(String::as_str));
        reader.error(
            Code::UnknownName,
            node.span.clone(),
            format!("no random excitation `{}` stands before this one", clip(&name)),
            help,
        );
        return None;
    };
    let after = reader.required(fields, "after")?;
    let delay =
        reader.formula_that(after, Context::Constant, Dimension::TIME, |delay| delay >= 0.0, "must not be negative")?;
    reader.used_trajectories.insert(index);
    let leader = &reader.model.trajectories[index];
    let mut function = leader.random()?.clone();
    function.delay = function.delay.combined(symdiff::Binary::Add, &delay);
    let (name, dimension) = (entry.key.clone(), leader.dimension);
    Some(Trajectory { name, points: Vec::new(), timing: Timing::Random(Box::new(function)), dimension })
}

/// Reports joints that follow a random excitation in a linearised model, where only forces are random.
pub fn check_joints(reader: &mut Reader, entries: &[Entry]) {
    if !matches!(reader.model.analysis, Analysis::Modes(_)) {
        return;
    }
    let is_random = |name: &str| match reader.symbol(name) {
        Some(Symbol::Trajectory { trajectory, .. }) => reader.model.trajectories[trajectory].random().is_some(),
        _ => false,
    };
    let follows = |joint: &&Joint| {
        joint.kind.formulas().into_iter().any(|formula| formula.names().any(|(name, _)| is_random(name)))
    };
    let joints: Vec<String> = reader.model.joints.iter().filter(follows).map(|joint| joint.name.clone()).collect();
    for entry in entries.iter().filter(|entry| joints.contains(&entry.key)) {
        let message = "in `analysis: modes` a joint does not follow a random excitation";
        reader.error(Code::BadExcitation, entry.key_span.clone(), message, "let a force follow it".to_owned());
    }
}
