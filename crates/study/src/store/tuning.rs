//! Constants of the room `store`.

use std::time::Duration;

use symdiff::constants::tuning;

tuning! {
    /// Simulations stored as files.
    "store" {
        /// A part that took longer to simulate is on the disk before it appears. Of the others a loss of power costs at
        /// most those of the last half minute, which a system writes by itself.
        worth_syncing: Duration = Duration::from_secs(1), moves "which parts outlive a loss of power";
    }
}
