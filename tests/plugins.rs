//! The shipped plugins: every crate of them is linked, every example builds, unknown fields are refused, every field
//! says what it means, and the command line shows all of it within the width of a page.

mod program;

use auxetica::config::{Plugin, options, plugins};
use program::works;

/// A crate that isn't linked, a plugin that is renamed or one that is new shows here.
const SHIPPED: [(&str, &str); 74] = [
    ("boundary", "Clamp"),
    ("boundary", "Hold"),
    ("boundary", "MotorAngle"),
    ("boundary", "MotorTorque"),
    ("callbacks", "Csv"),
    ("callbacks", "Npz"),
    ("callbacks", "Parquet"),
    ("damping", "LinearDamping"),
    ("drives", "Backlash"),
    ("drives", "Delay"),
    ("drives", "Gear"),
    ("drives", "Lag"),
    ("effects", "AuxeticNonlinearity"),
    ("effects", "AxialNonlinearity"),
    ("effects", "BacklashEffect"),
    ("effects", "BaseComplianceEffect"),
    ("effects", "BendingAnisotropy"),
    ("effects", "BendingNonlinearity"),
    ("effects", "CrossCoupling"),
    ("effects", "EffectiveLength"),
    ("effects", "EncoderScale"),
    ("effects", "EncoderZero"),
    ("effects", "FrameMisalignment"),
    ("effects", "GravityEffect"),
    ("effects", "HysteresisEffect"),
    ("effects", "IntrinsicCurvature"),
    ("effects", "JointClearance"),
    ("effects", "JointCompliance"),
    ("effects", "KelvinVoigtEffect"),
    ("effects", "LoadCalibration"),
    ("effects", "MarkerOffset"),
    ("effects", "MotorComplianceEffect"),
    ("effects", "MotorFriction"),
    ("effects", "MotorLag"),
    ("effects", "MountTilt"),
    ("effects", "ObstacleEffect"),
    ("effects", "PayloadEffect"),
    ("effects", "PermanentSetEffect"),
    ("effects", "ReciprocalCoupling"),
    ("effects", "RodAsymmetry"),
    ("effects", "StiffnessGradient"),
    ("effects", "TensionCompressionAsymmetry"),
    ("effects", "TetherEffect"),
    ("effects", "ThermalDrift"),
    ("effects", "TimeOffset"),
    ("effects", "TwistDependentStiffness"),
    ("effects", "Unknown"),
    ("effects", "ViscoelasticCreep"),
    ("forcing", "EndForce"),
    ("forcing", "EndTorque"),
    ("forcing", "Gravity"),
    ("forcing", "Obstacle"),
    ("forcing", "Payload"),
    ("forcing", "Tether"),
    ("forcing", "UniformForce"),
    ("inputs", "ActuationSequence"),
    ("inputs", "Channels"),
    ("inputs", "MotionPrimitives"),
    ("inputs", "Together"),
    ("joints", "SpringDamper"),
    ("laws", "Auxetic"),
    ("laws", "BaseCompliance"),
    ("laws", "Coupling"),
    ("laws", "Creep"),
    ("laws", "Drift"),
    ("laws", "Extension"),
    ("laws", "Hysteresis"),
    ("laws", "Intrinsic"),
    ("laws", "KelvinVoigt"),
    ("laws", "MotorCompliance"),
    ("laws", "Nonlinear"),
    ("laws", "PermanentSet"),
    ("laws", "Stiffness"),
    ("laws", "StrainEnergy"),
];

/// Widest line printed where there is no terminal.
const WIDEST: usize = 110;

fn build(plugin: &Plugin, text: &str) -> Result<(), String> {
    let built = (plugin.build)(&options(), text);
    built.map(drop).map_err(|e| e.to_string())
}

#[test]
fn the_shipped_plugins_are_these() {
    let mut found: Vec<_> = plugins().map(|p| (p.slot, p.name)).collect();
    found.sort_unstable();
    assert_eq!(found, SHIPPED);
}

#[test]
fn every_example_builds() {
    for plugin in plugins() {
        let built = build(plugin, plugin.example);
        assert!(built.is_ok(), "{}: {built:?}", plugin.name);
        assert!(plugin.example.starts_with(plugin.name), "{}", plugin.name);
    }
}

#[test]
fn an_unknown_field_is_refused() {
    for plugin in plugins() {
        let (fields, _) = plugin.example.rsplit_once(')').expect("a bracket");
        let comma = if fields.ends_with('(') { "" } else { ", " };
        let error = build(plugin, &format!("{fields}{comma}surely_not: 1)"));
        let error = error.expect_err(plugin.name);
        assert!(error.contains("surely_not"), "{}: {error}", plugin.name);
    }
}

#[test]
fn everything_is_documented() {
    for plugin in plugins() {
        assert!(!plugin.summary().is_empty(), "{}", plugin.name);
        assert!(!plugin.source.is_empty(), "{}", plugin.name);
        for field in plugin.fields() {
            let name = format!("{}.{}", plugin.name, field.name);
            assert!(
                field.doc.trim_end().ends_with('.'),
                "{name}: {:?}",
                field.doc
            );
            assert!(field.type_words != "value", "{name} has no type");
            assert!(
                field.required || field.default.is_some(),
                "{name} may be left out, but what is it then?"
            );
            let default = field.default.unwrap_or_default();
            assert!(default.len() < 60, "{name}: {default}");
        }
    }
}

#[test]
fn the_list_names_all() {
    let folder = tempfile::tempdir().unwrap();
    let list = works(folder.path(), &["plugins"]);
    for (slot, name) in SHIPPED {
        assert!(list.contains(&format!("{slot}:\n")), "{slot}: {list}");
        assert!(list.contains(&format!("\n {name} ")), "{name}: {list}");
    }
    narrow(&list);
}

#[test]
fn every_plugin_is_explained() {
    let folder = tempfile::tempdir().unwrap();
    for plugin in plugins() {
        let text = works(folder.path(), &["plugins", plugin.name]);
        assert!(
            text.contains(&format!("Source: {}\n", plugin.source)),
            "{text}"
        );
        assert!(
            text.contains(&format!("Example: {}\n", plugin.example)),
            "{text}"
        );
        for field in plugin.fields() {
            assert!(
                text.contains(&format!("\n {} ", field.name)),
                "{}: {text}",
                field.name
            );
        }
        narrow(&text);
    }
    let auxetic = works(folder.path(), &["plugins", "Auxetic"]);
    for words in [
        "[m/rad]",
        "Right | Left",
        "Paper",
        "(shear: 0, axial: 0,",
        "unlimited if left out",
    ] {
        assert!(auxetic.contains(words), "{words}: {auxetic}");
    }
    assert!(
        !auxetic.contains("e+308") && !auxetic.contains("e308"),
        "{auxetic}"
    );
}

fn narrow(text: &str) {
    for line in text.lines().filter(|line| !line.starts_with("Example")) {
        assert!(line.chars().count() <= WIDEST, "too wide: {line}");
    }
}
