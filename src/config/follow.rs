//! Following a path through a scanned text to the places that it means.

use crate::finding::{Finding, Span};
use crate::node::{Body, Entry, Node};
use crate::path::{self, Kind, Step};
use crate::suggest;

/// Where an override goes.
#[derive(Debug, PartialEq)]
pub(crate) enum Target {
    /// Over the value at this span.
    Replace(Span),
    /// Into a bracket, as a new part of it.
    Insert {
        at: usize,
        after_another: bool,
        key: Key,
    },
}

/// What stands before an inserted value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub(crate) enum Key {
    /// Nothing: an element of a list.
    None,
    /// A field name.
    Bare,
    /// A map key, a quoted string.
    Quoted,
}

/// The targets of a path, in the order of the text. A finding's span lies in the path's text.
pub(crate) fn targets(text: &str, root: &Node, steps: &[Step]) -> Result<Vec<Target>, Finding> {
    let mut found = Vec::new();
    Follower { text, root }.follow(root, steps, &mut found)?;
    Ok(found)
}

struct Follower<'a> {
    text: &'a str,
    root: &'a Node,
}

impl Follower<'_> {
    fn follow(&self, node: &Node, steps: &[Step], found: &mut Vec<Target>) -> Result<(), Finding> {
        let Some((step, later)) = steps.split_first() else {
            found.push(Target::Replace(node.span.clone()));
            return Ok(());
        };
        match (&step.kind, &node.body) {
            // `Some(..)` and other wrappers of one value are passed through.
            (Kind::Name(_) | Kind::Key(_), Body::Tuple(items)) if items.len() == 1 => {
                self.follow(&items[0], steps, found)
            }
            (Kind::Name(name), Body::Struct(entries)) => {
                self.named(node, entries, name, Key::Bare, step, later, found)
            }
            (Kind::Name(name) | Kind::Key(name), Body::Map(entries)) => {
                self.named(node, entries, name, Key::Quoted, step, later, found)
            }
            (Kind::Index(index), Body::List(items) | Body::Tuple(items)) => match items.get(*index)
            {
                Some(item) => self.follow(item, later, found),
                None => Err(self.fault(
                    node,
                    step,
                    &format!("has no [{index}]"),
                    &holds(items.len()),
                )),
            },
            (Kind::Every, Body::List(items) | Body::Tuple(items)) if !items.is_empty() => {
                self.every(items.iter(), later, found)
            }
            (Kind::Every, Body::Map(entries)) if !entries.is_empty() => {
                self.every(entries.iter().map(|entry| &entry.value), later, found)
            }
            (Kind::Every, Body::List(_) | Body::Map(_)) => {
                Err(self.fault(node, step, "is empty", "`*` needs at least one element"))
            }
            (Kind::Push, Body::List(items)) if later.is_empty() => {
                found.push(insert(
                    node,
                    items.last().map(|item| item.span.end),
                    Key::None,
                ));
                Ok(())
            }
            (Kind::Push, Body::List(_)) => Err(self.fault(
                node,
                step,
                "is not gone into by `[+]`",
                "append one whole value: `list[+]=value`",
            )),
            _ => Err(self.fault(node, step, self.nature(node), "set the whole value instead")),
        }
    }

    /// Follows all elements. If some of them have the value already, those that don't are not meant.
    fn every<'n>(
        &self,
        items: impl Iterator<Item = &'n Node>,
        later: &[Step],
        found: &mut Vec<Target>,
    ) -> Result<(), Finding> {
        let (mut all, mut faults) = (Vec::new(), Vec::new());
        for item in items {
            faults.extend(self.follow(item, later, &mut all).err());
        }
        let there = |target: &Target| matches!(target, Target::Replace(_));
        if all.iter().any(there) {
            all.retain(there);
        } else if !faults.is_empty() {
            return Err(faults.swap_remove(0));
        }
        found.extend(all);
        Ok(())
    }

    #[expect(
        clippy::too_many_arguments,
        reason = "one case of `follow`, which knows all of these"
    )]
    fn named(
        &self,
        node: &Node,
        entries: &[Entry],
        name: &str,
        key: Key,
        step: &Step,
        later: &[Step],
        found: &mut Vec<Target>,
    ) -> Result<(), Finding> {
        let names: Vec<_> = entries
            .iter()
            .map(|e| path::key_name(&self.text[e.key.clone()]))
            .collect();
        if let Some(place) = names.iter().position(|known| *known == name) {
            return self.follow(&entries[place].value, later, found);
        }
        if later.is_empty() {
            found.push(insert(node, entries.last().map(|e| e.span().end), key));
            return Ok(());
        }
        Err(self.fault(
            node,
            step,
            &format!("has no `{name}`"),
            &suggest::remedy(name, &names, "it has"),
        ))
    }

    fn fault(&self, node: &Node, step: &Step, what: &str, hint: &str) -> Finding {
        let place = match path::naming(self.text, self.root, node.span.start) {
            path if path.is_empty() => "the scenario".to_owned(),
            path => format!("`{path}`"),
        };
        Finding::new(step.span.clone(), format!("{place} {what}")).hint(hint)
    }

    fn nature(&self, node: &Node) -> &'static str {
        match node.body {
            Body::Leaf => "is a single value without parts",
            Body::Struct(_) => "has named fields: they are chosen by `.name`",
            Body::Tuple(_) | Body::List(_) => "has numbered elements: they are chosen by `[0]`",
            Body::Map(_) => "is a map: its values are chosen by `[\"key\"]`",
        }
    }
}

fn holds(count: usize) -> String {
    match count {
        0 => "it is empty; `[+]` appends".to_owned(),
        _ => format!("it holds [0] to [{}]; `[+]` appends", count - 1),
    }
}

fn insert(node: &Node, last: Option<usize>, key: Key) -> Target {
    Target::Insert {
        at: last.unwrap_or(node.span.end - 1),
        after_another: last.is_some(),
        key,
    }
}
