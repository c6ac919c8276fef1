//! `auxetica plugins`

use super::table::table;
use super::{Failure, print};
use crate::config::{Plugin, plugins};
use std::collections::BTreeMap;

#[derive(clap::Args)]
pub(super) struct Options {
    /// Plugin to explain.
    name: Option<String>,
}

pub(super) fn run(options: &Options) -> Result<(), Failure> {
    match &options.name {
        None => list(),
        Some(name) => explain(name),
    }
}

fn list() -> Result<(), Failure> {
    let mut slots: BTreeMap<&str, Vec<&Plugin>> = BTreeMap::new();
    for plugin in plugins() {
        slots.entry(plugin.slot).or_default().push(plugin);
    }
    let mut out = String::new();
    for (slot, plugins) in slots {
        out += &format!("{slot}:\n");
        for plugin in plugins {
            let summary = plugin
                .summary()
                .split_whitespace()
                .collect::<Vec<_>>()
                .join(" ");
            let sentence = summary
                .split_once(". ")
                .map_or(&*summary, |(first, _)| first);
            out += &format!("  {:<18} {}\n", plugin.name, sentence.trim_end_matches('.'));
        }
        out.push('\n');
    }
    print(&(out + "`auxetica plugins NAME` explains one."))
}

fn explain(name: &str) -> Result<(), Failure> {
    let found: Vec<_> = plugins().filter(|p| p.name == name).collect();
    if found.is_empty() {
        let known: Vec<_> = plugins().map(|p| p.name).collect();
        return Err(Failure::Unknown(format!(
            "there is no plugin named `{name}`; there are {}",
            known.join(", ")
        )));
    }
    for plugin in found {
        print(&format!(
            "{} ({}, in `{}:`; crate {})\n\n{}\n\nSource: {}\nExample: {}\n",
            plugin.name,
            plugin.noun,
            plugin.slot,
            plugin.package,
            plugin.summary(),
            plugin.source,
            plugin.example
        ))?;
        let fields = plugin.fields();
        if !fields.is_empty() {
            let rows = fields.into_iter().map(|f| {
                let default = f
                    .default
                    .unwrap_or_else(|| if f.required { "required" } else { "optional" }.to_owned());
                let doc = f.doc.split_whitespace().collect::<Vec<_>>().join(" ");
                vec![f.name, f.type_words, default, doc]
            });
            print(&table(&["field", "type", "default", "meaning"], rows))?;
        }
    }
    Ok(())
}
