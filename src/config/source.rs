//! A scenario text after loading, and reading typed values from it.

use std::path::Path;
use std::sync::OnceLock;

use ron::error::SpannedError;
use ron::value::RawValue;
use serde::Deserialize;

use crate::derived;
use crate::finding::{Finding, Span};
use crate::follow::{self, Target};
use crate::node::Node;
use crate::overrides::Override;
use crate::patchwork::Patchwork;
use crate::path;
use crate::plugin::{self, Hook};
use crate::problem::{Problem, Problems};
use crate::repair;
use crate::scan;

/// A scenario text with its bases and overrides resolved, which knows where every byte of it was
/// written.
#[derive(Debug)]
pub struct Source {
    name: String,
    patchwork: Patchwork,
    root: Node,
    options: ron::Options,
    /// Repaired texts, kept here since a typed value may borrow from the text it was read from.
    drafts: [OnceLock<String>; repair::MOST],
}

impl Source {
    /// Loads a file, and the files it is derived from, and applies `sets`, each `path=value`.
    ///
    /// # Errors
    /// If a file cannot be read, a path leads nowhere, or brackets and quotes do not match.
    pub fn load(file: &Path, sets: &[String]) -> Result<Self, Problems> {
        Self::new(
            file.display().to_string(),
            derived::load(file, &mut Vec::new())?,
            sets,
        )
    }

    /// Takes a text that is not a file, such as an embedded scenario; it may not have a `base`.
    ///
    /// # Errors
    /// If a path of `sets` leads nowhere, or brackets and quotes do not match.
    pub fn from_text(name: &str, text: &str, sets: &[String]) -> Result<Self, Problems> {
        Self::new(name.to_owned(), derived::standing_alone(name, text)?, sets)
    }

    fn new(name: String, mut patchwork: Patchwork, sets: &[String]) -> Result<Self, Problems> {
        let mut problems = Problems::default();
        for set in sets {
            let patched = Override::from_set(set).and_then(|change| change.apply(&patchwork));
            patchwork = problems.collect(patched).unwrap_or(patchwork);
        }
        problems.into_result()?;
        let root = scan::document(patchwork.text())
            .map_err(|finding| Problem::within(&patchwork, None, finding))?;
        let options = options_of(patchwork.text())
            .map_err(|error| repair::findings(patchwork.text(), error, |_| None))
            .map_err(|found| {
                Problems(
                    found
                        .into_iter()
                        .map(|f| Problem::within(&patchwork, None, f))
                        .collect(),
                )
            })?;
        Ok(Self {
            name,
            patchwork,
            root,
            options,
            drafts: Default::default(),
        })
    }

    /// This text with `sets` applied to it as well, each `path=value`.
    ///
    /// # Errors
    /// If a path leads nowhere, or brackets and quotes of a value do not match.
    pub fn with(&self, sets: &[String]) -> Result<Self, Problems> {
        Self::new(self.name.clone(), self.patchwork.clone(), sets)
    }

    /// The texts of all values that `path` means, at least one.
    ///
    /// # Errors
    /// If there is no such value: in words why, and after a semicolon what to do.
    pub fn values(&self, path: &str) -> Result<Vec<&str>, String> {
        let words = |finding: Finding| match finding.hint {
            Some(hint) => format!("{}; {hint}", finding.message),
            None => finding.message,
        };
        let (steps, length) = path::read(path).map_err(words)?;
        if length < path.len() {
            let rest = &path[length..];
            return Err(format!(
                "`{rest}` in the path is not understood; paths look like `laws[*].apply.factor`"
            ));
        }
        let targets = follow::targets(self.text(), &self.root, &steps).map_err(words)?;
        let value = |target| match target {
            Target::Replace(span) => Ok(&self.text()[span]),
            Target::Insert { .. } => Err(format!(
                "the scenario gives no value at `{path}`; write it there first, or mend the path"
            )),
        };
        targets.into_iter().map(value).collect()
    }

    /// The number that stands wherever `path` means.
    ///
    /// # Errors
    /// If there is none, or different ones: in words why, and after a semicolon what to do.
    pub fn number(&self, path: &str) -> Result<f64, String> {
        let number = |text: &str| {
            text.parse::<f64>().map_err(|_| {
                let shown: String = text.chars().take(40).collect();
                format!(
                    "`{path}` is no number but `{shown}`; name a single number, as in `rods[0].length` or \
                     `forcing[0].apply.g[2]`"
                )
            })
        };
        let texts = self.values(path)?;
        let first = number(texts[0])?;
        for text in &texts[1..] {
            let other = number(text)?;
            if other.total_cmp(&first).is_ne() {
                return Err(format!(
                    "`{path}` means different numbers, {first} and {other}; make them equal, or name them one by one"
                ));
            }
        }
        Ok(first)
    }

