//! Recordings that the program makes itself.

use auxetica::compare::{CompareError, film};
use auxetica::config::Source;
use auxetica::identify::Robot;
use auxetica::recordings::{RADIANS_PER_TICK, Recording};

/// Winding of the four rods at set-points [rad].
const TOUR: [[f64; 4]; 8] = [
    [0.0, 0.0, 0.0, 0.0],
    [4.0, 1.0, 0.5, 2.5],
    [1.5, 0.0, 2.0, 5.0],
    [3.0, 3.0, 3.0, 3.0],
    [0.0, 5.0, 3.5, 0.5],
    [5.0, 5.0, 5.0, 4.0],
    [2.0, 0.5, 5.0, 1.0],
    [0.4, 0.8, 0.2, 0.6],
];
/// Rows in a second, rows at rest, and the motors' speed [rad/s].
const RATE: f64 = 9.3;
const HELD: usize = 14;
const SPEED: f64 = 2.0;

/// A noiseless recording of a robot with this scenario on a tour of eight set-points.
pub fn recorded(source: &Source, robot: &Robot) -> Result<Recording, CompareError> {
    let mut rows = vec![(TOUR[0], TOUR[0]); HELD];
    for pair in TOUR.windows(2) {
        let apart = (0..4).map(|i| (pair[1][i] - pair[0][i]).abs());
        let steps = (apart.fold(0.0, f64::max) / SPEED * RATE).ceil() as usize;
        for step in 1..steps + HELD {
            let way = SPEED / RATE * step as f64;
            let toward = |i: usize| pair[0][i] + (pair[1][i] - pair[0][i]).clamp(-way, way);
            rows.push((std::array::from_fn(toward), pair[1]));
        }
    }
    let ticks = |wound: [f64; 4]| -> [f64; 4] {
        std::array::from_fn(|i| (robot.handed[i] * wound[i] / RADIANS_PER_TICK).round())
    };
    let time: Vec<f64> = (0..rows.len()).map(|row| row as f64 / RATE).collect();
    let present: Vec<[f64; 4]> = rows.iter().map(|(now, _)| ticks(*now)).collect();
    let goal = rows.iter().map(|(_, goal)| ticks(*goal)).collect();
    let angles: Vec<[f64; 4]> = (present.iter())
        .map(|row| row.map(|t: f64| t * RADIANS_PER_TICK))
        .collect();
    let film = film(source, &time, &angles)?;
    let motors = (present, film.loads);
    Ok(Recording::simulated(
        "made",
        time,
        goal,
        motors,
        &film.poses,
    ))
}
