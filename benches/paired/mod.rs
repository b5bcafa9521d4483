//! Two runs compared on a machine that does other things too: alternately, each first equally often. A model against
//! itself shows the resolution of the clock.

use std::time::Instant;

/// Measured medians, and quartiles of the ratio.
pub struct Paired {
    /// s
    pub seconds: [f64; 2],
    /// The second's time over the first's, pair by pair: lower quartile, median, upper quartile.
    pub ratio: [f64; 3],
}

/// Runs each of two closures `pairs` times.
pub fn paired(pairs: usize, runs: [&dyn Fn(); 2]) -> Paired {
    let mut times = [Vec::new(), Vec::new()];
    for pair in 0..pairs {
        let order = if pair % 2 == 0 { [0, 1] } else { [1, 0] };
        for which in order {
            let begun = Instant::now();
            runs[which]();
            times[which].push(begun.elapsed().as_secs_f64());
        }
    }
    let ratio = quartiles(times[0].iter().zip(&times[1]).map(|(first, second)| second / first).collect());
    Paired { seconds: times.map(|times| quartiles(times)[1]), ratio }
}

fn quartiles(mut values: Vec<f64>) -> [f64; 3] {
    values.sort_by(f64::total_cmp);
    [1, 2, 3].map(|quarter| values[(values.len() - 1) * quarter / 4])
}
