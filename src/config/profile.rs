//! A positive quantity along a rod: the same everywhere, or listed.

use std::borrow::Cow;
use std::fmt;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Deserialize, Deserializer, Error, SeqAccess, Visitor};
use serde::{Serialize, Serializer};

use crate::number::Positive;

/// One positive number for all places, or a list with one for each.
#[derive(Clone, Debug, PartialEq)]
pub enum Profile {
    /// The same everywhere.
    Uniform(Positive),
    /// One number for each place, at least one.
    Listed(Vec<Positive>),
}

impl Profile {
    /// The number at place `i`.
    ///
    /// # Panics
    /// If a list is shorter; see [`Profile::check_len`].
    pub fn at(&self, i: usize) -> f64 {
        match self {
            Self::Uniform(number) => **number,
            Self::Listed(numbers) => *numbers[i],
        }
    }

    /// Whether the profile fits `n` places; else what is wrong.
    ///
    /// # Errors
    /// If a list has another length.
    pub fn check_len(&self, n: usize) -> Result<(), String> {
        match self {
            Self::Listed(numbers) if numbers.len() != n => Err(format!(
                "the list has {} numbers for {n} places; give one for each, or a single number",
                numbers.len()
            )),
            _ => Ok(()),
        }
    }
}

impl<'de> Deserialize<'de> for Profile {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        match deserializer.deserialize_any(ProfileVisitor)? {
            Self::Listed(numbers) if numbers.is_empty() => Err(D::Error::custom(
                "the list is empty; give a number, or one for each place",
            )),
            profile => Ok(profile),
        }
    }
}

struct ProfileVisitor;

impl<'de> Visitor<'de> for ProfileVisitor {
    type Value = Profile;

    fn expecting(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("a positive number or a list of positive numbers")
    }

    fn visit_f64<E: Error>(self, number: f64) -> Result<Profile, E> {
        Positive::new(number)
            .map(Profile::Uniform)
            .map_err(E::custom)
    }

    fn visit_i64<E: Error>(self, number: i64) -> Result<Profile, E> {
        self.visit_f64(number as f64)
    }

    fn visit_u64<E: Error>(self, number: u64) -> Result<Profile, E> {
        self.visit_f64(number as f64)
    }

    fn visit_seq<A: SeqAccess<'de>>(self, mut list: A) -> Result<Profile, A::Error> {
        let mut numbers = Vec::new();
        while let Some(number) = list.next_element()? {
            numbers.push(number);
        }
        Ok(Profile::Listed(numbers))
    }
}

impl Serialize for Profile {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        match self {
            Self::Uniform(number) => number.serialize(serializer),
            Self::Listed(numbers) => numbers.serialize(serializer),
        }
    }
}

impl JsonSchema for Profile {
    fn schema_name() -> Cow<'static, str> {
        "Profile".into()
    }

    fn inline_schema() -> bool {
        true
    }

    fn json_schema(_: &mut SchemaGenerator) -> Schema {
        json_schema!({
            "title": "positive number or list of them",
            "anyOf": [
                { "type": "number", "exclusiveMinimum": 0 },
                { "type": "array", "items": { "type": "number", "exclusiveMinimum": 0 }, "minItems": 1 },
            ],
        })
    }
}
