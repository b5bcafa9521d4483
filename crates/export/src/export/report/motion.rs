//! `motion.json`: contents of a report that no other file of a run has. The mechanism, its motion and the model's text.

use serde::Serialize;

use super::derivatives::{PackedDerivatives, packed_derivatives};
use super::packing::{Packed, floats};
use super::visuals::{Visual, visuals};
use crate::export::drawing::drawing_svg;
use crate::results::{
    Bounds, Drawing, Motion, MotionPolynomials, MovingForce, ParameterSummary, Poses, Summary, WorstMotion,
};

/// Name of the file.
pub(in crate::export) const MOTION: &str = "motion.json";

/// Parts of a report in addition to the other files of a run.
#[derive(Debug)]
pub struct ReportParts {
    /// Description of the model.
    pub description: Option<String>,
    /// The files that the model was read from: names and texts.
    pub texts: Vec<(String, String)>,
    /// The motion, or why there is none.
    pub motion: Result<Motion, String>,
    /// Whether `report.html` is written in addition to the other files; scenes share one.
    pub page: bool,
}

#[derive(Serialize)]
struct Written<'m> {
    #[serde(skip_serializing_if = "Option::is_none")]
    description: Option<&'m str>,
    model: Vec<Text<'m>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    motion: Option<PackedMotion<'m>>,
    /// Reason for the absence of a motion.
    #[serde(skip_serializing_if = "Option::is_none")]
    absent: Option<&'m str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    derivatives: Option<PackedDerivatives<'m>>,
}

#[derive(Serialize)]
struct Text<'m> {
    name: &'m str,
    text: &'m str,
}

/// Like [`Motion`]; arrays of numbers are packed, and those of samples are differences from the nominal ones.
#[derive(Serialize)]
struct PackedMotion<'m> {
    drawing: &'m Drawing,
    /// The mechanism at its start, for readers without scripts.
    picture: String,
    visuals: Vec<Visual>,
    times: String,
    rows: usize,
    between: f64,
    per_body: usize,
    parameters: &'m [ParameterSummary],
    nominal: PackedNominal,
    forces: Vec<PackedForce<'m>>,
    samples: Vec<PackedSample<'m>>,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    worst: Vec<PackedWorst<'m>>,
    stopped: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    polynomials: Option<PackedPolynomials<'m>>,
}

#[derive(Serialize)]
struct PackedNominal {
    bodies: String,
    points: String,
}

#[derive(Serialize)]
struct PackedForce<'m> {
    name: &'m str,
    reaction: bool,
    values: Packed,
}

#[derive(Serialize)]
struct PackedSample<'m> {
    values: &'m [f64],
    bodies: Packed,
    points: String,
}

#[derive(Serialize)]
struct PackedWorst<'m> {
    name: &'m str,
    #[serde(skip_serializing_if = "Option::is_none")]
    time: Option<f64>,
    bodies: Packed,
    points: String,
}

#[derive(Serialize)]
struct PackedPolynomials<'m> {
    degrees: &'m [u8],
    bodies: Packed,
    points: String,
    error: f64,
    /// Absent without events.
    #[serde(skip_serializing_if = "Option::is_none")]
    events: Option<PackedEvents>,
}

/// Times of the nominal motion's events, and coefficients of their deviations: (event, term).
#[derive(Serialize)]
struct PackedEvents {
    times: String,
    deviations: String,
}

/// The file; with the results, it contains their derivatives too.
///
/// # Errors
/// Only if memory cannot be written to.
pub fn motion_json(parts: &ReportParts, results: Option<(&Bounds, &Summary)>) -> serde_json::Result<Vec<u8>> {
    let written = Written {
        description: parts.description.as_deref(),
        model: parts.texts.iter().map(|(name, text)| Text { name, text }).collect(),
        motion: parts.motion.as_ref().ok().map(|motion| packed(motion)),
        absent: parts.motion.as_ref().err().map(String::as_str),
        derivatives: results.and_then(|(bounds, summary)| packed_derivatives(bounds, summary)),
    };
    let mut json = serde_json::to_vec(&written)?;
    json.push(b'\n');
    Ok(json)
}

fn packed(motion: &Motion) -> PackedMotion<'_> {
    let Motion { nominal, .. } = motion;
    let lines = nominal.bodies.len() / motion.times.len().max(1);
    let beside = |values: &[f64], nominal: &[f64]| -> Vec<f64> {
        values.iter().zip(nominal).map(|(value, nominal)| value - nominal).collect()
    };
    let packed = |poses: &Poses| {
        let bodies = Packed::new(&beside(&poses.bodies, &nominal.bodies), lines);
        (bodies, floats(&beside(&poses.points, &nominal.points)))
    };
    let sample = |values, poses: &Poses| {
        let (bodies, points) = packed(poses);
        PackedSample { values, bodies, points }
    };
    PackedMotion {
        visuals: motion.drawing.solids.iter().flat_map(visuals).collect(),
        drawing: &motion.drawing,
        picture: drawing_svg(&motion.drawing),
        times: floats(&motion.times),
        rows: motion.rows,
        between: motion.between,
        per_body: motion.per_body,
        parameters: &motion.parameters,
        nominal: PackedNominal { bodies: floats(&nominal.bodies), points: floats(&nominal.points) },
        forces: motion.forces.iter().map(force).collect(),
        samples: motion.samples.iter().map(|moving| sample(&moving.values, &moving.poses)).collect(),
        worst: motion
            .worst
            .iter()
            .map(|WorstMotion { name, time, poses }| {
                let (bodies, points) = packed(poses);
                PackedWorst { name, time: *time, bodies, points }
            })
            .collect(),
        stopped: motion.stopped,
        polynomials: motion.polynomials.as_ref().map(|found| polynomials(found, nominal, lines)),
    }
}

fn force(force: &MovingForce) -> PackedForce<'_> {
    PackedForce { name: &force.name, reaction: force.is_reaction, values: Packed::new(&force.values, 6) }
}

fn polynomials<'m>(found: &'m MotionPolynomials, nominal: &Poses, lines: usize) -> PackedPolynomials<'m> {
    let MotionPolynomials { degrees, events, event_deviations, bodies, points, error } = found;
    let terms = bodies.len() / nominal.bodies.len().max(1);
    let events =
        (!events.is_empty()).then(|| PackedEvents { times: floats(events), deviations: floats(event_deviations) });
    let bodies = Packed::new(bodies, lines * terms);
    PackedPolynomials { degrees, bodies, points: floats(points), error: *error, events }
}
