//! A robot that is simulated on another mesh than the one that made its recordings lacks nothing.

mod common;

use auxetica::diagnose::verdict::Kind;
use common::concealed::{Case, Hidden};

#[test]
fn what_a_mesh_does_is_told_from_physics_that_is_missing() {
    // 10 elements for the scenario's 14: some four floors apart, once calibrated
    let case = Case::on_mesh(&Hidden::Nothing, 3, 6.0, (10, 10));
    let (d, _) = case.diagnosed(&["gravity"]);
    assert_eq!(d.verdict, Kind::None, "{}", d.words);
    let held_out = d.baseline.recordings.iter().filter(|r| r.role == "holdout");
    let apart: Vec<f64> = held_out.map(|r| r.position_rmse_mm).collect();
    assert!(
        apart.iter().all(|mm| *mm > 2.0 * d.floor.position_mm),
        "the meshes differ by {apart:?} mm"
    );
    // no more is left than with the same mesh
    let left = d.baseline.reduced_chi2;
    println!("{left:.2} of the mean square is left, {apart:?} mm");
    assert!(left < 0.4, "{left} of the mean square is left");
}
