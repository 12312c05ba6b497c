use std::path::Path;

use crate::document::{Diagnostic, Scene};

/// Every file that a scene names and that is not there, used or not.
///
/// It needs nothing but names, so it serves scenes that cannot be spawned as well: whatever is wrong
/// with a scene is reported at once.
#[must_use]
pub fn missing_files(scene: &Scene, folder: &Path) -> Vec<Diagnostic> {
    let mut missing = Vec::new();
    for (path, file) in scene.files() {
        let full = folder.join(file);
        let message = if full.is_dir() {
            format!("{} is a folder", full.display())
        } else if !full.exists() {
            format!("no file {}", full.display())
        } else {
            continue;
        };
        let help = match file {
            _ if file.contains('\\') && !full.is_dir() => "write `/` between folders",
            _ if file.starts_with('~') => "write the path in full: `~` is not expanded",
            _ => "paths are relative to the folder of the scene file",
        };
        missing.push(Diagnostic::error(path, message).help(help));
    }
    missing
}
