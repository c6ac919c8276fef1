//! What a scanned text consists of: values inside values, each with its span.

use crate::finding::Span;

/// A value: `span` includes the name in front of a bracket, as in `Gravity(..)`.
#[derive(Debug)]
pub(crate) struct Node {
    pub span: Span,
    pub name: Option<Span>,
    pub body: Body,
}

/// What a value is made of.
#[derive(Debug)]
pub(crate) enum Body {
    /// A number, string, character or bare word.
    Leaf,
    /// `(key: value, ..)`, and also `()`.
    Struct(Vec<Entry>),
    /// `(value, ..)`
    Tuple(Vec<Node>),
    /// `[value, ..]`
    List(Vec<Node>),
    /// `{key: value, ..}`
    Map(Vec<Entry>),
}

impl Node {
    /// The node and all that it holds, the outer before the inner.
    pub fn and_below(&self) -> Vec<&Node> {
        let inner: Vec<_> = match &self.body {
            Body::Leaf => Vec::new(),
            Body::Struct(entries) | Body::Map(entries) => {
                entries.iter().map(|entry| &entry.value).collect()
            }
            Body::Tuple(items) | Body::List(items) => items.iter().collect(),
        };
        std::iter::once(self)
            .chain(inner.into_iter().flat_map(Node::and_below))
            .collect()
    }
}

/// A `key: value` pair.
#[derive(Debug)]
pub(crate) struct Entry {
    pub key: Span,
    pub value: Node,
}

impl Entry {
    pub fn span(&self) -> Span {
        self.key.start..self.value.span.end
    }
}

/// The innermost node that fits, of those that lie inside one another.
pub(crate) fn smallest<'n>(root: &'n Node, fits: &dyn Fn(&Node) -> bool) -> Option<&'n Node> {
    root.and_below().into_iter().rfind(|node| fits(node))
}

/// The value that ends at `at` or last before it.
pub(crate) fn ended(root: &Node, at: usize) -> Option<&Node> {
    let before = root
        .and_below()
        .into_iter()
        .filter(|node| node.span.end <= at);
    before.max_by_key(|node| node.span.end)
}
