//! Local errors of a step.

use symdiff::Tile;

use super::newton::Newton;
use crate::assemble::CoordinateId;
use crate::compile::Program;

/// A lane's local error in a step.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct LocalError {
    /// Error of positions, relative to |q| or the coordinate's scale, whichever is larger, by the part that moves the
    /// mechanism.
    pub size: f64,
    /// The same of the whole change of acceleration, with the parts that constraints and stiff forces leave little of.
    pub whole: f64,
    /// The coordinate with this error.
    pub coordinate: CoordinateId,
    /// Change of that coordinate's acceleration within the step.
    pub change: f64,
}

/// After the iteration: (β + Δ/2 − 1/6) h² (a₊ − a) of each lane, of which only the part that moves the mechanism
/// counts. The rest is along the constraints' normals, where positions have no error: a₊ − a is large there after
/// every change of h, since the scheme wants velocities with Φ_q v + Φ_t = C h², and would not fall with smaller
/// steps.
pub(super) fn measure_errors(program: &Program, tile: &mut Tile, newton: &Newton, h: f64, errors: &mut [LocalError]) {
    tile.run(program.estimate());
    let (layout, numbers) = (&program.layout, program.coefficients);
    let gain = numbers.error_gain(h).abs();
    for (lane, worst) in errors.iter_mut().enumerate() {
        *worst = LocalError::default();
        let value = |register: usize| tile.lane(register)[lane];
        for (index, scale) in program.scale.iter().enumerate() {
            let [w, a, x] = [&layout.w, &layout.a, &layout.iterate].map(|block| value(block.start + index));
            let whole = numbers.of_new() * x + numbers.of_old() * w - (1.0 + numbers.of_algorithmic()) * a;
            // Where the step was singular there are no factors.
            let moving = value(layout.correction.start + index);
            let change = if newton.is_singular(lane) { whole } else { moving };
            let unit = gain / scale.max(value(layout.q.start + index).abs());
            // Written so that NaN wins and stays.
            if !(unit * change.abs() <= worst.size || worst.size.is_nan()) {
                let coordinate = CoordinateId::new(index);
                *worst = LocalError { size: unit * change.abs(), coordinate, change, ..*worst };
            }
            if !(unit * whole.abs() <= worst.whole || worst.whole.is_nan()) {
                worst.whole = unit * whole.abs();
            }
        }
    }
}
