//! What accuracy costs in time: the `study` as data, as a table (`csv`) and as a `plot`.

mod csv;
mod front;
mod log_axis;
mod plot;
mod study;

pub use self::csv::{cost_csv, write_cost};
pub use front::pareto;
pub use plot::cost_svg;
pub use study::{CostMethod, CostPoint, CostReference, CostStudy, Deviation, cost_curves};
