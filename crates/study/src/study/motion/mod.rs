//! The motion of all bodies, for a report: nominal, at samples, and as polynomials in the parameters.
//!
//! Poses are outputs of the whole model like any other, requested in place of its own: the same equations and the same
//! steps, and the program of a run contains none of it.

mod by_hand;
mod forces;
mod movable;
mod polynomials;
mod reach;
mod rows;
mod samples;
pub(crate) mod tuning;
mod worst;

use super::drawing::asked::{AskedBody, DrawingOutputs, DrawingValues};
use super::drawing::{drawn, extent, has_ground};
use super::{RunError, caught, pool};
use crate::assemble::FormulationInfo;
use crate::model::Description;
use crate::numerics::{Sample, Thinning};
use crate::results::{Drawing, FunctionWitness, Motion, MovingSample, ParameterSummary, Poses, Summary};
use crate::simulate::{Integration, Interruption};
pub use by_hand::{Grip, Hand, Held};
use forces::SimulatedForces;
pub use movable::Movable;
use polynomials::Recordings;
use rows::MotionRows;
use samples::Samples;
use tuning::TUNING;
use worst::add_worst_motions;

/// Numbers of two bytes that the motions of a report come to, about.
pub const REPORT_SIZE: usize = TUNING.report_size;

/// Options of a motion.
#[derive(Clone, Copy, Debug)]
pub struct MotionOptions<'a> {
    /// Threads; all cores if absent. The motion does not depend on them.
    pub threads: Option<usize>,
    /// Approximate limit of the number of two-byte numbers in all poses.
    pub size: usize,
    /// Asked now and then whether to end.
    pub interruption: Interruption<'a>,
    /// Whether motions are cut at events.
    pub between_events: bool,
    /// The formulation that was chosen for the model, if known: [`Summary::chosen_formulation`].
    pub formulation: Option<&'a FormulationInfo>,
}

impl<'a> MotionOptions<'a> {
    /// Options for a report of a run: cut at events if its motions were, in the formulation that was chosen for it.
    pub fn of_run(summary: &'a Summary, interruption: Interruption<'a>) -> Self {
        Self {
            threads: None,
            size: REPORT_SIZE,
            interruption,
            between_events: summary.integration.as_deref().is_some_and(Integration::is_cut_by_name),
            formulation: summary.chosen_formulation.as_ref(),
        }
    }
}

/// The motion of all bodies for a report, with those under the worst functions of excitations; or the reason why there
/// is none.
///
/// # Errors
/// If the mechanism cannot be built, assembled or stepped, at an interruption, and if it panics.
pub fn report_motion(
    description: &Description,
    worst: &[FunctionWitness],
    options: MotionOptions,
) -> Result<Motion, String> {
    let found = caught("the report's motion", || {
        let mut found = motion(description, options)?;
        add_worst_motions(description, &mut found, worst, options)?;
        Ok::<_, RunError>(found)
    });
    match found {
        Ok(found) => found.map_err(|error| error.to_string()),
        Err(error) => Err(error.to_string()),
    }
}

/// Simulates the motion of all bodies.
///
/// # Errors
/// If the mechanism cannot be built, assembled or stepped, and at an interruption.
fn motion(description: &Description, options: MotionOptions) -> Result<Motion, RunError> {
    let pool = pool(options.threads)?;
    pool.install(|| {
        let mut posed = Posed::compile(description, options.formulation, options.interruption)?;
        posed.rows.between_events = options.between_events;
        posed.simulate(description, options.size)
    })
}

/// A model with its bodies' poses in place of its outputs.
pub(super) struct Posed<'a> {
    pub(super) rows: MotionRows<'a>,
    bodies: Vec<AskedBody>,
    /// Whether bodies leave the plane.
    spatial: bool,
}

/// The poses of one sample at every row, and its points.
#[derive(Clone, Default)]
struct Recorded {
    rows: Vec<f64>,
    points: Vec<f64>,
    stopped: Option<usize>,
    /// Times of the events that all samples meet, s.
    events: Vec<f64>,
}

impl<'a> Posed<'a> {
    pub(super) fn compile(
        description: &Description,
        formulation: Option<&FormulationInfo>,
        interruption: Interruption<'a>,
    ) -> Result<Self, RunError> {
        let mut asked = DrawingOutputs::default();
        let bodies = description.bodies.iter().enumerate();
        let bodies: Vec<AskedBody> = bodies.map(|(index, body)| asked.body(description, index, body)).collect();
        Ok(Self {
            rows: MotionRows::asking(description, asked, formulation, interruption)?,
            bodies,
            spatial: description.space.spatial,
        })
    }

    /// The drawing, with its ground between two positions along x, m.
    fn drawn(&self, description: &Description, along: Option<[f64; 2]>) -> Result<Drawing, RunError> {
        drawn(description, along, Some(&self.rows.simulator))
    }

    fn per_body(&self) -> usize {
        if self.spatial { 7 } else { 3 }
    }

    /// Numbers of the pose of all bodies but the ground.
    fn lines(&self) -> usize {
        self.per_body() * (self.bodies.len() - 1)
    }

