//! Scanning bounds: least and largest values over a full grid of samples. They are inner bounds; the error says how far
//! the outputs may go beyond them between the samples.

use super::BoundsRequest;
use super::chebyshev::segments;
use super::ensemble::{Ensemble, EnsembleError};
use super::registry::{About, BoundingMethod, CostCurve, Refusal, Registered, Varied};
use super::request::{self, MOST_SIMULATIONS, Problem};
use super::result::{BandBuilder, MethodResult};
use super::tuning::TUNING;
use super::validation::Validation;
use crate::grammar::{Fields, Reader, SymbolTable};
use crate::numerics::{ParameterBox, ScanGrid, largest};

/// Keys of the file.
pub mod keys {
    use schemars::JsonSchema;

    use crate::grammar::mapping::grammar;
    use crate::methods::request::keys::PerParameter;

    grammar! {
        /// Scanning bounds.
        Scan is "`scan`" {
            /// Points, for all parameters or by parameter, both ends included; by default 30.
            points: Option<PerParameter>,
        }
    }
}

/// Scanning bounds.
#[derive(Clone, Debug)]
pub struct Scan {
    /// Points along each axis, both ends included.
    pub points: Vec<usize>,
}

impl Scan {
    /// Points along an axis where a model asks for none, the paper's.
    pub const POINTS: usize = TUNING.points;

    /// One number of points for each of k parameters.
    pub fn of_points(points: usize, k: usize) -> Self {
        Self { points: vec![points; k] }
    }

    /// Reads its keys.
    pub(super) fn read<S: SymbolTable>(
        reader: &mut Reader<'_, S>,
        fields: &Fields,
        uncertain: &[String],
        _tolerance: Option<f64>,
    ) -> Option<Self> {
        let points = request::per_parameter(reader, fields, "points", uncertain, 2..=TUNING.most_points, Self::POINTS)?;
        let scan = Self { points };
        let simulations = scan.samples().unwrap_or(f64::INFINITY);
        request::check_simulations(reader, fields, "points", uncertain.len(), simulations);
        Some(scan)
    }
}

impl Registered for Scan {
    const ABOUT: About = About {
        label: "Scan",
        summary: "least and largest values over a grid of samples: inner bounds",
        source: "Wu, Luo & Zhang, section 5: the scanning method",
        color: [130, 25, 80],
        fill: 0.10,
        dashes: Some([2.0, 6.5]),
        is_sampled: true,
        has_sensitivities: false,
        curves: &[CostCurve {
            name: "scan",
            label: "Scan",
            color: [130, 25, 80],
            varied: Varied::Points,
            counts: &[5, 10, 30],
            composes: false,
            simulations: |points, k| (points as f64).powi(k as i32),
            ask: |request, points, k| request.scan = Some(Scan::of_points(points, k)),
        }],
    };

    fn default_for(problem: &Problem) -> Self {
        Self::of_points(Self::POINTS, problem.parameters)
    }
}

impl BoundingMethod for Scan {
    fn fit(&mut self, problem: &Problem) -> Result<(), Refusal> {
        let samples: f64 = self.points.iter().map(|&count| count as f64).product();
        if samples > MOST_SIMULATIONS { Err(Refusal::too_many("scan", samples, problem.parameters)) } else { Ok(()) }
    }

    fn narrow(&mut self, kept: &[usize]) {
        request::pick(&mut self.points, kept);
    }

    fn follows_events(&self, _problem: &Problem) -> bool {
        true
    }

    /// The points of a part lie as close as in the whole.
    fn restrict(&mut self, part: &ParameterBox, whole: &ParameterBox) {
        for (axis, points) in self.points.iter_mut().enumerate() {
            let share = part.half_width(axis) / whole.half_width(axis);
            let scaled = (*points as f64 * share).ceil() as usize;
            *points = if share < 1.0 { scaled.max(2) } else { *points };
        }
    }

    fn samples(&self) -> Option<f64> {
        Some(self.points.iter().map(|&count| count as f64).product())
    }

    fn bound(
        &self,
        ensemble: &dyn Ensemble,
        validation: &Validation,
        _: &BoundsRequest,
    ) -> Result<MethodResult, EnsembleError> {
        let grid = ScanGrid::new(&self.points);
        let (outputs, rows) = (ensemble.outputs(), ensemble.rows());
        let (bounds, total) = ensemble.scan(&grid)?;
        let told = segments::beside_scan(ensemble, grid.len(), validation)?;
        let mut bands = BandBuilder::new(outputs, rows);
        for (row, output) in (0..rows).flat_map(|row| (0..outputs).map(move |output| (row, output))) {
            let range = bounds.range(row, output);
            let outside = validation.direct.at(row, output).into_iter().map(|value| range.distance(value));
            let beyond = told.as_ref().map(|told| {
                let other = told.bands[output][row];
                largest([range.lower - other.lower, range.upper - other.upper]) + told.surrogate[output][row]
            });
            // A sample that is no number stays one.
            let known = beyond.filter(|beyond| !beyond.is_nan() && !bounds.error(row, output).is_nan());
            bands.set(row, output, range, largest(outside.chain([known.unwrap_or(bounds.error(row, output))])));
        }
        let result = bands.finish(grid.len() + told.as_ref().map_or(0, |told| told.simulations), total);
        Ok(MethodResult { is_told_at_rows: told.is_some(), ..result })
    }
}
