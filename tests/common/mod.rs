//! What several tests share.
#![allow(dead_code, reason = "each test uses some of it")]

use std::path::{Path, PathBuf};

/// A file or folder of the reference data, which lie in `AUXETICA_DATA` (by default `../shared`). Without them a test
/// has nothing to compare with and should return; continuous integration (`CI` set) must have them.
pub fn data(relative: &str) -> Option<PathBuf> {
    let folder = std::env::var_os("AUXETICA_DATA").map_or_else(
        || Path::new(env!("CARGO_MANIFEST_DIR")).join("../shared"),
        PathBuf::from,
    );
    let path = folder.join(relative);
    if path.exists() {
        return Some(path);
    }
    let notice = format!(
        "{} is not there; AUXETICA_DATA names the folder of the reference data",
        path.display()
    );
    assert!(std::env::var_os("CI").is_none(), "{notice}");
    eprintln!("not compared: {notice}");
    None
}
