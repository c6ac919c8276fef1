//! Several actuation sequences at once.

use auxetica_engine::{Actuation, Dwell, Inputs, Nested, register};
use schemars::JsonSchema;
use serde::Deserialize;

/// Several sequences at once, of the segments of a robot for example, each with inputs of its own names.
#[derive(Debug, Deserialize, JsonSchema)]
#[serde(deny_unknown_fields)]
pub struct Together {
    /// The sequences.
    of: Vec<Nested<dyn Actuation>>,
}

register!(
    dyn Actuation: Together,
    example = r#"Together(of: [MotionPrimitives(sequence: [Elongation]), MotionPrimitives(sequence: [BendEast], motors: "upper_")])"#,
    source = "Auxetica",
);

impl Actuation for Together {
    fn inputs(&self) -> Result<Inputs, String> {
        let mut channels: Vec<(String, auxetica_engine::Series)> = Vec::new();
        for sequence in &self.of {
            for (name, series) in sequence.inputs()?.iter() {
                if channels.iter().any(|(known, _)| known == name) {
                    return Err(format!(
                        "two sequences give the input `{name}`; give one of them another name (`motors`)"
                    ));
                }
                channels.push((name.to_owned(), series.clone()));
            }
        }
        Ok(Inputs::new(channels))
    }

    /// All times at which one of the sequences is at rest.
    fn dwells(&self) -> Vec<Dwell> {
        let mut all: Vec<Dwell> = self.of.iter().flat_map(|s| s.dwells()).collect();
        all.sort_by(|a, b| a.time.total_cmp(&b.time));
        all.dedup_by(|later, first| {
            let same = (later.time - first.time).abs() < 1e-9;
            if same && first.name != later.name {
                first.name = format!("{} + {}", first.name, later.name);
            }
            same
        });
        all
    }
}
