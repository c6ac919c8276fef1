//! Figure 7: the recorded rod in stills of two trajectories, as a kinematic model describes it. Its twist is constant
//! along the rod, the other five strains by two segments.

use super::table2::Steady;
use super::{Data, ReproduceError, Shown, Table, Ticker};
use crate::kinematics::{LeastSquares, Observed, Pose, Spcs, StrainSelector, Variation};
use crate::report::{Camera, Colour, Entry, Picture, Scene, Stripes, View, palette, scenes};
use nalgebra::{Point3, Vector3};
use serde_json::json;

/// Constant twist, two segments for the rest (section IV-E).
const SELECTOR: StrainSelector = {
    use Variation::{Constant, Piecewise};
    StrainSelector([
        Piecewise, Piecewise, Constant, Piecewise, Piecewise, Piecewise,
    ])
};
/// Trajectories, their recordings, and where the stills lie between the first sample and the last.
const RUNS: [(&str, &str, [f64; STILLS]); 2] = [
    ("lemniscate", "20221012_153814", [0.1, 0.3, 0.5, 0.7, 0.9]),
    ("twisting", "20221012_103309", [0.0, 0.25, 0.5, 0.75, 0.99]),
];
const STILLS: usize = 5;
/// Cross-sections that are drawn, and how many of them with a frame.
const SECTIONS: usize = 33;
const FRAMES: usize = 9;
/// Radius of the rod \[m\].
const RADIUS: f64 = 0.0127;

/// A still: what is measured and what is fitted.
struct Still {
    sample: usize,
    angle: f64,
    measured: [Pose; 3],
    /// Poses at the measured points.
    fitted: [Pose; 3],
    /// Cross-sections along the rod.
    sections: Vec<Pose>,
    configuration: Vec<f64>,
}

pub(super) fn reproduce(data: &Data, ticker: Ticker<'_>) -> Result<Shown, ReproduceError> {
    let mut shown = Shown {
        title: "Figure 7: the recorded rod and its kinematic model",
        tables: Vec::new(),
        notes: vec![
            "The front-left rod, third in the data: motion capture gives its ring and its tip, the motor its base. \
             Fitted by least squares: constant twist, two segments for the other five strains. These eleven numbers \
             fit twelve measured ones, so that the positions are met and what is left is rotation. The paper shows \
             pictures without numbers; in extreme twisting its authors find the model less accurate."
                .into(),
        ],
        json: json!([]),
        pictures: Vec::new(),
    };
    let mut json = Vec::new();
    for (done, (name, recording, shares)) in RUNS.into_iter().enumerate() {
        let steady = Steady::read(data, recording)?;
        let last = steady.poses.len().saturating_sub(1) as f64;
        let stills: Vec<Still> = (shares.iter())
            .map(|share| Still::fit(&steady, (share * last).round() as usize))
            .collect();
        shown.tables.push(table(name, &stills));
        json.push(json!({
            "trajectory": name,
            "stills": stills.iter().map(Still::json).collect::<Vec<_>>(),
        }));
        shown
            .pictures
            .push((format!("fig7_{name}"), picture(&stills)));
        if ticker((done + 1) as f64 / RUNS.len() as f64).is_break() {
            return Err(ReproduceError::Interrupted);
        }
    }
    shown.json = json.into();
    Ok(shown)
}

impl Still {
    fn fit(steady: &Steady, sample: usize) -> Self {
        let arc_lengths = steady.arc_lengths;
        let measured = steady.poses[sample];
        let angle = steady.base_angles[sample];
        let rod = Spcs::uniform(SELECTOR, arc_lengths[2], 2);
        let fit = LeastSquares::new(rod.clone()).fit(
            &Observed {
                arc_lengths: &arc_lengths,
                poses: &measured,
                base_angle: Some(angle),
            },
            None,
        );
        let q = fit.configuration;
        let at = |i: usize| rod.pose(&q, arc_lengths[2] * i as f64 / (SECTIONS - 1) as f64);
        Self {
            sample,
            angle,
            measured,
            fitted: arc_lengths.map(|s| rod.pose(&q, s)),
            sections: (0..SECTIONS).map(at).collect(),
            configuration: q,
        }
    }

    /// Distance \[mm\] and angle \[mrad\] between measured and fitted pose of a point.
    fn off(&self, point: usize) -> (f64, f64) {
        let (a, b) = (&self.measured[point], &self.fitted[point]);
        (
            1e3 * (a.translation.vector - b.translation.vector).norm(),
            1e3 * a.rotation.angle_to(&b.rotation),
        )
    }

    fn json(&self) -> serde_json::Value {
        let off = |point| {
            let (position, rotation) = self.off(point);
            json!({"position_mm": position, "rotation_mrad": rotation})
        };
        json!({
            "sample": self.sample,
            "motor_angle_rad": self.angle,
            "ring": off(1),
            "tip": off(2),
            "configuration": self.configuration,
        })
    }

    fn view(&self) -> View {
        let mut scene = Scene::default();
        let stripes = Stripes {
            ground: Colour(236, 236, 236),
            stripe: palette::BLUE,
            count: 6,
        };
        scene.tube(&self.sections, RADIUS, stripes, 0.55);
        scene.ends(&self.sections, RADIUS, stripes.ground, 0.55);
        for section in self.sections.iter().step_by((SECTIONS - 1) / (FRAMES - 1)) {
            scene.frame(section, 0.018, 2, 1.4, 0.45);
        }
        for pose in &self.measured {
            scene.frame(pose, 0.026, 2, 2.6, 1.0);
        }
        let [(_, ring), (_, tip)] = [self.off(1), self.off(2)];
        View {
            title: format!("sample {}", self.sample),
            notes: vec![
                format!("motor at {:.0}°", self.angle.to_degrees()),
                format!("off: ring {ring:.0}, tip {tip:.0} mrad"),
            ],
            scene,
            camera: Camera {
                target: Point3::new(0.0, 0.0, 0.040),
                azimuth: 40.0_f64.to_radians(),
                elevation: 16.0_f64.to_radians(),
                distance: 0.5,
                height: 0.118,
                // the recorded robot hangs
                up: -Vector3::z(),
            },
        }
    }
}

fn table(name: &str, stills: &[Still]) -> Table {
    let row = |still: &Still| {
        let mut cells = vec![
            still.sample.to_string(),
            format!("{:.1}", still.angle.to_degrees()),
        ];
        for point in [1, 2] {
            let (position, rotation) = still.off(point);
            cells.extend([format!("{position:.3}"), format!("{rotation:.2}")]);
        }
        cells
    };
    Table {
        caption: format!("{name}: how far the fitted rod is from the measured poses"),
        header: [
            "sample",
            "motor [deg]",
            "ring [mm]",
            "[mrad]",
            "tip [mm]",
            "[mrad]",
        ]
        .map(String::from)
        .into(),
        rows: stills.iter().map(row).collect(),
    }
}

fn picture(stills: &[Still]) -> Picture {
    let views: Vec<View> = stills.iter().map(Still::view).collect();
    let legend = [
        Entry::patch("fitted rod", palette::BLUE),
        Entry::line("local x", palette::AXES[0]),
        Entry::line("local y", palette::AXES[1]),
        Entry::line("strong: measured pose", palette::BLACK),
        Entry::line("faint: by forward kinematics", palette::GREY),
    ];
    scenes(&views, STILLS, &legend, (1160, 400))
}
