//! Figure 2: the simulated robot in its seven motion primitives.

use super::robot::{RODS, along, platform_pose, robot};
use super::{ReproduceError, Shown, Table, Tally, Ticker};
use crate::engine::{ReadBody, RunError, SteadyOptions, SteadySolver};
use crate::report::{Camera, Colour, Entry, Pose, Scene, Stripes, View, palette, scenes};
use nalgebra::{Point3, Vector3};
use rayon::prelude::*;
use serde_json::json;

/// Radius of a rod, and of the platform with its thickness, as the scenario has them \[m\].
const ROD: f64 = 0.0127;
const PLATFORM: (f64, f64) = (0.0475, 0.003);
/// Rods of handedness right and left.
const RIGHT: Stripes = stripes(palette::BLUE);
const LEFT: Stripes = stripes(palette::ORANGE);

const fn stripes(stripe: Colour) -> Stripes {
    let ground = Colour(236, 236, 236);
    Stripes {
        ground,
        stripe,
        count: 6,
    }
}

/// The robot in one primitive.
struct State {
    name: String,
    angles: [f64; 4],
    /// From where it was at rest.
    platform: Pose,
    rods: Vec<Vec<Pose>>,
}

pub(super) fn reproduce(ticker: Ticker<'_>) -> Result<Shown, ReproduceError> {
    let dwells = robot(None)?.dwells;
    let tally = Tally::new(dwells.len() as f64, ticker);
    let states: Result<Vec<State>, ReproduceError> = (dwells.par_iter())
        .map(|dwell| {
            let state = solve(dwell.time, &dwell.name)?;
            tally.add(1.0)?;
            Ok(state)
        })
        .collect();
    let states = states?;
    let legend = [
        Entry::patch("right-handed rods", palette::BLUE),
        Entry::patch("left-handed rods", palette::ORANGE),
        Entry::line("local x", palette::AXES[0]),
        Entry::line("local y", palette::AXES[1]),
        Entry::line("z of the platform", palette::AXES[2]),
    ];
    let views: Vec<View> = states.iter().map(State::view).collect();
    let mut pictures = vec![("fig2".into(), scenes(&views, 4, &legend, (1160, 720)))];
    for (state, view) in states.iter().zip(&views) {
        let name = format!("fig2_{}", state.name.replace([' ', '-'], "_"));
        let one = std::slice::from_ref(view);
        pictures.push((name, scenes(one, 1, &legend, (600, 520))));
    }
    Ok(Shown {
        title: "Figure 2: the robot in its seven motion primitives",
        tables: vec![table(&states)],
        notes: vec![
            "The paper shows pictures without numbers. Steady states of scenarios/hsa_robot.ron, each from rest; \
             stripes on the rods show how far they are wound."
                .into(),
        ],
        json: states.iter().map(State::json).collect(),
        pictures,
    })
}

fn solve(time: f64, name: &str) -> Result<State, ReproduceError> {
    let mut model = robot(None)?;
    let angles = motor_angles(&model, time);
    let mut solver =
        SteadySolver::new(&mut model.system, SteadyOptions::default()).map_err(RunError::from)?;
    let rest = platform_pose(&model);
    solver
        .advance(&mut model.system, time)
        .map_err(RunError::from)?;
    let now = platform_pose(&model);
    Ok(State {
        name: in_words(name),
        angles,
        platform: Pose::from_parts(now.translation, now.rotation * rest.rotation.inverse()),
        rods: RODS.map(|rod| whole(&model, rod)).into(),
    })
}

fn motor_angles(model: &crate::engine::Model, time: f64) -> [f64; 4] {
    std::array::from_fn(|i| {
        let input = model.system.inputs().get(&format!("motor_{}", i + 1));
        input.map_or(0.0, |series| series.at(time))
    })
}

/// Cross-sections of a rod from its first node to its last.
fn whole(model: &crate::engine::Model, rod: &str) -> Vec<Pose> {
    let mut sections = along(model, rod);
    let id = model.system.find(rod).expect("the scenario has this rod");
    let body = model.system.body(id);
    let ends = [(0, 0), (sections.len() - 1, body.nodes() - 1)].map(|(section, node)| {
        Pose::from_parts(body.position(node).into(), sections[section].rotation)
    });
    sections.insert(0, ends[0]);
    sections.push(ends[1]);
    sections
}

/// `BendNorth` in words.
fn in_words(name: &str) -> String {
    let mut words = String::new();
    for letter in name.chars() {
        if letter.is_uppercase() && !words.is_empty() {
            words.push(' ');
        }
        words.extend(letter.to_lowercase());
    }
    words
}

impl State {
    fn turn(&self) -> Vector3<f64> {
        self.platform.rotation.scaled_axis()
    }

    fn json(&self) -> serde_json::Value {
        json!({
            "primitive": self.name,
            "motor_angles_rad": self.angles,
            "platform": {
                "position_m": self.platform.translation.vector.as_slice(),
                "rotation_vector_rad": self.turn().as_slice(),
            },
        })
    }

    fn view(&self) -> View {
        let mut scene = Scene::default();
        for (rod, sections) in self.rods.iter().enumerate() {
            let stripes = if rod % 2 == 0 { RIGHT } else { LEFT };
            scene.tube(sections, ROD, stripes, 1.0);
            let count = sections.len();
            for section in [count / 6, count / 2, 5 * count / 6] {
                scene.frame(&sections[section], 0.022, 2, 1.6, 1.0);
            }
        }
        let (radius, thickness) = PLATFORM;
        scene.disc(&self.platform, radius, thickness, Colour(190, 196, 204));
        let top = self.platform * Pose::translation(0.0, 0.0, thickness);
        scene.frame(&top, 0.035, 3, 2.4, 1.0);
        let [x, y, z] = decimals(self.platform.translation.vector * 1e3, 1);
        View {
            title: self.name.clone(),
            notes: vec![format!("platform at {x}, {y}, {z} mm")],
            scene,
            camera: Camera {
                target: Point3::new(0.0, 0.0, 0.08),
                azimuth: (-62.0_f64).to_radians(),
                elevation: 24.0_f64.to_radians(),
                distance: 0.7,
                height: 0.19,
                up: Vector3::z(),
            },
        }
    }
}

/// Three numbers with so many decimals.
fn decimals(v: Vector3<f64>, count: usize) -> [String; 3] {
    let unit = 10f64.powi(count as i32);
    // adding zero drops the sign of what rounds to zero
    [v.x, v.y, v.z].map(|c| format!("{:.count$}", (c * unit).round() / unit + 0.0))
}

fn table(states: &[State]) -> Table {
    let three = |v: Vector3<f64>| decimals(v, 2).join(" ");
    let row = |state: &State| {
        let angles = state.angles.map(|a| format!("{:.1}", a.to_degrees() + 0.0));
        vec![
            state.name.clone(),
            angles.join(" "),
            three(state.platform.translation.vector * 1e3),
            three(state.turn().map(f64::to_degrees)),
        ]
    };
    Table {
        caption: "The platform's centre, and its rotation from rest as a vector".into(),
        header: [
            "primitive",
            "motor angles [deg]",
            "x y z [mm]",
            "turned by [deg]",
        ]
        .map(String::from)
        .into(),
        rows: states.iter().map(row).collect(),
    }
}
