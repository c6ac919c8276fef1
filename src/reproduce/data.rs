//! Where the public data lie.

use super::ReproduceError;
use std::path::{Path, PathBuf};

/// The folder of the public data.
pub struct Data {
    folder: PathBuf,
}

impl Data {
    /// The folder that `AUXETICA_DATA` names, by default `../shared`.
    pub fn from_environment() -> Self {
        let folder =
            std::env::var_os("AUXETICA_DATA").map_or_else(|| "../shared".into(), PathBuf::from);
        Self { folder }
    }

    /// The folder itself.
    pub fn folder(&self) -> &Path {
        &self.folder
    }

    /// A file or folder in it.
    ///
    /// # Errors
    /// When it isn't there.
    pub fn find(&self, relative: &str) -> Result<PathBuf, ReproduceError> {
        let path = self.folder.join(relative);
        if path.exists() {
            Ok(path)
        } else {
            Err(ReproduceError::Missing { path })
        }
    }
}
