//! `modelDescription.xml` of FMI 2.0 and 3.0, as far as one motion needs it.

use std::collections::HashMap;
use std::path::Path;

use roxmltree::{Document, Node};
use serde::{Deserialize, Serialize};

use super::variable::{BASES, BaseUnit, NumberType, Variable};
use super::{NotRead, archive};

/// Version of the standard.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Version {
    /// 2.0
    Two,
    /// 3.0
    Three,
}

/// Interface by which a unit moves on.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Serialize, Deserialize)]
pub enum Interface {
    /// By steps of its own.
    CoSimulation,
    /// By its derivatives, which mbint integrates.
    ModelExchange,
}

/// The description of a unit.
#[derive(Clone, Debug, PartialEq)]
pub struct Unit {
    /// Version of the standard.
    pub version: Version,
    /// `guid` or `instantiationToken`.
    pub token: String,
    /// Name of its library for co-simulation, if it has one.
    pub co_simulation: Option<String>,
    /// Name of its library for model exchange, if it has one.
    pub model_exchange: Option<String>,
    /// Its variables.
    pub variables: Vec<Variable>,
    /// Its units, by name; `None` for one that is not reduced to SI.
    pub units: HashMap<String, Option<BaseUnit>>,
    /// Number of continuous states.
    pub states: usize,
    /// Number of event indicators, in FMI 2.0; in 3.0 an instance reports it.
    pub indicators: usize,
}

impl Unit {
    /// Reads a unit's file.
    ///
    /// # Errors
    /// If it is not an archive with a readable description.
    pub fn read(path: &Path) -> Result<Self, NotRead> {
        Self::of_text(&archive::description(path)?)
    }

    /// Parses a description.
    ///
    /// # Errors
    /// If it is not one of FMI 2.0 or 3.0.
    pub fn of_text(text: &str) -> Result<Self, NotRead> {
        let document = Document::parse(text.trim_start_matches('\u{feff}'))?;
        let root = document.root_element();
        if !root.has_tag_name("fmiModelDescription") {
            return Err(wrong(format!("`{}` is not `fmiModelDescription`", root.tag_name().name())));
        }
        let version = match root.attribute("fmiVersion") {
            Some("2.0") => Version::Two,
            Some(text) if text == "3.0" || text.starts_with("3.0.") => Version::Three,
            Some(other) => return Err(wrong(format!("its version of FMI is {other}, and only 2.0 and 3.0 are known"))),
            None => return Err(wrong("it does not say its version of FMI".to_owned())),
        };
        let token = if version == Version::Two { "guid" } else { "instantiationToken" };
        let token = root.attribute(token).ok_or_else(|| wrong(format!("it has no `{token}`")))?;
        let library = |tag: &str| {
            let found = children(root, tag).next().map(|own| own.attribute("modelIdentifier"));
            match found {
                None => Ok(None),
                Some(Some(name)) if is_identifier(name) => Ok(Some(name.to_owned())),
                Some(_) => Err(wrong(format!("`{tag}` has no `modelIdentifier` that is one"))),
            }
        };
        let types = types(root);
        let variables = children(root, "ModelVariables").flat_map(|own| own.children());
        let variables = variables.filter(Node::is_element);
        let read: Result<Vec<Vec<Variable>>, NotRead> = variables
            .map(|node| match version {
                Version::Two => Ok(vec![of_two(node, &types)?]),
                Version::Three => of_three(node, &types),
            })
            .collect();
        let states = children(root, "ModelStructure").map(|own| match version {
            Version::Two => children(own, "Derivatives").map(|own| children(own, "Unknown").count()).sum(),
            Version::Three => children(own, "ContinuousStateDerivative").count(),
        });
        let indicators = root.attribute("numberOfEventIndicators").map(|text| text.trim().parse());
        let indicators =
            indicators.transpose().map_err(|_| wrong("`numberOfEventIndicators` is no number".to_owned()))?;
        Ok(Self {
            version,
            token: token.to_owned(),
            co_simulation: library("CoSimulation")?,
            model_exchange: library("ModelExchange")?,
            variables: read?.into_iter().flatten().collect(),
            units: units(root),
            states: states.sum(),
            indicators: indicators.unwrap_or(0),
        })
    }

    /// A variable by its name.
    pub fn variable(&self, name: &str) -> Option<&Variable> {
        self.variables.iter().find(|variable| variable.name == name)
    }

    /// The library for an interface, by name.
    pub fn library(&self, interface: Interface) -> Option<&str> {
        match interface {
            Interface::CoSimulation => self.co_simulation.as_deref(),
            Interface::ModelExchange => self.model_exchange.as_deref(),
        }
    }
}

fn wrong(why: String) -> NotRead {
    NotRead::Description(why)
}

fn children<'a, 'i: 'a>(node: Node<'a, 'i>, tag: &'a str) -> impl Iterator<Item = Node<'a, 'i>> {
    node.children().filter(move |child| child.has_tag_name(tag))
}

