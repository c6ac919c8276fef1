//! Loading a file, and the files that it is derived from by `base:` and `set:`.

use std::io::ErrorKind;
use std::path::{Path, PathBuf};
use std::sync::Arc;

use crate::finding::{Finding, Span};
use crate::node::{Body, Entry, Node};
use crate::overrides::Override;
use crate::patchwork::{Origin, Patchwork};
use crate::path;
use crate::problem::Problem;
use crate::scan;

/// Loads a file with the values of its bases; `above` are the files that led here.
pub(crate) fn load(file: &Path, above: &mut Vec<PathBuf>) -> Result<Patchwork, Problem> {
    let text = std::fs::read_to_string(file).map_err(|error| {
        Problem::new(format!("`{}` cannot be read: {error}", file.display())).with_hint(match error
            .kind()
        {
            ErrorKind::NotFound => "check the name and the folder it is given from",
            ErrorKind::IsADirectory => "give a scenario file, not its folder",
            ErrorKind::InvalidData => {
                "a scenario is a text in UTF-8; is this another kind of file?"
            }
            _ => "check that it is a file that you may read",
        })
    })?;
    let origin = Arc::new(Origin {
        name: file.display().to_string(),
        text,
    });
    let root = root(&origin)?;
    let Some(base) = base_of(&origin, &root) else {
        return Ok(Patchwork::new(&origin));
    };
    let fault = |finding| Problem::at(&origin, Some("base".into()), finding);
    let name = string(&origin, &base.value).map_err(fault)?;
    let base_file = file.parent().unwrap_or(Path::new("")).join(name);
    above.push(file.canonicalize().unwrap_or_else(|_| file.to_owned()));
    if base_file
        .canonicalize()
        .is_ok_and(|base_file| above.contains(&base_file))
    {
        let message = format!("`{}` is derived from itself", base_file.display());
        return Err(fault(Finding::new(base.value.span.clone(), message).hint(
            "break the circle: one of the files must stand without `base`",
        )));
    }
    if !base_file.is_file() {
        let message = format!("there is no file `{}`", base_file.display());
        return Err(fault(Finding::new(base.value.span.clone(), message).hint(
            "the path of a base is relative to the folder of the file that names it",
        )));
    }
    let patchwork = load(&base_file, above)?;
    above.pop();
    overrides(&origin, &root)?
        .iter()
        .try_fold(patchwork, |text, change| change.apply(&text))
}

/// A text that stands for itself: it may not name a base, having no folder to look for it in.
pub(crate) fn standing_alone(name: &str, text: &str) -> Result<Patchwork, Problem> {
    let origin = Arc::new(Origin {
        name: name.to_owned(),
        text: text.to_owned(),
    });
    match base_of(&origin, &root(&origin)?) {
        None => Ok(Patchwork::new(&origin)),
        Some(base) => {
            let message = "`base` needs a folder to look in, but this text is not a file";
            let finding =
                Finding::new(base.span(), message).hint("save the text to a file and load that");
            Err(Problem::at(&origin, Some("base".into()), finding))
        }
    }
}

fn root(origin: &Arc<Origin>) -> Result<Node, Problem> {
    scan::document(&origin.text).map_err(|finding| Problem::at(origin, None, finding))
}

fn fields(root: &Node) -> &[Entry] {
    match &root.body {
        Body::Struct(entries) => entries,
        _ => &[],
    }
}

fn base_of<'n>(origin: &Origin, root: &'n Node) -> Option<&'n Entry> {
    fields(root)
        .iter()
        .find(|entry| &origin.text[entry.key.clone()] == "base")
}

fn string(origin: &Origin, node: &Node) -> Result<String, Finding> {
    ron::from_str(&origin.text[node.span.clone()])
        .map_err(|_| Finding::new(node.span.clone(), "expected a text in double quotes"))
}

/// The entries of `set`, and every other field of the file as a change of that field, in order.
fn overrides(origin: &Arc<Origin>, root: &Node) -> Result<Vec<Override>, Problem> {
    let fault = |finding| Problem::at(origin, Some("set".into()), finding);
    let change = |path: Span, value: &Node| Override {
        origin: Arc::clone(origin),
        path,
        value: value.span.clone(),
    };
    let mut changes = Vec::new();
    for field in fields(root) {
        match (&origin.text[field.key.clone()], &field.value.body) {
            ("base", _) => {}
            ("set", Body::Map(entries)) => {
                for entry in entries {
                    let path = path_span(origin, &entry.key).map_err(fault)?;
                    changes.push(change(path, &entry.value));
                }
            }
            ("set", _) => {
                let message = "`set` is a map from paths to values";
                return Err(fault(
                    Finding::new(field.value.span.clone(), message)
                        .hint("for example `set: { \"rods[0].length\": 0.1 }`"),
                ));
            }
            _ => changes.push(change(field.key.clone(), &field.value)),
        }
    }
    Ok(changes)
}

/// The path between the quotes of a key.
fn path_span(origin: &Origin, key: &Span) -> Result<Span, Finding> {
    let text = &origin.text[key.clone()];
    let name = path::key_name(text);
    if name.len() == text.len() || name.contains('\\') {
        return Err(Finding::new(key.clone(), "expected a path in double quotes")
            .hint("for example \"rods[0].length\"; keys inside a path take single quotes: \"inputs['name']\""));
    }
    Ok(key.start + 1..key.end - 1)
}
