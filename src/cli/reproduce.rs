//! `auxetica reproduce`

use super::progress::Meter;
use super::table::table;
use super::{Failure, print, write_whole};
use crate::reproduce::{Data, Item, ReproduceError, Shown};
use clap::ValueEnum;
use clap::builder::PossibleValue;
use std::path::{Path, PathBuf};
use std::sync::Mutex;

#[derive(clap::Args)]
pub(super) struct Options {
    /// What to compute again.
    #[arg(value_enum, default_value = "all")]
    items: Vec<Wanted>,
    /// Write all figures as JSON, to a file or to stdout if `-`.
    #[arg(long, value_name = "FILE")]
    json: Option<PathBuf>,
    /// Folder for the pictures.
    #[arg(long, value_name = "DIR", default_value = "out/reproduce")]
    out: PathBuf,
}

/// One item, or all that there are data for.
#[derive(Clone, Copy, PartialEq)]
enum Wanted {
    All,
    One(Item),
}

impl ValueEnum for Wanted {
    fn value_variants<'a>() -> &'a [Self] {
        const VARIANTS: [Wanted; 1 + Item::ALL.len()] = {
            let mut variants = [Wanted::All; 1 + Item::ALL.len()];
            let mut i = 0;
            while i < Item::ALL.len() {
                variants[i + 1] = Wanted::One(Item::ALL[i]);
                i += 1;
            }
            variants
        };
        &VARIANTS
    }

    fn to_possible_value(&self) -> Option<PossibleValue> {
        match self {
            Self::All => {
                Some(PossibleValue::new("all").help("All of them, as far as there are data"))
            }
            Self::One(item) => item.to_possible_value(),
        }
    }
}

pub(super) fn run(options: &Options, quiet: bool) -> Result<(), Failure> {
    let all = options.items.contains(&Wanted::All);
    let wanted = |item: &Item| all || options.items.contains(&Wanted::One(*item));
    // Nothing is computed for folders that can't be written to.
    let json_folder = options.json.as_deref().and_then(Path::parent);
    if let Some(folder) = json_folder.filter(|folder| *folder != Path::new("") && !folder.is_dir())
    {
        let absent = std::io::ErrorKind::NotFound.into();
        return Err(Failure::output(folder, absent));
    }
    std::fs::create_dir_all(&options.out).map_err(|e| Failure::output(&options.out, e))?;
    let to_stdout = options.json.as_deref() == Some(Path::new("-"));
    let data = Data::from_environment();
    let mut json = serde_json::Map::new();
    for item in Item::ALL.into_iter().filter(wanted) {
        let meter = Mutex::new(Meter::new(item.name(), quiet));
        let ticker = |done: f64| meter.lock().unwrap_or_else(|e| e.into_inner()).update(done);
        let outcome = item.reproduce(&data, &ticker);
        drop(meter);
        match outcome {
            Ok(shown) => {
                let pictures = save(&shown, &options.out)?;
                if !to_stdout {
                    print(&show(&shown, &pictures))?;
                }
                json.insert(item.name().into(), shown.json);
            }
            Err(missing @ ReproduceError::Missing { .. }) if all => {
                if !quiet {
                    eprintln!("skipped {}: {missing}\n", item.name());
                }
                json.insert(item.name().into(), serde_json::Value::Null);
            }
            Err(e) => return Err(e.into()),
        }
    }
    if let Some(path) = &options.json {
        let text = serde_json::to_string_pretty(&json).expect("figures are plain data");
        if to_stdout {
            print(&text)?;
        } else {
            write_whole(path, &(text + "\n"))?;
        }
    }
    Ok(())
}

/// Writes the pictures and tells their paths.
fn save(shown: &Shown, out: &Path) -> Result<Vec<PathBuf>, Failure> {
    let mut written = Vec::new();
    for (name, picture) in &shown.pictures {
        let paths = picture.save(out, name);
        written.extend(paths.map_err(|e| Failure::output(&out.join(name), e))?);
    }
    Ok(written)
}

/// The item for people.
fn show(shown: &Shown, pictures: &[PathBuf]) -> String {
    let mut text = format!("{}\n", shown.title);
    for part in &shown.tables {
        let header: Vec<&str> = part.header.iter().map(String::as_str).collect();
        let rows = table(&header, part.rows.iter().cloned());
        text += &format!("\n{}\n{rows}\n", part.caption);
    }
    if !shown.notes.is_empty() {
        text += &format!("\n{}\n", shown.notes.join("\n"));
    }
    for path in pictures {
        text += &format!("written: {}\n", path.display());
    }
    text
}
