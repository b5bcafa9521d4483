//! A model, read from a file or a text.

use std::path::{Path, PathBuf};

use super::{Axis, Error, Study, Sweep};
use crate::applications;
use crate::model::{Changes, Description, Override, ParameterValue, Reading, Witness, read_rooted, read_text};
use crate::results::{Gradients, Verification};
use crate::study::{self, Options, RunError};
use crate::syntax::Diagnostics;

/// A mechanism with its uncertain parameters and outputs, free of errors.
#[derive(Clone, Debug)]
pub struct Model {
    origin: Origin,
    asked: Asked,
    description: Description,
    scenes: Vec<String>,
    warnings: Diagnostics,
}

/// Source of a model; it is read again when a parameter is replaced.
#[derive(Clone, Debug)]
enum Origin {
    File { path: PathBuf, root: Option<PathBuf> },
    Text { name: String, text: String },
}

/// Changes of the file's model.
#[derive(Clone, Debug, Default)]
struct Asked {
    overrides: Vec<Override>,
    /// The chosen scene.
    scene: Option<String>,
    /// Outputs instead of the model's: names and formulas.
    outputs: Option<Vec<(String, String)>>,
    /// Functions of its excitations.
    witness: Option<Witness>,
}

impl Model {
    /// Reads a model (`.yaml`) or a robot (`.urdf`).
    ///
    /// # Errors
    /// [`Error::Model`]: everything that is wrong with the file.
    pub fn from_file(path: impl AsRef<Path>) -> Result<Self, Error> {
        Self::read(Origin::File { path: path.as_ref().to_owned(), root: None }, Asked::default())
    }

    /// Like [`Model::from_file`]; in addition, the model may name files of another folder or below: robots, tables,
    /// meshes, included files.
    ///
    /// # Errors
    /// [`Error::Model`]: everything that is wrong with the files.
    pub fn from_file_rooted(path: impl AsRef<Path>, root: impl AsRef<Path>) -> Result<Self, Error> {
        let (path, root) = (path.as_ref().to_owned(), Some(root.as_ref().to_owned()));
        Self::read(Origin::File { path, root }, Asked::default())
    }

    /// Reads a model from a text. Error messages call it `name`; the files that it names are searched for next to
    /// `name`.
    ///
    /// # Errors
    /// [`Error::Model`]: everything that is wrong with the text.
    pub fn from_yaml_str(name: &str, text: &str) -> Result<Self, Error> {
        Self::read(Origin::Text { name: name.to_owned(), text: text.to_owned() }, Asked::default())
    }

    /// The same model with another value of a parameter, written as after `--set` on the command line: `"0.16 ± 2%"`,
    /// `"[0.1, 0.2]"`, `"150 mm"`. A bare number is in the parameter's unit.
    ///
    /// # Errors
    /// [`Error::Model`]: the model does not have the parameter, or the value does not fit it.
    pub fn with(self, parameter: &str, value: impl std::fmt::Display) -> Result<Self, Error> {
        let wanted = Override::parse(&format!("{parameter}={value}"))?;
        let mut asked = self.asked;
        asked.overrides.retain(|known| known.name != wanted.name);
        asked.overrides.push(wanted);
        Self::read(self.origin, asked)
    }

    /// One of the model's scenes.
    ///
    /// # Errors
    /// [`Error::Scene`]: the model does not have it.
    pub fn scene(self, name: &str) -> Result<Self, Error> {
        Self::read(self.origin, Asked { scene: Some(name.to_owned()), ..self.asked })
    }

    /// The same model with other outputs than its own, each a name and a formula: `&[("x", "slider.x")]`. Outputs of a
    /// scene are added.
    ///
    /// # Errors
    /// [`Error::Model`]: a name or a formula is wrong, or a requirement needs one of the omitted outputs.
    pub fn observing(self, outputs: &[(&str, &str)]) -> Result<Self, Error> {
        let outputs = outputs.iter().map(|&(name, formula)| (name.to_owned(), formula.to_owned())).collect();
        Self::read(self.origin, Asked { outputs: Some(outputs), ..self.asked })
    }

    /// The same model with the functions and the values of a witness, given as its text (`witness.NAME.csv` of a run).
    ///
    /// # Errors
    /// [`Error::Witness`]: the text is not a witness, or not one of this model.
    pub fn replaying(self, witness: &str) -> Result<Self, Error> {
        Self::read(self.origin, Asked { witness: Some(Witness::parse(witness)?), ..self.asked })
    }

