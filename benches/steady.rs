//! What steady states of the paper's robot cost, on one core: those of the authors' 625 samples, each from rest (cold)
//! and one after the other (warm), and 100 in elongation; and derivatives with respect to ten of the robot's numbers. The authors' simulator takes about 275 s for each of these
//! (15 s at 4e-5 s a step, one run to rest).

mod robot;

use auxetica::engine::{
    End, Inputs, Model, Place, Sensitivities, Series, SteadyOptions, SteadyReport, SteadySolver,
};
use comfy_table::{CellAlignment, Table, presets};
use robot::{NUMBERS, scenario};
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

/// The authors' largest motor angle [rad].
const MOST: f64 = 3.139_846_324_338_117;

/// One steady state: how long it took, and what.
type Cost = (Duration, SteadyReport);

/// Motors that go through `angles` [rad] from rest, one row a second.
fn inputs(angles: &[[f64; 4]]) -> Inputs {
    let motor = |m: usize| {
        let values = std::iter::once(0.0).chain(angles.iter().map(|a| a[m]));
        let times = (0..=angles.len()).map(|t| t as f64);
        let series = Series::new(times.collect(), values.collect());
        (format!("motor_{}", m + 1), series.expect("two points"))
    };
    Inputs::new((0..4).map(motor).collect())
}

fn robot(angles: &[[f64; 4]]) -> Model {
    Model::build(&scenario(), Some(inputs(angles))).unwrap_or_else(|e| panic!("{e}"))
}

fn solver(model: &mut Model) -> SteadySolver {
    SteadySolver::new(&mut model.system, SteadyOptions::default()).unwrap_or_else(|e| panic!("{e}"))
}

fn advance(solver: &mut SteadySolver, model: &mut Model, time: f64) -> Cost {
    let start = Instant::now();
    let report = solver.advance(&mut model.system, time);
    (start.elapsed(), report.unwrap_or_else(|e| panic!("{e}")))
}

/// Each state after the one before.
fn warm(angles: &[[f64; 4]]) -> Vec<Cost> {
    let mut model = robot(angles);
    let mut solver = solver(&mut model);
    let times = (1..=angles.len()).map(|t| t as f64);
    times.map(|t| advance(&mut solver, &mut model, t)).collect()
}

/// Each state from rest.
fn cold(angles: &[[f64; 4]]) -> Vec<Cost> {
    let state = |angles: &[f64; 4]| {
        let mut model = robot(&[*angles]);
        let mut solver = solver(&mut model);
        advance(&mut solver, &mut model, 1.0)
    };
    angles.iter().map(state).collect()
}

/// Median time [ms] of the derivatives of the platform's and the rods' poses at each state.
fn sensitivities(angles: &[[f64; 4]]) -> f64 {
    let mut model = robot(angles);
    let mut solver = solver(&mut model);
    let mut sensitivities = Sensitivities::new(&scenario(), Some(&inputs(angles)), &NUMBERS)
        .unwrap_or_else(|e| panic!("{e}"));
    let outputs = |model: &Model| {
        let sites = model
            .system
            .ids()
            .iter()
            .map(|id| model.system.site(*id, Place::End(End::Tip)));
        sites
            .flat_map(|s| {
                s.position
                    .iter()
                    .chain(s.director.iter())
                    .copied()
                    .collect::<Vec<_>>()
            })
            .collect()
    };
    let mut times = Vec::new();
    for t in 1..=angles.len() {
        advance(&mut solver, &mut model, t as f64);
        let start = Instant::now();
        let found = sensitivities.at(&mut solver, &mut model.system, &outputs);
        times.push(start.elapsed().as_secs_f64() * 1e3);
        found.unwrap_or_else(|e| panic!("{e}"));
    }
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

/// Motor angles of the authors' four sets; none without the data (see `tests/common`).
fn samples() -> Vec<Vec<[f64; 4]>> {
    let data = std::env::var_os("AUXETICA_DATA").map_or_else(
        || Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared"),
        PathBuf::from,
    );
    let sets = [
        "170312_elongation_seed-101_100",
        "170335_bending_seed-101_225",
        "214951_twisting_seed-101_200",
        "215237_lemniscate_seed-101_100",
    ];
    let read = |set: &str| {
        let file = format!("reference_simulations/20221025_{set}-samples/actuation_specs.csv");
        let mut table = csv::Reader::from_path(data.join(file)).ok()?;
        let rows = table.records().map(|r| r.expect("a row"));
        let angle = |text: &str| text.parse().expect("a motor angle");
        Some(
            rows.map(|r| std::array::from_fn(|m| angle(&r[5 + m])))
                .collect(),
        )
    };
    sets.into_iter().filter_map(read).collect()
}

fn row(name: &str, costs: &[Cost]) -> Vec<String> {
    let mut times: Vec<f64> = costs.iter().map(|(t, _)| t.as_secs_f64() * 1e3).collect();
    times.sort_by(f64::total_cmp);
    let mean = |count: fn(&SteadyReport) -> usize| {
        let sum: usize = costs.iter().map(|(_, r)| count(r)).sum();
        format!("{:.1}", sum as f64 / costs.len() as f64)
    };
    vec![
        name.into(),
        costs.len().to_string(),
        format!("{:.2}", times[times.len() / 2]),
        format!("{:.2}", times[times.len() - 1]),
        mean(|r| r.increments),
        mean(|r| r.iterations),
        mean(|r| r.factorisations),
        mean(|r| r.evaluations),
    ]
}

fn main() {
    let shares = (0..100).map(|k| f64::from(k) / 99.0 * MOST);
    let elongation: Vec<_> = shares.map(|u| [u, -u, u, -u]).collect();
    let mut rows = vec![row("elongation, one after the other", &warm(&elongation))];
    rows.push(row(
        "full elongation, from rest",
        &cold(&[elongation[99]; 10]),
    ));
    let sets = samples();
    if sets.is_empty() {
        eprintln!("the authors' samples are left out: AUXETICA_DATA names no folder with them");
    } else {
        let all = |f: fn(&[[f64; 4]]) -> Vec<Cost>| -> Vec<Cost> {
            sets.iter().flat_map(|set| f(set)).collect()
        };
        rows.push(row("the authors' samples, warm", &all(warm)));
        rows.push(row("the authors' samples, cold", &all(cold)));
    }
    let header = [
        "steady states",
        "number",
        "median [ms]",
        "longest [ms]",
        "increments",
        "iterations",
        "factorisations",
        "evaluations",
    ];
    let mut table = Table::new();
    table
        .load_preset(presets::UTF8_HORIZONTAL_ONLY)
        .set_header(header)
        .add_rows(rows);
    for column in table.column_iter_mut().skip(1) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    println!("{table}");
    println!(
        "derivatives with respect to {} numbers at a steady state: {:.2} ms",
        NUMBERS.len(),
        sensitivities(&elongation)
    );
}