    /// The file or the name given to the text.
    pub fn name(&self) -> &str {
        &self.name
    }

    /// The text with everything resolved: it stands alone, so it belongs beside the results.
    pub fn text(&self) -> &str {
        self.patchwork.text()
    }

    pub(crate) fn root(&self) -> &Node {
        &self.root
    }

    /// Reads the whole text as one typed value, which may hold `&RawValue` where plugins go.
    ///
    /// # Errors
    /// All that is wrong with the text, as far as it can be told without the plugins.
    pub fn parse<'a, T: Deserialize<'a>>(&'a self) -> Result<T, Problems> {
        self.options.from_str(self.text()).map_err(|error| {
            let found = repair::findings(self.text(), error, |draft| {
                let slot = self.drafts.iter().find(|slot| slot.get().is_none())?;
                self.options
                    .from_str::<T>(slot.get_or_init(|| draft.to_owned()))
                    .err()
            });
            self.located(0, found)
        })
    }

    /// Builds the plugin that a slot names, as in `forcing: [Gravity(g: (0, 0, -9.81))]`.
    ///
    /// # Errors
    /// If no such plugin exists for this hook, or its fields are wrong.
    ///
    /// # Panics
    /// If the slot was not read from this source.
    pub fn build<H: ?Sized + Hook>(&self, slot: &RawValue) -> Result<Box<H>, Problems> {
        let span = self.span_of(slot);
        plugin::build(slot.get_ron(), &self.options)
            .map_err(|found| self.located(span.start, found))
    }

    /// A problem with the value at `path`, for what only the whole scenario can tell; if there is
    /// no such value, with the scenario as a whole.
    pub fn problem(&self, path: &str, message: impl Into<String>) -> Problem {
        let targets = path::read(path)
            .and_then(|(steps, _)| follow::targets(self.text(), &self.root, &steps));
        match targets.unwrap_or_default().first() {
            Some(Target::Replace(span)) => {
                let finding = Finding::new(span.clone(), message);
                Problem::within(&self.patchwork, Some(path.to_owned()), finding)
            }
            _ => self.locate(Finding::new(
                self.root.span.start..self.root.span.start + 1,
                message,
            )),
        }
    }

    /// A problem with the value in a slot.
    ///
    /// # Panics
    /// If the slot was not read from this source.
    pub fn problem_in(&self, slot: &RawValue, message: impl Into<String>) -> Problem {
        self.locate(Finding::new(self.span_of(slot), message))
    }

    /// The path of a slot, such as `laws[0].apply`.
    ///
    /// # Panics
    /// If the slot was not read from this source.
    pub fn path_of(&self, slot: &RawValue) -> String {
        path::naming(self.text(), &self.root, self.span_of(slot).start)
    }

    /// A raw value borrows from the text, so its address tells its place.
    fn span_of(&self, slot: &RawValue) -> Span {
        let (text, slot) = (self.text(), slot.get_ron());
        let start = slot.as_ptr().addr().wrapping_sub(text.as_ptr().addr());
        let inside = start <= text.len() && slot.len() <= text.len() - start;
        assert!(
            inside,
            "a slot is built by the source that it was read from"
        );
        start..start + slot.len()
    }

    fn located(&self, offset: usize, found: Vec<Finding>) -> Problems {
        Problems(
            found
                .into_iter()
                .map(|finding| self.locate(finding.shifted(offset)))
                .collect(),
        )
    }

    fn locate(&self, finding: Finding) -> Problem {
        let path = path::naming(self.text(), &self.root, finding.span.start);
        Problem::within(&self.patchwork, Some(path), finding)
    }
}

/// How scenarios are read: an optional value needs no `Some(..)`, and a choice that holds a
/// struct needs one pair of brackets, `Csv(file: "x")`.
pub fn options() -> ron::Options {
    use ron::extensions::Extensions;
    ron::Options::default()
        .with_default_extension(Extensions::IMPLICIT_SOME | Extensions::UNWRAP_VARIANT_NEWTYPES)
}

/// The options above and those of the `#![enable(..)]` header, which slots do not repeat.
fn options_of(text: &str) -> Result<ron::Options, SpannedError> {
    let extensions = ron::Deserializer::from_str(text)?.extensions();
    Ok(options().with_default_extension(extensions))
}
