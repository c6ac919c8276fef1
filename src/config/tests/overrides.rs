//! Overrides reach exactly the values that their path means, and nothing else in the text.

use auxetica_config::Source;

fn set(text: &str, sets: &[&str]) -> Result<String, String> {
    let sets: Vec<_> = sets.iter().map(|set| (*set).to_owned()).collect();
    Source::from_text("test.ron", text, &sets)
        .map(|source| source.text().to_owned())
        .map_err(|problems| problems.to_string())
}

#[track_caller]
fn becomes(text: &str, change: &str, after: &str) {
    assert_eq!(set(text, &[change]).unwrap(), after);
}

#[test]
fn a_field_an_element_and_a_tuple_index_are_replaced() {
    becomes(
        "(rods: [(length: 0.1)])",
        "rods[0].length=0.2",
        "(rods: [(length: 0.2)])",
    );
    becomes("(a: [1, 2, 3])", "a[1] = 9", "(a: [1, 9, 3])");
    becomes(
        "(a: Gravity(g: (0, 0, -9.81)))",
        "a.g[2]=-1.6",
        "(a: Gravity(g: (0, 0, -1.6)))",
    );
    becomes(
        "(a: Gravity(g: 1), b: 2)",
        "a=Drag(c: 3)",
        "(a: Drag(c: 3), b: 2)",
    );
}

#[test]
fn comments_strings_and_raw_strings_do_not_mislead() {
    becomes(
        "#![enable(implicit_some)]\n(/* a: ( /* nested [ */ */ s: \"a: [(\\\"\", r: r#\"\"]\"#, c: ')', a: 1) // a: (",
        "a=2",
        "#![enable(implicit_some)]\n(/* a: ( /* nested [ */ */ s: \"a: [(\\\"\", r: r#\"\"]\"#, c: ')', a: 2) // a: (",
    );
}

#[test]
fn wildcards_reach_every_element_of_lists_and_maps() {
    becomes(
        "(l: [(a: X(f: 1)), (a: Y(f: 22))])",
        "l[*].a.f=3",
        "(l: [(a: X(f: 3)), (a: Y(f: 3))])",
    );
    becomes(
        "(l: {\"x\": (f: 1), \"y\": (f: 2)})",
        "l.*.f=3",
        "(l: {\"x\": (f: 3), \"y\": (f: 3)})",
    );
    let error = set("(l: [])", &["l[*].f=1"]).unwrap_err();
    assert!(error.contains("`l` is empty"), "{error}");
}

#[test]
fn map_keys_are_chosen_by_brackets_or_dots() {
    let text = "(at: {\"rod_1\": (0, 0, 0), \"a b\": 1})";
    becomes(
        text,
        "at[\"rod_1\"][0]=5",
        "(at: {\"rod_1\": (5, 0, 0), \"a b\": 1})",
    );
    becomes(
        text,
        "at.rod_1[0]=5",
        "(at: {\"rod_1\": (5, 0, 0), \"a b\": 1})",
    );
    becomes(
        text,
        "at['a b']=5",
        "(at: {\"rod_1\": (0, 0, 0), \"a b\": 5})",
    );
    becomes("(at: {})", "at.new=5", "(at: {\"new\": 5})");
    becomes(
        "(at: {\"a\": 1,})",
        "at['b=c']=2",
        "(at: {\"a\": 1, \"b=c\": 2,})",
    );
}

#[test]
fn absent_fields_are_inserted_and_lists_appended_to() {
    becomes("(a: 1, // one\n)", "b=2", "(a: 1, b: 2, // one\n)");
    becomes("()", "b=2", "(b: 2)");
    becomes("(l: [1])", "l[+]=2", "(l: [1, 2])");
    becomes("(l: [])", "l[+]=Gravity(g: 2)", "(l: [Gravity(g: 2)])");
    becomes("(o: Some((a: 1)))", "o.a=2", "(o: Some((a: 2)))");
}

#[test]
fn overrides_apply_in_order() {
    let text = set("(rods: [])", &["rods[+]=(length: 1)", "rods[0].length=2"]).unwrap();
    assert_eq!(text, "(rods: [(length: 2)])");
}

#[test]
fn a_value_is_taken_without_the_comment_behind_it() {
    becomes("(a: 1, b: 2)", "a=3 // three", "(a: 3, b: 2)");
}

#[test]
fn paths_that_lead_nowhere_say_what_is_there() {
    let text = "(rods: [(length: 0.1, elements: 25)], solver: Steady)";
    let fails = |change: &str, words: &[&str]| {
        let error = set(text, &[change]).unwrap_err();
        for word in words {
            assert!(error.contains(word), "{change}: no {word:?} in\n{error}");
        }
    };
    fails(
        "rds[0].length=1",
        &[
            "the scenario has no `rds`",
            "did you mean `rods`?",
            "--set rds[0].length=1",
        ],
    );
    fails(
        "rods[3].length=1",
        &["`rods` has no [3]", "it holds [0] to [0]"],
    );
    fails(
        "rods[0].lenght.x=1",
        &["`rods[0]` has no `lenght`", "did you mean `length`?"],
    );
    fails("rods.length=1", &["numbered elements"]);
    fails("solver.tolerance=1", &["`solver` is a single value"]);
    fails("rods[0].length", &["expected `=`"]);
    fails("=1", &["a path is missing"]);
    fails("rods[x]=1", &["not understood"]);
    fails("title=hello world", &["nothing may follow the value"]);
    fails("title=(1", &["never closed"]);
    fails("title=", &["expected a value"]);
}

#[test]
fn all_bad_overrides_are_reported_at_once() {
    let error = set("(a: 1)", &["b.c=1", "d.e=1"]).unwrap_err();
    assert!(error.contains("`b`") && error.contains("`d`"), "{error}");
}

#[test]
fn values_are_read_where_a_path_leads() {
    let text = "(base_is: 1, rods: [(length: 0.1 /* m */), (length: 2e-1)], name: \"a = b\")";
    let source = Source::from_text("test.ron", text, &["rods[0].length=0.3".to_owned()]).unwrap();
    assert_eq!(source.values("rods[*].length"), Ok(vec!["0.3", "2e-1"]));
    assert_eq!(source.values("name"), Ok(vec!["\"a = b\""]));
    let changed = source.with(&["rods[*].length=5".to_owned()]).unwrap();
    assert_eq!(changed.values("rods[*].length"), Ok(vec!["5", "5"]));
    assert_eq!(
        source.values("rods[0].length"),
        Ok(vec!["0.3"]),
        "the first is as it was"
    );
    for (path, words) in [
        (
            "rods[0].width",
            "gives no value at `rods[0].width`; write it there first",
        ),
        ("rods[2].length", "`rods` has no [2]; it holds [0] to [1]"),
        (
            "rods[0].length =",
            "` =` in the path is not understood; paths look like",
        ),
        ("", "a path is missing here; paths look like"),
    ] {
        let told = source.values(path).unwrap_err();
        assert!(told.contains(words), "{path}: {told}");
    }
}
