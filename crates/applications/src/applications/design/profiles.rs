//! The objective along each free parameter, through a point.

use super::goal::Goal;
use super::surface::DesignSurface;
use super::tuning::TUNING;
use super::{DesignError, Question};
use crate::results::DesignProfile;

/// The profiles through a point on a surrogate; none of one that does not have the point.
pub fn profiles(
    question: &Question,
    surface: &DesignSurface,
    point: &[f64],
) -> Result<Vec<DesignProfile>, DesignError> {
    let is_inside = point.iter().zip(&surface.region).all(|(value, [lower, upper])| (lower..=upper).contains(&value));
    // The cost does not depend on a nominal value alone.
    if !is_inside || matches!(question.goal, Goal::Cost(_)) {
        return Ok(Vec::new());
    }
    let sign = if question.is_least { -1.0 } else { 1.0 };
    let mut assessed = question.assessed(surface)?;
    let mut of = |(parameter, [lower, upper]): (usize, &[f64; 2])| {
        let value = |index: usize| lower + (upper - lower) * index as f64 / (TUNING.points_of_profile - 1) as f64;
        let values: Vec<f64> = (0..TUNING.points_of_profile).map(value).collect();
        let mut profile = DesignProfile { parameter, values, nominal: Vec::new(), worst: Vec::new() };
        for value in &profile.values {
            let mut moved = point.to_vec();
            moved[parameter] = *value;
            let merit = |slacks: &[f64]| sign * question.goal.merit(slacks).value;
            profile.nominal.push(merit(&surface.slacks(&[surface.axes.nominal(&moved)])));
            profile.worst.push(merit(&assessed.slacks(&moved)));
        }
        profile
    };
    Ok(surface.region.iter().enumerate().map(&mut of).collect())
}
