//! Measured characteristics of rods: tables of the user, and published ones.

use super::Quantity;
use crate::config::remedy;
use std::path::Path;

/// Measured characteristics of one rod, SI units.
#[derive(Clone, Debug, PartialEq)]
pub struct Curves {
    /// Where they come from.
    pub origin: String,
    /// The points, in the order of the table.
    pub points: Vec<Point>,
}

/// One measured value.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Point {
    /// What was measured.
    pub quantity: Quantity,
    /// Twist angle \[rad\], positive the way that winds the rod.
    pub angle: f64,
    /// Value, SI units.
    pub value: f64,
    /// How much less it may be, SI units, not negative.
    pub error_minus: f64,
    /// How much more it may be, SI units, not negative.
    pub error_plus: f64,
}

impl Point {
    /// Half the length of the error bar.
    pub fn deviation(&self) -> f64 {
        (self.error_minus + self.error_plus) / 2.0
    }

    /// Whether `value` lies within the error bar.
    pub fn holds(&self, value: f64) -> bool {
        (-self.error_minus..=self.error_plus).contains(&(value - self.value))
    }
}

/// A table of curves that can't be used.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[error("{place}: {what}; {remedy}")]
pub struct BadCurves {
    /// File, line and field.
    pub place: String,
    /// What is wrong.
    pub what: String,
    /// What to do.
    pub remedy: String,
}

/// Columns of a table of curves.
const COLUMNS: [&str; 7] = [
    "rows",
    "quantity",
    "unit",
    "twist_angle_deg",
    "value",
    "error_minus",
    "error_plus",
];
/// The one that a table of a single rod may leave out.
const ROWS: usize = 0;

const GOOD_2022: &str = include_str!("good2022.csv");

/// One line of a table: the rod's number of rows, and the point.
type Line = (Option<u32>, Point);

impl Curves {
    /// The measurements of Good et al. 2022 of a closed rod of so many rows: 4, 6, 8, 10 or 12.
    ///
    /// # Errors
    /// If no such rod was measured.
    pub fn good2022(rows: u32) -> Result<Self, BadCurves> {
        let name = "Good et al. 2022";
        Reader { name }.curves(GOOD_2022, Some(rows))
    }

    /// Reads a CSV file with the columns `quantity`, `unit`, `twist_angle_deg`, `value`, `error_minus`, `error_plus` and,
    /// if it holds several rods, `rows`, of which `rows` chooses one. Lines that begin with `#` are comments.
    ///
    /// # Errors
    /// If the file can't be read, or anything in it isn't understood.
    pub fn read(path: &Path, rows: Option<u32>) -> Result<Self, BadCurves> {
        let (name, text) = text(path)?;
        Reader { name: &name }.curves(&text, rows)
    }

    /// The numbers of rows of the rods that a CSV file holds, ascending; a single none if it has no column `rows`.
    ///
    /// # Errors
    /// If the file can't be read, or anything in it isn't understood.
    pub fn rows(path: &Path) -> Result<Vec<Option<u32>>, BadCurves> {
        let (name, text) = text(path)?;
        let lines = Reader { name: &name }.lines(&text)?;
        let mut rows: Vec<_> = lines.into_iter().map(|(rows, _)| rows).collect();
        rows.sort_unstable();
        rows.dedup();
        Ok(rows)
    }

    /// The angles of its points \[rad\], ascending, each once.
    pub fn angles(&self) -> Vec<f64> {
        let mut angles: Vec<f64> = self.points.iter().map(|point| point.angle).collect();
        angles.sort_by(f64::total_cmp);
        angles.dedup();
        angles
    }

    /// Its points that `keep` chooses.
    pub fn only(&self, keep: impl Fn(&Point) -> bool) -> Self {
        let kept = self.points.iter().filter(|point| keep(point));
        Self {
            points: kept.copied().collect(),
            ..self.clone()
        }
    }
}

/// Name and text of a file.
fn text(path: &Path) -> Result<(String, String), BadCurves> {
    let name = path.display().to_string();
    match std::fs::read_to_string(path) {
        Ok(text) => Ok((name, text)),
        Err(e) => Err(BadCurves {
            place: name,
            what: format!("can't be read ({e})"),
            remedy: "give a CSV file of measured curves that you may read".into(),
        }),
    }
}

struct Reader<'a> {
    name: &'a str,
}

