//! The worst functions of excitations, as a run writes them: a file with which a model is run again.
//!
//! ```text
//! # parameter damper = 1350
//! t,road
//! 0,0
//! 0.35,0.035
//! ```
//!
//! Straight lines lead from point to point; where a function jumps, two points are close. Lines that begin with
//! `# parameter` name the parameters' values.

use symdiff::{Formula, Spline, SplineError, Unary};

use crate::elements::Timing;
use crate::model::description::{Description, ParameterValue};
use crate::model::parameters::deviation_of;
use crate::syntax::table::{Cell, Table};
use crate::syntax::{Code, Coded};

/// Before a parameter's value.
const PARAMETER: &str = "# parameter ";

/// Functions of the time by their points, and values of parameters.
#[derive(Clone, Debug)]
pub struct Witness {
    functions: Vec<(String, Spline)>,
    parameters: Vec<(String, f64)>,
}

/// Why a file is no witness of a model.
#[derive(Clone, Debug, PartialEq, thiserror::Error)]
pub enum WitnessError {
    /// It is no table.
    #[error("line {line}: {message}")]
    NoTable {
        /// Why.
        message: String,
        /// From 1 on.
        line: u64,
    },
    /// A value that is no number.
    #[error("`{text}` in line {line} is not a number")]
    NoNumber {
        /// It.
        text: String,
        /// From 1 on.
        line: u64,
    },
    /// Points of a function that are wrong.
    #[error("`{name}`: {error}")]
    Points {
        /// Name of the excitation.
        name: String,
        /// Why.
        error: SplineError,
    },
    /// It has a function, or a value, of something that the model does not have.
    #[error("the model has no {what} `{name}`")]
    Unknown {
        /// E.g. `excitation`.
        what: &'static str,
        /// Its name.
        name: String,
    },
    /// It lacks a function.
    #[error("it has no column for the excitation `{name}`")]
    Missing {
        /// Name of the excitation.
        name: String,
    },
}

impl Witness {
    /// Witness of functions by their points, and of values of parameters, SI.
    ///
    /// # Errors
    /// Points that do not make a function.
    pub fn new<'p>(
        functions: impl IntoIterator<Item = (&'p str, &'p [(f64, f64)])>,
        parameters: Vec<(String, f64)>,
    ) -> Result<Self, WitnessError> {
        let function = |(name, points): (&str, &[(f64, f64)])| match Spline::linear(points) {
            Ok(spline) => Ok((name.to_owned(), spline)),
            Err(error) => Err(WitnessError::Points { name: name.to_owned(), error }),
        };
        Ok(Self { functions: functions.into_iter().map(function).collect::<Result<_, _>>()?, parameters })
    }

    /// Reads a file.
    ///
    /// # Errors
    /// The first field that is wrong.
    pub fn parse(text: &str) -> Result<Self, WitnessError> {
        let mut parameters = Vec::new();
        for (line, own) in (1..).zip(text.lines()) {
            let Some(own) = own.strip_prefix(PARAMETER) else { continue };
            let (name, value) = own.split_once('=').unwrap_or((own, ""));
            let number = value.trim().parse::<f64>().ok().filter(|number| number.is_finite());
            let number = number.ok_or_else(|| WitnessError::NoNumber { text: value.trim().to_owned(), line })?;
            parameters.push((name.trim().to_owned(), number));
        }
        let table = Table::read(text);
        let names: Vec<String> = match table.lines.first() {
            Some(heading) => heading.cells.iter().skip(1).map(|cell| cell.text.to_owned()).collect(),
            None => return Err(WitnessError::NoTable { message: "it is empty".to_owned(), line: 1 }),
        };
        let mut points: Vec<Vec<(f64, f64)>> = vec![Vec::new(); names.len()];
        for own in &table.lines[1..] {
            let line = own.number as u64;
            if let Some(message) = table.misfit(own) {
                return Err(WitnessError::NoTable { message, line });
            }
            let number = |cell: &Cell| table.number(cell).map_err(|message| WitnessError::NoTable { message, line });
            let time = number(&own.cells[0])?;
            for (points, cell) in points.iter_mut().zip(&own.cells[1..]) {
                points.push((time, number(cell)?));
            }
        }
        let functions = names.iter().map(String::as_str).zip(points.iter().map(Vec::as_slice));
        Self::new(functions, parameters)
    }

    /// Gives a model's excitations these functions, and its parameters these values.
    ///
    /// # Errors
    /// Where they are not those of the model.
    pub fn replay(&self, model: &mut Description) -> Result<(), WitnessError> {
        let unknown = |what, name: &str| WitnessError::Unknown { what, name: name.to_owned() };
        let excitations = model.trajectories.iter().filter(|own| own.excitation().is_some());
        for own in excitations.map(|own| &own.name) {
            if !self.functions.iter().any(|(name, _)| name == own) {
                return Err(WitnessError::Missing { name: own.clone() });
            }
        }
        for (name, spline) in &self.functions {
            let found = model.mechanism_mut().trajectories.iter_mut().find(|own| own.name == *name);
            let own = found.filter(|own| own.excitation().is_some()).ok_or_else(|| unknown("excitation", name))?;
            own.timing = Timing::Given(Formula::name("t").applied(Unary::Spline(*spline, 0)));
            let deviation = deviation_of(name);
            let constants = model.parameters.iter_mut().filter(|own| own.name == deviation);
            constants.for_each(|own| own.value = ParameterValue::Formula(Formula::number(0.0)));
        }
        for (name, value) in &self.parameters {
            let found = model.parameters.iter_mut().find(|own| own.name == *name);
            found.ok_or_else(|| unknown("parameter", name))?.value = ParameterValue::Formula(Formula::number(*value));
        }
        Ok(())
    }
}

