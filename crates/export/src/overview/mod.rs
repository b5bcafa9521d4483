//! A run for people: tables of its bounds, verdicts and statistics as plain text with marks of style, and its warnings.

mod assemblies;
mod black_box;
mod excitations;
mod marks;
mod run;
mod stack;
mod statistics;
mod table;
pub mod tuning;
mod verdicts;
mod warnings;
mod words;

pub use assemblies::lines as assemblies;
pub use marks::{BOLD, Mark, RED, YELLOW, plain};
pub use run::overview;
pub use statistics::yields;
pub use table::{Align, Table};
pub use verdicts::{band, requirements};
pub use warnings::{Warning, unanswered, warnings};
pub use words::{coordinates, count, digits, short, significant};
