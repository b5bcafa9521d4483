//! Taylor bounds: the scheme in jet arithmetic gives the Taylor polynomial about the middle of the box, to any order,
//! from one simulation.

use rayon::prelude::*;
use symdiff::jet::JetSpace;

use super::BoundsRequest;
use super::chebyshev::segments;
use super::ensemble::{Ensemble, EnsembleError, JET_WORK};
use super::registry::{About, BoundingMethod, CostCurve, Refusal, Registered, Varied};
use super::request::{self, Budget, Problem};
use super::result::{BandBuilder, MethodResult, PolynomialEstimate};
use super::tuning::TUNING;
use super::validation::Validation;
use crate::grammar::{Fields, Reader, SymbolTable};
use crate::numerics::{RangeKind, TaylorRange};
use crate::syntax::codes::Code;

/// Keys of the file.
pub mod keys {
    use schemars::JsonSchema;

    use crate::grammar::mapping::grammar;
    use crate::methods::request::keys::Range;

    grammar! {
        /// Taylor bounds.
        Taylor is "`taylor`" {
            /// Total degree; by default 2.
            order: Option<u32>,
            /// By default tight.
            range: Option<Range>,
        }
    }
}

/// Taylor bounds.
#[derive(Clone, Debug)]
pub struct Taylor {
    /// Total degree.
    pub order: usize,
    /// How the polynomial's range is found.
    pub range: RangeKind,
}

impl Taylor {
    /// Degree where a model asks for none, the paper's.
    pub const ORDER: usize = TUNING.taylor_order;

    /// Reads its keys.
    pub(super) fn read<S: SymbolTable>(
        reader: &mut Reader<'_, S>,
        fields: &Fields,
        uncertain: &[String],
        _tolerance: Option<f64>,
    ) -> Option<Self> {
        let range = request::range(reader, fields);
        let order =
            fields.get("order").map_or(Some(Self::ORDER), |node| reader.count(node, 1, TUNING.most_taylor_order))?;
        // Monomials of degree up to n in k variables: (n + k)! / (n! k!).
        let uncertain = uncertain.len();
        let coefficients = (1..=uncertain).fold(1.0, |count, k| count * (order + k) as f64 / k as f64);
        if coefficients > TUNING.most_coefficients {
            let message = format!("order {order} in {uncertain} parameters has {coefficients:.2e} coefficients");
            reader.error(
                Code::TooLarge,
                fields.key_span("order"),
                message,
                format!("at most {:e} can be computed", TUNING.most_coefficients),
            );
        }
        Some(Self { order, range: range? })
    }
}

impl Default for Taylor {
    /// The usual order, the tight range.
    fn default() -> Self {
        Self { order: Self::ORDER, range: RangeKind::Tight }
    }
}

impl Registered for Taylor {
    const ABOUT: About = About {
        label: "Taylor",
        summary: "a Taylor polynomial in the parameters, from one simulation in jet arithmetic, and its range",
        source: "Wu, Luo & Zhang, section 3: Taylor interval method",
        color: [240, 160, 20],
        fill: 0.18,
        dashes: Some([10.0, 7.0]),
        is_sampled: true,
        has_sensitivities: false,
        curves: &[CostCurve {
            name: "taylor",
            label: "Taylor",
            color: [240, 160, 20],
            varied: Varied::Order,
            counts: &[1, 2, 3],
            composes: false,
            // Pairs of monomials of at most this degree together: (2k + order) over order.
            simulations: |order, k| (1..=order).fold(1.0, |pairs, i| pairs * (2 * k + i) as f64 / i as f64),
            ask: |request, order, _| request.taylor = Some(Taylor { order, ..Taylor::default() }),
        }],
    };

    fn default_for(_: &Problem) -> Self {
        Self::default()
    }
}

impl BoundingMethod for Taylor {
    fn fit(&mut self, problem: &Problem) -> Result<(), Refusal> {
        if problem.has_equations { Ok(()) } else { Err(Refusal::no_equations("taylor")) }
    }

    fn degree(&self) -> usize {
        self.order
    }

    fn work(&self, _: &Budget) -> usize {
        JET_WORK * (self.order + 1)
    }

    fn follows_events(&self, problem: &Problem) -> bool {
        problem.composes
    }

    fn bound(
        &self,
        ensemble: &dyn Ensemble,
        validation: &Validation,
        _: &BoundsRequest,
    ) -> Result<MethodResult, EnsembleError> {
        let k = ensemble.domain().dimension();
        let space = JetSpace::new(k, self.order);
        if let Some(found) = segments::of_jets(ensemble, &space, validation)? {
            return Ok(found);
        }
        let range = TaylorRange::new(k, self.order, self.range);
        let mut bands = BandBuilder::new(ensemble.outputs(), ensemble.rows());
        let mut reached = 0;
        let mut simulated = ensemble.jets(&space, &mut |rows, values| {
            let found: Option<Vec<PolynomialEstimate>> = values
                .par_chunks_exact(space.len())
                .map_init(
                    || range.clone(),
                    |range, coefficients| {
                        ensemble.go_on().ok()?;
                        let at_point = |xi: &Vec<f64>| range.monomials().evaluate(coefficients, xi);
                        let at_validation = validation.points.iter().map(at_point).collect();
                        let (range, excess) = range.enclose(coefficients);
                        let coefficients = Vec::new();
                        Some(PolynomialEstimate {
                            range,
                            excess,
                            truncation: 0.0,
                            at_validation,
                            sensitivity: None,
                            coefficients,
                        })
                    },
                )
                .collect();
            let Some(mut found) = found else { return };
            reached = rows.end;
            // With a kink, too, it is furthest off at the corners, which are among the validation samples.
            bands.set_polynomials(rows, &mut found, validation, &[]);
        })?;
        simulated.end_at(reached, ensemble);
        Ok(bands.finish(1, simulated))
    }
}
