//! Finding every problem of a text although ron stops at the first: the offending part is made
//! harmless, keeping all positions, and the text is read again.

use ron::error::SpannedError;

use crate::diagnose::diagnose;
use crate::finding::{Finding, Span};
use crate::node::{Body, Entry, Node, smallest};
use crate::scan;

/// No reader wants more at once.
pub(crate) const MOST: usize = 16;

/// All findings in `text`, of which `error` is the first. `read` reads a repaired text.
pub(crate) fn findings(
    text: &str,
    mut error: SpannedError,
    mut read: impl FnMut(&str) -> Option<SpannedError>,
) -> Vec<Finding> {
    let mut text = text.to_owned();
    let mut findings: Vec<Finding> = Vec::new();
    let mut misspelt = false;
    while findings.len() < MOST {
        let Ok(root) = scan::document(&text) else {
            break;
        };
        let finding = diagnose(&text, &root, &error);
        let repeated = findings
            .iter()
            .any(|earlier| earlier.span.start == finding.span.start);
        // A field is missing because its misspelling was cut out.
        if repeated || (misspelt && finding.message.starts_with("missing field")) {
            break;
        }
        misspelt |= finding
            .hint
            .as_deref()
            .is_some_and(|hint| hint.starts_with("did you mean"));
        let repaired = repaired(&text, &root, &finding.span);
        findings.push(finding);
        let Some(next) = repaired else { break };
        text = next;
        match read(&text) {
            Some(next) => error = next,
            None => break,
        }
    }
    findings
}

/// The text with an unknown field blanked out, or a refused leaf made 1.
fn repaired(text: &str, root: &Node, span: &Span) -> Option<String> {
    if let Some(entry) = entry_named_at(root, span) {
        let after = &text[entry.span().end..];
        let blank = after.len() - after.trim_start().len();
        let comma = if after[blank..].starts_with(',') {
            blank + 1
        } else {
            0
        };
        return Some(padded(
            text,
            entry.span().start..entry.span().end + comma,
            "",
        ));
    }
    let leaf = smallest(root, &|node| node.span == *span)?;
    matches!(leaf.body, Body::Leaf).then(|| padded(text, span.clone(), "1"))
}

/// `text` with `span` replaced by `with` and spaces, every line end kept.
fn padded(text: &str, span: Span, with: &str) -> String {
    let blanks = &text.as_bytes()[span.start + with.len()..span.end];
    let blanks: String = blanks
        .iter()
        .map(|byte| if *byte == b'\n' { '\n' } else { ' ' })
        .collect();
    format!("{}{with}{blanks}{}", &text[..span.start], &text[span.end..])
}

fn entry_named_at<'n>(root: &'n Node, key: &Span) -> Option<&'n Entry> {
    root.and_below()
        .into_iter()
        .find_map(|node| match &node.body {
            Body::Struct(entries) => entries.iter().find(|entry| entry.key == *key),
            _ => None,
        })
}
