//! `mbint explain --units`, `--functions`, `--outputs`, `--tuning`, `--exit-codes`, `--codes`: lists of the
//! language and of the program, from the tables of the code.

use super::Failure;
use super::console::to_json;
use super::status::{Status, StatusDocs};
use super::tuning::tuning;
use crate::elements::effects::EffectKind;
use crate::grammar::Sensor;
use crate::grammar::reference::{self, FunctionDocs, OutputDocs, UnitDocs};
use crate::overview::{Align, Table};
use crate::syntax::{Code, wrapped};
use serde::Serialize;
use symdiff::constants::Constant;

/// A list of the language.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum Listing {
    Units,
    Functions,
    Outputs,
    Tuning,
    ExitCodes,
    Codes,
}

impl Listing {
    /// The list for people.
    pub fn text(self) -> String {
        match self {
            Self::Units => text(&reference::units()),
            Self::Functions => text(&reference::functions()),
            Self::Outputs => text(&outputs()),
            Self::Tuning => tuning_text(),
            Self::ExitCodes => text(&Status::ALL.map(Status::docs)),
            Self::Codes => codes_text(),
        }
    }

    /// The list as a JSON array.
    ///
    /// # Errors
    /// As [`to_json`].
    pub fn json(self) -> Result<String, Failure> {
        match self {
            Self::Units => to_json(&reference::units()),
            Self::Functions => to_json(&reference::functions()),
            Self::Outputs => to_json(&outputs()),
            Self::Tuning => to_json(&limits()),
            Self::ExitCodes => to_json(&Status::ALL.map(Status::docs)),
            Self::Codes => to_json(&codes()),
        }
    }

    /// The list as a page of the book.
    pub fn page(self) -> String {
        match self {
            Self::Units => page(&reference::units()),
            Self::Functions => page(&reference::functions()),
            Self::Outputs => page(&outputs()),
            Self::Tuning => page(&tuning()),
            Self::ExitCodes => page(&Status::ALL.map(Status::docs)),
            Self::Codes => Code::index(),
        }
    }
}

/// The outputs of the language, those of every effect included.
fn outputs() -> Vec<OutputDocs> {
    let mut outputs = reference::outputs();
    for effect in EffectKind::docs() {
        outputs.extend(effect.sensors.into_iter().map(|(name, unit)| {
            OutputDocs {
                of: effect.keyword,
                output: format!("EFFECT.{name}"),
                unit,
                meaning: match name == Sensor::AXIAL.name() {
                    true => "tension between its two points: negative where it pushes them apart",
                    false => "value and sign as in the effect's equation",
                }
                .to_owned(),
            }
        }));
    }
    outputs
}

/// A constant, for those who list it.
#[derive(Serialize)]
struct Limit {
    room: &'static str,
    name: &'static str,
    value: &'static str,
    why: &'static str,
    moves: &'static str,
}

fn limits() -> Vec<Limit> {
    let limit = |Constant { room, name, value, why, moves }| Limit { room, name, value, why, moves };
    tuning().into_iter().map(limit).collect()
}

/// The constants, room by room: their texts are too long for columns.
fn tuning_text() -> String {
    let mut text = String::new();
    let mut last = "";
    for Constant { room, name, value, why, moves } in tuning() {
        if room != last {
            text += &format!("{}{room}\n", if last.is_empty() { "" } else { "\n" });
            last = room;
        }
        let about = wrapped(&format!("{why} It moves {moves}.")).replace('\n', "\n    ");
        text += &format!("  {name} = {value}\n    {about}\n");
    }
    text
}

/// A code, for those who list it.
#[derive(Serialize)]
struct CodeDocs {
    code: &'static str,
    title: &'static str,
}

fn codes() -> Vec<CodeDocs> {
    Code::ALL.iter().map(|code| CodeDocs { code: code.id(), title: code.title() }).collect()
}

fn codes_text() -> String {
    let mut table = Table::new([("code", Align::Left), ("kind of mistake", Align::Left)]);
    codes().iter().for_each(|own| table.row([own.code.to_owned(), own.title.to_owned()]));
    table.render(0)
}

