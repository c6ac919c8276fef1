//! Files that are written by one recorder at a time.

use auxetica_engine::CallbackError;
use std::error::Error;
use std::fmt;
use std::fs::{self, File, OpenOptions, TryLockError};
use std::io;
use std::path::{Path, PathBuf};

/// The error of writing `path`, with a remedy.
pub(crate) fn failed(
    path: &Path,
    source: impl Into<Box<dyn Error + Send + Sync>>,
) -> CallbackError {
    CallbackError {
        what: format!("writing {}", path.display()),
        source: Box::new(Unwritten(source.into())),
    }
}

#[derive(Debug)]
struct Unwritten(Box<dyn Error + Send + Sync>);

impl fmt::Display for Unwritten {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(
            f,
            "{}; give another `file`, or see that its folder has room and may be written to",
            self.0
        )
    }
}

impl Error for Unwritten {
    fn source(&self) -> Option<&(dyn Error + 'static)> {
        Some(&*self.0)
    }
}

/// Opens `path` empty for writing, with the folders that it needs.
pub(crate) fn open(path: &Path) -> Result<File, CallbackError> {
    open_locked(path).map_err(|source| failed(path, source))
}

fn open_locked(path: &Path) -> io::Result<File> {
    if let Some(folder) = path.parent() {
        fs::create_dir_all(folder).map_err(|e| {
            let message = format!("there can be no folder {} ({e})", folder.display());
            io::Error::new(e.kind(), message)
        })?;
    }
    let file = OpenOptions::new()
        .write(true)
        .create(true)
        .truncate(false)
        .open(path)?;
    // Emptied under its lock only; file systems that have no locks go without.
    if let Err(TryLockError::WouldBlock) = file.try_lock() {
        return Err(io::Error::other("another recorder is writing it"));
    }
    // Pipes and terminals are empty and can't be cut.
    if file.metadata()?.len() > 0 {
        file.set_len(0)?;
    }
    Ok(file)
}

/// Opens the file that [`complete`] turns into `path`.
pub(crate) fn open_part(path: &Path) -> Result<File, CallbackError> {
    if path.is_dir() {
        return Err(failed(path, io::Error::from(io::ErrorKind::IsADirectory)));
    }
    open(&part(path))
}

/// Gives the whole `file` of [`open_part`] its name, in place of a file that had it.
pub(crate) fn complete(file: File, path: &Path) -> Result<PathBuf, CallbackError> {
    file.sync_all()
        .and_then(|()| {
            drop(file);
            fs::rename(part(path), path)
        })
        .map_err(|source| failed(path, source))?;
    Ok(path.into())
}

fn part(path: &Path) -> PathBuf {
    let mut name = path.as_os_str().to_owned();
    name.push(".part");
    name.into()
}