impl Reader<'_> {
    fn fault(&self, place: &str, what: impl Into<String>, remedy: impl Into<String>) -> BadCurves {
        BadCurves {
            place: format!("{}{place}", self.name),
            what: what.into(),
            remedy: remedy.into(),
        }
    }

    fn curves(&self, text: &str, rows: Option<u32>) -> Result<Curves, BadCurves> {
        let lines = self.lines(text)?;
        let mut rods: Vec<u32> = lines.iter().filter_map(|(rows, _)| *rows).collect();
        rods.sort_unstable();
        rods.dedup();
        let listed = rods
            .iter()
            .map(u32::to_string)
            .collect::<Vec<_>>()
            .join(", ");
        let chosen = match (rows, rods.as_slice()) {
            (None, [] | [_]) => None,
            (None, _) => {
                let what = format!("it holds rods of {listed} rows");
                return Err(self.fault("", what, "choose one with --rows"));
            }
            (Some(rows), _) if !rods.contains(&rows) => {
                let remedy = match rods.as_slice() {
                    [] => "it has no column `rows`: leave --rows out".to_owned(),
                    _ => format!("there are rods of {listed} rows"),
                };
                return Err(self.fault("", format!("it holds no rod of {rows} rows"), remedy));
            }
            (some, _) => some,
        };
        let of_rod = lines
            .into_iter()
            .filter(|(rows, _)| chosen.is_none() || *rows == chosen);
        let points: Vec<_> = of_rod.map(|(_, point)| point).collect();
        for quantity in Quantity::ALL {
            let mut of_quantity = points.iter().filter(|p| p.quantity == quantity).peekable();
            let is_nothing = |p: &Point| p.value.abs() + p.error_minus + p.error_plus == 0.0;
            if of_quantity.peek().is_some() && of_quantity.all(is_nothing) {
                let what = format!("every value and error of `{}` is 0", quantity.name());
                return Err(self.fault("", what, "drop its lines, or give its error bars"));
            }
        }
        let origin = match rows {
            Some(rows) => format!("{}, {rows} rows", self.name),
            None => self.name.to_owned(),
        };
        Ok(Curves { origin, points })
    }

    fn lines(&self, text: &str) -> Result<Vec<Line>, BadCurves> {
        let mut reader = csv::ReaderBuilder::new()
            .comment(Some(b'#'))
            .flexible(true)
            .trim(csv::Trim::All)
            .from_reader(text.as_bytes());
        let header = reader.headers().expect("a text in memory is read").clone();
        let columns = self.columns(&header)?;
        let mut lines = Vec::new();
        let mut last = 1;
        for record in reader.records() {
            let record = record.expect("a text in memory is read");
            last = record.position().map_or(0, csv::Position::line);
            let place = format!(", line {last}");
            if record.len() != header.len() {
                let what = format!(
                    "{} fields where {} are expected",
                    record.len(),
                    header.len()
                );
                let remedy = "mend the line: fields are separated by commas, as in the header";
                return Err(self.fault(&place, what, remedy));
            }
            lines.push(self.line(&record, &columns, &place)?);
        }
        if lines.is_empty() {
            return Err(self.fault(
                "",
                "it holds no measured point",
                "add lines below the header",
            ));
        }
        // A number cut short in the last column would pass for a whole one.
        if !text.ends_with('\n') {
            let remedy = "restore the file, or end the line if it is complete";
            let what = "it is cut off: its last line has no end";
            return Err(self.fault(&format!(", line {last}"), what, remedy));
        }
        Ok(lines)
    }

    /// Where each of [`COLUMNS`] is.
    fn columns(&self, header: &csv::StringRecord) -> Result<[Option<usize>; 7], BadCurves> {
        let remedy = || format!("the header is `{}`", COLUMNS.join(","));
        for name in header {
            if !COLUMNS.contains(&name) {
                let what = format!("unknown column `{name}` in the header");
                return Err(self.fault("", what, remedy()));
            }
            if header.iter().filter(|other| *other == name).count() > 1 {
                return Err(self.fault("", format!("column `{name}` is there twice"), remedy()));
            }
        }
        let found = COLUMNS.map(|name| header.iter().position(|other| other == name));
        match found
            .iter()
            .enumerate()
            .find(|(c, at)| at.is_none() && *c != ROWS)
        {
            None => Ok(found),
            Some((c, _)) => {
                Err(self.fault("", format!("column `{}` is missing", COLUMNS[c]), remedy()))
            }
        }
    }

    fn line(
        &self,
        record: &csv::StringRecord,
        columns: &[Option<usize>; 7],
        line: &str,
    ) -> Result<Line, BadCurves> {
        let field = |c: usize| columns[c].map_or("", |at| &record[at]);
        let place = |c: usize| format!("{line}, `{}`", COLUMNS[c]);
        let number = |c: usize| match field(c).parse::<f64>() {
            Ok(number) if number.is_finite() => Ok(number),
            Ok(number) => Err(self.fault(
                &place(c),
                format!("{number} is not finite"),
                "drop the line or mend the field",
            )),
            Err(_) => Err(self.fault(
                &place(c),
                format!("`{}` is not a number", field(c)),
                "mend the field",
            )),
        };
        let error = |c: usize| match number(c)? {
            error if error < 0.0 => {
                let what = format!("{error} is negative");
                Err(self.fault(
                    &place(c),
                    what,
                    "give the length of the error bar, 0 or more",
                ))
            }
            error => Ok(error),
        };
        let rows = match columns[ROWS] {
            None => None,
            Some(at) => Some(record[at].parse().map_err(|_| {
                let what = format!("`{}` is not a number of rows", &record[at]);
                self.fault(&place(ROWS), what, "give 4, 6, 8 ..")
            })?),
        };
        let quantity = Quantity::ALL
            .into_iter()
            .find(|q| q.name() == field(1))
            .ok_or_else(|| {
                let known = Quantity::ALL.map(Quantity::name);
                let what = format!("unknown quantity `{}`", field(1));
                self.fault(&place(1), what, remedy(field(1), &known, "known"))
            })?;
        if field(2) != quantity.unit() {
            let what = format!(
                "unit `{}` where `{}` is expected",
                field(2),
                quantity.unit()
            );
            return Err(self.fault(&place(2), what, "convert the value and its errors"));
        }
        let si = quantity.in_si();
        let point = Point {
            quantity,
            angle: number(3)?.to_radians(),
            value: number(4)? * si,
            error_minus: error(5)? * si,
            error_plus: error(6)? * si,
        };
        Ok((rows, point))
    }
}
