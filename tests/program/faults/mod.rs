//! Faults around a run, and uncertainty that a mechanism does not bear: no half-written file is left, finished results
//! stay, and reports are true.

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
