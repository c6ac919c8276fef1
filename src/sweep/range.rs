//! A range of numbers for one path, or for several that are tied.

use crate::config::{Problem, Tied};

/// Numbers from one end to the other.
#[derive(Clone, Debug)]
pub struct Range {
    pub(super) tied: Tied,
    from: f64,
    to: f64,
    count: Option<usize>,
}

impl Range {
    /// Reads `path=a..b:n`, or `path=a..b` without a count of values; `path, path=..` ties paths to one value.
    ///
    /// # Errors
    /// If it isn't understood, or the range is empty or runs backwards.
    pub fn read(text: &str) -> Result<Self, Problem> {
        const EXAMPLE: &str = "for example `--over rods[0].length=0.08..0.12:5`";
        let tied = Tied::read("--over", text)?;
        let fault = |message: String, remedy: &str| Err(tied.problem(message).with_hint(remedy));
        let Some(range) = tied.rest().strip_prefix('=') else {
            return fault("expected `=` and a range after the path".into(), EXAMPLE);
        };
        let (ends, count) = match range.split_once(':') {
            Some((ends, count)) => (ends, Some(count.trim())),
            None => (range, None),
        };
        let number = |text: &str| text.trim().parse().ok().filter(|v: &f64| v.is_finite());
        let ends = ends.split_once("..");
        let Some((Some(from), Some(to))) = ends.map(|(a, b)| (number(a), number(b))) else {
            return fault(
                "expected two finite numbers with `..` between".into(),
                EXAMPLE,
            );
        };
        if to < from {
            let message = format!("the range runs backwards, from {from} to {to}");
            return fault(message, "give the smaller number first");
        }
        if to <= from {
            let message = format!("the range is empty, both ends are {from}");
            return fault(message, "`--set path=value` gives one value to all jobs");
        }
        let count = match count.map(str::parse) {
            None => None,
            Some(Ok(count)) if count >= 2 => Some(count),
            Some(Ok(count)) => {
                let message = format!("a range takes 2 values or more, not {count}");
                return fault(message, "`--set path=value` gives one value to all jobs");
            }
            Some(Err(_)) => return fault("expected a whole number of values".into(), EXAMPLE),
        };
        Ok(Self {
            tied,
            from,
            to,
            count,
        })
    }

    /// How many values a grid takes.
    pub(super) fn count(&self) -> Result<usize, Problem> {
        let missing = || {
            let problem = self
                .tied
                .problem("the grid doesn't know how many values to take");
            problem.with_hint("add their number, as in `0.08..0.12:5`, or sample with `--latin N`")
        };
        self.count.ok_or_else(missing)
    }

    /// Refuses a count, which only a grid has.
    pub(super) fn no_count(&self) -> Result<(), Problem> {
        match self.count {
            None => Ok(()),
            Some(count) => {
                let message = format!("`:{count}` has no meaning in a Latin hypercube");
                let remedy = "`--latin N` says how many values every range takes";
                Err(self.tied.problem(message).with_hint(remedy))
            }
        }
    }

    /// The number at a share of the way, the ends exactly.
    pub(super) fn at(&self, share: f64) -> f64 {
        self.from * (1.0 - share) + self.to * share
    }
}
