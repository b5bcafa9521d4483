//! Results of a run, as data only.

mod allocation;
mod analysis;
mod black_box;
mod bounds;
mod chains;
mod cost;
mod decisions;
mod design;
mod drawing;
mod effect_cost;
mod excitations;
mod explanation;
mod fit;
mod gradients;
mod merge;
mod motion;
mod peaks;
mod provenance;
mod reduced;
mod requirement;
mod samples;
mod statistics;
mod structure;
mod summary;
pub(crate) mod tuning;
mod verification;

pub use crate::methods::{Method, TooDeep};
pub use allocation::{AllocatedTolerance, Allocation, Criterion, NotMet, ToleranceZone, TradePoint};
pub use analysis::{AnalysisSummary, ValueSummary};
pub use black_box::{BlackBoxSummary, NoiseSummary};
pub use bounds::{Band, Bounds, Contribution, OutputBounds, OutputDerivatives, ResponsePoint, Witness, foremost};
#[doc(hidden)]
pub use chains::{ChainSummary, LinkSummary};
pub use cost::example as cost_example;
pub use cost::{CostMethod, CostPoint, CostReference, CostStudy, Deviation, Integrator, cost_curves, pareto};
pub use decisions::{Decision, Each, Saving};
pub use design::{DesignKind, DesignObjective, DesignParameter, DesignPoint, DesignProfile, DesignStudy, DesignTrade};
pub use drawing::{Drawing, DrawnBody, DrawnElement, DrawnLength, DrawnPoint, DrawnSolid};
pub use effect_cost::{EffectCost, StepInstructions};
pub use excitations::{ExcitationSummary, FunctionWitness, WitnessFunction};
pub use explanation::{EffectExplanation, Explanation, InstructionCounts, LeftOut, NewtonMatrix};
pub use fit::{ConsistentSet, Fit, FitAxis, FitOutput, FitParameter, FitProjection, FitRow, SkewPaving, Unexplained};
pub use gradients::{DerivativesAt, GradientParameter, Gradients, OutputGradients, ReducedGradients};
pub use merge::{Piece, add_methods, bounds_of_pieces, explanation_of_subsystems, summary_of_subsystems};
pub use motion::{Motion, MotionPolynomials, MovingForce, MovingSample, Poses, WorstMotion};
pub use peaks::PeakSummary;
pub use provenance::{ModelFile, Provenance, RunRequest};
pub use reduced::{Occurrence, ReducedBand, ReducedContribution, ReducedSummary, WorstCase};
pub use requirement::{LimitLine, NearestCase, RequirementSummary, Verdict};
pub use samples::{SampleFormat, SampleTable};
pub use statistics::{
    ExposureSummary, Histogram, LawSummary, NumberStatistics, OutputStatistics, OutputStatisticsSummary, RandomSummary,
    Sensitivity, StatisticsResult, StatisticsSummary, Uncertain, YieldSummary,
};
pub use structure::{KindCount, MassRange, MobilityCount, Structure};
pub use summary::{
    AssemblySummary, ContributionSummary, DampedMode, ErrorSummary, EventSummary, EventsFollowed, MethodSummary,
    ParameterSummary, PieceSummary, SingularSummary, StartOverlap, SubsystemSummary, Summary,
};
pub use verification::{
    Convergence, DerivativeCheck, EffectBalance, Exchange, FormulationVerification, PowerBalance, Quantity,
    SchemeVerification, Verification,
};
