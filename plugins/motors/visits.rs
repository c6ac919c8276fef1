//! Motors that go from one set of angles to the next and wait at each.

use auxetica_engine::{Dwell, Inputs, Series};

/// Angles that the motors go to.
pub struct Visit {
    /// What is reached there, for reports.
    pub name: String,
    /// Angle of each motor \[rad\].
    pub angles: Vec<f64>,
}

/// How the motors go.
pub struct Timing {
    /// Time from one set of angles to the next \[s\].
    pub ramp: f64,
    /// Time spent at each \[s\].
    pub hold: f64,
    /// Whether the motors go back to zero after each.
    pub home: bool,
}

impl Timing {
    /// When visit `k` is reached \[s\].
    fn arrival(&self, k: usize) -> f64 {
        let ramps = if self.home { 2.0 } else { 1.0 };
        k as f64 * (ramps * self.ramp + self.hold) + self.ramp
    }

    /// The motors' angles over time, from zero at time 0. Inputs are called `motors` and the motor's number from 1.
    pub fn inputs(&self, visits: &[Visit], motors: &str) -> Result<Inputs, String> {
        let count = visits.first().map_or(0, |visit| visit.angles.len());
        let series = |motor: usize| {
            let (mut times, mut values) = (vec![0.0], vec![0.0]);
            let mut go = |time: f64, value: f64| {
                if times.last().is_none_or(|last| time > *last) {
                    times.push(time);
                    values.push(value);
                }
            };
            for (k, visit) in visits.iter().enumerate() {
                let arrival = self.arrival(k);
                go(arrival, visit.angles[motor]);
                go(arrival + self.hold, visit.angles[motor]);
                if self.home {
                    go(arrival + self.hold + self.ramp, 0.0);
                }
            }
            Ok((
                format!("{motors}{}", motor + 1),
                Series::new(times, values)?,
            ))
        };
        let channels: Result<Vec<_>, String> = (0..count).map(series).collect();
        Ok(Inputs::new(channels?))
    }

    /// The end of the time spent at each.
    pub fn dwells(&self, visits: &[Visit]) -> Vec<Dwell> {
        let dwell = |(k, visit): (usize, &Visit)| Dwell {
            time: self.arrival(k) + self.hold,
            name: visit.name.clone(),
        };
        visits.iter().enumerate().map(dwell).collect()
    }
}
