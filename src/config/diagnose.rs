//! From ron's errors to findings that say what is allowed and what was probably meant.

use ron::error::{Error, Position, SpannedError};

use crate::finding::{Finding, Span};
use crate::literal;
use crate::node::{Body, Node, ended, smallest};
use crate::suggest;

/// What a refusal by ron means. `root` is the scanned `text`.
pub(crate) fn diagnose(text: &str, root: &Node, error: &SpannedError) -> Finding {
    let start = offset(text, error.span.start);
    let end = offset(text, error.span.end);
    let taken = taken(text, root, start..end.max(start));
    let next = next(text, root, end);
    match &error.code {
        Error::NoSuchStructField {
            expected,
            found,
            outer,
        } => Finding::new(
            taken,
            format!("unknown field `{found}`{}", inside(outer.as_ref())),
        )
        .hint(suggest::remedy(found, expected, "allowed fields")),
        Error::NoSuchEnumVariant {
            expected,
            found,
            outer,
        } => Finding::new(
            taken,
            format!("`{found}` is not one of the choices{}", of(outer.as_ref())),
        )
        .hint(suggest::remedy(found, expected, "allowed")),
        Error::MissingStructField { field, outer } => {
            let bracket = smallest(root, &|node| is_bracket(node) && node.span.contains(&end));
            let message = format!("missing field `{field}`{}", inside(outer.as_ref()));
            Finding::new(bracket.map_or(next, head), message).hint(format!("add `{field}: ..`"))
        }
        Error::DuplicateStructField { field, .. } => {
            Finding::new(taken, format!("field `{field}` is given twice"))
                .hint("remove one of them")
        }
        Error::ExpectedDifferentStructName { expected, found } => {
            Finding::new(next, format!("expected `{expected}`, found `{found}`")).hint(format!(
                "write `{expected}(..)`, or the bracket without a name"
            ))
        }
        Error::InvalidValueForType { expected, found } => {
            Finding::new(taken, format!("expected {expected}, found {found}"))
        }
        Error::ExpectedDifferentLength { expected, found } => {
            let bracket = smallest(root, &|node| is_bracket(node) && node.span.contains(&end));
            let span = bracket.map_or(next, |node| node.span.clone());
            let wanted = length(expected);
            Finding::new(span, format!("expected {wanted}, found {found}"))
                .hint(format!("give {wanted} in the bracket"))
        }
        Error::Message(message) => match Finding::unpack(message) {
            Some(packed) => {
                packed.shifted(ended(root, end).map_or(taken.start, |node| node.span.start))
            }
            None => with_remedy(taken, message),
        },
        code @ Error::ExpectedNamedStructLike(name) => {
            // The name has been taken by then, if there is one.
            let named = ended(root, end).filter(|node| text[node.span.clone()] == **name);
            expected(text, named.map_or(next, |node| node.span.clone()), code)
        }
        code => expected(text, next, code),
    }
}

/// "3 values" for serde's "an array of length 3" and "a tuple of size 3".
fn length(expected: &str) -> String {
    match expected
        .rsplit(' ')
        .next()
        .and_then(|word| word.parse::<usize>().ok())
    {
        Some(1) => "1 value".to_owned(),
        Some(count) => format!("{count} values"),
        None => expected.to_owned(),
    }
}

/// A message of a `Deserialize` may carry its remedy after `; `, as those of this crate do.
fn with_remedy(span: Span, message: &str) -> Finding {
    match message.split_once("; ") {
        Some((message, hint)) => Finding::new(span, message).hint(hint),
        None => Finding::new(span, message),
    }
}

/// Errors that ron raises before it has taken the offending value.
fn expected(text: &str, span: Span, code: &Error) -> Finding {
    let found = match &text[span.clone()] {
        "" => "the end of the text".to_owned(),
        found if found.chars().count() > 40 || found.contains('\n') => "something else".to_owned(),
        found => format!("`{found}`"),
    };
    let name;
    let doubled = found.starts_with("`(") && text[..span.start].trim_end().ends_with('(');
    let (what, hint) = match code {
        Error::ExpectedFloat if doubled => ("a number", "one pair of brackets is enough here"),
        Error::ExpectedFloat => ("a number", "for example 0.5, -2 or 1e-9"),
        Error::ExpectedInteger => ("a whole number", "for example 25"),
        Error::ExpectedBoolean => ("`true` or `false`", "write it without quotes"),
        Error::ExpectedString => ("a text", "texts stand in double quotes: \"like this\""),
        Error::ExpectedArray => ("a list", "lists stand in square brackets: [1, 2, 3]"),
        Error::ExpectedMap => ("a map", "maps stand in curly brackets: {\"key\": value}"),
        Error::ExpectedStructLike => ("`(`", "write the values in round brackets: (..)"),
        Error::ExpectedNamedStructLike(named) => {
            name = format!("`{named}(..)` or `(..)`");
            (
                name.as_str(),
                "round brackets are needed, even if nothing stands in them",
            )
        }
        Error::ExpectedStructLikeEnd => ("`)`", "are there more values than allowed?"),
        Error::ExpectedIdentifier => ("a name", "names are written without quotes"),
        code => return Finding::new(span, lower_first(&code.to_string())),
    };
    Finding::new(span, format!("expected {what}, found {found}")).hint(hint)
}

fn lower_first(message: &str) -> String {
    let mut chars = message.chars();
    chars.next().map_or_else(String::new, |first| {
        first.to_lowercase().chain(chars).collect()
    })
}

fn inside(outer: Option<&String>) -> String {
    outer.map_or_else(String::new, |name| format!(" in `{name}`"))
}

fn of(outer: Option<&String>) -> String {
    outer.map_or_else(String::new, |name| format!(" of `{name}`"))
}

/// The byte at a position of ron, whose columns count characters.
fn offset(text: &str, position: Position) -> usize {
    let line_start = match position.line {
        1 => 0,
        line => text
            .match_indices('\n')
            .nth(line - 2)
            .map_or(text.len(), |(at, _)| at + 1),
    };
    let line = &text[line_start..];
    line.char_indices()
        .nth(position.col - 1)
        .map_or(text.len(), |(at, _)| line_start + at)
}

/// What ron had just taken. A closing bracket stands for the whole value that it closes.
fn taken(text: &str, root: &Node, span: Span) -> Span {
    let word = text[span.clone()].trim();
    if word.is_empty() {
        return ended(root, span.end).map_or(span, |node| node.span.clone());
    }
    let start = span.start + text[span.clone()].find(word).unwrap_or(0);
    let end = start + word.len();
    let closes = word.ends_with([')', ']', '}']);
    let whole = |node: &Node| match node.body {
        // ron may take a sign or a quotation mark before the rest.
        Body::Leaf => node.span.contains(&start),
        _ => closes && node.span.end == end,
    };
    smallest(root, &whole).map_or(start..end, |node| node.span.clone())
}

/// The value that begins at `at` or after it, else the token there.
fn next(text: &str, root: &Node, at: usize) -> Span {
    let rest = &text[at..];
    let start = at + rest.len() - rest.trim_start().len();
    match smallest(root, &|node| node.span.start == start) {
        Some(node) => node.span.clone(),
        None => start..start + literal::token(&text[start..]),
    }
}

/// The name before a bracket, or the bracket itself.
fn head(node: &Node) -> Span {
    node.name
        .clone()
        .unwrap_or_else(|| node.span.start..node.span.start + 1)
}

fn is_bracket(node: &Node) -> bool {
    !matches!(node.body, Body::Leaf)
}
