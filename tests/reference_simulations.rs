//! Agreement with the reference implementation (being written).
use auxetica::config::Source;
use auxetica::engine::{Inputs, Model, ReadBody, Series, SteadyOptions, SteadySolver};
use std::path::Path;

#[test]
fn primitives() {
    let source = Source::load(Path::new("scenarios/hsa_robot.ron"), &[]).unwrap();
    let mut model = match Model::build(&source, None) {
        Ok(m) => m,
        Err(e) => panic!("{e}"),
    };
    let mut solver = SteadySolver::new(&mut model.system, SteadyOptions::default()).unwrap();
    for t in model.dwells.clone() {
        let start = std::time::Instant::now();
        let r = solver.advance(&mut model.system, t);
        let p = model.system.body(model.system.find("platform").unwrap());
        println!("{t} {r:?} {:?} {:?} {:?}", p.position(0), p.director(0), start.elapsed());
    }
    let _ = (Inputs::default(), Series::new(vec![0.0], vec![0.0]));
}
