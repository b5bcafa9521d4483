//! Stand-ins for stages that are being written. To be deleted: `pending::model` → `crate::model`, `pending::mechanics` →
//! `crate::mechanics`, `pending::batch` → `crate::batch`, [`explain`] → wherever the facts are put together.

use crate::model::Description;
use crate::report::Explanation;

pub(super) mod model {
    use std::path::Path;

    use serde::Serialize;

    use crate::model::{BoundsRequest, Description, Simulation, Stepping};

    #[derive(Clone, Debug, PartialEq)]
    pub struct Override {
        pub name: String,
        #[allow(dead_code)]
        pub value: String,
    }

    #[derive(Clone, Debug, Serialize)]
    pub struct Record {
        file: String,
        message: String,
    }

    #[derive(Debug)]
    pub struct Diagnostics(Record);

    impl Diagnostics {
        pub fn render(&self, _color: bool) -> String {
            format!("error: {}: {}\n", self.0.file, self.0.message)
        }

        pub fn records(&self) -> Vec<Record> {
            vec![self.0.clone()]
        }
    }

    pub fn load(path: &Path, _overrides: &[Override]) -> Result<Description, Diagnostics> {
        let wrong = |message: String| Diagnostics(Record { file: path.display().to_string(), message });
        let text = std::fs::read_to_string(path).map_err(|error| wrong(format!("cannot read: {error}")))?;
        let name = text.lines().find_map(|line| line.strip_prefix("model: "));
        let name = name.ok_or_else(|| wrong("no `model:`".into()))?.to_owned();
        Ok(Description {
            name,
            description: None,
            parameters: vec![],
            bodies: vec![],
            joints: vec![],
            effects: vec![],
            initial: vec![],
            guess: vec![],
            outputs: vec![],
            simulation: Simulation { duration: 2.0, stepping: Stepping::Fixed(1e-3), alpha: -0.1, output_step: 0.01 },
            bounds: BoundsRequest::default(),
        })
    }

    pub fn schema() -> String {
        "{}\n".into()
    }
}

pub(super) mod mechanics {
    use crate::model::Description;

    #[derive(Debug, thiserror::Error)]
    #[error("not built")]
    pub struct BuildError;

    #[allow(clippy::unnecessary_wraps)]
    pub fn build(_model: &Description) -> Result<(), BuildError> {
        Ok(())
    }
}

pub(super) fn explain(model: &Description) -> Result<Explanation, mechanics::BuildError> {
    mechanics::build(model)?;
    Ok(Explanation { model: model.name.clone(), ..Explanation::default() })
}

pub(super) mod batch {
    use crate::bounds::{Band, Bounds, Method, OutputBounds};
    use crate::model::Description;
    use crate::report::{MethodSummary, Summary};

    pub struct Options<'a> {
        /// Absent: those that the model asks for.
        pub methods: Option<Vec<Method>>,
        /// Absent: one a core.
        #[allow(dead_code)]
        pub threads: Option<usize>,
        /// Told the fraction that is done.
        pub progress: &'a (dyn Fn(f64) + Sync),
    }

    #[derive(Debug, thiserror::Error)]
    #[error("did not run")]
    pub struct RunError;

    #[allow(clippy::unnecessary_wraps, clippy::needless_pass_by_value)]
    pub fn run(model: &Description, options: Options<'_>) -> Result<(Bounds, Summary), RunError> {
        let times: Vec<f64> = (0..=200).map(|i| f64::from(i) / 100.0).collect();
        let curve = |by: f64| times.iter().map(|t| t.sin() + by * t).collect::<Vec<f64>>();
        let methods = options.methods.unwrap_or(Method::ALL.to_vec());
        let bands = methods.iter().map(|&method| Band { method, lower: curve(-0.01), upper: curve(0.01) }).collect();
        (options.progress)(1.0);
        let summary = |method: &str| MethodSummary {
            method: method.into(),
            solves: 1,
            steps: 2000,
            newton_iterations: 4000,
            rank_revealing_solves: 0,
            seconds: Some(0.001),
        };
        let summary = Summary {
            model: model.name.clone(),
            mbint: env!("CARGO_PKG_VERSION").into(),
            coordinates: 0,
            constraints: 0,
            degrees_of_freedom: 0,
            redundant_constraints: vec![],
            alpha: model.simulation.alpha,
            duration: model.simulation.duration,
            parameters: vec![],
            methods: ["nominal"].into_iter().chain(methods.iter().map(|m| m.name())).map(summary).collect(),
            failure: None,
        };
        let output = OutputBounds { name: "angle".into(), unit: "rad".into(), nominal: curve(0.0), bands };
        Ok((Bounds { times, outputs: vec![output] }, summary))
    }
}