/// A listed item, one per row.
trait Row<const N: usize> {
    const TITLE: &'static str;
    const INTRODUCTION: &'static str;
    const HEADINGS: [(&'static str, Align); N];
    fn cells(&self) -> [String; N];
}

fn text<const N: usize, T: Row<N>>(rows: &[T]) -> String {
    let mut table = Table::new(T::HEADINGS);
    rows.iter().for_each(|row| table.row(row.cells()));
    table.render(0)
}

/// A page of the book, which a test keeps up to date.
fn page<const N: usize, T: Row<N>>(rows: &[T]) -> String {
    let line = |cells: &[String]| format!("| {} |\n", cells.join(" | "));
    let mut page = format!("# {}\n\n{}\n\n", T::TITLE, T::INTRODUCTION);
    page += &line(&T::HEADINGS.map(|(heading, _)| heading.to_owned()));
    page += &line(&T::HEADINGS.map(|(_, align)| if align == Align::Left { "---" } else { "---:" }.to_owned()));
    rows.iter().for_each(|row| page += &line(&row.cells().map(|cell| cell.replace('|', "\\|"))));
    page
}

/// The shortest decimal with a readable exponent: `0.001`, `1e-6`, `3.14159…` in full.
fn number(value: f64) -> String {
    if (1e-3..1e5).contains(&value) { value.to_string() } else { format!("{value:e}") }
}

impl Row<4> for UnitDocs {
    const TITLE: &'static str = "Units";
    const INTRODUCTION: &'static str = "Units are combined by `*`, `/` and `^`: `N*s/m`, `kg*m^2`, `1/s`. In a formula, a unit ends\n\
        where a name of the model follows an operator between spaces: `250 kg/m * L`. A percentage is only a tolerance: `2%`. \
        `mbint explain --units` prints this list.";
    const HEADINGS: [(&'static str, Align); 4] =
        [("unit", Align::Left), ("in SI units", Align::Right), ("SI unit", Align::Left), ("quantity", Align::Left)];

    fn cells(&self) -> [String; 4] {
        [self.unit.to_owned(), number(self.value), self.si.clone(), self.quantity.clone()]
    }
}

impl Row<3> for FunctionDocs {
    const TITLE: &'static str = "Functions of formulas";
    const INTRODUCTION: &'static str = "Formulas have `+`, `-`, `*`, `/`, `^`, parentheses, numbers with units (`10 deg`), the number\n\
        `pi`, comparisons (`<`, `<=`, `>`, `>=`, `==`, `!=`: 1 where they hold, else 0), `and`, `or`, `not`, and these\n\
        functions. Tables of the model are functions of one argument. `mbint explain --functions` prints this list.";
    const HEADINGS: [(&'static str, Align); 3] =
        [("function", Align::Left), ("domain", Align::Left), ("value", Align::Left)];

    fn cells(&self) -> [String; 3] {
        [self.function.clone(), self.domain.to_owned(), self.value.to_owned()]
    }
}

impl Row<4> for OutputDocs {
    const TITLE: &'static str = "Outputs";
    const INTRODUCTION: &'static str = "An output is a formula of the following names, of parameters and of the outputs above it. Names in capitals are\n\
        the model's own. A body has the names that its coordinates allow: `angle` in the plane, Euler parameters in space;\n\
        a joint those of its coordinates; an effect those that its own page lists. `mbint explain --outputs` prints \
        this list.";
    const HEADINGS: [(&'static str, Align); 4] =
        [("of", Align::Left), ("name", Align::Left), ("unit", Align::Left), ("value, sign and frame", Align::Left)];

    fn cells(&self) -> [String; 4] {
        [self.of.to_owned(), self.output.clone(), self.unit.clone(), self.meaning.clone()]
    }
}

impl Row<5> for Constant {
    const TITLE: &'static str = "Limits and thresholds";
    const INTRODUCTION: &'static str = "Numbers of the program that could be others, by the rooms of the source that have them, with the results that move\n\
        if one changes. They are compiled in: a result never depends on the machine. Facts, such as coefficients of a method\n\
        or sizes of a page, are not in it. `mbint explain --tuning` prints this list.";
    const HEADINGS: [(&'static str, Align); 5] = [
        ("room", Align::Left),
        ("name", Align::Left),
        ("value", Align::Right),
        ("meaning", Align::Left),
        ("moves", Align::Left),
    ];

    fn cells(&self) -> [String; 5] {
        [self.room, self.name, self.value, self.why, self.moves].map(str::to_owned)
    }
}

impl Row<3> for StatusDocs {
    const TITLE: &'static str = "Exit codes";
    const INTRODUCTION: &'static str = "`mbint --help` prints the same codes. With several models or scenes the code is \
        that of the worst. A pipe that its reader closes is no error.\n\n\
        Messages begin with `error` or `warning`, often with a [code](../errors/index.md), and say what is wrong, where, and what to do; those about a model's file\n\
        show the line. Results go to standard output, messages and progress to standard error; with `--quiet` only errors\n\
        are printed.";
    const HEADINGS: [(&'static str, Align); 3] =
        [("code", Align::Right), ("meaning", Align::Left), ("results' folder", Align::Left)];

    fn cells(&self) -> [String; 3] {
        [self.code.to_string(), self.meaning.to_owned(), self.results.to_owned()]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model;

    /// A spatial and a planar mechanism with every kind of part that has outputs, except effects.
    const SPACE: &str = "
bodies:
  BODY: { mass: 1, inertia: [1, 1, 1], points: { POINT: [0.1, 0, 0] } }
joints:
  JOINT: { cylindrical: { between: [ground, BODY.POINT], axis: z } }
outputs: { OUTPUTS }
simulation: { duration: 0.1, step: 1e-2 }
";
    const PLANE: &str = "
bodies:
  BODY: { mass: 1, inertia: 1, points: { POINT: [0.1, 0] } }
joints:
  JOINT: { revolute: [ground, BODY.POINT] }
outputs: { OUTPUTS }
simulation: { duration: 0.1, step: 1e-2 }
";

    #[test]
    fn every_listed_output_has_a_model_that_has_it() {
        for OutputDocs { output, of, .. } in reference::outputs() {
            let is_accepted = |model: &str| {
                let text = model.replace("OUTPUTS", &format!("o: {output}"));
                model::load_str("listing.yaml", &text, &[]).is_ok()
            };
            assert!(is_accepted(SPACE) || is_accepted(PLANE), "{of} {output}");
        }
    }

    #[test]
    fn units_have_their_values() {
        let listed = Listing::Units.page();
        for row in ["| mm | 0.001 | m | length |", "| rpm | 0.10471975511965977 | rad/s | angular velocity |"] {
            assert!(listed.contains(row), "{listed}");
        }
    }
}
