//! The jobs of a sweep: what differs between them, and their identities.

use super::SweepError;
use super::range::Range;
use crate::config::{Problem, Problems, Source, Tied};
use crate::engine::Model;
use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_pcg::Pcg64Mcg;
use sha2::{Digest, Sha256};
use std::path::Path;

/// More jobs than this are a slip of the pen.
const MOST: usize = 10_000_000;

/// A scenario and the list of its jobs: each puts one row of numbers into the places that the columns name.
pub struct Plan {
    name: String,
    scenario: String,
    columns: Vec<Tied>,
    rows: Vec<Vec<f64>>,
    digest: [u8; 32],
}

impl Plan {
    /// Every combination of the ranges' values; the last range changes fastest.
    ///
    /// # Errors
    /// If a range has no count of values, or the columns don't fit the scenario.
    pub fn grid(source: &Source, ranges: Vec<Range>) -> Result<Self, SweepError> {
        let mut problems = Problems::default();
        let counts = ranges.iter().map(Range::count);
        let counts: Vec<usize> = counts.filter_map(|count| problems.collect(count)).collect();
        problems.into_result()?;
        let product = counts.iter().try_fold(1_usize, |n, c| n.checked_mul(*c));
        let jobs = product
            .filter(|n| *n <= MOST)
            .ok_or_else(|| too_many(&counts))?;
        let row = |job: usize| {
            let mut rest = job;
            let mut row = vec![0.0; ranges.len()];
            for ((value, range), count) in row.iter_mut().zip(&ranges).zip(&counts).rev() {
                *value = range.at((rest % count) as f64 / (count - 1) as f64);
                rest /= count;
            }
            row
        };
        let rows = (0..jobs).map(row).collect();
        Self::new(source, ranges.into_iter().map(|r| r.tied).collect(), rows)
    }

    /// A Latin hypercube (McKay, Beckman and Conover 1979, doi:10.1080/00401706.1979.10489755): each range is cut into
    /// as many equal parts as there are `jobs`, and each part holds one job, at a random place in it.
    ///
    /// # Errors
    /// If a range has a count of values, or the columns don't fit the scenario.
    pub fn latin(
        source: &Source,
        ranges: Vec<Range>,
        jobs: usize,
        seed: u64,
    ) -> Result<Self, SweepError> {
        let mut problems = Problems::default();
        for range in &ranges {
            problems.collect(range.no_count());
        }
        problems.into_result()?;
        if jobs > MOST {
            return Err(too_many(&[jobs]));
        }
        let mut random = Pcg64Mcg::seed_from_u64(seed);
        let mut rows = vec![Vec::with_capacity(ranges.len()); jobs];
        for range in &ranges {
            let mut parts: Vec<usize> = (0..jobs).collect();
            parts.shuffle(&mut random);
            for (row, part) in rows.iter_mut().zip(parts) {
                let within: f64 = random.random();
                row.push(range.at((part as f64 + within) / jobs as f64));
            }
        }
        Self::new(source, ranges.into_iter().map(|r| r.tied).collect(), rows)
    }

    /// The rows of a CSV file whose header names paths.
    ///
    /// # Errors
    /// If it can't be read, or holds anything but finite numbers, or its columns don't fit the scenario.
    pub fn list(source: &Source, file: &Path) -> Result<Self, SweepError> {
        let bad = |message: String| SweepError::List {
            file: file.into(),
            message,
        };
        let mut reader = csv::ReaderBuilder::new()
            .trim(csv::Trim::All)
            .from_path(file)
            .map_err(|e| bad(e.to_string()))?;
        let context = format!("column of {}:", file.display());
        let mut columns = Vec::new();
        for name in reader.headers().map_err(|e| bad(e.to_string()))? {
            let tied = Tied::read(&context, name)?;
            if !tied.rest().is_empty() {
                let problem = tied.problem("expected one path, or several with commas between");
                return Err(Problems::from(problem).into());
            }
            columns.push(tied);
        }
        let mut rows = Vec::new();
        for record in reader.records() {
            let record = record.map_err(|e| bad(e.to_string()))?;
            let line = record.position().map_or(0, |p| p.line());
            let mut row = Vec::with_capacity(columns.len());
            for (cell, column) in record.iter().zip(&columns) {
                let number = cell.parse().ok().filter(|v: &f64| v.is_finite());
                row.push(number.ok_or_else(|| {
                    let column = column.name();
                    bad(format!(
                        "line {line}, column `{column}`: `{cell}` is no finite number"
                    ))
                })?);
            }
            rows.push(row);
        }
        if rows.is_empty() {
            return Err(bad("there is no row of numbers below the header".into()));
        }
        if rows.len() > MOST {
            return Err(too_many(&[rows.len()]));
        }
        Self::new(source, columns, rows)
    }

