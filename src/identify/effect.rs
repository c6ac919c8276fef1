//! Physics that a scenario may lack: what it is called, what it says, and how it changes the scenario.

use auxetica_config::{Hook, Problems, Source, plugins};
use auxetica_engine::scenario::{Scenario, Targets};
use std::any::TypeId;

/// Which part of a model an effect belongs to.
#[derive(Clone, Copy, Debug, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Hooked {
    /// The rods' law.
    Constitutive,
    /// External loads.
    Forcing,
    /// Motors and clamps.
    Boundary,
    /// Joints between rods and platform.
    Joint,
    /// Masses and inertias.
    Body,
    /// How the robot was recorded, not how it is.
    Recording,
}

impl Hooked {
    /// Its name in JSON.
    #[must_use]
    pub fn name(self) -> String {
        format!("{self:?}").to_lowercase()
    }
}

/// A number of an effect.
#[derive(Clone, Debug, PartialEq)]
pub struct Quantity {
    /// What reports call it.
    pub name: String,
    /// Its unit.
    pub unit: &'static str,
    /// Value at which the effect is not there.
    pub null: f64,
    /// A value at which it is plainly there; the search begins with it, and its size is the scale.
    pub typical: f64,
    /// Least and largest value that is physical.
    pub range: (f64, f64),
}

impl Quantity {
    /// Whether the effect fades as the number grows, as with a stiffness that gives way.
    #[must_use]
    pub fn absent_where_large(&self) -> bool {
        self.typical > 0.0 && self.null / self.typical > 2.0
    }
}

/// One form of an effect: its numbers, and the changes of the scenario in which `{0}`, `{1}` .. stand for them (`-{0}` for
/// the opposite).
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Variant {
    /// What distinguishes it from the effect's other forms, such as the rod; empty if there is one only.
    pub name: String,
    /// Its numbers.
    pub quantities: Vec<Quantity>,
    changes: Vec<Change>,
}

#[derive(Clone, Debug, PartialEq)]
enum Change {
    /// Puts a value at a path.
    Set(String, String),
    /// Adds an entry to a list of the scenario, which may not be there yet.
    Append(&'static str, String),
}

impl Variant {
    /// A form of this name, without numbers or changes.
    #[must_use]
    pub fn new(name: impl Into<String>) -> Self {
        Self {
            name: name.into(),
            ..Self::default()
        }
    }

    /// Adds a number: its name, unit, the value at which the effect isn't there, a typical one, and the range.
    #[must_use]
    pub fn number(
        mut self,
        name: impl Into<String>,
        unit: &'static str,
        (null, typical): (f64, f64),
        range: (f64, f64),
    ) -> Self {
        self.quantities.push(Quantity {
            name: name.into(),
            unit,
            null,
            typical,
            range,
        });
        self
    }

    /// Puts `value` at `path` of the scenario.
    #[must_use]
    pub fn set(mut self, path: impl Into<String>, value: impl Into<String>) -> Self {
        self.changes.push(Change::Set(path.into(), value.into()));
        self
    }

    /// Adds an entry to `list` of the scenario.
    #[must_use]
    pub fn append(mut self, list: &'static str, entry: impl Into<String>) -> Self {
        self.changes.push(Change::Append(list, entry.into()));
        self
    }

