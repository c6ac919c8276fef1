//! Auxetica's side of `benches/peers/run.sh`: the work of `rods.py` and `hsa.py`, step by step; one JSON object a line.

use auxetica::config::Source;
use auxetica::engine::{End, Model, Place};
use serde_json::json;
use std::path::Path;
use std::time::Instant;

/// Batches of steps; the first is not counted.
const BATCHES: usize = 10;
const CASES: &str = include_str!("cases.csv");
const ROBOT: (f64, u64) = (4e-5, 200);

fn rods(rods: usize, elements: usize) -> Model {
    let at = |i: usize| format!("\"rod_{i}\": ({}, 0, 0)", 0.2 * i as f64);
    let places: Vec<_> = (0..rods).map(at).collect();
    let text = format!(
        r#"(
            title: "clamped rods",
            rods: [(
                name: "rods", at: {{{}}}, length: 1, elements: {elements}, radius: 0.05, density: 1000,
                material: Moduli(youngs: 1e6, shear: 4e5),
            )],
            boundary: [(apply: Clamp(cell: Rigid))],
            forcing: [(apply: EndForce(force: (1, 0, 0)))],
            damping: [(apply: LinearDamping(translational: (0.1, 0.1, 0.1), rotational: (0.1, 0.1, 0.1)))],
            solver: Dynamic(duration: 1),
        )"#,
        places.join(", ")
    );
    built(Source::from_text("peers", &text, &[]))
}

fn robot() -> Model {
    let motor = |(i, sign): (usize, f64)| {
        let angle = sign * 179.9_f64.to_radians();
        format!("boundary[{i}].apply.angle=Ramp(to: {angle}, over: 5)")
    };
    let sets: Vec<_> = [1.0, -1.0, 1.0, -1.0]
        .into_iter()
        .enumerate()
        .map(motor)
        .collect();
    let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("scenarios/hsa_robot.ron");
    built(Source::load(&path, &sets))
}

fn built(source: Result<Source, auxetica::config::Problems>) -> Model {
    source
        .and_then(|source| Model::build(&source, None))
        .unwrap_or_else(|e| panic!("{e}"))
}

/// Prints microseconds a step (median) and how far `body` has moved.
fn measure(name: &str, mut model: Model, body: &str, (dt, steps): (f64, u64)) {
    let body = model.system.find(body).expect("it is in the scenario");
    let place = Place::End(End::Tip);
    let start = model.system.site(body, place).position;
    model.system.apply_boundaries();
    let mut seconds: Vec<f64> = (0..BATCHES)
        .map(|_| {
            let begin = Instant::now();
            for _ in 0..steps {
                model.system.step(dt).unwrap_or_else(|e| panic!("{e}"));
            }
            begin.elapsed().as_secs_f64()
        })
        .skip(1)
        .collect();
    seconds.sort_by(f64::total_cmp);
    let us = 1e6 * seconds[seconds.len() / 2] / steps as f64;
    let moved = model.system.site(body, place).position - start;
    let moved = moved.as_slice();
    println!("{}", json!({"name": name, "us": us, "moved": moved}));
}

fn main() {
    for line in CASES.lines().skip(1) {
        let fields: Vec<&str> = line.split(',').collect();
        let [n, elements, steps] = [0, 1, 3].map(|i| fields[i].parse().expect("a whole number"));
        let dt = fields[2].parse().expect("a number");
        let last = format!("rod_{}", n - 1);
        let model = rods(n, elements);
        measure(
            &format!("{n} x {elements} rods"),
            model,
            &last,
            (dt, steps as u64),
        );
    }
    measure("4 x 25 HSA robot", robot(), "platform", ROBOT);
}
