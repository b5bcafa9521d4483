//! Rows of a surrogate over a box, each with the closure over the coordinates that are best taken as independent.

use rayon::prelude::*;

use super::{Row, RowMotion};
use crate::methods::chebyshev::range_search::Previous;
use crate::methods::closure::Closure;
use crate::methods::ensemble::{Ensemble, EnsembleError};
use crate::numerics::{Course, ParameterBox, Surrogate, SurrogateWork};

/// Motions and outputs of a surrogate's samples in some rows.
#[derive(Clone, Copy)]
pub struct NodeMotions<'a> {
    /// Times of the rows, s.
    pub times: &'a [f64],
    /// Row by row, line by line, sample by sample: coordinates, velocities, outputs, and times of courses.
    pub values: &'a [f64],
    /// Values of a row.
    pub stride: usize,
    /// Courses of coordinates that turn, by coordinate; none, or one for each.
    pub courses: &'a [Option<Course>],
}

/// One mechanism's closures, and the functions that are evaluated through them.
pub struct Composer<'a> {
    ensemble: &'a dyn Ensemble,
    /// Closures used so far.
    closures: Vec<Box<dyn Closure + 'a>>,
}

impl<'a> Composer<'a> {
    /// Composer without any closure yet.
    pub fn new(ensemble: &'a dyn Ensemble) -> Self {
        Self { ensemble, closures: Vec::new() }
    }

    /// Applies `look` to rows of a surrogate over a box, in parallel by blocks of `block` rows (with the extremes of
    /// the row before in the same block). Velocities are expanded where they are asked for, or outputs need them.
    ///
    /// # Errors
    /// If a closure cannot be compiled, and at an interruption.
    pub fn rows<T: Send>(
        &mut self,
        surrogate: &Surrogate,
        domain: &ParameterBox,
        NodeMotions { times, values, stride, courses }: NodeMotions<'_>,
        velocities: bool,
        block: usize,
        look: impl Fn(usize, &Row, &mut Previous) -> T + Sync,
    ) -> Result<Vec<T>, EnsembleError> {
        let coordinates = 2 * self.ensemble.scales().len() * surrogate.samples().len();
        let mut chosen = Vec::with_capacity(times.len());
        for (&time, motion) in times.iter().zip(values.chunks_exact(stride)) {
            chosen.push(self.choose(surrogate, domain, time, &motion[..coordinates])?);
        }
        let look_at_block = |(number, times): (usize, &[f64])| {
            let (mut work, mut previous) = (SurrogateWork::default(), Previous::default());
            let first = number * block;
            let at = |(index, &time): (usize, &f64)| {
                self.ensemble.go_on()?;
                let row = first + index;
                let (closure, motion) = (self.closures[chosen[row]].as_ref(), &values[row * stride..][..stride]);
                let velocities = velocities || closure.needs_velocities();
                let at = Row::new(
                    self.ensemble,
                    surrogate,
                    domain,
                    closure,
                    RowMotion { time, motion, courses, velocities },
                    &mut work,
                );
                Ok(look(row, &at, &mut previous))
            };
            times.iter().enumerate().map(at).collect()
        };
        let blocks: Result<Vec<Vec<T>>, EnsembleError> =
            times.par_chunks(block).enumerate().map(look_at_block).collect();
        Ok(blocks?.into_iter().flatten().collect())
    }

    /// The closure over the coordinates that are best taken as independent at the middle sample's motion.
    fn choose(
        &mut self,
        surrogate: &Surrogate,
        domain: &ParameterBox,
        time: f64,
        motion: &[f64],
    ) -> Result<usize, EnsembleError> {
        let middle = surrogate.middle();
        let parameters = domain.sample(&surrogate.samples()[middle]);
        let values: Vec<f64> = motion.chunks_exact(surrogate.samples().len()).map(|line| line[middle]).collect();
        let independent = self.ensemble.independent(&parameters, &values, time);
        if let Some(known) = self.closures.iter().position(|closure| closure.independent() == independent) {
            return Ok(known);
        }
        self.closures.push(self.ensemble.closure(independent)?);
        Ok(self.closures.len() - 1)
    }
}
