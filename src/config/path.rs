//! Paths such as `rods[0].length`: reading them, and naming the place of a byte by one.

use crate::finding::{Finding, Span};
use crate::node::{Body, Entry, Node};

/// One step of a path, and where it stands in the path's text.
#[derive(Debug)]
pub(crate) struct Step {
    pub span: Span,
    pub kind: Kind,
}

/// How a step chooses among the parts of a value.
#[derive(Debug, PartialEq)]
pub(crate) enum Kind {
    /// `.name`: a field of a struct, or a string key of a map.
    Name(String),
    /// `[2]`: an element of a list or tuple.
    Index(usize),
    /// `["name"]`: a string key of a map.
    Key(String),
    /// `[*]`: every element of a list, every value of a map.
    Every,
    /// `[+]`: the place after the last element of a list.
    Push,
}

/// Reads a path from the beginning of `text`; returns its steps and its length in bytes.
pub(crate) fn read(text: &str) -> Result<(Vec<Step>, usize), Finding> {
    let mut steps = Vec::new();
    let mut at = 0;
    loop {
        let rest = &text[at..];
        let (kind, inside, length) = if let Some(inner) = rest.strip_prefix('[') {
            let (kind, length) = bracketed(inner).ok_or_else(|| {
                Finding::new(at..at + 1, "this index is not understood").hint(
                    "an index is `[2]`, `[\"key\"]`, `[*]` for all of them, or `[+]` for one more",
                )
            })?;
            (kind, at + 1..at + length, length + 1)
        } else {
            let dot = usize::from(!steps.is_empty() && rest.starts_with('.'));
            let word = &rest[dot..];
            let length = word
                .find(|c: char| !(c.is_alphanumeric() || c == '_' || c == '*'))
                .unwrap_or(word.len());
            if length == 0 || (dot == 0 && !steps.is_empty()) {
                break;
            }
            let start = at + dot;
            (named(&word[..length]), start..start + length, dot + length)
        };
        steps.push(Step { span: inside, kind });
        at += length;
    }
    if steps.is_empty() {
        return Err(Finding::new(0..text.len().min(1), "a path is missing here")
            .hint("paths look like `rods[0].length`, `laws[*].apply.factor`, `inputs[\"name\"]`"));
    }
    Ok((steps, at))
}

fn named(word: &str) -> Kind {
    match word {
        "*" => Kind::Every,
        _ => word
            .parse()
            .map_or_else(|_| Kind::Name(word.to_owned()), Kind::Index),
    }
}

/// What stands in brackets, and its length up to and including the closing one.
fn bracketed(inner: &str) -> Option<(Kind, usize)> {
    if let Some(mark) = inner.chars().next().filter(|c| matches!(c, '"' | '\'')) {
        let end = inner[1..].find(mark)? + 1;
        let closed = inner[end + 1..].starts_with(']');
        return closed.then(|| (Kind::Key(inner[1..end].to_owned()), end + 2));
    }
    let end = inner.find(']')?;
    let kind = match &inner[..end] {
        "*" => Kind::Every,
        "+" => Kind::Push,
        index => Kind::Index(index.parse().ok()?),
    };
    Some((kind, end + 1))
}

/// The text of a key without the quotes of a string.
pub(crate) fn key_name(key: &str) -> &str {
    key.strip_prefix('"')
        .and_then(|key| key.strip_suffix('"'))
        .unwrap_or(key)
}

/// The path of the innermost value or field that holds byte `at`; empty for the root.
pub(crate) fn naming(text: &str, root: &Node, at: usize) -> String {
    let mut path = String::new();
    let mut node = root;
    while let Some(next) = step_into(text, node, at, &mut path) {
        node = next;
    }
    path
}

fn step_into<'n>(text: &str, node: &'n Node, at: usize, path: &mut String) -> Option<&'n Node> {
    let entry_here = |entries: &'n [Entry]| entries.iter().find(|e| e.span().contains(&at));
    match &node.body {
        Body::Leaf => None,
        Body::Struct(entries) => {
            let entry = entry_here(entries)?;
            if !path.is_empty() {
                path.push('.');
            }
            path.push_str(&text[entry.key.clone()]);
            Some(&entry.value)
        }
        Body::Map(entries) => {
            let entry = entry_here(entries)?;
            path.push_str(&format!("[{}]", &text[entry.key.clone()]));
            Some(&entry.value)
        }
        Body::Tuple(items) | Body::List(items) => {
            let index = items.iter().position(|item| item.span.contains(&at))?;
            // `Some(..)` and other wrappers are passed through, as they are when a path is followed.
            if !(node.name.is_some() && items.len() == 1) {
                path.push_str(&format!("[{index}]"));
            }
            Some(&items[index])
        }
    }
}
