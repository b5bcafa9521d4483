//! Chebyshev bounds: a polynomial in the parameters, from samples at Chebyshev nodes, and its range.
//!
//! The independent coordinates are expanded, from which outputs follow (`composition`), or outputs (the paper's).
//! The degree is given, or grows until a tolerance is met (`adaptive`); of outputs too (`outputs_alone`).

pub(super) mod adaptive;
mod along_gradients;
mod combined;
pub(super) mod composition;
mod detail;
mod estimator;
mod outputs_alone;
mod polynomials;
mod range_search;
pub(super) mod segments;
mod sensitivity;
mod sub_box;
mod total_degree;
pub(crate) mod tuning;

use super::BoundsRequest;
use super::ensemble::{Ensemble, EnsembleError, Interrupted, Observed, Sampling, Simulated, Until, lines};
use super::kept::{KeptRow, KeptSurrogate};
use super::registry::{About, BoundingMethod, CostCurve, Refusal, Registered, Varied};
use super::request::{self, Keep, MOST_SIMULATIONS, Problem};
use super::result::{BandBuilder, MethodResult};
use super::validation::Validation;
use crate::grammar::{Fields, Reader, SymbolTable};
use crate::numerics::{ParameterBox, PolynomialRange, RangeKind, Sample, Surrogate, largest};
use crate::syntax::codes::Code;
use adaptive::{Goal, OutputGoal};
use along_gradients::FollowedWithin;
pub use along_gradients::MOST_ON_GRIDS;
pub use combined::ends_of_combinations;
pub use composition::can_compose;
use composition::{Composer, NodeMotions, Row};
use estimator::RangeEstimator;
use outputs_alone::OutputsAlone;
use polynomials::expanded;
use range_search::{Previous, RangeSearch};
pub use segments::{number_as_motion, range_in_part};
use sensitivity::SensitivityAnalysis;
use tuning::TUNING;

const EXPAND: [(&str, Expand); 2] = [("coordinates", Expand::Coordinates), ("output", Expand::Output)];

/// Keys of the file.
pub mod keys {
    use schemars::JsonSchema;

    use crate::grammar::mapping::{grammar, schema_only};
    use crate::methods::request::keys::{PerParameter, Range};

    schema_only! {
        #[schemars(rename_all = "lowercase", inline)]
        pub enum Expand {
            /// The independent coordinates and their velocities; outputs follow from them through the loop closure.
            Coordinates,
            /// Each output, as in the paper.
            Output,
        }
    }

    grammar! {
        /// Chebyshev bounds.
        Chebyshev is "`chebyshev`" {
            /// Degree, for all parameters or by parameter; by default 5, but adaptive if there is a tolerance or more
            /// than three parameters.
            order: Option<PerParameter>,
            /// Nodes, more than the degree; by default one more.
            nodes: Option<PerParameter>,
            /// Expanded quantities; by default the coordinates, or the output where a `range` is asked for.
            expand: Option<Expand>,
            /// How the range of an output's polynomial is found; by default tight. Coordinates need none.
            range: Option<Range>,
        }
    }
}

/// Quantities that a Chebyshev surrogate expands.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Expand {
    /// The independent coordinates and their velocities; outputs follow from them.
    Coordinates,
    /// Each output (the paper's).
    Output,
}

/// The degree of a Chebyshev polynomial.
#[derive(Clone, Debug, PartialEq, Eq)]
pub enum Degree {
    /// Given for each parameter.
    Fixed {
        /// Degree in each parameter.
        order: Vec<usize>,
        /// Number of nodes along each axis, more than the degree.
        nodes: Vec<usize>,
    },
    /// As the tolerance asks for.
    Adaptive,
}

/// Chebyshev bounds.
#[derive(Clone, Debug)]
pub struct Chebyshev {
    /// Degree in each parameter.
    pub degree: Degree,
    /// Expanded quantities.
    pub expand: Expand,
    /// How the ranges of the outputs' polynomials are found, where those are expanded.
    pub range: RangeKind,
}

impl Chebyshev {
    /// As the tolerance asks for.
    pub const ADAPTIVE: Self = Self { degree: Degree::Adaptive, expand: Expand::Coordinates, range: RangeKind::Tight };

    /// Most parameters for which full grids are the default.
    pub const FEW: usize = TUNING.few_parameters;

