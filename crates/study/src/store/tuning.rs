//! Constants of the room `store`.

use std::time::Duration;

use symdiff::constants::tuning;

tuning! {
    /// Simulations kept as files.
    "store" {
        /// What took longer to simulate is on the disk before it appears. Of the rest a loss of power costs the last
        /// half minute's at most, which a system writes by itself.
        worth_syncing: Duration = Duration::from_secs(1), moves "which parts outlive a loss of power";
    }
}
