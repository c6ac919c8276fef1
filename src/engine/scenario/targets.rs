//! Names of bodies that hooks act on.

use crate::bodies::End;
use crate::site::Place;
use serde::de::{Deserialize, Deserializer, SeqAccess, Visitor};

/// One name, a list of names, or all bodies.
#[derive(Clone, Debug, Default, PartialEq)]
pub enum Targets {
    /// Every body that the hook can act on.
    #[default]
    All,
    /// Bodies or groups of these names.
    Named(Vec<String>),
}

impl Targets {
    /// The names, none for all bodies.
    pub fn names(&self) -> &[String] {
        match self {
            Self::All => &[],
            Self::Named(names) => names,
        }
    }
}

impl<'de> Deserialize<'de> for Targets {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        struct Names;
        impl<'de> Visitor<'de> for Names {
            type Value = Targets;
            fn expecting(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                f.write_str("a name or a list of names in quotes")
            }
            fn visit_str<E>(self, name: &str) -> Result<Targets, E> {
                Ok(Targets::Named(vec![name.into()]))
            }
            fn visit_seq<A: SeqAccess<'de>>(self, mut names: A) -> Result<Targets, A::Error> {
                let mut all = Vec::new();
                while let Some(name) = names.next_element()? {
                    all.push(name);
                }
                Ok(Targets::Named(all))
            }
        }
        deserializer.deserialize_any(Names)
    }
}

/// Splits `rod_1`, `rod_1.start`, `rod_1.tip` and `rod_1[12]` into name and place.
pub(super) fn name_and_place(text: &str) -> Result<(&str, Place), String> {
    if let Some(name) = text.strip_suffix(".start") {
        return Ok((name, Place::End(End::Start)));
    }
    if let Some((name, index)) = text.strip_suffix(']').and_then(|t| t.split_once('[')) {
        let node = index
            .parse()
            .map_err(|_| format!("`{index}` in `{text}` is not a node; give 0, 1, 2 .."))?;
        return Ok((name, Place::Node(node)));
    }
    let name = text.strip_suffix(".tip").unwrap_or(text);
    Ok((name, Place::End(End::Tip)))
}
