//! Writes a recording in the layout it is read from.

use std::fmt::Write as _;
use std::fs;
use std::io;
use std::path::Path;

use crate::files::{self, File};
use crate::{Body, Error, Mocap, Recording};

impl Recording {
    /// Writes the recording into a new folder, in the layout that [`Recording::read`] reads.
    /// Numbers are written in full, so that they are read back as they were.
    ///
    /// The folder appears only when all is written; nothing is ever overwritten.
    ///
    /// # Errors
    /// When the folder exists already or cannot be written, or the recording could not be read
    /// back: series of unequal length, a number that is not finite, time that does not increase.
    pub fn write(&self, folder: impl AsRef<Path>) -> Result<(), Error> {
        let folder = folder.as_ref();
        self.check()?;
        if folder.symlink_metadata().is_ok() {
            return Err(Error::Exists {
                path: folder.into(),
            });
        }
        let mut partial = folder.as_os_str().to_owned();
        partial.push(".partial");
        let partial = Path::new(&partial);
        let failed = |source: io::Error| Error::Unwritable {
            path: folder.into(),
            source,
        };
        fs::create_dir(partial).map_err(|source| match source.kind() {
            io::ErrorKind::AlreadyExists => Error::Exists {
                path: partial.into(),
            },
            _ => failed(source),
        })?;
        let written = self
            .write_files(partial)
            .and_then(|()| fs::rename(partial, folder));
        written.map_err(|source| {
            // The first failure is the one to report.
            let _ = fs::remove_dir_all(partial);
            failed(source)
        })
    }

    fn write_files(&self, folder: &Path) -> io::Result<()> {
        let write = |file: &File, text: String| fs::write(folder.join(file.name), text);
        write(&files::TIME, lines(self.time.iter().map(|&time| [time])))?;
        for (file, series) in [
            (&files::GOAL, &self.goal),
            (&files::PRESENT, &self.present),
            (&files::VELOCITIES, &self.velocities),
            (&files::LOADS, &self.loads),
        ] {
            write(file, lines(series.iter().copied()))?;
        }
        match &self.mocap {
            Some(mocap) => write(&files::MOCAP, lines(frames(mocap))),
            None => Ok(()),
        }
    }
}

/// Rows of the motion-capture file; frames count from one.
fn frames(mocap: &Mocap) -> impl Iterator<Item = [f64; 9]> + '_ {
    let mut frame = 0.0;
    (0..mocap.base.position.len()).flat_map(move |row| {
        frame += 1.0;
        Body::ALL.map(|body| {
            let track = mocap.track(body);
            let (p, q) = (track.position[row], track.rotation[row]);
            let number = f64::from(body.number());
            [frame, number, q.i, q.j, q.k, q.w, p.x, p.y, p.z]
        })
    })
}

fn lines<const N: usize>(rows: impl Iterator<Item = [f64; N]>) -> String {
    let mut text = String::new();
    for row in rows {
        for (column, value) in row.iter().enumerate() {
            let separator = if column == 0 { "" } else { "," };
            // Writing to a string cannot fail.
            let _ = write!(text, "{separator}{value}");
        }
        text.push('\n');
    }
    text
}
