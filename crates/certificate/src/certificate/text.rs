//! The file of a certificate: a JSON object a line, of numbers as hexadecimal floats.

use std::fmt::Write as _;
use std::sync::Arc;

use serde::{Deserialize, Serialize};

use symdiff::Spline;

use super::hexadecimal;
use super::{Certificate, Certified, Equations, ModelFile, Node, Piece, ProvenCell};

/// The only version so far.
const VERSION: u32 = 1;

/// Why a text is no certificate.
#[derive(Clone, Debug, PartialEq, Eq, thiserror::Error)]
#[error("line {line}: {why}")]
pub struct FormatError {
    /// From 1.
    pub line: usize,
    /// The fault.
    pub why: String,
}

/// A line of the file: an object with one key, which names its kind.
#[derive(Serialize, Deserialize)]
#[serde(rename_all = "snake_case", deny_unknown_fields)]
enum Line {
    Certificate { version: u32, model: String, files: Vec<[String; 2]> },
    System(SystemLine),
    Row { t: String, bounds: Vec<Option<String>> },
    Piece { lower: String, upper: String, q: Vec<String>, v: Vec<String> },
    Cell { middle: String, half: String, w: Vec<String>, lambda: Vec<String>, tube: String },
}

#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct SystemLine {
    parameters: Vec<String>,
    lower: String,
    upper: String,
    order: usize,
    coordinates: usize,
    multipliers: usize,
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    tables: Vec<TableLine>,
    nodes: Vec<String>,
    motion: Vec<usize>,
    start: [Vec<usize>; 2],
    outputs: Vec<(String, usize)>,
}

/// A piecewise cubic: below the first knot, between each two, above the last; of powers of t less the knot before.
#[derive(Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
struct TableLine {
    knots: String,
    cubics: Vec<String>,
    periodic: bool,
}

/// Numbers, separated by spaces.
fn numbers(values: &[f64]) -> String {
    let mut text = String::new();
    for (index, &value) in values.iter().enumerate() {
        if index > 0 {
            text.push(' ');
        }
        hexadecimal::append(value, &mut text);
    }
    text
}

/// Texts of polynomials, without the zeros at their ends.
fn polynomials(of: &[Vec<f64>]) -> Vec<String> {
    let kept = |own: &[f64]| own.iter().rposition(|&c| c != 0.0).map_or(0, |last| last + 1);
    of.iter().map(|own| numbers(&own[..kept(own)])).collect()
}

/// The file.
#[must_use]
pub fn write(certificate: &Certificate) -> String {
    let mut text = String::new();
    let mut add = |line: &Line| {
        // Strings and whole numbers only: there is nothing that JSON cannot hold.
        let line = serde_json::to_string(line).unwrap_or_default();
        let _ = writeln!(text, "{line}");
    };
    let Certificate { model, files, systems } = certificate;
    let files = files.iter().map(|file| [file.name.clone(), file.sha256.clone()]).collect();
    add(&Line::Certificate { version: VERSION, model: model.clone(), files });
    for system in systems {
        let equations = &system.equations;
        let tables = equations.tables();
        add(&Line::System(SystemLine {
            parameters: system.parameters.clone(),
            lower: numbers(&system.lower),
            upper: numbers(&system.upper),
            order: system.order,
            coordinates: equations.coordinates,
            multipliers: equations.multipliers,
            tables: tables.iter().map(|&table| table_line(table)).collect(),
            nodes: equations.nodes.iter().map(|node| node.text(&tables)).collect(),
            motion: equations.motion.clone(),
            start: equations.start.clone(),
            outputs: system.outputs.iter().cloned().zip(equations.outputs.iter().copied()).collect(),
        }));
        for (&t, bounds) in system.times.iter().zip(&system.bounds) {
            let bounds = bounds.iter().map(|own| own.map(|ends| numbers(&ends))).collect();
            add(&Line::Row { t: hexadecimal::write(t), bounds });
        }
        for piece in &system.pieces {
            let (lower, upper) = (numbers(&piece.lower), numbers(&piece.upper));
            add(&Line::Piece { lower, upper, q: polynomials(&piece.q), v: polynomials(&piece.v) });
            for ProvenCell { middle, half, w, lambda, tube } in &piece.cells {
                let [middle, half] = [middle, half].map(|&number| hexadecimal::write(number));
                let (w, lambda, tube) = (polynomials(w), polynomials(lambda), numbers(tube));
                add(&Line::Cell { middle, half, w, lambda, tube });
            }
        }
    }
    text
}

fn number(text: &str) -> Result<f64, String> {
    hexadecimal::read(text).ok_or_else(|| format!("`{text}` is no hexadecimal float, such as 0x1.8p-3"))
}