/// A name of C: it becomes the name of a file.
fn is_identifier(name: &str) -> bool {
    !name.is_empty() && name.chars().all(|c| c.is_ascii_alphanumeric() || c == '_')
}

/// Units of declared types, by the types' names.
fn types(root: Node) -> HashMap<String, String> {
    let declared = children(root, "TypeDefinitions").flat_map(|own| own.children()).filter(Node::is_element);
    // In 3.0 the type itself has the unit, in 2.0 its `Real`.
    let unit = |node: Node| node.descendants().find_map(|own| own.attribute("unit").map(str::to_owned));
    declared.filter_map(|node| Some((node.attribute("name")?.to_owned(), unit(node)?))).collect()
}

fn units(root: Node) -> HashMap<String, Option<BaseUnit>> {
    let declared = children(root, "UnitDefinitions").flat_map(|own| children(own, "Unit").collect::<Vec<_>>());
    let named = declared.filter_map(|node| Some((node.attribute("name")?.to_owned(), node)));
    named.map(|(name, node)| (name, children(node, "BaseUnit").next().and_then(base_unit))).collect()
}

/// A unit in SI; `None` if one of its numbers cannot be parsed.
fn base_unit(node: Node) -> Option<BaseUnit> {
    let mut exponents = [0; 8];
    for (exponent, base) in exponents.iter_mut().zip(BASES) {
        *exponent = node.attribute(base).map_or(Some(0), |text| text.trim().parse().ok())?;
    }
    let number = |name: &str, default: f64| node.attribute(name).map_or(Some(default), |text| text.trim().parse().ok());
    Some(BaseUnit { exponents, factor: number("factor", 1.0)?, offset: number("offset", 0.0)? })
}

fn of_two(node: Node, types: &HashMap<String, String>) -> Result<Variable, NotRead> {
    let own = node.children().find(Node::is_element).ok_or_else(|| wrong("a variable has no type".to_owned()))?;
    let kind = match own.tag_name().name() {
        "Real" => Ok(NumberType::Float64),
        "Integer" | "Enumeration" => Ok(NumberType::Int32),
        "Boolean" => Ok(NumberType::Boolean),
        other => Err(other.to_owned()),
    };
    variable(node, own, kind, types)
}

/// A variable, and its aliases.
fn of_three(node: Node, types: &HashMap<String, String>) -> Result<Vec<Variable>, NotRead> {
    let is_array = children(node, "Dimension").next().is_some();
    let kind = match node.tag_name().name() {
        word if is_array => Err(format!("array of {word}")),
        "Float64" => Ok(NumberType::Float64),
        "Float32" => Ok(NumberType::Float32),
        "Int8" => Ok(NumberType::Int8),
        "UInt8" => Ok(NumberType::UInt8),
        "Int16" => Ok(NumberType::Int16),
        "UInt16" => Ok(NumberType::UInt16),
        "Int32" => Ok(NumberType::Int32),
        "UInt32" => Ok(NumberType::UInt32),
        "Int64" | "Enumeration" => Ok(NumberType::Int64),
        "UInt64" => Ok(NumberType::UInt64),
        "Boolean" => Ok(NumberType::Boolean),
        other => Err(other.to_owned()),
    };
    let own = variable(node, node, kind, types)?;
    let aliases = children(node, "Alias").filter_map(|alias| alias.attribute("name"));
    let aliases: Vec<Variable> = aliases.map(|name| Variable { name: name.to_owned(), ..own.clone() }).collect();
    Ok(std::iter::once(own).chain(aliases).collect())
}

/// A variable; `own` has the attributes of its type.
fn variable(
    node: Node,
    own: Node,
    kind: Result<NumberType, String>,
    types: &HashMap<String, String>,
) -> Result<Variable, NotRead> {
    let name = node.attribute("name").ok_or_else(|| wrong("a variable has no `name`".to_owned()))?.to_owned();
    let reference = node.attribute("valueReference").and_then(|text| text.trim().parse().ok());
    let reference = reference.ok_or_else(|| wrong(format!("variable `{name}` has no `valueReference`")))?;
    let causality = node.attribute("causality").unwrap_or("local").to_owned();
    let start = own.attribute("start").and_then(|text| match text.trim() {
        "true" => Some(1.0),
        "false" => Some(0.0),
        number => number.parse().ok(),
    });
    let is_constant = node.attribute("variability") == Some("constant");
    let is_given = matches!(causality.as_str(), "parameter" | "input") || node.attribute("initial") == Some("exact");
    let declared = own.attribute("declaredType").and_then(|name| types.get(name)).cloned();
    let unit = own.attribute("unit").map(str::to_owned).or(declared);
    Ok(Variable { name, reference, kind, causality, start, is_settable: is_given && !is_constant, unit })
}
