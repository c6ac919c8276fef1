//! `auxetica plugins`

use super::table::{bare, words};
use super::{Failure, print};
use crate::config::{Plugin, plugins, remedy};
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
        let row = |plugin: &Plugin| {
            let summary = one_line(&plugin.summary());
            let sentence = summary
                .split_once(". ")
                .map_or(&*summary, |(first, _)| first);
            let sentence = sentence.trim_end_matches('.').to_owned();
            vec![format!("{:<16}", plugin.name), sentence]
        };
        out += &format!("{slot}:\n{}\n\n", bare(plugins.into_iter().map(row)));
    }
    print(&(out + "`auxetica plugins NAME` explains one."))
}

fn explain(name: &str) -> Result<(), Failure> {
    let found: Vec<_> = plugins().filter(|p| p.name == name).collect();
    if found.is_empty() {
        let known: Vec<_> = plugins().map(|p| p.name).collect();
        return Err(Failure::Unknown(format!(
            "there is no plugin named `{name}`; {}",
            remedy(name, &known, "known")
        )));
    }
    for plugin in found {
        print(&format!(
            "{} ({}, in `{}:`; crate {})\n\n{}\n\nSource: {}\nExample: {}\n",
            plugin.name,
            plugin.noun,
            plugin.slot,
            plugin.package,
            bare([vec![one_line(&plugin.summary())]]),
            plugin.source,
            plugin.example
        ))?;
        let fields = plugin.fields();
        if !fields.is_empty() {
            let rows = fields.into_iter().map(|f| {
                let default = f
                    .default
                    .unwrap_or_else(|| if f.required { "required" } else { "optional" }.to_owned());
                vec![f.name, f.type_words, default, one_line(&f.doc)]
            });
            print(&words(&["field", "type", "default", "meaning"], rows))?;
        }
    }
    Ok(())
}

fn one_line(text: &str) -> String {
    text.split_whitespace().collect::<Vec<_>>().join(" ")
}