    /// Degree where a model asks for none.
    pub const ORDER: usize = TUNING.order;

    /// For a request without a degree: [`ORDER`](Self::ORDER), or adaptive if there is a tolerance or if there are many
    /// parameters.
    pub fn unspecified(k: usize, tolerance: Option<f64>) -> Self {
        if tolerance.is_some() || k > Self::FEW { Self::ADAPTIVE } else { Self::of_order(Self::ORDER, k) }
    }

    /// Reads its keys.
    pub(super) fn read<S: SymbolTable>(
        reader: &mut Reader<'_, S>,
        fields: &Fields,
        uncertain: &[String],
        tolerance: Option<f64>,
    ) -> Option<Self> {
        let order = request::per_parameter(reader, fields, "order", uncertain, 1..=TUNING.most_order, Self::ORDER);
        let nodes = match fields.get("nodes") {
            Some(_) => {
                request::per_parameter(reader, fields, "nodes", uncertain, 2..=TUNING.most_nodes, Self::ORDER + 1)
            }
            None => order.as_ref().map(|order| order.iter().map(|order| order + 1).collect()),
        };
        let expand = match fields.get("expand") {
            Some(node) => reader.choice(node, &EXPAND),
            None if fields.get("range").is_some() => Some(Expand::Output), // a range is asked for of outputs only
            None => Some(Expand::Coordinates),
        };
        let unspecified = Self::unspecified(uncertain.len(), tolerance);
        if fields.get("order").is_none() && fields.get("nodes").is_none() && unspecified.degree == Degree::Adaptive {
            let asked = fields.get("range").or(fields.get("expand"));
            if let Some(node) = asked.filter(|_| expand == Some(Expand::Output)) {
                let message = "an output is expanded to an order that is given, not to a tolerance";
                let help = "give an `order`, or leave this out".to_owned();
                reader.error(Code::BadMethod, node.span.clone(), message, help);
            }
            return Some(unspecified);
        }
        if let (Some(Expand::Coordinates), Some(node)) = (expand, fields.get("range")) {
            let help = "leave it out, or expand the output".to_owned();
            reader.error(Code::BadMethod, node.span.clone(), "`range` is about an expanded output", help);
        }
        let range = request::range(reader, fields);
        let (order, nodes) = (order?, nodes?);
        let few = order.iter().zip(&nodes).find(|(order, nodes)| nodes <= order);
        if let (Some((order, nodes)), Some(node)) = (few, fields.get("nodes")) {
            let message = format!("{nodes} nodes are too few for order {order}");
            reader.error(Code::BadMethod, node.span.clone(), message, format!("at least {} are needed", order + 1));
        }
        let key = if fields.get("nodes").is_some() { "nodes" } else { "order" };
        request::check_simulations(reader, fields, key, uncertain.len(), total_degree::samples(&order, &nodes));
        Some(Self { degree: Degree::Fixed { order, nodes }, expand: expand?, range: range? })
    }

    /// One degree for each of k parameters, one node more than the degree.
    pub fn of_order(order: usize, k: usize) -> Self {
        let degree = Degree::Fixed { order: vec![order; k], nodes: vec![order + 1; k] };
        Self { degree, expand: Expand::Coordinates, range: RangeKind::Tight }
    }

    /// The same with the outputs expanded.
    pub fn of_outputs(order: usize, k: usize, range: RangeKind) -> Self {
        Self { expand: Expand::Output, range, ..Self::of_order(order, k) }
    }
}

/// A curve of `mbint cost`.
const fn curve(
    name: &'static str,
    label: &'static str,
    color: [u8; 3],
    composes: bool,
    ask: fn(&mut BoundsRequest, usize, usize),
) -> CostCurve {
    let simulations = |order: usize, k: usize| ((order + 1) as f64).powi(k as i32);
    CostCurve { name, label, color, varied: Varied::Order, counts: &[2, 3, 5, 8], composes, simulations, ask }
}