fn list(text: &str) -> Result<Vec<f64>, String> {
    text.split(' ').filter(|word| !word.is_empty()).map(number).collect()
}

fn lists(texts: &[String]) -> Result<Vec<Vec<f64>>, String> {
    texts.iter().map(|text| list(text)).collect()
}

/// Reads a certificate.
///
/// # Errors
/// For the first line that does not belong to a certificate.
pub fn read(text: &str) -> Result<Certificate, FormatError> {
    let mut found: Option<Certificate> = None;
    for (index, line) in text.lines().enumerate() {
        let wrong = |why: String| FormatError { line: index + 1, why };
        let line: Line = serde_json::from_str(line).map_err(|error| wrong(format!("not of a certificate: {error}")))?;
        add(&mut found, line).map_err(wrong)?;
    }
    found.ok_or_else(|| FormatError { line: 1, why: "the file is empty".to_owned() })
}

/// Adds a line to those read so far.
fn add(found: &mut Option<Certificate>, line: Line) -> Result<(), String> {
    if let Line::Certificate { version, model, files } = line {
        if version != VERSION {
            return Err(format!("version {version} is not known, {VERSION} is"));
        }
        if found.is_some() {
            return Err("a second certificate begins".to_owned());
        }
        let files = files.into_iter().map(|[name, sha256]| ModelFile { name, sha256 }).collect();
        *found = Some(Certificate { model, files, systems: Vec::new() });
        return Ok(());
    }
    let certificate = found.as_mut().ok_or("the first line is to be the `certificate`")?;
    if let Line::System(line) = line {
        certificate.systems.push(Arc::new(system(line)?));
        return Ok(());
    }
    let system = Arc::make_mut(certificate.systems.last_mut().ok_or("a `system` is to come first")?);
    match line {
        Line::Row { t, bounds } => {
            let ends = |own: Option<String>| match own.map(|own| list(&own)).transpose()? {
                None => Ok(None),
                Some(ends) => <[f64; 2]>::try_from(ends).map(Some).map_err(|_| "a bound has two ends".to_owned()),
            };
            system.times.push(number(&t)?);
            system.bounds.push(bounds.into_iter().map(ends).collect::<Result<_, String>>()?);
        }
        Line::Piece { lower, upper, q, v } => {
            let (lower, upper, q, v) = (list(&lower)?, list(&upper)?, lists(&q)?, lists(&v)?);
            system.pieces.push(Piece { lower, upper, q, v, cells: Vec::new() });
        }
        Line::Cell { middle, half, w, lambda, tube } => {
            let piece = system.pieces.last_mut().ok_or("a `piece` is to come first")?;
            let (middle, half, tube) = (number(&middle)?, number(&half)?, list(&tube)?);
            piece.cells.push(ProvenCell { middle, half, w: lists(&w)?, lambda: lists(&lambda)?, tube });
        }
        Line::Certificate { .. } | Line::System(_) => {}
    }
    Ok(())
}

fn table_line(table: Spline) -> TableLine {
    let (knots, cubics, periodic) = table.pieces();
    TableLine { knots: numbers(knots), cubics: cubics.iter().map(|cubic| numbers(cubic)).collect(), periodic }
}

fn table(line: &TableLine) -> Result<Spline, String> {
    let cubic = |text: &String| <[f64; 4]>::try_from(list(text)?).map_err(|_| "a cubic has four numbers".to_owned());
    let cubics = line.cubics.iter().map(cubic).collect::<Result<Vec<_>, String>>()?;
    let table = Spline::of_pieces(list(&line.knots)?, cubics, line.periodic);
    table.ok_or_else(|| "a table has ascending knots, and one cubic more than knots".to_owned())
}

fn system(line: SystemLine) -> Result<Certified, String> {
    let tables = line.tables.iter().map(table).collect::<Result<Vec<_>, _>>()?;
    let node = |text: &String| Node::of_text(text, &tables).ok_or_else(|| format!("`{text}` is no operation"));
    let nodes = line.nodes.iter().map(node).collect::<Result<_, _>>()?;
    let (outputs, of_outputs): (Vec<String>, Vec<usize>) = line.outputs.into_iter().unzip();
    Ok(Certified {
        parameters: line.parameters,
        lower: list(&line.lower)?,
        upper: list(&line.upper)?,
        outputs,
        equations: Equations {
            nodes,
            coordinates: line.coordinates,
            multipliers: line.multipliers,
            motion: line.motion,
            start: line.start,
            outputs: of_outputs,
        },
        order: line.order,
        times: Vec::new(),
        bounds: Vec::new(),
        pieces: Vec::new(),
    })
}
