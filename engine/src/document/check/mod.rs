//! What a scene may not say, as far as it shows without files: ranges, shapes and names.

use super::diagnostic::Diagnostic;
use super::scene::Scene;

/// Everything wrong with a scene that needs no file to be seen.
#[must_use]
pub fn check(scene: &Scene) -> Vec<Diagnostic> {
    check_readable(scene, &[])
}

/// The same for a scene that was read with errors at the `broken` paths: says nothing of these.
pub(super) fn check_readable(scene: &Scene, broken: &[String]) -> Vec<Diagnostic> {
    if scene.format == 1 || broken.iter().any(|path| path == "format") {
        return Vec::new();
    }
    let message = format!("format {} is unknown: this version reads format 1", scene.format);
    vec![Diagnostic::error("format", message)]
}
