//! What a plugin's fields are, in words, from the schema that serde's own attributes shape.

use serde_json::{Map, Value};

use crate::plugin::Plugin;

/// One field of a plugin.
#[derive(Clone, Debug, PartialEq)]
pub struct FieldDoc {
    /// As written in a scenario.
    pub name: String,
    /// The type for readers: "positive number", "Right | Left".
    pub type_words: String,
    /// The value if it is left out, as RON, where the schema tells.
    pub default: Option<String>,
    /// Whether it may not be left out.
    pub required: bool,
    /// The doc comment: meaning and unit.
    pub doc: String,
}

impl Plugin {
    /// What it does: the doc comment of the type.
    pub fn summary(&self) -> String {
        text(&(self.schema)().to_value(), "description").to_owned()
    }

    /// Its fields, by name as the schema sorts them.
    pub fn fields(&self) -> Vec<FieldDoc> {
        let root = (self.schema)().to_value();
        let required = |name: &str| {
            root["required"]
                .as_array()
                .is_some_and(|names| names.iter().any(|n| n == name))
        };
        let Some(properties) = root["properties"].as_object() else {
            return Vec::new();
        };
        let field = |(name, schema): (&String, &Value)| FieldDoc {
            name: name.clone(),
            type_words: words(&root, schema, 0),
            default: schema
                .get("default")
                .map(|value| ron_words(&root, schema, value)),
            required: required(name),
            doc: text(schema, "description").to_owned(),
        };
        properties.iter().map(field).collect()
    }
}

fn text<'v>(value: &'v Value, key: &str) -> &'v str {
    value[key].as_str().unwrap_or_default()
}

/// The schema that a `$ref` leads to.
fn resolved<'v>(root: &'v Value, schema: &'v Value) -> &'v Value {
    let path = text(schema, "$ref").strip_prefix('#');
    path.and_then(|path| root.pointer(path)).unwrap_or(schema)
}

/// A type in words. Types that hold themselves end after a few levels.
fn words(root: &Value, schema: &Value, depth: usize) -> String {
    let schema = resolved(root, schema);
    if let Some(title) = schema["title"].as_str() {
        return title.to_owned();
    }
    if depth > 4 {
        return "value".to_owned();
    }
    let inner = |schema: &Value| words(root, schema, depth + 1);
    let any = |choices: &Vec<Value>| {
        let choices: Vec<_> = choices
            .iter()
            .filter(|c| c["type"] != "null")
            .map(inner)
            .collect();
        choices.join(" | ")
    };
    if let Some(name) = schema.get("const") {
        return bare(name);
    }
    if let Some(names) = schema["enum"].as_array() {
        return names.iter().map(bare).collect::<Vec<_>>().join(" | ");
    }
    if let Some(choices) = schema["oneOf"].as_array().or(schema["anyOf"].as_array()) {
        return any(choices);
    }
    if let Some(parts) = schema["prefixItems"].as_array() {
        return format!(
            "({})",
            parts.iter().map(inner).collect::<Vec<_>>().join(", ")
        );
    }
    let kinds = match &schema["type"] {
        Value::Array(kinds) => kinds
            .iter()
            .filter_map(Value::as_str)
            .find(|kind| *kind != "null"),
        kind => kind.as_str(),
    };
    match kinds {
        Some("array") => match &schema["minItems"] {
            count if count.is_u64() && *count == schema["maxItems"] => {
                format!(
                    "({})",
                    vec![inner(&schema["items"]); count.as_u64().map_or(0, |n| n as usize)]
                        .join(", ")
                )
            }
            _ => format!("list of {}", inner(&schema["items"])),
        },
        Some("object") => object(schema, inner),
        Some("boolean") => "true | false".to_owned(),
        Some("string") => "text".to_owned(),
        Some("integer") if schema["minimum"] == 0 => "whole number of at least 0".to_owned(),
        Some("integer") => "whole number".to_owned(),
        Some(kind) => kind.to_owned(),
        None => "value".to_owned(),
    }
}

/// A map, a choice that holds something (`Csv(file: text)`), or a struct.
fn object(schema: &Value, inner: impl Fn(&Value) -> String) -> String {
    let listed = |properties: &Map<String, Value>| {
        let fields: Vec<_> = properties
            .iter()
            .map(|(name, s)| format!("{name}: {}", inner(s)))
            .collect();
        format!("({})", fields.join(", "))
    };
    match (
        schema["properties"].as_object(),
        schema["required"].as_array(),
    ) {
        (Some(properties), Some(required))
            if properties.len() == 1 && required.len() == 1 && is_choice(properties) =>
        {
            let (name, held) = properties.iter().next().expect("there is one");
            match inner(held) {
                held if held.starts_with('(') => format!("{name}{held}"),
                held => format!("{name}({held})"),
            }
        }
        (Some(properties), _) => listed(properties),
        (None, _) if schema["additionalProperties"].is_object() => {
            format!("map of {}", inner(&schema["additionalProperties"]))
        }
        (None, _) => "()".to_owned(),
    }
}

/// Variants of enums are written with a capital, fields are not.
fn is_choice(properties: &Map<String, Value>) -> bool {
    properties
        .keys()
        .all(|name| name.starts_with(char::is_uppercase))
}

fn bare(value: &Value) -> String {
    value
        .as_str()
        .map_or_else(|| value.to_string(), str::to_owned)
}

/// A default, written as a scenario would.
fn ron_words(root: &Value, schema: &Value, value: &Value) -> String {
    let schema = resolved(root, schema);
    match value {
        Value::Null => "None".to_owned(),
        // The name of a choice stands without quotes.
        Value::String(name) if schema["type"] != "string" || !schema["enum"].is_null() => {
            name.clone()
        }
        Value::Array(items) => {
            let items: Vec<_> = items
                .iter()
                .map(|item| ron_words(root, &schema["items"], item))
                .collect();
            let is_tuple = schema["minItems"] == schema["maxItems"] && schema["minItems"].is_u64();
            if is_tuple {
                format!("({})", items.join(", "))
            } else {
                format!("[{}]", items.join(", "))
            }
        }
        // A choice that holds one value.
        Value::Object(fields) if fields.len() == 1 && is_choice(fields) => {
            let held = fields.iter();
            held.map(|(name, v)| format!("{name}({})", ron_words(root, &Value::Null, v)))
                .collect()
        }
        Value::Object(fields) => {
            let fields: Vec<_> = fields
                .iter()
                .map(|(name, v)| {
                    format!(
                        "{name}: {}",
                        ron_words(root, &schema["properties"][name], v)
                    )
                })
                .collect();
            format!("({})", fields.join(", "))
        }
        // Whole numbers read better without `.0`.
        other => other.to_string().trim_end_matches(".0").to_owned(),
    }
}
