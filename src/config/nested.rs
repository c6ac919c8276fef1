//! A plugin inside another.

use std::borrow::Cow;
use std::fmt;
use std::ops::Deref;

use ron::value::RawValue;
use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Deserialize, Deserializer, Error};

use crate::plugin::{self, Hook};
use crate::{scan, source};

/// A plugin that another one holds, as in `Ramp(over: 1, of: Gravity(..))`.
///
/// `#![enable(..)]` headers of the file do not reach it.
pub struct Nested<T: ?Sized + Hook>(pub Box<T>);

impl<T: ?Sized + Hook> Deref for Nested<T> {
    type Target = T;

    fn deref(&self) -> &T {
        &self.0
    }
}

impl<T: ?Sized + Hook> fmt::Debug for Nested<T> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "Nested({})", T::NOUN)
    }
}

impl<'de, T: ?Sized + Hook> Deserialize<'de> for Nested<T> {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let text = <&RawValue>::deserialize(deserializer)?.get_ron();
        let start = scan::single_value(text).map_or(0, |node| node.span.start);
        plugin::build(text, &source::options())
            .map(Self)
            .map_err(|found| {
                let mut first = found[0].clone();
                first.span = first.span.start - start..first.span.end - start;
                D::Error::custom(first.pack())
            })
    }
}

impl<T: ?Sized + Hook> JsonSchema for Nested<T> {
    fn schema_name() -> Cow<'static, str> {
        format!("Nested_{}", T::NOUN).into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({ "title": format!("a {}", T::NOUN) })
    }
}
