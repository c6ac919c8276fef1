//! Plugins: types that any crate registers for a hook, found by the name written in a scenario.

use std::any::{Any, TypeId};

use ron::error::SpannedError;

use crate::finding::Finding;
use crate::literal;
use crate::repair;
use crate::scan;
use crate::suggest;

/// A trait whose implementations are plugins: `impl Hook for dyn Forcing { .. }`.
pub trait Hook: 'static {
    /// What one plugin is called, in the singular: "forcing".
    const NOUN: &'static str;
    /// The field of a scenario that takes such plugins: "forcing".
    const SLOT: &'static str;
}

/// Reads a plugin from its RON text; the `Any` holds a `Box<dyn Trait>`.
pub type Build = fn(&ron::Options, &str) -> Result<Box<dyn Any>, SpannedError>;

/// A registered plugin. [`register!`](crate::register) makes these.
#[derive(Debug)]
pub struct Plugin {
    /// The name of the type, by which scenarios call it.
    pub name: &'static str,
    /// The trait object type that is built.
    pub hook: fn() -> TypeId,
    /// [`Hook::NOUN`] of the hook.
    pub noun: &'static str,
    /// [`Hook::SLOT`] of the hook.
    pub slot: &'static str,
    /// A use that works, as written in a scenario.
    pub example: &'static str,
    /// The paper and equation that it follows.
    pub source: &'static str,
    /// The crate that registers it.
    pub package: &'static str,
    /// Its fields, with their types and meaning.
    pub schema: fn() -> schemars::Schema,
    /// Reads it from text.
    pub build: Build,
}

inventory::collect!(Plugin);

/// Registers a plugin: a type that derives `serde::Deserialize` (with `deny_unknown_fields`) and
/// `schemars::JsonSchema` and implements the trait of a hook.
///
/// The crate that uses it needs `serde` and `schemars` for the derives, nothing else; see the crate's
/// front page for an example.
#[macro_export]
macro_rules! register {
    (dyn $hook:path: $plugin:ident, example = $example:expr, source = $source:expr $(,)?) => {
        $crate::inventory::submit! {
            $crate::Plugin {
                name: ::core::stringify!($plugin),
                hook: ::core::any::TypeId::of::<dyn $hook>,
                noun: <dyn $hook as $crate::Hook>::NOUN,
                slot: <dyn $hook as $crate::Hook>::SLOT,
                example: $example,
                source: $source,
                package: ::core::env!("CARGO_PKG_NAME"),
                schema: || $crate::schemars::schema_for!($plugin),
                build: |options, text| {
                    let plugin: $plugin = options.from_str(text)?;
                    let plugin: ::std::boxed::Box<dyn $hook> = ::std::boxed::Box::new(plugin);
                    ::core::result::Result::Ok(::std::boxed::Box::new(plugin))
                },
            }
        }
    };
}

/// All plugins linked into this program, by noun, then name.
pub fn plugins() -> impl Iterator<Item = &'static Plugin> {
    let mut plugins: Vec<_> = inventory::iter::<Plugin>.into_iter().collect();
    plugins.sort_by_key(|plugin| (plugin.noun, plugin.name, plugin.package));
    plugins.into_iter()
}

/// Builds the plugin that `text` names. The spans of the findings lie in `text`.
pub(crate) fn build<H: ?Sized + Hook>(
    text: &str,
    options: &ron::Options,
) -> Result<Box<H>, Vec<Finding>> {
    let node = scan::single_value(text).map_err(|finding| vec![finding])?;
    let is_word = |word: &str| word.starts_with(|c: char| c.is_alphabetic() || c == '_');
    let head = node.name.clone().unwrap_or_else(|| node.span.clone());
    let name = &text[head.clone()];
    if !is_word(name) {
        let known = names::<H>();
        let end = head.start + literal::token(&text[head.start..]);
        let message = format!("a {} begins with its name, as in `Name(..)`", H::NOUN);
        return Err(vec![
            Finding::new(head.start..end, message)
                .hint(format!("known: {}", suggest::quoted(&known))),
        ]);
    }
    let plugin =
        find::<H>(name).map_err(|(message, hint)| vec![Finding::new(head, message).hint(hint)])?;
    let built = (plugin.build)(options, text).map_err(|error| {
        repair::findings(text, error, |draft| (plugin.build)(options, draft).err())
    })?;
    Ok(*built
        .downcast()
        .expect("a plugin is built for the hook that it is registered for"))
}

fn names<H: ?Sized + Hook>() -> Vec<&'static str> {
    plugins()
        .filter(|p| (p.hook)() == TypeId::of::<H>())
        .map(|p| p.name)
        .collect()
}

/// The one plugin of that name for the hook, or a message and its remedy.
fn find<H: ?Sized + Hook>(name: &str) -> Result<&'static Plugin, (String, String)> {
    let (mine, other): (Vec<_>, Vec<_>) = plugins()
        .filter(|plugin| plugin.name == name)
        .partition(|plugin| (plugin.hook)() == TypeId::of::<H>());
    match (mine.as_slice(), other.first()) {
        ([plugin], _) => Ok(plugin),
        ([], Some(elsewhere)) => Err((
            format!("`{name}` is a {}, not a {}", elsewhere.noun, H::NOUN),
            format!("put it under `{}:`", elsewhere.slot),
        )),
        ([], None) => Err((
            format!("there is no {} named `{name}`", H::NOUN),
            suggest::remedy(name, &names::<H>(), "known"),
        )),
        (several, _) => {
            let packages: Vec<_> = several.iter().map(|plugin| plugin.package).collect();
            Err((
                format!("several crates register a {} named `{name}`", H::NOUN),
                format!("use one of them only: {}", suggest::quoted(&packages)),
            ))
        }
    }
}