    /// The scenario with the effect at these values.
    ///
    /// # Errors
    /// If the scenario has no place for a change.
    pub fn apply(&self, source: &Source, values: &[f64]) -> Result<Source, Problems> {
        let filled = |text: &str| {
            let mut text = text.to_owned();
            for (k, value) in values.iter().enumerate() {
                let place = format!("{{{k}}}");
                text = text.replace(&format!("-{place}"), &format!("{:?}", -value));
                text = text.replace(&place, &format!("{value:?}"));
            }
            text
        };
        let mut changed: Option<Source> = None;
        for change in &self.changes {
            let now = changed.as_ref().unwrap_or(source);
            let set = match change {
                Change::Set(path, value) => format!("{path}={}", filled(value)),
                Change::Append(list, entry) if now.values(list).is_ok() => {
                    format!("{list}[+]={}", filled(entry))
                }
                Change::Append(list, entry) => format!("{list}=[{}]", filled(entry)),
            };
            changed = Some(now.with(&[set])?);
        }
        match changed {
            Some(changed) => Ok(changed),
            None => source.with(&[]),
        }
    }
}

/// What effects need to know of a scenario.
#[derive(Clone, Debug, Default, PartialEq)]
pub struct Robot {
    /// Names of all rods, in the order of the scenario.
    pub rods: Vec<String>,
    /// Names of its rigid bodies.
    pub cylinders: Vec<String>,
    /// Names of its markers, in the order of the scenario.
    pub markers: Vec<String>,
    /// Of each rod, in the same order, +1 or -1 as its law says that it is handed; 0 if it says nothing.
    pub handed: Vec<f64>,
    /// Lengths of each group of rods \[m\].
    pub lengths: Vec<f64>,
    /// Offsets of the markers \[m\].
    pub offsets: Vec<[f64; 3]>,
    /// Which of its rod laws say how rods are handed.
    pub handed_laws: Vec<usize>,
    /// Number of joint entries.
    pub joints: usize,
    /// Whether gravity acts already.
    pub gravity: bool,
}

impl Robot {
    /// Reads it from a scenario.
    ///
    /// # Errors
    /// If the scenario can't be read.
    pub fn of(source: &Source) -> Result<Self, Problems> {
        let scenario: Scenario<'_> = source.parse()?;
        let groups = scenario.rods.iter();
        let (groups, rods): (Vec<String>, Vec<String>) = groups
            .flat_map(|group| {
                let name = |rod: &str| (group.name.clone(), rod.to_owned());
                group.names().into_iter().map(name).collect::<Vec<_>>()
            })
            .unzip();
        let mut handed_laws = Vec::new();
        let mut handed = vec![0.0; rods.len()];
        for (i, law) in scenario.laws.iter().enumerate() {
            let handedness = source.values(&format!("laws[{i}].apply.handedness"));
            let sign = match handedness.as_deref() {
                Ok(["Right"]) => 1.0,
                Ok(["Left"]) => -1.0,
                _ => continue,
            };
            handed_laws.push(i);
            let named = |name: &String| law.on.names().contains(name);
            for (r, handed) in handed.iter_mut().enumerate() {
                if law.on == Targets::All || named(&rods[r]) || named(&groups[r]) {
                    *handed = sign;
                }
            }
        }
        let is_gravity = |slot: &str| slot.trim_start().starts_with("Gravity");
        Ok(Self {
            rods,
            handed,
            lengths: scenario.rods.iter().map(|group| *group.length).collect(),
            offsets: scenario.markers.iter().map(|m| *m.offset).collect(),
            cylinders: (scenario.cylinders.iter())
                .map(|c| c.name.clone())
                .collect(),
            markers: scenario.markers.iter().map(|m| m.name.clone()).collect(),
            handed_laws,
            joints: scenario.joints.len(),
            gravity: (scenario.forcing.iter()).any(|f| is_gravity(f.apply.get_ron())),
        })
    }
}

/// A physical effect, or a fault of the recording, that may explain why a simulation differs from a recording.
pub trait Effect: Send + Sync {
    /// Its name in reports and JSON.
    fn id(&self) -> &'static str;
    /// What it is, in a sentence for a roboticist.
    fn words(&self) -> &'static str;
    /// Its equation; what its terms follow if it is no cause.
    fn equation(&self) -> &'static str;
    /// Which part of the model it belongs to.
    fn hook(&self) -> Hooked;
    /// Its forms on a robot; none where it can't act.
    fn variants(&self, robot: &Robot) -> Vec<Variant>;
    /// The experiment that tells it from what looks like it.
    fn experiment(&self) -> &'static str;
    /// Whether it shows in what the motors report as their loads, and not in poses.
    fn in_loads(&self) -> bool {
        false
    }
    /// Whether it is a cause. What is none only describes: its forms are terms of a law, of which several may be taken, and
    /// they are tried where no cause explains the mismatch.
    fn is_cause(&self) -> bool {
        true
    }
}

impl Hook for dyn Effect {
    const NOUN: &'static str = "effect";
    const SLOT: &'static str = "effects";
}

impl dyn Effect {
    /// Every effect that is linked into this program, those that only describe included, by id.
    ///
    /// # Panics
    /// If an effect's own example does not build; a test holds that it does.
    #[must_use]
    pub fn all() -> Vec<Box<dyn Effect>> {
        let mine = plugins().filter(|p| (p.hook)() == TypeId::of::<dyn Effect>());
        let mut effects: Vec<Box<dyn Effect>> = mine
            .map(|plugin| {
                let built = (plugin.build)(&auxetica_config::options(), plugin.example);
                let built = built.unwrap_or_else(|e| panic!("{}: {e}", plugin.name));
                *built.downcast().expect("a plugin is what it registers as")
            })
            .collect();
        effects.sort_by_key(|effect| effect.id());
        effects
    }
}
