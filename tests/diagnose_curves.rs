//! Diagnoses of rods by their measured curves: of Good et al.'s rods the blocked force is found on its own and predicted
//! better on rods left out; nothing is named on curves of the paper's own law, an effect that made them is; misuse is told.

mod program;

use program::{list, number, refused, rod, shipped, works};
use serde_json::Value;
use std::fmt::Write as _;
use std::fs;
use std::path::Path;

const GOOD_2022: &str = concat!(env!("CARGO_MANIFEST_DIR"), "/src/characterise/good2022.csv");

/// `diagnose --json -`
fn diagnosed(folder: &Path, arguments: &[&str]) -> Value {
    let all = [&["diagnose"], arguments, &["--json", "-"]].concat();
    serde_json::from_str(&works(folder, &all)).expect("JSON alone on stdout")
}

/// Root mean square of held-out figures of a rod, in units of the error bars.
fn held_out(fitted: &Value, rod: &str) -> f64 {
    let figures = list(&fitted["figures"]).iter();
    let of_rod = |f: &&Value| f["rod"] == rod && f["role"] == "holdout";
    let found = figures.clone().find(of_rod);
    number(&found.unwrap_or_else(|| panic!("{rod} was held out"))["rms_in_bars"])
}

/// Curves of the rod of 8 rows as `set` makes it, each a deviation of 2 % of the largest value off, up and down in turn.
fn made(folder: &Path, set: &[&str]) -> String {
    let scenario = rod(8);
    let mut arguments = vec![
        "characterise",
        &scenario,
        "--angles",
        "0..150:6",
        "--json",
        "-",
    ];
    set.iter().for_each(|set| arguments.extend(["--set", set]));
    let made: Value = serde_json::from_str(&works(folder, &arguments)).expect("JSON");
    let mut text = String::from("quantity,unit,twist_angle_deg,value,error_minus,error_plus\n");
    for (quantity, unit, key, si, bar) in [
        ("holding_torque", "N mm", "holding_torque_n_m", 1e-3, 1.1),
        (
            "minimum_energy_length",
            "mm",
            "minimum_energy_length_m",
            1e-3,
            0.2,
        ),
        (
            "spring_constant",
            "N/mm",
            "spring_constant_n_per_m",
            1e3,
            0.015,
        ),
        ("blocked_force", "N", "blocked_force_n", 1.0, 0.14),
    ] {
        for (i, at) in list(&made["states"]).iter().enumerate() {
            let value = number(&at[key]) / si;
            let off = if i % 2 == 0 { bar } else { -bar };
            let angle = number(&at["twist_angle_rad"]).to_degrees();
            writeln!(
                text,
                "{quantity},{unit},{angle},{},{bar},{bar}",
                value + off
            )
            .unwrap();
        }
    }
    let path = folder.join("made.csv");
    fs::write(&path, text).unwrap();
    path.to_str().expect("plain").to_owned()
}

#[test]
fn of_published_rods_the_blocked_force_is_found_and_predicted_better_on_rods_left_out() {
    let folder = tempfile::tempdir().unwrap();
    let rods = [4, 6, 8, 10, 12].map(rod);
    let mut arguments: Vec<&str> = rods.iter().map(String::as_str).collect();
    let effects =
        "auxetic_nonlinearity,axial_nonlinearity,motor_compliance,tension_compression_asymmetry";
    let scenario = folder.path().join("fitted.ron");
    let scenario = scenario.to_str().expect("plain");
    arguments.extend(["--curves", GOOD_2022, "--effects", effects]);
    arguments.extend(["--write-scenario", scenario]);
    let d = diagnosed(folder.path(), &arguments);
    let first = &list(&d["location"]["quantities"])[0];
    assert_eq!(first["quantity"], "blocked_force");
    assert!(number(&first["share"]) > 0.8, "{first}");
    assert!(
        d["location"]["state"]
            .as_str()
            .unwrap()
            .contains("too high")
    );
    assert_eq!(
        d["effects"][0]["id"], "axial_nonlinearity",
        "{}",
        d["words"]
    );
    let (before, after) = (
        held_out(&d["baseline"], "all"),
        held_out(&d["augmented"], "all"),
    );
    assert!(after < 2.0 / 3.0 * before, "{before} -> {after} error bars");
    for rows in [4, 6, 8, 10, 12] {
        let rod = format!("{rows} rows");
        let (before, after) = (
            held_out(&d["baseline"], &rod),
            held_out(&d["augmented"], &rod),
        );
        assert!(after < before, "{rod}: {before} -> {after}");
    }
    // what the calibration by all quantities would hide
    let told = |alarm: &Value| {
        alarm
            .as_str()
            .is_some_and(|a| a.starts_with("8 rows: extension factor"))
    };
    assert!(list(&d["alarms"]).iter().any(told), "{}", d["alarms"]);
    let written = folder.path().join("fitted-hsa_rod_8rows.ron");
    let shown = works(
        folder.path(),
        &[
            "characterise",
            written.to_str().expect("plain"),
            "--good2022",
            "8",
        ],
    );
    assert!(shown.contains("blocked force [N]"));
}