    fn new(source: &Source, columns: Vec<Tied>, rows: Vec<Vec<f64>>) -> Result<Self, SweepError> {
        let mut problems = Problems::default();
        let mut taken: Vec<(String, &Tied)> = Vec::new();
        for column in &columns {
            for place in problems.collect(column.numbers(source)).unwrap_or_default() {
                match taken.iter().find(|(known, _)| *known == place) {
                    Some((_, other)) => problems.0.push(taken_twice(column, other, &place)),
                    None => taken.push((place, column)),
                }
            }
        }
        problems.into_result()?;
        let mut digest = Sha256::new_with_prefix(source.text());
        for column in &columns {
            digest.update(b"\0");
            digest.update(column.name());
        }
        Ok(Self {
            name: source.name().to_owned(),
            scenario: source.text().to_owned(),
            columns,
            rows,
            digest: digest.finalize().into(),
        })
    }

    /// Refuses a plan in which no job has a good scenario, with the problems of the first.
    ///
    /// # Errors
    /// All that is wrong with the first job's scenario.
    pub fn check(&self) -> Result<(), Problems> {
        let built = |job| {
            self.source(job)
                .and_then(|source| Model::build(&source, None))
        };
        match built(0) {
            Err(problems) if (1..self.jobs()).all(|job| built(job).is_err()) => Err(problems),
            _ => Ok(()),
        }
    }

    /// Number of jobs; each is known by its index.
    pub fn jobs(&self) -> usize {
        self.rows.len()
    }

    /// The scenario that all jobs share, standing alone.
    pub fn scenario(&self) -> &str {
        &self.scenario
    }

    /// Names of the parameters: paths, tied ones with commas between.
    pub fn columns(&self) -> impl Iterator<Item = String> {
        self.columns.iter().map(Tied::name)
    }

    /// The parameters of a job, one a column.
    pub fn row(&self, job: usize) -> &[f64] {
        &self.rows[job]
    }

    /// What a job is: 16 digits of SHA-256 over its scenario, its paths and its numbers.
    pub fn hash(&self, job: usize) -> String {
        let mut digest = Sha256::new_with_prefix(self.digest);
        for value in self.row(job) {
            digest.update(value.to_bits().to_le_bytes());
        }
        let hex = |byte: &u8| format!("{byte:02x}");
        digest.finalize()[..8].iter().map(hex).collect()
    }

    /// The scenario of a job.
    ///
    /// # Errors
    /// If its numbers don't fit in.
    pub fn source(&self, job: usize) -> Result<Source, Problems> {
        let columns = self.columns.iter().zip(self.row(job));
        let sets: Vec<String> = columns.flat_map(|(c, value)| c.sets(*value)).collect();
        Source::from_text(&self.name, &self.scenario, &sets)
    }

    /// The list as [`Plan::list`] reads it.
    pub fn to_csv(&self) -> String {
        let mut table = csv::Writer::from_writer(Vec::new());
        let rows = self.rows.iter();
        let rows = rows.map(|row| row.iter().map(f64::to_string).collect());
        for row in std::iter::once(self.columns().collect::<Vec<_>>()).chain(rows) {
            table.write_record(row).expect("memory takes all rows");
        }
        let bytes = table.into_inner().expect("memory takes all rows");
        String::from_utf8(bytes).expect("paths and numbers are text")
    }
}

fn taken_twice(column: &Tied, other: &Tied, place: &str) -> Problem {
    let also = other.name();
    let message = format!("`{place}` is changed twice, also by `{also}`");
    column
        .problem_with_paths(message)
        .with_hint("give each place once")
}

fn too_many(counts: &[usize]) -> SweepError {
    let counts: Vec<_> = counts.iter().map(usize::to_string).collect();
    SweepError::TooMany {
        jobs: counts.join(" x "),
        most: MOST,
    }
}
