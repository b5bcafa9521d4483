//! Least memory of a run's results, and whether it is free: a run that would end in the middle is refused before it
//! begins.

use super::tuning::TUNING;
use super::work::held_out;
use crate::methods::Sensitivity;
use crate::study::problem::Study;

/// Sizes of a number, of a range, and of the sensitivities of an output in a row, of which each has three lists of its
/// own, bytes.
const NUMBER: usize = size_of::<f64>();
const RANGE: usize = 2 * NUMBER;
const SENSITIVITIES: usize = size_of::<Option<Sensitivity>>();

/// More memory than there is.
#[derive(Clone, Copy, Debug, PartialEq, thiserror::Error)]
#[error(
    "bounds of {outputs} outputs in {rows} rows take {} GB of memory or more, and {} GB are free: ask for fewer outputs, \
     or for fewer rows by a larger `output_step`",
    gigabytes(.needed), gigabytes(.free)
)]
pub struct Memory {
    outputs: usize,
    rows: usize,
    needed: u64,
    free: u64,
}

impl Memory {
    /// Memory needed and free, if the studies of a run need more than is free; `None` also if the latter is unknown.
    pub(in crate::study) fn lacking(studies: &[Study]) -> Option<Self> {
        let free = free()?;
        let needed = studies.iter().map(least_bytes).fold(0, u64::saturating_add);
        let largest = studies.iter().max_by_key(|study| least_bytes(study))?;
        let (outputs, rows) = (largest.simulator.system.outputs.len(), largest.rows());
        (needed > free).then_some(Self { outputs, rows, needed, free })
    }
}

/// Least bytes of the results stored for every output in every row: samples that measure errors, bands and
/// sensitivities.
fn least_bytes(study: &Study) -> u64 {
    let (k, methods) = (study.domain.dimension(), study.request.methods().len());
    let found = RANGE + 2 * NUMBER + SENSITIVITIES;
    let of_method = found + 3 * TUNING.list_bytes.max(k * NUMBER) + (3 + 3 * k) * NUMBER;
    let of_output = held_out(study) * NUMBER + found + NUMBER + methods * of_method;
    let of_row = (study.simulator.system.outputs.len() as u64).saturating_mul(of_output as u64);
    of_row.saturating_mul(study.rows() as u64)
}

fn gigabytes(bytes: &u64) -> String {
    format!("{:.1}", *bytes as f64 / 1e9)
}

/// Bytes that this program can still get, if the system says so.
fn free() -> Option<u64> {
    let read = |path: &str| std::fs::read_to_string(path).ok();
    let number =
        |text: &str, unit: u64| text.split_whitespace().find_map(|word| word.parse::<u64>().ok()).map(|n| n * unit);
    let line = |path: &str, name: &str| read(path)?.lines().find_map(|line| line.strip_prefix(name).map(str::to_owned));
    let machine = line("/proc/meminfo", "MemAvailable:").and_then(|rest| number(&rest, 1024));
    let addresses = line("/proc/self/limits", "Max address space").and_then(|rest| {
        // The soft limit comes first.
        let limit = rest.split_whitespace().next()?.parse::<u64>().ok()?;
        let taken = line("/proc/self/status", "VmSize:").and_then(|rest| number(&rest, 1024))?;
        Some(limit.saturating_sub(taken))
    });
    let group = read("/sys/fs/cgroup/memory.max").and_then(|text| {
        let taken = read("/sys/fs/cgroup/memory.current").and_then(|text| number(&text, 1))?;
        Some(number(&text, 1)?.saturating_sub(taken))
    });
    [machine, addresses, group].into_iter().flatten().min()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lacking_memory_is_stated_in_gigabytes() {
        let lacking = Memory { outputs: 5000, rows: 101, needed: 9_600_000_000, free: 4_000_000_000 };
        let message = lacking.to_string();
        assert!(
            message.contains("5000 outputs in 101 rows take 9.6 GB of memory or more, and 4.0 GB are free"),
            "{message}"
        );
    }

    #[cfg(target_os = "linux")]
    #[test]
    fn free_memory_is_known_on_this_system() {
        assert!(free().is_some_and(|free| free > 1 << 20));
    }
}
