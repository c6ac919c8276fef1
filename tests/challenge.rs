//! Blind challenges: the same seed makes the same recordings, nothing is named where nothing is concealed, and a truth
//! that was changed afterwards is refused.

use auxetica::challenge::{Onto, RECORDINGS, Recorded, SEAL, Spec, TRUTH, conceal, score};
use auxetica::config::Positive;
use auxetica::recordings::Recording;
use std::path::Path;

fn spec() -> (Spec, auxetica::config::Source) {
    let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/challenges/small.ron");
    let (mut spec, nominal) = Spec::load(&file).unwrap_or_else(|e| panic!("{e}"));
    (spec.controls, spec.singles) = (1, 0);
    if let Recorded::Simulated(tours) = &mut spec.recordings {
        tours.set_points = 8;
    }
    (spec, nominal)
}

#[test]
fn a_control_is_given_nothing_and_its_truth_is_sealed() {
    let folder = tempfile::tempdir().expect("a folder");
    let (spec, nominal) = spec();
    let made = |name: &str| {
        let out = folder.path().join(name);
        conceal(&spec, &nominal, &out, &|_| ()).unwrap_or_else(|e| panic!("{e}"));
        out
    };
    let (one, two) = (made("one"), made("two"));
    for recording in RECORDINGS {
        let text = |out: &Path| {
            let file = out.join("case_000").join(recording);
            std::fs::read(file.join("mocap_frame_data_history.csv")).expect("poses")
        };
        assert!(text(&one) == text(&two), "{recording} differs");
    }
    assert!(
        conceal(&spec, &nominal, &one, &|_| ()).is_err(),
        "it was there"
    );

    let (results, tally) = score(&one, 1, false, &|_| ()).unwrap_or_else(|e| panic!("{e}"));
    assert_eq!(tally.controls, (1, 0), "{:?}", results[0].said);
    std::fs::write(one.join(TRUTH), "[]").expect("changed");
    let Err(refused) = score(&one, 1, false, &|_| ()) else {
        panic!("a changed truth was taken");
    };
    let refused = refused.to_string();
    assert!(refused.contains(SEAL), "{refused}");
}

#[test]
fn an_effect_concealed_in_given_recordings_is_named_and_nothing_else_moved() {
    let folder = tempfile::tempdir().expect("a folder");
    let positive = |x: f64| Positive::new(x).expect("it is positive");
    let (mut spec, nominal) = spec();
    let given = folder.path().join("given");
    conceal(&spec, &nominal, &given, &|_| ()).unwrap_or_else(|e| panic!("{e}"));
    let control = given.join("case_000");
    let given = |name: &str| control.join(name).display().to_string();
    spec.singles = 1;
    spec.effects = vec!["backlash".into()];
    spec.strength = (positive(2.0), positive(3.0));
    spec.recordings = Recorded::Real(Onto {
        train: RECORDINGS[..2].iter().map(|name| given(name)).collect(),
        holdout: vec![given(RECORDINGS[2])],
    });
    let out = folder.path().join("spiked");
    let truths = conceal(&spec, &nominal, &out, &|_| ()).unwrap_or_else(|e| panic!("{e}"));
    let platform = |folder: &Path| {
        let recording = Recording::read(folder).unwrap_or_else(|e| panic!("{e}"));
        recording.mocap.expect("it has poses").platform.position
    };
    for truth in &truths {
        let before = platform(&control.join(RECORDINGS[0]));
        let after = platform(&out.join(&truth.case).join("train_0_train_0_circle"));
        let apart = before.iter().zip(&after).map(|(a, b)| (a - b).norm());
        let most = apart.fold(0.0, f64::max);
        let moved = if truth.effects.is_empty() {
            0.0..1e-12
        } else {
            1e-3..1e-2
        };
        assert!(moved.contains(&most), "{}: {most} m", truth.case);
    }
    let (results, tally) = score(&out, 1, true, &|_| ()).unwrap_or_else(|e| panic!("{e}"));
    let said = results.iter().map(|r| (r.verdict, &r.said));
    assert_eq!(tally.singles, (1, 1), "{:?}", said.collect::<Vec<_>>());
    assert_eq!(
        tally.controls,
        (0, 0),
        "nobody knows what is in given recordings"
    );
    let hidden = results.iter().filter(|r| r.hidden.is_some());
    assert_eq!(hidden.count(), 1, "the single one, without backlash");
}

#[test]
fn a_wrong_specification_is_told_with_its_line() {
    let folder = tempfile::tempdir().expect("a folder");
    let file = folder.path().join("spec.ron");
    std::fs::write(&file, "(\n    scenario: \"x.ron\",\n    seeds: 3,\n)").expect("written");
    let Err(told) = Spec::load(&file) else {
        panic!("an unknown field was taken");
    };
    let told = told.to_string();
    let small = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/challenges/small.ron");
    let text = std::fs::read_to_string(small).expect("it is shipped");
    let reversed = text.replace("strength: (0.7, 3)", "strength: (3, 0.7)");
    assert_ne!(text, reversed);
    std::fs::write(&file, reversed).expect("written");
    let Err(e) = Spec::load(&file) else {
        panic!("a reversed range was taken");
    };
    assert!(
        e.to_string().contains("`strength` goes from 3 to 0.7"),
        "{e}"
    );
    assert!(
        told.contains("spec.ron:3") && told.contains("seeds"),
        "{told}"
    );
}
