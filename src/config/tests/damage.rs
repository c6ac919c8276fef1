//! Whatever is done to a scenario's text, reading it ends in a value or in a report, never a panic.

use std::collections::BTreeMap;

use auxetica_config::{Direction, Positive, Profile, Source, Vec3};
use ron::value::RawValue;
use serde::Deserialize;

const TEXT: &str = "#![enable(unwrap_newtypes)]
(
    title: \"x [ \\\" é\", /* a ( /* nested */ comment */
    raw: r#\"\"quoted\" (\"#,
    at: {\"rod_1\": (0, 0.5, -1e-3)},
    laws: [(on: ['a', '\\''], apply: Auxetic(handedness: Right, factor: 0.01))], // )
    along: (0, 0, 2), profile: [1, 2], length: 0.1,
)
";

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(dead_code, reason = "only whether it can be read is of interest")]
struct Scenario<'a> {
    title: String,
    raw: String,
    at: BTreeMap<String, Vec3>,
    #[serde(borrow)]
    laws: Vec<Law<'a>>,
    along: Option<Direction>,
    profile: Profile,
    length: Positive,
}

#[derive(Deserialize)]
#[serde(deny_unknown_fields)]
#[expect(dead_code, reason = "only whether it can be read is of interest")]
struct Law<'a> {
    on: Vec<char>,
    #[serde(borrow)]
    apply: &'a RawValue,
}

/// Reads and reports as a program would; true if it could be read.
fn read(text: &str) -> bool {
    let sets = [
        "laws[*].apply.factor=0.02".to_owned(),
        "at.new=(1, 2, 3)".to_owned(),
    ];
    [&sets[..], &[]].into_iter().all(|sets| {
        let result = Source::from_text("test.ron", text, sets)
            .and_then(|source| source.parse::<Scenario>().map(|_| ()));
        result
            .map_err(|problems| assert!(!problems.render(true).is_empty()))
            .is_ok()
    })
}

#[test]
fn the_whole_text_can_be_read() {
    let source = Source::from_text("test.ron", TEXT, &[]).unwrap();
    source
        .parse::<Scenario>()
        .map(|_| ())
        .unwrap_or_else(|problems| panic!("{problems}"));
    assert!(read(TEXT));
}

#[test]
fn a_text_cut_anywhere_is_refused_cleanly() {
    let end = TEXT.trim_end().len();
    for cut in (0..end).filter(|cut| TEXT.is_char_boundary(*cut)) {
        assert!(!read(&TEXT[..cut]), "read although cut at {cut}");
    }
}

#[test]
fn a_text_with_any_character_changed_is_read_or_refused_cleanly() {
    for (at, old) in TEXT.char_indices() {
        for new in "()[]{}\"'\\/*:,#r0-.eé \n\u{1f}"
            .chars()
            .filter(|new| *new != old)
        {
            read(&format!(
                "{}{new}{}",
                &TEXT[..at],
                &TEXT[at + old.len_utf8()..]
            ));
        }
        read(&format!("{}{}", &TEXT[..at], &TEXT[at + old.len_utf8()..]));
    }
}

#[test]
fn odd_texts_and_overrides_are_refused_cleanly() {
    for text in [
        "",
        " ",
        "é",
        "\u{feff}",
        "(",
        "/*",
        "#![",
        "r#",
        "b'",
        "\"\\",
        "((((1))))",
    ] {
        read(text);
    }
    read(&"(".repeat(100_000));
    read(&"[".repeat(5_000));
    for set in [
        "",
        "é",
        "=",
        "a",
        "a=",
        "a[",
        "a[é",
        "a['",
        "a[\"é=1",
        "a.=1",
        "..=1",
        "[",
        "a=é",
        "title=é",
        "title.é=1",
        "[*]=1",
        "a[99999999999999999999]=1",
    ] {
        if let Err(problems) = Source::from_text("test.ron", TEXT, &[set.to_owned()]) {
            assert!(!problems.to_string().is_empty());
        }
    }
}

#[test]
fn unclosed_brackets_and_strings_are_reported_where_they_open() {
    let error = |text: &str| Source::from_text("t", text, &[]).unwrap_err().to_string();
    let open = error("(\n  a: [1, 2,\n");
    assert!(
        open.contains("t:2:6") && open.contains("this `[` is never closed"),
        "{open}"
    );
    let open = error("(\n  a: \"abc)\n");
    assert!(
        open.contains("t:2:6") && open.contains("this string is never closed"),
        "{open}"
    );
    let wrong = error("(a: [1, 2))");
    assert!(wrong.contains("expected `]` to close the `[`"), "{wrong}");
    let comma = error("(a: 1 b: 2)");
    assert!(
        comma.contains("t:1:7") && comma.contains("is a comma missing"),
        "{comma}"
    );
}