    /// The uncertain parameters.
    fn parameters(&self, description: &Description) -> Vec<ParameterSummary> {
        let parameters = self.rows.simulator.system.parameters.iter().map(|parameter| ParameterSummary {
            name: parameter.name.clone(),
            unit: parameter.unit.clone(),
            display: description.parameter_units.get(&parameter.name).cloned(),
            nominal: parameter.nominal,
            lower: parameter.lower,
            upper: parameter.upper,
        });
        parameters.collect()
    }

    fn simulate(&self, description: &Description, size: usize) -> Result<Motion, RunError> {
        let samples = Samples::of(&self.rows.domain);
        let wanted: Vec<Sample> =
            [&self.rows.domain.nominal].into_iter().chain(&samples.shown).chain(&samples.nodes).cloned().collect();
        let poses = || {
            // Its ground is drawn once the range of the motion is known.
            let drawing = self.drawn(description, None)?;
            let (times, recorded) = self.record(description, &drawing, &wanted)?;
            Ok::<_, RunError>((drawing, times, recorded))
        };
        let forces = || SimulatedForces::of(description, &self.rows);
        let (poses, forces) = rayon::join(poses, forces);
        let (drawing, times, recorded) = poses?;
        let rows = times.len();
        let complete = |sample: &Recorded| sample.stopped.is_none_or(|stopped| stopped >= rows);
        let shown: Vec<usize> = (1..=samples.shown.len()).filter(|&sample| complete(&recorded[sample])).collect();
        let nodes = &recorded[1 + samples.shown.len()..];
        let surrogate = samples.surrogate.as_ref().filter(|_| nodes.iter().all(complete));

        let lines = self.lines();
        let terms = surrogate.map_or(0, |surrogate| surrogate.basis().len());
        let most = (size / (lines * (2 + shown.len() + terms)).max(1)).clamp(TUNING.fewest_poses, TUNING.most_poses);
        let weights = self.weights(&recorded[0].points, &drawing);
        let looked_at: Vec<&[f64]> = [0].iter().chain(&shown).map(|&sample| recorded[sample].rows.as_slice()).collect();
        let thinning = Thinning { samples: looked_at, weights: &weights };
        let (kept, between) = thinning.rows(&times, most, TUNING.near_pose * self.rows.simulator.system.length);

        let poses = |sample: &Recorded| Poses {
            bodies: kept.iter().flat_map(|row| &sample.rows[row * lines..][..lines]).copied().collect(),
            points: sample.points.clone(),
        };
        let nominal = poses(&recorded[0]);
        let samples: Vec<MovingSample> = shown
            .iter()
            .map(|&sample| MovingSample { values: wanted[sample].to_vec(), poses: poses(&recorded[sample]) })
            .collect();
        let recordings = Recordings {
            times: &times,
            shown_rows: &kept,
            lines,
            nominal: &recorded[0],
            nodes,
            others: shown.iter().map(|&sample| (self.rows.domain.xi(&wanted[sample]), &recorded[sample])).collect(),
            weights: &weights,
        };
        let polynomials = surrogate.map(|surrogate| recordings.polynomials(surrogate));
        let found_times: Vec<f64> = kept.iter().map(|&row| times[row]).collect();
        Ok(Motion {
            times: found_times.clone(),
            rows,
            between,
            per_body: self.per_body(),
            parameters: self.parameters(description),
            nominal,
            stopped: wanted.len() - 1 - nodes.len() - samples.len(),
            samples,
            worst: Vec::new(),
            polynomials,
            forces: forces.map_or_else(Vec::new, |forces| forces.at(&found_times)),
            drawing: self.with_ground(description, drawing, &recorded[0].rows)?,
        })
    }

    /// The drawing with as much of its ground as the nominal motion passes.
    fn with_ground(&self, description: &Description, drawing: Drawing, rows: &[f64]) -> Result<Drawing, RunError> {
        if !has_ground(description) {
            return Ok(drawing);
        }
        self.drawn(description, Some(extent(rows.iter().copied().step_by(self.per_body()))))
    }

    /// Displacement of a point of a body per change of a coordinate of its pose: 1 for positions, the body's reach for
    /// angles, m.
    fn weights(&self, points: &[f64], drawing: &Drawing) -> Vec<f64> {
        let mut points = points.chunks_exact(3);
        let reach = drawing.bodies.iter().map(|body| {
            let own = points.by_ref().take(body.points.len() + usize::from(body.center_of_mass.is_some()));
            own.map(|point| point.iter().map(|x| x * x).sum::<f64>().sqrt()).fold(0.0, f64::max)
        });
        let reach: Vec<f64> = reach.collect();
        let of_body = |reach: f64| {
            let turning = if self.spatial { vec![2.0 * reach; 4] } else { vec![reach] };
            std::iter::repeat_n(1.0, self.per_body() - turning.len()).chain(turning)
        };
        reach[1..].iter().flat_map(|&reach| of_body(reach)).collect()
    }

