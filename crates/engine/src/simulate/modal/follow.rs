//! Matching of the modes of two configurations by their shapes.

use nalgebra::DMatrix;

use super::eigen::Mode;
use super::likeness::likeness;

/// The modes that are most like known ones, in their order, and the least likeness. The most alike are paired first.
pub fn followed(known: &[Mode], found: &[Mode], mass: &DMatrix<f64>) -> (Vec<Mode>, f64) {
    let mut pairs: Vec<(f64, usize, usize)> = Vec::new();
    for (index, mode) in known.iter().enumerate() {
        for (other, candidate) in found.iter().enumerate() {
            pairs.push((likeness(&mode.shape, &candidate.shape, Some(mass)), index, other));
        }
    }
    pairs.sort_by(|a, b| b.0.total_cmp(&a.0).then((a.1, a.2).cmp(&(b.1, b.2))));
    let (mut chosen, mut taken) = (vec![None; known.len()], vec![false; found.len()]);
    let mut least = 1.0_f64;
    for (likeness, index, other) in pairs {
        if chosen[index].is_none() && !taken[other] {
            (chosen[index], taken[other]) = (Some(found[other].clone()), true);
            least = least.min(likeness);
        }
    }
    let missing = || Mode { frequency: f64::NAN, damping: f64::NAN, shape: known[0].shape.clone() };
    (chosen.into_iter().map(|mode| mode.unwrap_or_else(missing)).collect(), least)
}
