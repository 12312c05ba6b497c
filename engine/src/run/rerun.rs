//! Repetition of a run from what its files say of it.

use std::path::{Path, PathBuf};
use std::time::Instant;

use super::reading::sound;
use super::{Failure, Options, Progress, report_of_reading};
use crate::document::{self, StopCriterion};
use crate::files;
use crate::output::RecipeRecord;
use crate::products::{Report, SceneSource};

/// Input files of a run that have changed since, each with what has changed.
///
/// - `folder`: folder that paths of the scene are relative to
#[must_use]
pub fn changed_files(record: &RecipeRecord, folder: &Path) -> Vec<String> {
    let change = |(path, hash): (&String, &String)| {
        let path = folder.join(path);
        let found = files::open(&path).and_then(|file| {
            Ok(blake3::Hasher::new().update_reader(file)?.finalize().to_hex().to_string())
        });
        match found {
            Ok(found) if found == *hash => None,
            Ok(_) => Some(format!("{} has changed since", path.display())),
            Err(error) => Some(format!("{} cannot be read: {error}", path.display())),
        }
    };
    record.files.iter().filter_map(change).collect()
}

/// Repeats a run: the scene, its sensors and the number of samples are those of the record.
///
/// - `folder`: folder that paths of the scene are relative to
///
/// # Errors
/// All errors of the scene.
pub fn rerun(
    record: &RecipeRecord,
    folder: &Path,
    options: &Options,
    progress: &dyn Progress,
) -> Result<Report, Failure> {
    let start = Instant::now();
    progress.stage("reading the scene");
    let options = Options {
        quality: record.quality,
        keeps_coefficients: record.keeps_coefficients,
        ..options.clone()
    };
    let name = "the scene of the result";
    let reading = document::read_text(name, &record.scene, &options.document)
        .map_err(|error| Failure::Scene(error.to_string()))?;
    let reading = sound(reading, &folder.join(name), &options)?;
    let is_timed = |stop: &StopCriterion| matches!(stop, StopCriterion::Seconds(_));
    for (sensor, _) in
        reading.scene.sensors.iter().filter(|(_, one)| one.until().iter().any(is_timed))
    {
        progress.warn(&format!("sensors.{sensor} measures for a time: its number of samples, and so its results, differ from run to run"));
    }
    let report = report_of_reading(&reading, folder, &options, progress, None, start)?;
    let file: Option<PathBuf> = record.scene_file();
    let source = file.map(|file| SceneSource {
        file,
        variant: record.variant.clone(),
        set: record.set.clone().into_iter().collect(),
        quality: record.quality,
    });
    Ok(Report { params: record.params.clone().into_iter().collect(), source, ..report })
}
