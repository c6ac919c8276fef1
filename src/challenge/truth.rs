//! What the cases of a challenge conceal.

use serde::{Deserialize, Serialize};

/// What one case conceals.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Truth {
    /// Name of the case: its folder.
    pub case: String,
    /// Effects, none in a control.
    pub effects: Vec<Concealed>,
    /// Values of the scenario's uncertain numbers, by name.
    pub parameters: Vec<(String, f64)>,
    /// Number of elements.
    pub elements: usize,
    /// Whether it is concealed in real recordings, which may conceal more that nobody has put down.
    pub real: bool,
}

/// An effect that is concealed.
#[derive(Clone, Debug, Serialize, Deserialize)]
pub struct Concealed {
    /// Its identifier; `foreign` if it is in no library.
    pub id: String,
    /// Its form, or what it is if it is in no library.
    pub form: String,
    /// Its part of the model, empty if it is in no library.
    pub hook: String,
    /// Its values, by name.
    pub values: Vec<(String, f64)>,
}

impl Concealed {
    /// Identifier of what is in no library.
    pub const FOREIGN: &'static str = "foreign";
}