    fn read(origin: Origin, asked: Asked) -> Result<Self, Error> {
        let changes = Changes { overrides: &asked.overrides, outputs: asked.outputs.as_deref() };
        let reading = match &origin {
            Origin::File { path, root } => read_rooted(path, changes, root.as_deref()),
            Origin::Text { name, text } => read_text(name, text, changes),
        };
        let warnings = reading.diagnostics.clone();
        let scenes = reading.scenes.iter().map(|scene| scene.name.clone()).collect();
        let Some(whole) = reading.description.clone() else { return Err(Error::Model(reading.diagnostics)) };
        let mut description = match &asked.scene {
            None => whole,
            Some(name) => chosen(reading, name)?,
        };
        if let Some(witness) = &asked.witness {
            witness.replay(&mut description)?;
        }
        Ok(Self { origin, asked, description, scenes, warnings })
    }

    /// Its name; for a scene, `MODEL/SCENE`.
    pub fn name(&self) -> &str {
        &self.description.name
    }

    /// Names of its scenes, in the order of the file.
    pub fn scenes(&self) -> impl Iterator<Item = &str> {
        self.scenes.iter().map(String::as_str)
    }

    /// Names of its outputs, each with its SI unit (empty if dimensionless or unknown).
    pub fn outputs(&self) -> impl Iterator<Item = (&str, &str)> {
        self.description.outputs.iter().map(|output| (output.name.as_str(), output.unit.as_str()))
    }

    /// Its uncertain parameters with the smallest and the largest value of each, SI.
    pub fn uncertain(&self) -> impl Iterator<Item = (&str, [f64; 2])> {
        self.description.uncertain().filter_map(|(_, parameter)| match parameter.value {
            ParameterValue::Interval { lower, upper, .. } => Some((parameter.name.as_str(), [lower, upper])),
            ParameterValue::Formula(_) => None,
        })
    }

    /// Duration of its motion, s; 0 without a motion.
    pub fn duration(&self) -> f64 {
        self.description.simulation.duration
    }

    /// Warnings: the model can be used, but something in it is probably not intended.
    pub fn warnings(&self) -> &Diagnostics {
        &self.warnings
    }

    /// Builds and assembles the model, and fits its methods: all steps of a run before it simulates.
    ///
    /// # Errors
    /// [`Error::Run`]: the reason why a run would not begin.
    pub fn check(&self) -> Result<(), Error> {
        study::ready(&self.description)?;
        Ok(())
    }

    /// A study of the model, with the methods that its `bounds:` request until others are chosen.
    pub fn study(&self) -> Study<'static> {
        Study::new(self.description.clone())
    }

    /// Runs a study for each combination of values of some parameters. `ask` chooses methods and options, such as
    /// `|study| study.chebyshev(3)`; `|study| study` uses the model's.
    ///
    /// # Errors
    /// [`Error::Model`]: the model does not have a parameter, or a value does not fit it. [`Error::Run`]: a point is
    /// costly, and that is not allowed. [`Error::Setting`]: a setting is outside of its range. Another run that fails
    /// leaves its point without results.
    pub fn sweep(&self, axes: &[Axis], ask: impl Fn(Study<'static>) -> Study<'static>) -> Result<Sweep, Error> {
        let mut sweep = Sweep::new(self.name(), axes);
        for values in Axis::combinations(axes) {
            let mut model = self.clone();
            for (parameter, value) in Axis::settings(axes, &values) {
                model = model.with(&parameter, value)?;
            }
            // A combination without a motion does not end the others.
            let summary = match ask(model.study()).run() {
                Ok(result) => Some(result.summary().clone()),
                Err(Error::Run(error)) if !matches!(error, RunError::Costly(_) | RunError::Memory(_)) => None,
                Err(error) => return Err(error),
            };
            sweep.add(values, summary);
        }
        Ok(sweep)
    }

    /// Derivatives of all outputs over time by all uncertain parameters, at their nominal values.
    ///
    /// # Errors
    /// [`Error::Gradient`]: the mechanism cannot be run, nothing in it is uncertain, or its motion has no derivatives.
    pub fn gradients(&self) -> Result<Gradients, Error> {
        Ok(study::gradient(&self.description, &Options::default()).map_err(Box::new)?)
    }

    /// Whether the model integrates with the order that theory predicts, in all its coordinates: errors against known
    /// motions, which added loads make solutions.
    ///
    /// # Errors
    /// [`Error::Run`]: the mechanism cannot be built; [`Error::Verify`]: its analysis takes no steps.
    pub fn verify(&self) -> Result<Verification, Error> {
        Ok(applications::verify(&self.description, &Options::default())?)
    }
}

/// The scene with this name.
fn chosen(reading: Reading, name: &str) -> Result<Description, Error> {
    let mut scenes = reading.chosen(&[name.to_owned()])?;
    // One known name was asked for.
    Ok(scenes.remove(0).1)
}