impl Registered for Chebyshev {
    const ABOUT: About = About {
        label: "Chebyshev",
        summary: "a Chebyshev polynomial in the parameters, from samples, and its range",
        source: "Wu, Luo & Zhang: Chebyshev interval method; Gerstner & Griebel, Computing 71 (2003) 65",
        color: [0, 114, 178],
        fill: 0.16,
        dashes: None,
        is_sampled: true,
        has_sensitivities: true,
        curves: &[
            curve("chebyshev.coordinates", "Chebyshev, composed", [0, 114, 178], true, |request, order, k| {
                request.chebyshev = Some(Self::of_order(order, k));
            }),
            curve("chebyshev.tight", "Chebyshev, tight", [86, 180, 233], false, |request, order, k| {
                request.chebyshev = Some(Self::of_outputs(order, k, RangeKind::Tight));
            }),
            curve("chebyshev.interval", "Chebyshev, Σ|c|", [0, 158, 115], false, |request, order, k| {
                request.chebyshev = Some(Self::of_outputs(order, k, RangeKind::Interval));
            }),
        ],
    };

    fn default_for(problem: &Problem) -> Self {
        Self::unspecified(problem.parameters, problem.tolerance)
    }
}

impl BoundingMethod for Chebyshev {
    fn fit(&mut self, problem: &Problem) -> Result<(), Refusal> {
        let k = problem.parameters;
        if self.degree == Degree::Adaptive && !problem.composes {
            self.expand = Expand::Output;
        }
        match self.samples() {
            Some(samples) if samples > MOST_SIMULATIONS => Err(Refusal::too_many("chebyshev", samples, k)),
            _ => Ok(()),
        }
    }

    fn narrow(&mut self, kept: &[usize]) {
        if let Degree::Fixed { order, nodes } = &mut self.degree {
            request::pick(order, kept);
            request::pick(nodes, kept);
        }
    }

    fn samples(&self) -> Option<f64> {
        match &self.degree {
            Degree::Fixed { order, nodes } => Some(total_degree::samples(order, nodes)),
            Degree::Adaptive => None,
        }
    }

    fn degree(&self) -> usize {
        match &self.degree {
            Degree::Fixed { order, .. } => order.iter().copied().max().unwrap_or(0),
            Degree::Adaptive => 0,
        }
    }

    fn observes(&self, problem: &Problem) -> Observed {
        if self.expand == Expand::Coordinates && problem.composes { Observed::Motion } else { Observed::Outputs }
    }

    fn follows_events(&self, problem: &Problem) -> bool {
        // Outputs alone are not cut at events.
        problem.composes && (self.expand == Expand::Coordinates || self.degree != Degree::Adaptive)
    }

    fn bound(
        &self,
        ensemble: &dyn Ensemble,
        validation: &Validation,
        request: &BoundsRequest,
    ) -> Result<MethodResult, EnsembleError> {
        let Degree::Fixed { order, nodes } = &self.degree else {
            let alone = OutputsAlone(ensemble);
            return adapted(if self.expand == Expand::Output { &alone } else { ensemble }, validation, request);
        };
        let (surrogate, is_full) = total_degree::surrogate(order, nodes);
        let samples = ensemble.domain().samples(surrogate.samples());
        let composes = can_compose(ensemble.domain().dimension(), ensemble.scales().len());
        // An output is no polynomial behind an event, whatever is to be expanded.
        if composes
            && is_full
            && request.keep != Keep::WholeBox
            && let Some(result) = segments::of_degree(ensemble, &surrogate, &samples, validation, request.keep)?
        {
            return Ok(result);
        }
        let mut kept_rows = request.keep.is_any().then(Vec::new);
        let (bands, simulated) = match self.expand {
            Expand::Coordinates if composes => {
                composed(ensemble, &surrogate, &samples, validation, kept_rows.as_mut())?
            }
            _ if !is_full => composed(&OutputsAlone(ensemble), &surrogate, &samples, validation, kept_rows.as_mut())?,
            _ => {
                let range = PolynomialRange::new(order, self.range);
                expanded(ensemble, &surrogate, range, &samples, validation, kept_rows.as_mut())?
            }
        };
        let kept = kept_rows.map(|rows| KeptSurrogate::of_box(ensemble.domain(), surrogate.basis(), rows));
        Ok(bands.finish_keeping(samples.len(), simulated, kept))
    }
}