#[test]
fn nothing_is_named_on_curves_of_the_same_law_with_other_numbers() {
    let folder = tempfile::tempdir().unwrap();
    let sets = [
        "laws[0].apply.factor=3.2e-3",
        "rods[0].material.youngs=2.4e5",
    ];
    let curves = made(folder.path(), &sets);
    let d = diagnosed(folder.path(), &[&rod(8), "--curves", &curves]);
    assert_eq!(d["verdict"], "none", "{}", d["words"]);
    assert!(list(&d["effects"]).is_empty() && list(&d["alarms"]).is_empty());
}

#[test]
fn the_effect_that_made_the_curves_is_named_with_its_value() {
    let folder = tempfile::tempdir().unwrap();
    let sets = ["laws[+]=(apply: Nonlinear(compression: 0.6))"];
    let curves = made(folder.path(), &sets);
    let effects = "auxetic_nonlinearity,motor_compliance,tension_compression_asymmetry,twist_dependent_stiffness";
    let d = diagnosed(
        folder.path(),
        &[&rod(8), "--curves", &curves, "--effects", effects],
    );
    assert_eq!(d["verdict"], "effect", "{}", d["words"]);
    assert_eq!(d["location"]["quantities"][0]["quantity"], "blocked_force");
    let named = &d["effects"][0];
    assert_eq!(named["id"], "tension_compression_asymmetry");
    let ratio = &named["parameters"][0];
    assert!((number(&ratio["value"]) - 0.6).abs() < 0.05, "{ratio}");
    let ends = list(&ratio["ci95"]);
    assert!(number(&ends[0]) < 0.6 && number(&ends[1]) > 0.6, "{ratio}");
    assert!(held_out(&d["augmented"], "rod") < 2.0, "{}", d["augmented"]);
}

#[test]
fn misuse_is_told_with_a_remedy() {
    let folder = tempfile::tempdir().unwrap();
    let at = folder.path();
    let table = |text: &str| {
        let path = at.join("table.csv");
        fs::write(&path, text).unwrap();
        path.to_str().expect("plain").to_owned()
    };
    let header = "quantity,unit,twist_angle_deg,value,error_minus,error_plus\n";
    let (eight, robot) = (rod(8), shipped("hsa_robot.ron"));
    let robot = robot.to_str().expect("plain");
    let no = |arguments: &[&str], words: &[&str]| {
        refused(at, &[&["diagnose"], arguments].concat(), 2, words);
    };
    no(
        &[&eight, "--curves", "nowhere.csv"],
        &["nowhere.csv", "can't be read"],
    );
    let nan = table(&format!("{header}blocked_force,N,30,NaN,0.1,0.1\n"));
    no(
        &[&eight, "--curves", &nan],
        &["line 2", "`value`", "not finite"],
    );
    let unknown = table(&format!("{header}blocked_farce,N,30,1,0.1,0.1\n"));
    no(
        &[&eight, "--curves", &unknown],
        &["line 2", "blocked_farce", "blocked_force"],
    );
    let few = table(&format!("{header}blocked_force,N,30,1,0.1,0.1\n"));
    no(
        &[&eight, "--curves", &few],
        &["table.csv", "1 quantities at 1 angles", "measure 2"],
    );
    let other = "rods[0].length=0.3";
    no(
        &[&eight, "--set", other, "--curves", GOOD_2022],
        &["no rod as long", "300.0 mm", "--rows"],
    );
    no(
        &[&eight, "--curves", GOOD_2022, "--rows", "7"],
        &["no rod of 7 rows", "4, 6, 8, 10, 12"],
    );
    no(
        &[&eight, "--curves", GOOD_2022, "--rows", "8,10"],
        &["2 rods", "1 scenarios"],
    );
    no(
        &[&eight, &eight, "--curves", GOOD_2022],
        &["both taken", "8 rows"],
    );
    no(
        &[robot, "--curves", GOOD_2022, "--rows", "8"],
        &["several rods"],
    );
    no(
        &[&eight, "--curves", GOOD_2022, "--effects", "gravitas"],
        &["gravity"],
    );
    no(
        &[&eight, "--curves", GOOD_2022, "--set", "uncertain=[]"],
        &["uncertain"],
    );
    no(
        &[&eight, "--curves", GOOD_2022, "--train", "somewhere"],
        &["--train"],
    );
    no(&[&eight], &["--train"]);
    no(
        &[&eight, &eight, "--train", "a", "b", "--holdout", "c"],
        &["several scenarios"],
    );
}
