//! Error against computing time, as a table (`csv`) and as a `plot`.

mod csv;
mod plot;

pub use self::csv::write_cost;
