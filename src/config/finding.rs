//! What is wrong at a span of some text, before it is known which file the text came from.

use std::ops::Range;

/// A range of bytes.
pub(crate) type Span = Range<usize>;

/// A fault, its place in the text that was examined, and a remedy.
#[derive(Clone, Debug, PartialEq)]
pub(crate) struct Finding {
    pub span: Span,
    pub message: String,
    pub hint: Option<String>,
}

/// Stands in front of a finding that travels through ron as a plain error message.
const MARK: char = '\u{1f}';

impl Finding {
    pub fn new(span: Span, message: impl Into<String>) -> Self {
        Self {
            span,
            message: message.into(),
            hint: None,
        }
    }

    pub fn hint(mut self, hint: impl Into<String>) -> Self {
        self.hint = Some(hint.into());
        self
    }

    pub fn shifted(mut self, by: usize) -> Self {
        self.span = self.span.start + by..self.span.end + by;
        self
    }

    /// Writes the finding as one message, since ron carries nothing but text out of a nested
    /// `Deserialize`; [`Finding::unpack`] reads it again.
    pub fn pack(&self) -> String {
        let hint = self.hint.as_deref().unwrap_or_default();
        let Span { start, end } = self.span;
        format!("{MARK}{start}{MARK}{end}{MARK}{}{MARK}{hint}", self.message)
    }

    pub fn unpack(message: &str) -> Option<Self> {
        let mut parts = message.strip_prefix(MARK)?.split(MARK);
        let span = parts.next()?.parse().ok()?..parts.next()?.parse().ok()?;
        let message = parts.next()?.to_owned();
        let hint = parts
            .next()
            .filter(|hint| !hint.is_empty())
            .map(str::to_owned);
        Some(Self {
            span,
            message,
            hint,
        })
    }
}
