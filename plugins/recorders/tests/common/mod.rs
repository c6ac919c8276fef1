//! A small system and recorders made from text, as a scenario does.

use auxetica_engine::rod::Section;
use auxetica_engine::{
    BoundaryCondition, Callback, Cylinder, End, Inputs, Moment, PoseView, RateView, ReadBody, Rod,
    Snapshot, System, rotation,
};
use nalgebra::{Matrix3, Vector3};
use serde::de::DeserializeOwned;
use std::path::Path;

/// Elements of the rod.
pub const ELEMENTS: usize = 3;

/// Holds the first element through a half cell, so that cell 0 exists.
struct Wall;

impl BoundaryCondition for Wall {
    fn rates(&self, _now: &Moment<'_>, body: &mut RateView<'_>) {
        body.set_velocity(0, Vector3::zeros());
    }

    fn values(&self, _now: &Moment<'_>, body: &mut PoseView<'_>) {
        body.set_wall(End::Start, Matrix3::identity());
    }
}

/// A rod `rod` that curls by itself, walled at its start, and a rigid body `plate, top` that stands aslant.
pub fn system() -> System {
    let section = Section {
        outside: 0.01,
        inside: 0.0,
    };
    let rigidities = section.rigidities(1e6, 4e5);
    let mut rod = Rod::uniform("rod", 0.3, ELEMENTS, section, 1000.0, rigidities);
    rod.rest_kappa = Vector3::new(0.7, 1.3, 2.1);
    let plate = Cylinder {
        name: "plate, top".into(),
        centre: Vector3::new(0.1, 0.2, 0.3),
        director: rotation::exp(&Vector3::new(0.3, 0.5, 0.7)),
        mass: 0.1,
        inertia: Vector3::new(1e-5, 1e-5, 2e-5),
    };
    let mut system = System::new(Inputs::default());
    let rod = system.add_rod(&rod).unwrap();
    system.add_cylinder(&plate).unwrap();
    system.add_boundary(rod, "wall", Box::new(Wall)).unwrap();
    system.apply_boundaries();
    system.evaluate();
    system
}

/// All bodies at the present time.
pub fn snapshot(system: &System) -> Snapshot<'_> {
    Snapshot {
        time: system.time(),
        bodies: system.ids().iter().map(|id| system.body(*id)).collect(),
    }
}

/// A recorder from its text in a scenario.
pub fn recorder<T: DeserializeOwned>(text: &str) -> T {
    ron::from_str(text).unwrap()
}

/// Starts `recorder` in `out` and records `times` times, with steps between; `see` looks at each snapshot.
pub fn run(
    recorder: &mut dyn Callback,
    out: &Path,
    times: usize,
    mut see: impl FnMut(&Snapshot<'_>),
) {
    let mut system = system();
    recorder.start(out, &snapshot(&system).bodies).unwrap();
    for _ in 0..times {
        recorder.record(&snapshot(&system)).unwrap();
        see(&snapshot(&system));
        for _ in 0..7 {
            system.step(1e-4).unwrap();
        }
    }
}

/// What a row of a table must hold of `Position, Director, Dilatation, Kappa, Torque`.
#[allow(dead_code, reason = "tests of arrays have no rows")]
pub fn expected_row(body: &dyn ReadBody, i: usize) -> Vec<Option<f64>> {
    let mut row: Vec<_> = body.position(i).iter().copied().map(Some).collect();
    let frame = (i < body.directors()).then(|| body.director(i));
    for d in 0..3 {
        row.extend((0..3).map(|axis| frame.map(|f| f[(d, axis)])));
    }
    row.push((i < body.elements()).then(|| body.dilatation(i)));
    let kappa = body.cells().contains(&i).then(|| body.kappa(i));
    row.extend((0..3).map(|axis| kappa.map(|k| k[axis])));
    let torque = (i < body.directors()).then(|| body.torque(i));
    row.extend((0..3).map(|axis| torque.map(|t| t[axis])));
    row
}

/// The columns of [`expected_row`].
#[allow(dead_code, reason = "tests of arrays have no rows")]
pub const COLUMNS: [&str; 22] = [
    "time_s",
    "body",
    "index",
    "position_x_m",
    "position_y_m",
    "position_z_m",
    "director_d1_x",
    "director_d1_y",
    "director_d1_z",
    "director_d2_x",
    "director_d2_y",
    "director_d2_z",
    "director_d3_x",
    "director_d3_y",
    "director_d3_z",
    "dilatation",
    "kappa_d1_rad_per_m",
    "kappa_d2_rad_per_m",
    "kappa_d3_rad_per_m",
    "torque_d1_N_m",
    "torque_d2_N_m",
    "torque_d3_N_m",
];
