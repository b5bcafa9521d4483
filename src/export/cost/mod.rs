//! Error against computing time, as a table (`csv`) and as a `plot`.

mod csv;
mod log_axis;
mod plot;

pub use self::csv::{cost_csv, write_cost};
pub use plot::cost_svg;
