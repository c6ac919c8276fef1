//! Recordings of simulated robots.

use crate::{Mocap, Pose, RADIANS_PER_TICK, Recording, RobotGeometry, Track, to_world};
use std::f64::consts::TAU;

/// The motors' unit of velocity \[rad/s\].
const VELOCITY_UNIT: f64 = 0.229 * TAU / 60.0;

impl Recording {
    /// The recording of a robot that is simulated: times \[s\], goals and positions of its motors \[ticks\] with their loads,
    /// and poses of platform and ring in the base frame, one a row. Velocities are those from the row before, in the motors'
    /// whole units, and the base stays where it is.
    ///
    /// # Panics
    /// If there are not as many of one as of the other.
    #[must_use]
    pub fn simulated(
        name: &str,
        time: Vec<f64>,
        goal: Vec<[f64; 4]>,
        (present, loads): (Vec<[f64; 4]>, Vec<[f64; 4]>),
        poses: &[[Pose; 2]],
    ) -> Self {
        let rows = time.len();
        let lengths = [goal.len(), present.len(), loads.len(), poses.len()];
        assert_eq!(lengths, [rows; 4], "rows");
        let base = Pose::translation(0.0, 0.0, RobotGeometry::default().base_markers);
        let track = |b: usize| Track::new(poses.iter().map(|row| to_world(&row[b])));
        let velocity = |row: usize| -> [f64; 4] {
            let before = row.saturating_sub(1);
            let dt = (time[row] - time[before]).max(1e-6);
            std::array::from_fn(|i| {
                let turned = (present[row][i] - present[before][i]) * RADIANS_PER_TICK;
                (turned / dt / VELOCITY_UNIT).round()
            })
        };
        Self {
            name: name.to_owned(),
            velocities: (0..rows).map(velocity).collect(),
            loads,
            mocap: Some(Mocap {
                base: Track::new(std::iter::repeat_n(to_world(&base), rows)),
                platform: track(0),
                ring: track(1),
            }),
            time,
            goal,
            present,
        }
    }
}