    /// Times of the rows that are examined, and the poses of every sample there. The nominal sample, the first, reaches
    /// all of them.
    fn record(
        &self,
        description: &Description,
        drawing: &Drawing,
        wanted: &[Sample],
    ) -> Result<(Vec<f64>, Vec<Recorded>), RunError> {
        let mut recorded = vec![Recorded::default(); wanted.len()];
        let found = self.rows.of_samples(description, wanted, self.lines(), |sample, is_first, values| {
            self.pose(&values, &mut recorded[sample].rows);
            if is_first {
                recorded[sample].points = self.points(&values, drawing);
            }
        })?;
        recorded.iter_mut().zip(found.stopped).for_each(|(recorded, stopped)| recorded.stopped = stopped);
        recorded.iter_mut().zip(found.events).for_each(|(recorded, events)| recorded.events = events);
        Ok((found.times, recorded))
    }

    fn pose(&self, values: &DrawingValues, into: &mut Vec<f64>) {
        for body in &self.bodies[1..] {
            let [x, y, z] = values.position(body).into();
            match values.angle(body).filter(|_| !self.spatial) {
                Some(angle) => into.extend([x, y, angle]),
                None => {
                    let turned = values.orientation(body).into_inner();
                    into.extend([x, y, z, turned.w, turned.i, turned.j, turned.k]);
                }
            }
        }
    }

    /// Points of all bodies in their frames, as [`Poses`] has them.
    fn points(&self, values: &DrawingValues, drawing: &Drawing) -> Vec<f64> {
        let of_body = |(asked, drawn): (&AskedBody, &crate::results::DrawnBody)| {
            let named = asked.points.iter().map(|&(point, _)| values.vector(point).into());
            let origin = (drawn.points.len() > asked.points.len()).then_some([0.0; 3]);
            let center = asked.center_of_mass.map_or([0.0; 3], |center| values.vector(center).into());
            let center = drawn.center_of_mass.map(|_| center);
            named.chain(origin).chain(center).flatten().collect::<Vec<f64>>()
        };
        self.bodies.iter().zip(&drawing.bodies).flat_map(of_body).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model;

    fn four_bar() -> Description {
        let path = std::path::Path::new(env!("CARGO_MANIFEST_DIR")).join("../../models/four_bar.yaml");
        model::load(&path, &[]).unwrap_or_else(|diagnostics| panic!("{diagnostics}"))
    }

    #[test]
    fn poses_leave_the_steps_unchanged() {
        let description = four_bar();
        let whole = crate::study::formulation::compiled(&crate::assemble::Questions::of(&description)).unwrap().program;
        let posed = Posed::compile(&description, None, Interruption::default()).unwrap().rows.simulator.program;
        let steps = |program: &crate::compile::Program| {
            [program.step_size(), program.step(), program.factor(), program.correct(), program.advance()]
                .map(|tape| tape.len())
        };
        assert_eq!(steps(&posed), steps(&whole));
        assert_ne!(posed.observe().len(), whole.observe().len());
    }

    #[test]
    fn polynomials_match_held_out_samples() {
        let motion = motion(
            &four_bar(),
            MotionOptions {
                threads: Some(1),
                size: 300_000,
                interruption: Interruption::default(),
                between_events: false,
                formulation: None,
            },
        )
        .unwrap();
        let polynomials = motion.polynomials.as_ref().unwrap();
        assert_eq!((motion.samples.len(), motion.stopped, polynomials.degrees.len()), (12, 0, 30));
        // Tolerances are half a percent: the remainder of a polynomial of degree four is far below a micrometre.
        assert!(polynomials.error < 1e-7, "{}", polynomials.error);
        assert!(motion.between < 1e-3, "{}", motion.between);
        let several = super::motion(
            &four_bar(),
            MotionOptions {
                threads: Some(2),
                size: 300_000,
                interruption: Interruption::default(),
                between_events: false,
                formulation: None,
            },
        )
        .unwrap();
        assert_eq!(several.nominal.bodies, motion.nominal.bodies);
        assert_eq!(several.polynomials.unwrap().bodies, polynomials.bodies);
    }

    #[test]
    fn known_and_chosen_formulation_give_the_same_motion() {
        let description = four_bar();
        let options = crate::study::Options { threads: Some(1), ..Default::default() };
        let (_, summary) = crate::study::run(&description, options).unwrap();
        let known = summary.chosen_formulation.as_ref();
        assert!(known.is_some_and(|known| known.joint));
        let of = |formulation| {
            let interruption = Interruption::default();
            let options =
                MotionOptions { threads: Some(1), size: 300_000, interruption, between_events: false, formulation };
            motion(&description, options).unwrap()
        };
        let [known, chosen] = [known, None].map(|formulation| format!("{:?}", of(formulation)));
        assert_eq!(known, chosen);
    }

    #[test]
    fn small_size_gives_few_poses_and_their_error() {
        let motion = motion(
            &four_bar(),
            MotionOptions {
                threads: Some(1),
                size: 1,
                interruption: Interruption::default(),
                between_events: false,
                formulation: None,
            },
        )
        .unwrap();
        assert_eq!((motion.times.len(), motion.rows), (TUNING.fewest_poses, 201));
        assert!(motion.between > 1e-3, "{}", motion.between);
    }
}
