//! What several tests share.
#![allow(dead_code, reason = "each test uses some of it")]

pub mod concealed;
pub mod derivatives;
pub mod made;

use auxetica::config::Source;
use auxetica::engine::{BodyId, BoundaryCondition, Model, ReadBody, SteadyOptions, SteadySolver};
use nalgebra::Vector3;
use std::path::{Path, PathBuf};

/// A file or folder of the reference data, which lie in `AUXETICA_DATA` (by default `../shared`). Without them a test
/// has nothing to compare with and should return; continuous integration (`CI` set) must have them.
pub fn data(relative: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("AUXETICA_DATA").map_or_else(
        || Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared"),
        PathBuf::from,
    );
    let path = folder.join(relative);
    if path.exists() {
        return Some(path);
    }
    let notice = format!(
        "{} is not there; AUXETICA_DATA names the folder of the reference data",
        path.display()
    );
    assert!(std::env::var_os("CI").is_none(), "{notice}");
    eprintln!("not compared: {notice}");
    None
}

/// The model of a scenario text.
pub fn model(text: &str) -> Model {
    Source::from_text("test", text, &[])
        .and_then(|source| Model::build(&source, None))
        .unwrap_or_else(|problems| panic!("{problems}"))
}

/// Loads of the only body of a model that a boundary condition puts in its place.
pub fn deform(model: &mut Model, as_told: Box<dyn BoundaryCondition>) -> BodyId {
    let id = model.system.ids()[0];
    model
        .system
        .add_boundary(id, "deform", as_told)
        .expect("a free body can be put anywhere");
    model.system.apply_boundaries();
    model.system.evaluate();
    id
}

/// Moves the model to its steady state at `time` \[s\].
pub fn steady(model: &mut Model, time: f64) {
    SteadySolver::new(&mut model.system, SteadyOptions::default())
        .and_then(|mut solver| solver.advance(&mut model.system, time))
        .unwrap_or_else(|e| panic!("{}: {e}", model.title));
}

/// Positions of a body's nodes.
pub fn nodes(model: &Model, body: &str) -> Vec<Vector3<f64>> {
    let body = model.system.body(
        model
            .system
            .find(body)
            .expect("the body is in the scenario"),
    );
    (0..body.nodes()).map(|i| body.position(i)).collect()
}

/// Position of a body's last node.
pub fn tip(model: &Model, body: &str) -> Vector3<f64> {
    *nodes(model, body).last().expect("a body has nodes")
}
