//! Vectors and directions in space, written `(x, y, z)`.

use std::borrow::Cow;
use std::ops::Deref;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Deserialize, Deserializer, Error};
use serde::{Serialize, Serializer};

use crate::number::Finite;

/// Three finite numbers.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Vec3([f64; 3]);

impl Vec3 {
    /// The vector of these components.
    ///
    /// # Errors
    /// If one of them is not finite.
    pub fn new(components: [f64; 3]) -> Result<Self, String> {
        components
            .iter()
            .try_for_each(|x| Finite::new(*x).map(|_| ()))?;
        Ok(Self(components))
    }
}

impl<'de> Deserialize<'de> for Vec3 {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        let components = <[Finite; 3]>::deserialize(deserializer)?;
        Ok(Self(components.map(f64::from)))
    }
}

/// A unit vector; any finite vector but zero is accepted and normalised.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Direction([f64; 3]);

impl Direction {
    /// The direction of a vector.
    ///
    /// # Errors
    /// If the vector is zero or not finite.
    pub fn new(vector: [f64; 3]) -> Result<Self, String> {
        // Scaled first, so that squares neither overflow nor vanish.
        let largest = vector.iter().fold(0.0, |most: f64, x| most.max(x.abs()));
        let finite = vector.iter().all(|x| x.is_finite());
        if !finite || largest <= 0.0 {
            let [x, y, z] = vector;
            return Err(format!(
                "expected a direction, found ({x}, {y}, {z}); give a finite vector that is not zero"
            ));
        }
        let scaled = vector.map(|x| x / largest);
        let length = scaled.iter().map(|x| x * x).sum::<f64>().sqrt();
        Ok(Self(scaled.map(|x| x / length)))
    }
}

impl<'de> Deserialize<'de> for Direction {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        Self::new(*Vec3::deserialize(deserializer)?).map_err(D::Error::custom)
    }
}

macro_rules! triple {
    ($name:ident, $title:literal) => {
        impl Deref for $name {
            type Target = [f64; 3];

            fn deref(&self) -> &[f64; 3] {
                &self.0
            }
        }

        impl From<$name> for [f64; 3] {
            fn from(vector: $name) -> Self {
                vector.0
            }
        }

        impl Serialize for $name {
            fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
                self.0.serialize(serializer)
            }
        }

        impl JsonSchema for $name {
            fn schema_name() -> Cow<'static, str> {
                stringify!($name).into()
            }

            fn inline_schema() -> bool {
                true
            }

            fn json_schema(_: &mut SchemaGenerator) -> Schema {
                json_schema!({
                    "type": "array",
                    "prefixItems": [{ "type": "number" }, { "type": "number" }, { "type": "number" }],
                    "minItems": 3,
                    "maxItems": 3,
                    "title": $title,
                })
            }
        }
    };
}

triple!(Vec3, "vector (x, y, z)");
triple!(Direction, "direction (x, y, z), normalised");
