//! Uncertain numbers of scenarios: what is declared or given is found, what is wrong is refused at its place.

use auxetica_config::Source;
use auxetica_identify::Parameter;

const BEAM: &str = r#"(
    title: "two beams",
    rods: [
        (name: "a", length: 0.1, elements: 4, radius: 0.01, density: 1000, material: Moduli(youngs: 1e6, shear: 4e5)),
        (name: "b", length: 0.2, elements: 4, radius: 0.01, density: 1000, material: Moduli(youngs: 1e6, shear: 5e5)),
    ],
    solver: Steady(),
    uncertain: [
        (name: "Young's modulus", path: "rods[*].material.youngs", unit: "Pa", range: (1e5, 1e7), prior: (1e6, 1e5)),
    ],
)"#;

fn source(sets: &[&str]) -> Source {
    let sets: Vec<_> = sets.iter().map(|set| (*set).to_owned()).collect();
    Source::from_text("beams.ron", BEAM, &sets).expect("loaded")
}

#[test]
fn one_parameter_stands_for_several_places() {
    let parameters = Parameter::declared(&source(&[])).expect("good");
    let [youngs] = parameters.as_slice() else {
        panic!("{parameters:?}")
    };
    assert_eq!(
        (youngs.nominal, youngs.range, youngs.prior),
        (1e6, (1e5, 1e7), Some((1e6, 1e5)))
    );
    let changed = source(&[]).with(&[youngs.set(2.5e6)]).expect("set");
    assert_eq!(changed.values(&youngs.path), Ok(vec!["2.5e6", "2.5e6"]));
}

#[test]
fn a_parameter_is_given_by_path_and_range() {
    let given = Parameter::given(&source(&[]), "rods[1].length = 0.1..0.3").expect("good");
    assert_eq!(
        (given.name.as_str(), given.nominal, given.range),
        ("rods[1].length", 0.2, (0.1, 0.3))
    );
}

#[test]
fn what_is_declared_wrongly_is_refused_at_its_place() {
    for (set, words) in [
        (
            "uncertain[0].path=\"rods[*].material.young\"",
            ["gives no value at", "mend the path"],
        ),
        (
            "uncertain[0].path=\"rods[2].length\"",
            ["has no [2]", "uncertain[0].path"],
        ),
        (
            "uncertain[0].path=\"rods[0].name\"",
            ["is no number", "name a single number"],
        ),
        (
            "uncertain[0].path=\"rods[0].material\"",
            ["is no number", "name a single number"],
        ),
        (
            "uncertain[0].path=\"rods[*].material.shear\"",
            ["different numbers, 400000 and 500000", "one by one"],
        ),
        (
            "uncertain[0].path=\"\"",
            ["a path is missing", "paths look like"],
        ),
        (
            "uncertain[0].range=(1e7, 1e5)",
            ["empty or reversed", "lesser end first"],
        ),
        (
            "uncertain[0].range=(2e6, 1e7)",
            ["outside the range", "widen it"],
        ),
    ] {
        let told = Parameter::declared(&source(&[set]))
            .expect_err(set)
            .to_string();
        let built = auxetica_engine::Model::build(&source(&[set]), None)
            .err()
            .expect("refused")
            .to_string();
        assert_eq!(told, built, "a scenario is checked alike whoever reads it");
        for word in words {
            assert!(
                told.contains(word),
                "{set}: `{word}` is missing from\n{told}"
            );
        }
    }
    let none = Parameter::declared(&source(&["uncertain=[]"]))
        .expect_err("nothing")
        .to_string();
    assert!(
        none.contains("declares nothing under `uncertain`"),
        "{none}"
    );
    let twice = "uncertain[+]=(name: \"Young's modulus\", path: \"rods[0].length\", range: (0, 1))";
    let twice = auxetica_engine::Model::build(&source(&[twice]), None)
        .err()
        .expect("refused")
        .to_string();
    assert!(twice.contains("is taken"), "{twice}");
}

#[test]
fn what_is_given_wrongly_is_refused() {
    for (text, words) in [
        ("rods[0].length", "write PATH=a..b"),
        ("rods[0].length=0.1", "write PATH=a..b"),
        ("rods[0].length=a..b", "write PATH=a..b"),
        ("rods[0].length=0.05..NaN", "write PATH=a..b"),
        ("rods[0].length=0.3..0.1", "lesser end first"),
        ("rods[0].length=0.2..0.3", "outside the range"),
        ("rods[0].radii=0.1..0.3", "gives no value at"),
        ("rods[0].lenght.x=0.1..0.3", "did you mean `length`"),
        ("rods[0].name=0.1..0.3", "is no number"),
        ("laws[*].apply.factor=0.1..0.3", "has no `laws`"),
    ] {
        let told = Parameter::given(&source(&[]), text)
            .expect_err(text)
            .to_string();
        assert!(
            told.contains(words),
            "{text}: `{words}` is missing from\n{told}"
        );
    }
}
