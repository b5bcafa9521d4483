//! Constants of the room `applications: explain`.

use symdiff::constants::tuning;

tuning! {
    /// Lists of the parts of a compiled model.
    "applications: explain" {
        /// Instructions a step up to which a model is compiled again to count the saving.
        counted: usize = 30_000, moves "the list of decisions of `explain`";
        /// Most names that a decision lists.
        named: usize = 8, moves "the list of decisions of `explain`";
        /// A model is compiled once more for each of its effects as long as that makes no more instructions than this.
        most_instructions: usize = 3_000_000, moves "the costs of effects of `explain`";
        /// Most joints that are listed.
        most_named: usize = 8, moves "the list of joints of `explain`";
    }
}
