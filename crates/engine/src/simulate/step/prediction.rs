//! What Newton's iteration of a step starts from.

use symdiff::{Tile, Vectorise};

use crate::compile::Program;

/// w₊ and λ₊ of pending lanes as weighted sums of values w, λ.
pub(super) struct Predict<'a> {
    pub program: &'a Program,
    pub tile: &'a mut Tile,
    pub pending: &'a [bool],
    pub weights: [f64; 3],
    pub values: [&'a [f64]; 3],
}

impl Vectorise for Predict<'_> {
    type Output = ();

    #[inline(always)]
    fn run(self) {
        let layout = &self.program.layout;
        let width = self.tile.width();
        let ([a, b, c], [now, last, second_last]) = (self.weights, self.values);
        let targets = layout.iterate.clone().chain(layout.lambda.clone());
        for (index, register) in targets.enumerate() {
            let [now, last, second_last] = [now, last, second_last].map(|values| &values[index * width..][..width]);
            let values = self.tile.lane_mut(register);
            for lane in 0..width {
                let predicted = a * now[lane] + (b * last[lane] + c * second_last[lane]);
                values[lane] = if self.pending[lane] { predicted } else { values[lane] };
            }
        }
    }
}
