//! A text put together from pieces of others, which remembers where each byte came from.

use std::sync::Arc;

use crate::finding::Span;

/// A text that was given to us: a file, an embedded scenario, or one `--set`.
#[derive(Debug, PartialEq)]
pub(crate) struct Origin {
    pub name: String,
    pub text: String,
}

/// Bytes of an origin, or marks such as `, ` put between them.
#[derive(Clone, Debug)]
pub(crate) struct Piece {
    text: String,
    origin: Arc<Origin>,
    offset: usize,
    /// Marks stand for one byte of the origin, the one that caused them.
    is_mark: bool,
}

impl Piece {
    pub fn slice(origin: &Arc<Origin>, span: Span) -> Self {
        let text = origin.text[span.clone()].to_owned();
        Self {
            text,
            origin: Arc::clone(origin),
            offset: span.start,
            is_mark: false,
        }
    }

    pub fn mark(text: impl Into<String>, origin: &Arc<Origin>, offset: usize) -> Self {
        Self {
            text: text.into(),
            origin: Arc::clone(origin),
            offset,
            is_mark: true,
        }
    }

    fn cut(&self, span: Span) -> Self {
        Self {
            text: self.text[span.clone()].to_owned(),
            origin: Arc::clone(&self.origin),
            offset: self.origin_offset(span.start),
            is_mark: self.is_mark,
        }
    }

    fn origin_offset(&self, at: usize) -> usize {
        self.offset + if self.is_mark { 0 } else { at }
    }
}

/// The pieces and their sum.
#[derive(Clone, Debug)]
pub(crate) struct Patchwork {
    pieces: Vec<Piece>,
    text: String,
}

impl Patchwork {
    pub fn new(origin: &Arc<Origin>) -> Self {
        Self::of(vec![Piece::slice(origin, 0..origin.text.len())])
    }

    fn of(pieces: Vec<Piece>) -> Self {
        let text = pieces.iter().map(|piece| piece.text.as_str()).collect();
        Self { pieces, text }
    }

    pub fn text(&self) -> &str {
        &self.text
    }

    /// The text with `span` replaced by `patch`.
    pub fn splice(&self, span: Span, patch: Vec<Piece>) -> Self {
        let mut pieces = self.part(0..span.start);
        pieces.extend(patch);
        pieces.extend(self.part(span.end..self.text.len()));
        Self::of(pieces)
    }

    fn part(&self, span: Span) -> Vec<Piece> {
        let mut start = 0;
        let mut parts = Vec::new();
        for piece in &self.pieces {
            let end = start + piece.text.len();
            let (from, to) = (span.start.max(start), span.end.min(end));
            if from < to {
                parts.push(piece.cut(from - start..to - start));
            }
            start = end;
        }
        parts
    }

    /// The origin of a span, and the span there (cut short where the next piece begins).
    pub fn origin(&self, span: &Span) -> (&Arc<Origin>, Span) {
        let mut start = 0;
        let last = self.pieces.len() - 1;
        for (index, piece) in self.pieces.iter().enumerate() {
            let end = start + piece.text.len();
            if span.start < end || index == last {
                let from = piece.origin_offset(span.start.min(end) - start);
                let to = if piece.is_mark {
                    from + 1
                } else {
                    piece.offset + (span.end.min(end) - start).max(from - piece.offset)
                };
                return (&piece.origin, from..to.min(piece.origin.text.len()));
            }
            start = end;
        }
        unreachable!("a patchwork has at least one piece, and the last one always answers")
    }
}
