//! The five rods of Table I as the shipped scenarios have them.

use super::ReproduceError;
use crate::config::{Problem, Source};
use ron::value::RawValue;
use std::collections::BTreeMap;

/// The scenario that the others are derived from, and those: rows and text.
const FOUR_ROWS: &str = include_str!("../../scenarios/hsa_rod_4rows.ron");
const DERIVED: [(u32, &str); 4] = [
    (6, include_str!("../../scenarios/hsa_rod_6rows.ron")),
    (8, include_str!("../../scenarios/hsa_rod_8rows.ron")),
    (10, include_str!("../../scenarios/hsa_rod_10rows.ron")),
    (12, include_str!("../../scenarios/hsa_rod_12rows.ron")),
];

/// Numbers of rows.
pub(super) const ROWS: [u32; 5] = [4, 6, 8, 10, 12];

/// A scenario that changes another.
#[derive(serde::Deserialize)]
struct Derived<'a> {
    #[serde(rename = "base")]
    _base: String,
    #[serde(borrow)]
    set: BTreeMap<String, &'a RawValue>,
}

/// The scenario of a rod. Embedded texts have no folder to find their base in, so its changes are applied here.
pub(super) fn rod(rows: u32) -> Result<Source, ReproduceError> {
    let name = format!("scenarios/hsa_rod_{rows}rows.ron (embedded)");
    let sets = match DERIVED.iter().find(|(of, _)| *of == rows) {
        None => Vec::new(),
        Some((_, text)) => {
            let derived: Derived<'_> = ron::from_str(text)
                .map_err(|e| Problem::new(format!("{name}: {e}")))
                .map_err(crate::config::Problems::from)?;
            let set = |(path, value): (&String, &&RawValue)| format!("{path}={}", value.get_ron());
            derived.set.iter().map(set).collect()
        }
    };
    Ok(Source::from_text(&name, FOUR_ROWS, &sets)?)
}
