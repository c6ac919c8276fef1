//! Recordings that show nothing say "nothing is missing" only if they would have shown it.

mod common;

use auxetica::diagnose::verdict::{Diagnosis, Kind};
use common::concealed::{Case, Hidden};

/// Diagnoses recordings of a robot that lacks nothing, wound by up to `angle` \[rad\].
fn diagnosed(angle: f64) -> Diagnosis {
    let (d, _) = Case::new(&Hidden::Nothing, 4, angle).diagnosed(&[]);
    for n in &d.noticeable {
        println!("{} {:.3}", n.words(), n.share);
    }
    println!("{}", d.words);
    d
}

#[test]
fn motors_that_hardly_turn_are_too_little_data() {
    let d = diagnosed(0.15);
    assert_eq!(d.verdict, Kind::Insufficient, "{}", d.words);
    assert!(
        d.words.starts_with("These recordings show too little"),
        "{}",
        d.words
    );
    assert!(d.effects.is_empty());
    let unseen = d.noticeable.iter().filter(|n| n.share > 1.0).count();
    assert!(2 * unseen > d.noticeable.len());
}

#[test]
fn motors_that_turn_far_are_enough() {
    let d = diagnosed(6.0);
    assert_eq!(d.verdict, Kind::None, "{}", d.words);
}
