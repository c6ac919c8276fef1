//! A scanner that finds where the values of a RON text are, without knowing their types.
//!
//! It stands before ron for two reasons: overrides are spliced into the text, so the span of the
//! value at a path must be known, and a bracket or string that is never closed is best reported
//! where it was opened.

use crate::finding::{Finding, Span};
use crate::literal;
use crate::node::{Body, Entry, Node};

/// Deeper than any scenario needs and shallow enough for every stack; below ron's own limit.
const DEEPEST: usize = 60;

/// Scans a whole document: optional `#![enable(..)]` header, then one value.
pub(crate) fn document(text: &str) -> Result<Node, Finding> {
    let mut scanner = Scanner {
        text,
        at: 0,
        depth: 0,
    };
    scanner.blank()?;
    while scanner.rest().starts_with('#') {
        scanner.header()?;
        scanner.blank()?;
    }
    scanner.only_value()
}

/// Scans text that must be one single value.
pub(crate) fn single_value(text: &str) -> Result<Node, Finding> {
    Scanner {
        text,
        at: 0,
        depth: 0,
    }
    .only_value()
}

struct Scanner<'a> {
    text: &'a str,
    at: usize,
    depth: usize,
}

impl<'a> Scanner<'a> {
    fn rest(&self) -> &'a str {
        &self.text[self.at..]
    }

    fn peek(&self) -> Option<char> {
        self.rest().chars().next()
    }

    fn eat(&mut self, c: char) -> bool {
        let found = self.peek() == Some(c);
        if found {
            self.at += c.len_utf8();
        }
        found
    }

    /// Skips white space and comments; block comments nest.
    fn blank(&mut self) -> Result<(), Finding> {
        loop {
            let rest = self.rest();
            let start = self.at;
            if rest.starts_with("//") {
                self.at += rest.find('\n').unwrap_or(rest.len());
            } else if rest.starts_with("/*") {
                self.at += literal::block_comment(rest).ok_or_else(|| {
                    Finding::new(start..start + 2, "this comment is never closed")
                        .hint("close it with `*/`")
                })?;
            } else if let Some(c) = rest.chars().next().filter(|c| c.is_whitespace()) {
                self.at += c.len_utf8();
            } else {
                return Ok(());
            }
        }
    }

    fn header(&mut self) -> Result<(), Finding> {
        let start = self.at;
        while !self.eat(']') {
            match self.peek() {
                Some(_) if self.string()? => {}
                Some(c) => self.at += c.len_utf8(),
                None => {
                    return Err(
                        Finding::new(start..start + 1, "this header is never closed")
                            .hint("headers look like `#![enable(implicit_some)]`"),
                    );
                }
            }
        }
        Ok(())
    }

    fn only_value(&mut self) -> Result<Node, Finding> {
        let node = self.value()?;
        self.blank()?;
        match self.peek() {
            None => Ok(node),
            Some(_) => Err(Finding::new(
                self.token(),
                format!("nothing may follow the value, found {}", self.found()),
            )
            .hint("one value only; is a bracket closed too early, or a string not quoted?")),
        }
    }

    fn value(&mut self) -> Result<Node, Finding> {
        self.blank()?;
        let start = self.at;
        match self.peek() {
            Some('(' | '[' | '{') => return self.group(start, None),
            None | Some(',' | ':' | ')' | ']' | '}') => {
                let message = format!("expected a value, found {}", self.found());
                return Err(Finding::new(self.token(), message)
                    .hint("values look like 0.1, (0, 0, 1), [1, 2], \"text\" or Name(..)"));
            }
            Some(_) if self.string()? => {}
            Some(_) => return self.word(),
        }
        Ok(Node {
            span: start..self.at,
            name: None,
            body: Body::Leaf,
        })
    }

    /// A number or bare word, or a name with its brackets.
    fn word(&mut self) -> Result<Node, Finding> {
        let start = self.at;
        self.at = self.token().end;
        let span = start..self.at;
        let is_name = self.text[start..].starts_with(|c: char| c.is_alphabetic() || c == '_');
        self.blank()?;
        if is_name && self.peek() == Some('(') {
            return self.group(start, Some(span));
        }
        self.at = span.end;
        Ok(Node {
            span,
            name: None,
            body: Body::Leaf,
        })
    }

    /// Skips a string or character; false if there is none here.
    fn string(&mut self) -> Result<bool, Finding> {
        let start = self.at;
        match literal::string(self.rest()) {
            None => Ok(false),
            Some(Ok(length)) => {
                self.at += length;
                Ok(true)
            }
            Some(Err(mark)) => Err(
                Finding::new(start..start + 1, "this string is never closed")
                    .hint(format!("add the missing `{mark}`")),
            ),
        }
    }

    fn group(&mut self, start: usize, name: Option<Span>) -> Result<Node, Finding> {
        let opening = self.at;
        let open = &self.text[opening..=opening];
        let close = match open {
            "(" => ')',
            "[" => ']',
            _ => '}',
        };
        self.at += 1;
        self.depth += 1;
        if self.depth > DEEPEST {
            let message = format!("brackets are nested more than {DEEPEST} deep");
            return Err(Finding::new(opening..self.at, message).hint("are brackets doubled?"));
        }
        let (mut entries, mut items) = (Vec::new(), Vec::new());
        loop {
            self.blank()?;
            if self.eat(close) {
                break;
            }
            self.refuse_end(opening, open, close)?;
            let item = self.value()?;
            self.blank()?;
            let keyed = open != "[" && self.eat(':');
            if keyed {
                entries.push(Entry {
                    key: item.span,
                    value: self.value()?,
                });
            } else if open == "{" {
                let message = format!("expected `:` and a value, found {}", self.found());
                return Err(Finding::new(self.token(), message)
                    .hint("entries of a map are written `key: value`"));
            } else {
                items.push(item);
            }
            if !entries.is_empty() && !items.is_empty() {
                let last = if keyed {
                    &entries[entries.len() - 1].key
                } else {
                    &items[items.len() - 1].span
                };
                return Err(Finding::new(
                    last.clone(),
                    "values with a field name and values without one are mixed in one bracket",
                )
                .hint("write every field as `name: value`"));
            }
            self.blank()?;
            if !self.eat(',') && self.peek() != Some(close) {
                self.refuse_end(opening, open, close)?;
                let last = entries.last().map(|entry: &Entry| &entry.value);
                self.refuse_run_on(last.or(items.last()))?;
                let message = format!("expected `,` or `{close}`, found {}", self.found());
                return Err(Finding::new(self.token(), message)
                    .hint("is a comma missing after the previous value?"));
            }
        }
        self.depth -= 1;
        let body = match open {
            "[" => Body::List(items),
            "{" => Body::Map(entries),
            _ if items.is_empty() => Body::Struct(entries),
            _ => Body::Tuple(items),
        };
        Ok(Node {
            span: start..self.at,
            name,
            body,
        })
    }

    /// A quote that is missing lets a text end at the next one, lines later.
    fn refuse_run_on(&self, last: Option<&Node>) -> Result<(), Finding> {
        let run_on = last.filter(|last| {
            let text = &self.text[last.span.clone()];
            matches!(last.body, Body::Leaf) && text.starts_with('"') && text.contains('\n')
        });
        match run_on {
            None => Ok(()),
            Some(Node { span, .. }) => Err(Finding::new(
                span.start..span.start + 1,
                format!(
                    "this string goes on over the end of its line, up to {}",
                    self.found()
                ),
            )
            .hint("is its closing `\"` missing?")),
        }
    }

    fn refuse_end(&self, opening: usize, open: &str, close: char) -> Result<(), Finding> {
        match self.peek() {
            None => Err(Finding::new(
                opening..opening + 1,
                format!("this `{open}` is never closed"),
            )
            .hint(format!("add the missing `{close}`"))),
            Some(c @ (')' | ']' | '}')) => Err(Finding::new(
                self.at..self.at + 1,
                format!(
                    "expected `{close}` to close the `{open}` of line {}, found `{c}`",
                    1 + self.text[..opening].matches('\n').count()
                ),
            )
            .hint(format!(
                "is a `{close}` missing before it, or is it one too many?"
            ))),
            Some(_) => Ok(()),
        }
    }

    /// The span of the token here, for messages.
    fn token(&self) -> Span {
        self.at..self.at + literal::token(self.rest())
    }

    fn found(&self) -> String {
        match &self.text[self.token()] {
            "" => "the end of the text".to_owned(),
            token => format!("`{token}`"),
        }
    }
}
