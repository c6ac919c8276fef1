//! Places that paths mean, for whoever changes one value in many ways.

use std::sync::Arc;

use crate::finding::{Finding, Span};
use crate::follow::{self, Target};
use crate::patchwork::Origin;
use crate::path;
use crate::problem::Problem;
use crate::source::Source;

/// Paths that are tied to one value, as in `rods[0].length, rods[1].length=0.1..0.2`.
#[derive(Clone, Debug)]
pub struct Tied {
    origin: Arc<Origin>,
    paths: Vec<Span>,
    end: usize,
}

impl Tied {
    /// Reads one path or several with commas between them; what follows them is [`Tied::rest`]. `context` is what
    /// problems name the text by, such as `--over`.
    ///
    /// # Errors
    /// If there is no path, or one is not understood.
    pub fn read(context: &str, text: &str) -> Result<Self, Problem> {
        let origin = Arc::new(Origin {
            name: format!("{context} {text}"),
            text: text.to_owned(),
        });
        let blank = |at: usize| text[at..].len() - text[at..].trim_start().len();
        let mut paths = Vec::new();
        let mut at = blank(0);
        loop {
            let (_, length) = path::read(&text[at..])
                .map_err(|finding| Problem::at(&origin, None, finding.shifted(at)))?;
            paths.push(at..at + length);
            at += length;
            at += blank(at);
            if !text[at..].starts_with(',') {
                return Ok(Self {
                    origin,
                    paths,
                    end: at,
                });
            }
            at += 1;
            at += blank(at);
        }
    }

    /// What follows the paths.
    pub fn rest(&self) -> &str {
        &self.origin.text[self.end..]
    }

    /// The paths.
    pub fn paths(&self) -> impl Iterator<Item = &str> {
        self.paths
            .iter()
            .map(|span| &self.origin.text[span.clone()])
    }

    /// All paths as one name.
    pub fn name(&self) -> String {
        self.paths().collect::<Vec<_>>().join(", ")
    }

    /// A problem with what follows the paths.
    pub fn problem(&self, message: impl Into<String>) -> Problem {
        let finding = Finding::new(self.end..self.origin.text.len(), message);
        Problem::at(&self.origin, None, finding)
    }

    /// The paths of all places that are meant, without wildcards. Each holds a number in `source`, or nothing yet.
    ///
    /// # Errors
    /// If a path leads nowhere, or to something that is no number, or two lead to one place.
    pub fn numbers(&self, source: &Source) -> Result<Vec<String>, Problem> {
        let mut places: Vec<String> = Vec::new();
        for span in &self.paths {
            let fault =
                |finding: Finding| Problem::at(&self.origin, None, finding.shifted(span.start));
            let whole = 0..span.len();
            let (steps, _) = path::read(&self.origin.text[span.clone()]).map_err(fault)?;
            for target in follow::targets(source.text(), source.root(), &steps).map_err(fault)? {
                let place = match target {
                    Target::Replace(value) => {
                        let text = &source.text()[value.clone()];
                        let place = path::naming(source.text(), source.root(), value.start);
                        if ron::from_str::<f64>(text).is_err() {
                            let shown: String = text.chars().take(40).collect();
                            let message = format!("`{place}` isn't a number but `{shown}`");
                            let remedy = "name a number, such as `rods[0].length` or `forcing[0].apply.force[2]`";
                            return Err(fault(Finding::new(whole, message).hint(remedy)));
                        }
                        place
                    }
                    Target::Insert { at, .. } => {
                        let last = &steps[steps.len() - 1].span;
                        let name =
                            &self.origin.text[span.start + last.start..span.start + last.end];
                        format!("{}.{name}", path::naming(source.text(), source.root(), at))
                    }
                };
                if places.contains(&place) {
                    let finding = Finding::new(whole, format!("`{place}` is meant twice"));
                    return Err(fault(finding.hint("name each place once")));
                }
                places.push(place);
            }
        }
        Ok(places)
    }

    /// A problem with the paths.
    pub fn problem_with_paths(&self, message: impl Into<String>) -> Problem {
        let end = self.paths.last().map_or(0, |last| last.end);
        Problem::at(&self.origin, None, Finding::new(0..end, message))
    }

    /// What puts `value` in all these places, each as [`Source`] takes it.
    pub fn sets(&self, value: f64) -> impl Iterator<Item = String> {
        self.paths().map(move |path| format!("{path}={value}"))
    }
}
