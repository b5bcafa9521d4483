//! Initial guess of Newton's iteration of a step.

use symdiff::{LaneWork, Tile, lanes};

use crate::compile::Program;

/// w₊ and λ₊ of pending lanes as weighted sums of values w, λ.
pub(super) struct Predict<'a> {
    pub program: &'a Program,
    pub tile: &'a mut Tile,
    pub pending: &'a [bool],
    pub weights: [f64; 3],
    pub values: [&'a [f64]; 3],
}

impl LaneWork for Predict<'_> {
    #[inline(always)]
    fn run<const W: usize>(self) {
        let layout = &self.program.layout;
        let (pending, [a, b, c]) = (lanes::<W, _>(self.pending), self.weights);
        let [now, last, second_last] = self.values.map(|values| values.as_chunks::<W>().0);
        let (accelerations, multipliers) = (layout.iterate.clone(), layout.lambda.clone());
        let ends = accelerations.len();
        for (registers, values) in [(accelerations, 0..ends), (multipliers, ends..now.len())] {
            let targets = self.tile.block_mut(registers).as_chunks_mut::<W>().0.iter_mut();
            let before = now[values.clone()].iter().zip(&last[values.clone()]).zip(&second_last[values]);
            for (target, ((now, last), second_last)) in targets.zip(before) {
                for lane in 0..W {
                    let predicted = a * now[lane] + (b * last[lane] + c * second_last[lane]);
                    target[lane] = if pending[lane] { predicted } else { target[lane] };
                }
            }
        }
    }
}
