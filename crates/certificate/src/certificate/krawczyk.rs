//! Krawczyk's operator: from an approximate solution to a proven enclosure.

use symdiff::taylor_model::up;

use super::matrix::Bounds;
use super::tuning::TUNING;
use crate::numerics::larger;

/// The operator for a box of corrections |y| ≤ g: a bound of |C times the residual|, and one of |I − C J| with the
/// derivatives J over the solutions in the box, row by row.
pub struct Image {
    /// Bound of |C times the residual|.
    pub missed: Vec<f64>,
    /// Bound of |I − C J|.
    pub contraction: Bounds,
}

/// A box that the operator maps into itself: for every ξ one solution is in it; `None` if none is found. The search
/// begins at `first`.
pub fn enclose(first: Vec<f64>, mut image: impl FnMut(&[f64]) -> Image) -> Option<Vec<f64>> {
    let mut box_of = first;
    for _ in 0..TUNING.attempts_of_krawczyk {
        let Image { missed, contraction } = image(&box_of);
        let norm = contraction.rows().map(|row| up(row.iter().sum())).fold(0.0, larger);
        let apply = |y: &[f64]| -> Vec<f64> {
            contraction.times(y).iter().zip(&missed).map(|(moved, missed)| up(moved + missed)).collect()
        };
        let mapped = apply(&box_of);
        // Written so that NaN is no proof.
        if norm < 1.0 && mapped.iter().zip(&box_of).all(|(mapped, y)| mapped <= y) {
            // The image contains the solution too, and so does the image of the image.
            return Some(apply(&mapped));
        }
        if mapped.iter().any(|y| !y.is_finite()) {
            return None;
        }
        let wider = mapped
            .iter()
            .zip(&box_of)
            .map(|(&mapped, &y)| up(TUNING.inflation_of_krawczyk * larger(mapped, y.min(mapped))));
        box_of = wider.collect();
    }
    None
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_contraction_is_enclosed_and_an_expansion_is_not() {
        let image = |factor: f64| {
            move |_: &[f64]| Image {
                missed: vec![1.0, 0.5],
                contraction: Bounds::of(2, 2, &[factor, 0.1, 0.0, factor]),
            }
        };
        let found = enclose(vec![1e-9, 1e-9], image(0.5)).unwrap();
        // y₂ = 0.5/(1 − 0.5) = 1, y₁ = (1 + 0.1)/(1 − 0.5) = 2.2.
        assert!((2.2..3.0).contains(&found[0]) && (1.0..1.4).contains(&found[1]), "{found:?}");
        assert_eq!(enclose(vec![1e-9, 1e-9], image(1.01)), None);
        assert_eq!(enclose(vec![1e-9, 1e-9], image(f64::NAN)), None);
    }
}
