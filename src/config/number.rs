//! Numbers that are checked where they are read, so that the error stands at the number.

use std::borrow::Cow;
use std::ops::Deref;

use schemars::{JsonSchema, Schema, SchemaGenerator, json_schema};
use serde::de::{Deserialize, Deserializer, Error};
use serde::{Serialize, Serializer};

macro_rules! checked {
    ($(#[$doc:meta])* $name:ident($inner:ty), $words:literal, $remedy:literal, $schema:tt,
     |$x:ident| $check:expr, $convert:expr) => {
        $(#[$doc])*
        #[derive(Clone, Copy, Debug, PartialEq, PartialOrd)]
        pub struct $name($inner);

        impl $name {
            /// The number, if it is allowed; else what is wrong and the remedy.
            ///
            /// # Errors
            /// If the number is out of range or not finite.
            pub fn new($x: f64) -> Result<Self, String> {
                if $check {
                    Ok(Self($convert))
                } else {
                    Err(format!(concat!("expected a ", $words, ", found {}; ", $remedy), $x))
                }
            }
        }

        impl Deref for $name {
            type Target = $inner;

            fn deref(&self) -> &$inner {
                &self.0
            }
        }

        impl From<$name> for $inner {
            fn from(number: $name) -> Self {
                number.0
            }
        }

        impl<'de> Deserialize<'de> for $name {
            fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
                Self::new(f64::deserialize(deserializer)?).map_err(D::Error::custom)
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
                json_schema!($schema)
            }
        }
    };
}

checked!(
    /// A finite number above zero.
    Positive(f64), "positive finite number", "give a number above 0",
    { "type": "number", "exclusiveMinimum": 0, "title": "positive number" },
    |x| x.is_finite() && x > 0.0, x
);
checked!(
    /// A finite number, zero or above.
    NonNegative(f64), "finite number of at least 0", "give 0 or a number above it",
    { "type": "number", "minimum": 0, "title": "number of at least 0" },
    |x| x.is_finite() && x >= 0.0, x
);
checked!(
    /// A number that is neither infinite nor NaN.
    Finite(f64), "finite number", "inf and NaN are not allowed here",
    { "type": "number", "title": "number" },
    |x| x.is_finite(), x
);
checked!(
    /// A whole number of at least one.
    Count(usize), "whole number of at least 1", "give 1, 2, 3 ..",
    { "type": "integer", "minimum": 1, "title": "whole number of at least 1" },
    // Whole numbers are exact in f64 up to this bound, which no count comes near.
    |x| x >= 1.0 && x.fract() == 0.0 && x < 9_007_199_254_740_992.0, x as usize
);

impl Default for NonNegative {
    fn default() -> Self {
        Self(0.0)
    }
}

impl Default for Finite {
    fn default() -> Self {
        Self(0.0)
    }
}
