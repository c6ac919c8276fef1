//! What is wrong with a scenario, said so that it can be mended.

use std::fmt;
use std::sync::Arc;

use annotate_snippets::{AnnotationKind, Level, Renderer, Snippet};

use crate::finding::{Finding, Span};
use crate::patchwork::{Origin, Patchwork};

/// One fault of a scenario: where it is, what it is, and what to do.
#[derive(Clone, Debug, PartialEq)]
pub struct Problem {
    /// The file, or the `--set ..`, in which the fault was written; empty if it lies in no text.
    pub origin: String,
    /// Line in the origin, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// The field at fault, such as `rods[0].length`.
    pub path: Option<String>,
    /// What is wrong.
    pub message: String,
    /// What to do about it.
    pub hint: Option<String>,
    place: Option<Box<(Arc<Origin>, Span)>>,
}

impl Problem {
    /// A problem that lies in no text, such as a file that cannot be read.
    pub fn new(message: impl Into<String>) -> Self {
        Self {
            origin: String::new(),
            line: 0,
            column: 0,
            path: None,
            message: message.into(),
            hint: None,
            place: None,
        }
    }

    /// The same problem with a remedy.
    #[must_use]
    pub fn with_hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }

    pub(crate) fn at(origin: &Arc<Origin>, path: Option<String>, finding: Finding) -> Self {
        let span = char_bounds(&origin.text, finding.span);
        let before = &origin.text[..span.start];
        let line_start = before.rfind('\n').map_or(0, |newline| newline + 1);
        Self {
            origin: origin.name.clone(),
            line: 1 + before.matches('\n').count(),
            column: 1 + before[line_start..].chars().count(),
            path: path.filter(|path| !path.is_empty()),
            message: finding.message,
            hint: finding.hint,
            place: Some(Box::new((Arc::clone(origin), span))),
        }
    }

    pub(crate) fn within(patchwork: &Patchwork, path: Option<String>, finding: Finding) -> Self {
        let (origin, span) = patchwork.origin(&finding.span);
        Self::at(origin, path, Finding { span, ..finding })
    }

    /// The problem as a report with its source line, with or without colours.
    pub fn render(&self, color: bool) -> String {
        let label = self.path.as_ref().map(|path| format!("in `{path}`"));
        let mut group =
            Level::ERROR
                .primary_title(self.message.as_str())
                .elements(self.place.as_deref().map(|(origin, span)| {
                    let mark = AnnotationKind::Primary
                        .span(span.clone())
                        .label(label.as_deref());
                    Snippet::source(origin.text.as_str())
                        .path(origin.name.as_str())
                        .annotation(mark)
                }));
        if let Some(hint) = &self.hint {
            group = group.element(Level::HELP.message(hint.as_str()));
        }
        let renderer = if color {
            Renderer::styled()
        } else {
            Renderer::plain()
        };
        renderer.render(&[group])
    }
}

/// The span widened to whole characters and to at least one, as far as the text goes.
fn char_bounds(text: &str, span: Span) -> Span {
    let is_boundary = |at: &usize| text.is_char_boundary(*at);
    let start = (0..=span.start.min(text.len()))
        .rev()
        .find(is_boundary)
        .unwrap_or(0);
    let least = start + text[start..].chars().next().map_or(0, char::len_utf8);
    let end = (span.end..text.len())
        .find(is_boundary)
        .unwrap_or(text.len());
    start..end.max(least)
}

impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(false))
    }
}

impl std::error::Error for Problem {}

/// Everything found wrong with a scenario in one reading.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Problems(pub Vec<Problem>);

impl Problems {
    /// All problems one below the other, with or without colours.
    pub fn render(&self, color: bool) -> String {
        let reports: Vec<_> = self.0.iter().map(|problem| problem.render(color)).collect();
        reports.join("\n\n")
    }

    /// `Ok` if there is nothing wrong.
    pub fn into_result(self) -> Result<(), Self> {
        if self.0.is_empty() { Ok(()) } else { Err(self) }
    }

    /// Takes the value of a result, or keeps its problems and goes on.
    pub fn collect<T, E: Into<Self>>(&mut self, result: Result<T, E>) -> Option<T> {
        result
            .map_err(|problems| self.0.extend(problems.into().0))
            .ok()
    }
}

impl From<Problem> for Problems {
    fn from(problem: Problem) -> Self {
        Self(vec![problem])
    }
}

impl fmt::Display for Problems {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.render(false))
    }
}

impl std::error::Error for Problems {}