impl Coded for WitnessError {
    fn code(&self) -> Option<Code> {
        Some(Code::BadWitness)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::load_str;

    const MODEL: &str = "
        parameters: { k: 60 N/m ± 10% }
        excitations: { push: { within: ± 2 N } }
        bodies: { mass: { mass: 1.5, coordinates: [x] } }
        effects:
          spring: { spring_damper: { between: [ground, mass], along: x, stiffness: k } }
          pusher: { force: { on: mass, value: [push, 0] } }
        outputs: { x: mass.x }
        simulation: { duration: 1, step: 1e-2, output_step: 0.1 }
    ";

    #[test]
    fn replayed_witness_leaves_no_uncertain_parameter() {
        let mut model = load_str("m.yaml", MODEL, &[]).unwrap();
        assert_eq!(model.uncertain().count(), 2);
        let witness = Witness::parse("# parameter k = 66\nt,push\n0,2\n0.5,2\n0.500000001,-2\n1,-2\n").unwrap();
        witness.replay(&mut model).unwrap();
        assert_eq!(model.uncertain().count(), 0);
    }

    #[test]
    fn files_of_other_models_are_refused() {
        let error = |text: &str| {
            let mut model = load_str("m.yaml", MODEL, &[]).unwrap();
            Witness::parse(text).and_then(|witness| witness.replay(&mut model)).unwrap_err().to_string()
        };
        assert_eq!(error("t,gust\n0,1\n1,1\n"), "it has no column for the excitation `push`");
        assert_eq!(error("t,push,gust\n0,1,1\n1,1,1\n"), "the model has no excitation `gust`");
        assert_eq!(error("t,push\n0,1\n1,x\n"), "line 3: `x` is not a number");
        assert_eq!(error("t,push\n0,1\n"), format!("`push`: {}", SplineError::TooFew));
        assert_eq!(error("# parameter m = 1\nt,push\n0,1\n1,1\n"), "the model has no parameter `m`");
        assert_eq!(error("# parameter k = a\nt,push\n0,1\n1,1\n"), "`a` in line 1 is not a number");
    }
}
