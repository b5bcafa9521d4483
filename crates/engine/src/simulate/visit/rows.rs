//! Outputs in rows, reduced to one number a channel.

use crate::simulate::drive::{Accumulator, Channel};

/// Reduced outputs of one sample, channel by channel, given all of them (row by row) at these times, s. Between rows an
/// output is the cubic through four of them.
pub fn reduced_rows(channels: &[Channel], times: &[f64], values: &[f64]) -> Vec<f64> {
    let outputs = values.len() / times.len().max(1);
    let mut reduction = Accumulator::new(channels, outputs, 1);
    for (&time, row) in times.iter().zip(values.chunks_exact(outputs.max(1))) {
        let mut buffer = reduction.buffer();
        buffer.copy_from_slice(row);
        reduction.push(time, buffer, &[true]);
    }
    reduction.finish()
}