/// To the degree that the tolerance asks for.
fn adapted(
    ensemble: &dyn Ensemble,
    validation: &Validation,
    request: &BoundsRequest,
) -> Result<MethodResult, EnsembleError> {
    let tolerance = request.tolerance.unwrap_or(BoundsRequest::TOLERANCE);
    let spent = validation.simulations;
    let of_output = |output: usize| {
        let (span, time) = (validation.spans[output], validation.time_error(output, ensemble.rows()));
        let allowed = tolerance * span;
        // Where the steps miss the tolerance nothing is to be gained.
        let missed = |time: &f64| time.is_nan() || *time > allowed;
        let rows = if span > 0.0 { time.iter().position(missed).unwrap_or(ensemble.rows()) } else { 0 };
        let time = largest(time[..rows].iter().copied());
        OutputGoal { allowed: (allowed - time).max(TUNING.least_share * allowed), rows }
    };
    let mut goal = Goal { outputs: (0..ensemble.outputs()).map(of_output).collect(), budget: request.budget, spent };
    if request.keep != Keep::WholeBox
        && let Some(found) = segments::adapted(ensemble, &goal, validation, request.keep)?
    {
        return Ok(found);
    }
    let outputs = ensemble.outputs();
    let followed = ensemble.followed().map(|followed| FollowedWithin::new(followed, &goal, ensemble));
    if let Some(followed) = &followed {
        if followed.are_bounds(request.keep) {
            return Ok(followed.bounds());
        }
        followed.leave(&mut goal, request.keep);
    }
    let adapted = adaptive::search(ensemble, goal, validation, request.keep.is_any())?;
    let mut bands = BandBuilder::new(outputs, ensemble.rows());
    for (index, estimate) in adapted.found.into_iter().enumerate() {
        bands.set_estimate(index / outputs, index % outputs, estimate);
    }
    let mut result = bands.finish_keeping(adapted.simulations - spent, adapted.simulated, adapted.kept);
    followed.iter().for_each(|followed| followed.replace(&mut result));
    Ok(MethodResult { order: Some(adapted.order), boxes: Some(adapted.boxes), ..result })
}

/// The outputs follow from the expanded independent coordinates.
fn composed(
    ensemble: &dyn Ensemble,
    surrogate: &Surrogate,
    samples: &[Sample],
    validation: &Validation,
    mut kept: Option<&mut Vec<KeptRow>>,
) -> Result<(BandBuilder, Simulated), EnsembleError> {
    let domain: &ParameterBox = ensemble.domain();
    let mut bands = BandBuilder::new(ensemble.outputs(), ensemble.rows());
    let mut composer = Composer::new(ensemble);
    let search = RangeSearch::new(domain.dimension());
    let estimator = RangeEstimator {
        search: &search,
        validation: validation.held_out(),
        halved: Some((&validation.direct, &validation.halved)),
        sensitivity: Some(SensitivityAnalysis::new(domain, surrogate)),
    };
    let stride = lines(ensemble, Observed::Motion) * samples.len();
    let mut failure: Option<EnsembleError> = None;
    let mut reached = 0;
    let sampling = Sampling { observed: Observed::Motion, until: Until::FirstStop, whole: false };
    let mut simulated = ensemble.simulate(samples, sampling, &mut |rows, values| {
        let times: Vec<f64> = rows.clone().map(|row| ensemble.time(row)).collect();
        let first = rows.start;
        let keeps = kept.is_some();
        let look = |index: usize, row: &Row, previous: &mut Previous| {
            let found = estimator.estimate(row, first + index, previous);
            let kept = keeps.then(|| row.kept(found.iter().map(|estimate| estimate.is_own).collect()));
            (found, kept)
        };
        let motions = NodeMotions { times: &times, values, stride, courses: &[] };
        match composer.rows(surrogate, domain, motions, true, composition::tuning::TUNING.rows_in_order, look) {
            Ok(found) => {
                for (row, (estimates, row_kept)) in rows.zip(found) {
                    kept.iter_mut().for_each(|kept| kept.extend(row_kept.clone()));
                    let estimates = estimates.into_iter().enumerate();
                    estimates.for_each(|(output, estimate)| bands.set_estimate(row, output, estimate));
                }
                reached = first + times.len();
            }
            // The rows before are known.
            Err(error) if error.is::<Interrupted>() => {}
            Err(error) => failure = Some(error),
        }
    })?;
    simulated.end_at(reached, ensemble);
    failure.map_or(Ok((bands, simulated)), Err)
}
