//! The long table, row by row.

use crate::layout::Layout;
use crate::quantity::Quantity;
use auxetica_engine::{ReadBody, Snapshot};
use serde::Serialize;

/// One row, keys first, then the [`columns`] of the quantities.
#[derive(Serialize)]
pub(crate) struct Row<'a> {
    /// Time \[s\].
    pub(crate) time: f64,
    /// Name of the body.
    pub(crate) body: &'a str,
    /// Index of node, element and cell.
    pub(crate) index: usize,
    /// One value a component, `None` where it doesn't exist.
    pub(crate) values: &'a [Option<f64>],
}

/// Names of the columns before those of the quantities.
pub(crate) const KEYS: [&str; 3] = ["time_s", "body", "index"];

/// Names of the columns of `quantities`.
pub(crate) fn columns(quantities: &[Quantity]) -> impl Iterator<Item = String> {
    quantities
        .iter()
        .flat_map(|quantity| Layout::from(*quantity).columns())
}

/// Hands every row of `snapshot` to `write`, up to the first error.
pub(crate) fn each<E>(
    snapshot: &Snapshot<'_>,
    quantities: &[Quantity],
    mut write: impl FnMut(&Row<'_>) -> Result<(), E>,
) -> Result<(), E> {
    let layouts: Vec<Layout> = quantities.iter().copied().map(Layout::from).collect();
    let mut values = Vec::new();
    for body in &snapshot.bodies {
        for index in 0..body.nodes() {
            values.clear();
            for layout in &layouts {
                layout.append(body, index, &mut values);
            }
            write(&Row {
                time: snapshot.time,
                body: body.name(),
                index,
                values: &values,
            })?;
        }
    }
    Ok(())
}
