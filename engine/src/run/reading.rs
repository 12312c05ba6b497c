use std::path::Path;

use super::{Failure, Options};
use crate::document::{self, Diagnostic, Reading, Scene, ScenePath};
use crate::spawn::missing_files;

/// Reads a scene file.
///
/// # Errors
/// All errors of the scene, rendered for a person.
pub(super) fn read(path: &Path, options: &Options) -> Result<Reading, Failure> {
    let reading = document::read_file(path, &options.document)
        .map_err(|error| Failure::Scene(error.to_string()))?;
    sound(reading, path, options)
}

/// Reads the text of a scene that stands for a file, which need not be there.
///
/// # Errors
/// All errors of the scene, rendered for a person.
pub(super) fn read_as(path: &Path, text: &str, options: &Options) -> Result<Reading, Failure> {
    let reading = document::read_text(&path.display().to_string(), text, &options.document)
        .map_err(|error| Failure::Scene(error.to_string()))?;
    sound(reading, path, options)
}

/// Reading without errors, with the sensors that are asked for.
pub(super) fn sound(
    mut reading: Reading,
    path: &Path,
    options: &Options,
) -> Result<Reading, Failure> {
    if reading.is_sound() {
        let unknown = choose_sensors(&mut reading.scene, &options.sensors);
        return if unknown.is_empty() {
            Ok(reading)
        } else {
            Err(Failure::Scene(reading.source.render(&unknown)))
        };
    }
    // Missing files are reported at once with the errors of the text.
    let mut problems = reading.diagnostics;
    // A path that could not be read is a placeholder, and its error is known.
    let known: Vec<ScenePath> = problems.iter().map(|problem| problem.path.clone()).collect();
    let missing = missing_files(&reading.scene, folder_of(path)).into_iter();
    problems.extend(missing.filter(|m| !known.iter().any(|path| m.path.is_within(path))));
    Err(Failure::Scene(reading.source.render(&problems)))
}

/// Removes all sensors but these; returns an error for each unknown name.
pub(super) fn choose_sensors(scene: &mut Scene, names: &[String]) -> Vec<Diagnostic> {
    let unknown = names.iter().filter(|name| !scene.sensors.contains_key(name.as_str()));
    let known = || scene.sensors.keys().map(String::as_str);
    let unknown = unknown.map(|name| document::unknown_name("sensors", "sensor", name, known()));
    let unknown = unknown.collect();
    if !names.is_empty() {
        scene.sensors.retain(|name, _| names.contains(name));
    }
    unknown
}

/// Folder that paths in a scene file are relative to.
pub(super) fn folder_of(path: &Path) -> &Path {
    path.parent().unwrap_or(Path::new(""))
}
