//! Recorders: callbacks that export what bodies do over time, as [`Csv`] and [`Parquet`] tables or [`Npz`] arrays.
//!
//! All three record the same [`Quantity`]s and write numbers in full, so that they are read back as they were, NaN
//! included. Tables are long ("tidy"), one row a time, body and index:
//!
//! | column | meaning |
//! | --- | --- |
//! | `time_s` | time \[s\] |
//! | `body` | name of the body |
//! | `index` | node `i`; element `i` between nodes `i` and `i + 1`; cell `i` between elements `i - 1` and `i` |
//! | `position_x_m`, ... | one column a component, its unit last: `x, y, z` in the world frame, `d1, d2, d3` in the material frame |
//!
//! What doesn't exist at an index is empty: elements at the last node, cells at the ends unless a wall holds them,
//! elements and cells of rigid bodies. Rigid bodies have one row; their node is the centre of mass.
//!
//! Positions, velocities, frames and angular velocities are those at the time recorded. All else is from the last
//! evaluation of the loads, which the engine's steps do at their middle.
//!
//! Folders are made as needed. A file that can't be written, or that another recorder is writing, is told before the
//! run.

mod csv_table;
mod files;
mod layout;
mod npz_arrays;
mod parquet_file;
mod parquet_table;
mod quantity;
mod rows;

pub use csv_table::Csv;
pub use npz_arrays::Npz;
pub use parquet_file::{Kind, ParquetFile, Value};
pub use parquet_table::Parquet;
pub use quantity::Quantity;
