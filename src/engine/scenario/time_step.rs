//! The time step of a dynamic run, and how far it is from the stability limit.

use super::{Model, Solver};
use crate::run::RunError;
use crate::stability;
use auxetica_config::{Positive, remedy};
use ron::value::RawValue;
use serde::de::{Deserialize, Deserializer, Error};

/// Share of the stability limit that `Auto` chooses, and beyond which a given time step is warned of.
pub const LARGEST_SHARE: f64 = 0.9;

/// A scenario's wish: `Auto`, or a number of seconds.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub enum TimeStep {
    /// 0.9 of the stability limit at the start.
    #[default]
    Auto,
    /// This long \[s\].
    Fixed(Positive),
}

impl<'de> Deserialize<'de> for TimeStep {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Self, D::Error> {
        // ron forgets which bare word it has read where any type may stand
        let text = <&RawValue>::deserialize(deserializer)?.get_ron().trim();
        if text == "Auto" {
            return Ok(Self::Auto);
        }
        let number: f64 = ron::from_str(text).map_err(|_| {
            D::Error::custom(format!(
                "expected `Auto` or a number of seconds, found `{text}`; {}",
                remedy(text, &["Auto"], "allowed")
            ))
        })?;
        Positive::new(number)
            .map(Self::Fixed)
            .map_err(D::Error::custom)
    }
}

/// A time step beside the stability limit.
#[derive(Clone, Copy, Debug, Default, PartialEq)]
pub struct StepSize {
    /// Time step \[s\].
    pub dt: f64,
    /// Stability limit \[s\] at the start.
    pub limit: f64,
}

impl StepSize {
    /// What to tell of a step that is close to the limit, or beyond it.
    pub fn warning(&self) -> Option<String> {
        let share = self.dt / self.limit;
        // the limit is known to 1 %
        (share > LARGEST_SHARE * 1.001).then(|| {
            format!(
                "the time step of {:.3e} s is {share:.2} of the stability limit of {:.3e} s at the start, which motion \
                 may lower; `solver.dt: Auto` takes {:.3e}",
                self.dt,
                self.limit,
                self.limit * LARGEST_SHARE
            )
        })
    }
}

impl Model {
    /// The scenario's time step, or the one of `Auto`, beside the stability limit, which is found when it is first
    /// asked for. A step beyond the limit is an error unless the scenario insists.
    pub fn time_step(&mut self) -> Result<StepSize, RunError> {
        let (wish, unstable) = match self.solver {
            Solver::Dynamic { dt, unstable, .. } => (dt, unstable),
            Solver::Implicit { .. } | Solver::Steady { .. } => (TimeStep::Auto, false),
        };
        let limit = self.stability_limit();
        let dt = match wish {
            TimeStep::Auto => limit * LARGEST_SHARE,
            TimeStep::Fixed(dt) => *dt,
        };
        if dt > limit && !unstable {
            return Err(RunError::Unstable { dt, limit });
        }
        Ok(StepSize { dt, limit })
    }

    fn stability_limit(&mut self) -> f64 {
        let system = &mut self.system;
        *self.stability_limit.get_or_insert_with(|| {
            let start = system.save();
            system.apply_boundaries();
            // Not sought from the wish: damping stops all motion over steps that are long enough, which isn't
            // stability.
            let limit = stability::limit(system, stability::wave_time(system));
            system.restore(&start);
            limit
        })
    }
}
