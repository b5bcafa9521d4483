//! How much alike two shapes are.

use nalgebra::DMatrix;

use crate::numerics::dot;
use crate::simulate::statics::times;

/// Modal assurance criterion, |aᴴ M b|² / (aᴴ M a · bᴴ M b); M = I where none is given. 1 for shapes that are the
/// same.
pub fn likeness(a: &[Vec<f64>; 2], b: &[Vec<f64>; 2], mass: Option<&DMatrix<f64>>) -> f64 {
    let image = |shape: &[Vec<f64>; 2]| match mass {
        Some(mass) => [times(mass, &shape[0]), times(mass, &shape[1])],
        None => shape.clone(),
    };
    let (of_a, of_b) = (image(a), image(b));
    let re = dot(&a[0], &of_b[0]) + dot(&a[1], &of_b[1]);
    let im = dot(&a[0], &of_b[1]) - dot(&a[1], &of_b[0]);
    let own = |shape: &[Vec<f64>; 2], image: &[Vec<f64>; 2]| dot(&shape[0], &image[0]) + dot(&shape[1], &image[1]);
    let size = own(a, &of_a) * own(b, &of_b);
    if size > 0.0 { (re * re + im * im) / size } else { 0.0 }
}
