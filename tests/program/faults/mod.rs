//! What can go wrong around a run, and uncertainty that a mechanism does not bear: nothing half is left, what is
//! finished is kept, and what is reported is true.

mod disk;
mod folder;
mod infeasible;
mod interrupts;
mod many;
mod names;
mod numbers;
mod panics;
mod processors;
mod replaced;
mod sizes;
mod terminal;
mod uncertainty;
