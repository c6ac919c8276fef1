//! Set-points of a recording, and the motors' way from one to the next.

use super::spec::Tours;
use rand::RngExt;
use std::f64::consts::PI;

/// Winding angles \[rad\] of rods at azimuths \[rad\]: all positive wind.
fn wound(azimuths: &[f64], mean: f64, along: [f64; 2]) -> Vec<f64> {
    let of = |a: &f64| (mean + along[0] * a.cos() + along[1] * a.sin()).max(0.0);
    azimuths.iter().map(of).collect()
}

/// Set-points of a recording by its kind, the rest first.
pub(super) fn set_points(
    kind: &str,
    tours: &Tours,
    azimuths: &[f64],
    random: &mut impl RngExt,
) -> Vec<Vec<f64>> {
    let most = *tours.angle;
    let point = |k: usize, random: &mut dyn FnMut() -> f64| {
        let phase = 2.0 * PI * k as f64 / tours.set_points as f64;
        let half = most / 2.0;
        match kind {
            "circle" => wound(azimuths, half, [half * phase.cos(), half * phase.sin()]),
            "lemniscate" => {
                let along = [half * phase.cos(), half * (2.0 * phase).sin() / 2.0];
                wound(azimuths, half, along)
            }
            _ => azimuths.iter().map(|_| most * random()).collect(),
        }
    };
    let mut uniform = || random.random::<f64>();
    let rest = vec![0.0; azimuths.len()];
    std::iter::once(rest)
        .chain((0..tours.set_points).map(|k| point(k, &mut uniform)))
        .collect()
}

/// Times \[s\] and angles \[rad\] at the spec's rate of a tour through set-points, each held once all motors are there.
pub(super) fn rows(points: &[Vec<f64>], tours: &Tours) -> (Vec<f64>, Vec<Vec<f64>>, Vec<usize>) {
    // when the motors leave for a set-point and when the last has arrived
    let mut legs = vec![(0.0, 0.0)];
    for pair in points.windows(2) {
        let apart = pair[0]
            .iter()
            .zip(&pair[1])
            .map(|(a, b)| (a - b).abs())
            .fold(0.0, f64::max);
        let leave = legs.last().expect("it has one").1 + *tours.hold;
        legs.push((leave, leave + apart / *tours.speed));
    }
    let end = legs.last().expect("it has one").1 + *tours.hold;
    let count = (end * *tours.rate) as usize;
    let (mut times, mut angles, mut goals) = (Vec::new(), Vec::new(), Vec::new());
    for row in 0..count {
        let time = row as f64 / *tours.rate;
        let to = legs
            .iter()
            .rposition(|(leave, _)| *leave <= time)
            .expect("the first leaves at once");
        let from = to.saturating_sub(1);
        let reach = *tours.speed * (time - legs[to].0);
        let toward = |(a, b): (&f64, &f64)| a + (b - a).clamp(-reach, reach);
        angles.push(points[from].iter().zip(&points[to]).map(toward).collect());
        times.push(time);
        goals.push(to);
    }
    (times, angles, goals)
}
