//! The physics that a model of a robot of rods most often lacks, as effects that `auxetica diagnose` tries.

mod boundary;
mod constitutive;
mod forcing;
mod joint;
mod recording;
mod unknown;

/// Registers an effect: its type, id, part of the model, words, equation, experiment, source and variants, and what else is true
/// of it.
macro_rules! effect {
    ($(#[$doc:meta])* $name:ident, $id:literal, $hook:ident, $words:literal, $equation:literal, $experiment:literal,
     $source:literal, |$robot:ident| $variants:expr $(, $more:ident)?) => {
        $(#[$doc])*
        #[derive(Clone, Debug, serde::Deserialize, schemars::JsonSchema)]
        #[serde(deny_unknown_fields)]
        pub struct $name {}

        auxetica_engine::register!(
            dyn auxetica_identify::Effect: $name,
            example = concat!(stringify!($name), "()"),
            source = $source,
        );

        impl auxetica_identify::Effect for $name {
            fn id(&self) -> &'static str {
                $id
            }
            fn words(&self) -> &'static str {
                $words
            }
            fn equation(&self) -> &'static str {
                $equation
            }
            fn hook(&self) -> auxetica_identify::Hooked {
                auxetica_identify::Hooked::$hook
            }
            fn variants(&self, $robot: &auxetica_identify::Robot) -> Vec<auxetica_identify::Variant> {
                $variants
            }
            fn experiment(&self) -> &'static str {
                $experiment
            }
            $(fn $more(&self) -> bool {
                true
            })?
        }
    };
}
pub(crate) use effect;

/// One form for each rod, as `form` makes it of the rod's name.
pub(crate) fn each_rod(
    robot: &auxetica_identify::Robot,
    what: &str,
    form: impl Fn(auxetica_identify::Variant, &str) -> auxetica_identify::Variant,
) -> Vec<auxetica_identify::Variant> {
    let variant = |rod: &String| {
        let name = [what, rod].join(" ").trim().to_owned();
        form(auxetica_identify::Variant::new(name), rod)
    };
    robot.rods.iter().map(variant).collect()
}
