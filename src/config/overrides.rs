//! One value put in place of another: `--set path=value`, or an entry of a derived file.

use std::sync::Arc;

use crate::finding::{Finding, Span};
use crate::follow::{self, Key, Target};
use crate::literal;
use crate::patchwork::{Origin, Patchwork, Piece};
use crate::path;
use crate::problem::Problem;
use crate::scan;

/// A path and a value, both as spans of the origin that gives them.
pub(crate) struct Override {
    pub origin: Arc<Origin>,
    pub path: Span,
    pub value: Span,
}

impl Override {
    /// Reads `path=value`.
    pub fn from_set(set: &str) -> Result<Self, Problem> {
        let origin = Arc::new(Origin {
            name: format!("--set {set}"),
            text: set.to_owned(),
        });
        let fault = |finding| Problem::at(&origin, None, finding);
        let (_, length) = path::read(set).map_err(fault)?;
        let path_end = length + set[length..].len() - set[length..].trim_start().len();
        if !set[path_end..].starts_with('=') {
            let end = path_end + literal::token(&set[path_end..]);
            let finding = Finding::new(path_end..end, "expected `=` and a value after the path")
                .hint("for example `--set rods[0].length=0.1`");
            return Err(fault(finding));
        }
        let start = path_end + 1;
        let node = scan::single_value(&set[start..]).map_err(|finding| {
            fault(
                finding
                    .shifted(start)
                    .hint("the value is written as in a scenario: 0.1, (0, 0, 1), \"text\""),
            )
        })?;
        let value = node.span.start + start..node.span.end + start;
        Ok(Self {
            origin,
            path: 0..length,
            value,
        })
    }

    /// Puts the value into the text, at every place that the path means.
    pub fn apply(&self, patchwork: &Patchwork) -> Result<Patchwork, Problem> {
        let fault =
            |finding: Finding| Problem::at(&self.origin, None, finding.shifted(self.path.start));
        let path = &self.origin.text[self.path.clone()];
        let (steps, length) = path::read(path).map_err(fault)?;
        if length < path.len() {
            let finding = Finding::new(
                length..path.len(),
                "this part of the path is not understood",
            );
            return Err(fault(finding));
        }
        let root =
            scan::document(patchwork.text()).map_err(|f| Problem::within(patchwork, None, f))?;
        let mut targets = follow::targets(patchwork.text(), &root, &steps).map_err(fault)?;
        // From the end of the text, so that the spans still to come stay true.
        let mut patched = None;
        while let Some(target) = targets.pop() {
            let last_step = &steps[steps.len() - 1].span;
            let (span, pieces) = self.pieces(target, last_step);
            patched = Some(patched.as_ref().unwrap_or(patchwork).splice(span, pieces));
        }
        Ok(patched.expect("a path that leads nowhere is a fault"))
    }

    fn pieces(&self, target: Target, last_step: &Span) -> (Span, Vec<Piece>) {
        let value = Piece::slice(&self.origin, self.value.clone());
        match target {
            Target::Replace(span) => (span, vec![value]),
            Target::Insert {
                at,
                after_another,
                key,
            } => {
                let name = self.path.start + last_step.start..self.path.start + last_step.end;
                let mark = |text: &str| Piece::mark(text, &self.origin, name.start);
                let mut pieces = Vec::new();
                if after_another {
                    pieces.push(mark(", "));
                }
                match key {
                    Key::None => {}
                    Key::Bare => {
                        pieces.extend([Piece::slice(&self.origin, name.clone()), mark(": ")])
                    }
                    Key::Quoted => {
                        let name = self.origin.text[name.clone()].trim_matches(['"', '\'']);
                        pieces.push(mark(&format!("\"{name}\": ")));
                    }
                }
                pieces.push(value);
                (at..at, pieces)
            }
        }
    }
}
