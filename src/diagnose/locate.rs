//! Where simulation and recordings differ.

use super::forward::CHANNELS;
use super::samples::{Phase, Samples};
use super::verdict::{ChannelShare, Interval, Location};

const NAMES: [&str; 6] = ["x", "y", "z", "turn x", "turn y", "turn z"];
const BODIES: [&str; 2] = ["platform", "ring"];
/// Where the ring and the platform are, as shares of the rods' length.
const PLACES: [f64; 2] = [0.5, 1.0];

/// Locates whitened residuals, of several recordings one after the other.
pub fn locate(residuals: &[f64], data: &[Samples]) -> Location {
    let mut channels = [0.0; CHANNELS];
    let (mut rest, mut times) = (residuals, Vec::new());
    let mut features: Vec<[f64; 4]> = Vec::new();
    let mut sizes = Vec::new();
    for samples in data {
        let (own, others) = rest.split_at(samples.list.len() * CHANNELS);
        rest = others;
        let mut each = Vec::new();
        for (sample, values) in samples.list.iter().zip(own.chunks_exact(CHANNELS)) {
            for (sum, value) in channels.iter_mut().zip(values) {
                *sum += value * value;
            }
            let size = values.iter().map(|v| v * v).sum::<f64>();
            each.push((sample.time, size));
            let [a, b, c, d] = sample.angles;
            let moving = f64::from(u8::from(sample.phase == Phase::Moving));
            // windings: right-handed rods 1 and 3 wind with growing angles, left-handed 2 and 4 with falling ones
            let (winding, twist) = (a - b + c - d, a + b + c + d);
            let bending = (a + b - c - d).hypot(a - b - c + d);
            features.push([winding.abs(), twist.abs(), bending, moving]);
            sizes.push(size.sqrt());
        }
        times.extend(longest(&samples.name, &each));
    }
    let total: f64 = channels.iter().sum::<f64>().max(1e-300);
    let mut shares: Vec<_> = (0..CHANNELS)
        .map(|c| ChannelShare {
            body: BODIES[c / 6].to_owned(),
            channel: NAMES[c % 6].to_owned(),
            share: channels[c] / total,
        })
        .collect();
    shares.sort_by(|a, b| b.share.total_cmp(&a.share));
    let of_body = |b: usize| channels[6 * b..6 * b + 6].iter().sum::<f64>() / total;
    Location {
        channels: shares,
        time: times,
        state: state(&features, &sizes),
        arclength: vec![(PLACES[0], of_body(1)), (PLACES[1], of_body(0))],
    }
}

/// The stretch around the worst sample in which the mismatch is at least half of the worst.
fn longest(name: &str, each: &[(f64, f64)]) -> Option<Interval> {
    let worst = (0..each.len()).max_by(|a, b| each[*a].1.total_cmp(&each[*b].1))?;
    let high = |i: &usize| each[*i].1 > each[worst].1 / 4.0;
    let from = (0..=worst).rev().take_while(high).last()?;
    let to = (worst..each.len()).take_while(high).last()?;
    Some(Interval {
        recording: name.to_owned(),
        seconds: [each[from].0, each[to].0],
    })
}

/// Which feature of the state the mismatch grows with most, by the correlation of ranks.
fn state(features: &[[f64; 4]], sizes: &[f64]) -> String {
    let words = [
        "as the robot gets longer",
        "as the platform is twisted",
        "as the robot bends",
        "while the motors turn",
    ];
    let sizes = ranks(sizes);
    let correlation = |f: usize| {
        let column: Vec<f64> = features.iter().map(|row| row[f]).collect();
        pearson(&ranks(&column), &sizes)
    };
    let best = (0..4).max_by(|a, b| correlation(*a).total_cmp(&correlation(*b)));
    match best.map(|f| (f, correlation(f))) {
        Some((f, r)) if r > 0.3 => {
            format!("the mismatch grows {} (rank correlation {r:.2})", words[f])
        }
        _ => "the mismatch is about as large in all states".into(),
    }
}

fn ranks(values: &[f64]) -> Vec<f64> {
    let mut order: Vec<usize> = (0..values.len()).collect();
    order.sort_by(|a, b| values[*a].total_cmp(&values[*b]));
    let mut ranks = vec![0.0; values.len()];
    for (rank, i) in order.into_iter().enumerate() {
        ranks[i] = rank as f64;
    }
    ranks
}

fn pearson(a: &[f64], b: &[f64]) -> f64 {
    let n = a.len() as f64;
    let (ma, mb) = (a.iter().sum::<f64>() / n, b.iter().sum::<f64>() / n);
    let cov: f64 = a.iter().zip(b).map(|(x, y)| (x - ma) * (y - mb)).sum();
    let var = |v: &[f64], m: f64| v.iter().map(|x| (x - m).powi(2)).sum::<f64>();
    cov / (var(a, ma) * var(b, mb)).sqrt().max(1e-300)
}
