//! Parts of the rooms for this package's own binary, tests and benches. Not part of the library: it may change with any
//! version.

pub mod applications {
    pub use crate::applications::language_costs;
}

pub mod assemble {
    pub use crate::assemble::{Questions, build, in_absolute_coordinates, in_joint_coordinates};
}

pub mod cli {
    pub use crate::cli::main;
}

pub mod compile {
    pub use crate::compile::{Scheme, Tapes};
}

pub mod elements {
    pub use crate::elements::JointKind;
}

pub mod export {
    pub use crate::export::{bounds_csv, effects_page};
}

pub mod methods {
    pub use crate::methods::{BoundsRequest, Chebyshev, Scan, Taylor};
}

pub mod model {
    pub use crate::model::{
        Analysis, Description, EffectKind, Override, ParameterValue, Reading, Stepping, load, load_str, read, read_str,
        schema,
    };
}

pub mod numerics {
    pub use crate::numerics::{PointSet, Sample};
}

pub mod reduce {
    pub use crate::reduce::Reduction;
}

pub mod simulate {
    pub use crate::simulate::{
        EnsembleRun, Gradient, Integration, Integrator, Interruption, JetBox, NoGradient, Observed, Schedule,
        SimulationError, Simulator, Stepper, Steps, Wanted, gradients, integrator, jet_integrator,
        schedule_for_tolerance,
    };
}

pub mod study {
    pub use crate::study::{Kept, Options, prepare, run, run_keeping};
}

pub mod syntax {
    pub use crate::syntax::Code;
    pub use crate::syntax::codes::MODEL;
}
