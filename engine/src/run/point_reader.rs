//! Scenes of a sweep's points, read from one parsed file.

use std::path::{Path, PathBuf};

use rayon::prelude::*;

use super::provenance::FileHashes;
use super::reading::{choose_sensors, folder_of, sound};
use super::sweep::SharingKeys;
use super::{Failure, Options, Progress};
use crate::document::{ParsedScene, ReadOptions, Reading, Scene, ScenePath, Sun};
use crate::products::{Night, SweepPoint};

/// Number of points that are read side by side, between two reports of progress.
pub(super) const AT_A_TIME: usize = 256;

/// Reader of a scene file at the points of its sweep.
pub(super) struct PointReader {
    file: PathBuf,
    options: Options,
    /// The scene without its sweep: no point needs the list of all.
    parsed: ParsedScene,
    hashes: FileHashes,
}

/// Properties of a point that need no run.
pub(super) struct PointSummary {
    /// Hash of all that decides its results.
    pub(super) key: String,
    pub(super) sharing: SharingKeys,
    pub(super) sun: Option<Sun>,
    pub(super) night: Option<Night>,
}

impl PointReader {
    /// A reader of a file, and the scene with its own values of all parameters.
    ///
    /// # Errors
    /// Errors of the scene.
    pub(super) fn new(file: &Path, options: &Options) -> Result<(Self, Scene), Failure> {
        let parsed = ParsedScene::from_file(file).map_err(|e| Failure::Scene(e.to_string()))?;
        let without_sweep = parsed.without_sweep();
        let (file, options) = (file.to_owned(), options.clone());
        let hashes = FileHashes::default();
        let reader = Self { file, options, parsed: without_sweep, hashes };
        let (Reading { scene, .. }, _) = reader.sound(parsed.read(&reader.options.document))?;
        Ok((reader, scene))
    }

    /// The reader for points that keep the values of each randomisation.
    pub(super) fn with_replicates(self) -> Self {
        Self { options: Options { keeps_replicates: true, ..self.options }, ..self }
    }

    /// Hashes of the files that scenes name.
    pub(super) const fn hashes(&self) -> &FileHashes {
        &self.hashes
    }

    /// Scenes at some points, none of which is dark.
    pub(super) fn read_all(&self, points: &[SweepPoint]) -> Vec<Result<Reading, Failure>> {
        let read = |point: &SweepPoint| {
            sound(self.parsed.read(&self.at(point)), &self.file, &self.options)
                .map_err(|failure| wrong_at(point, failure))
        };
        points.par_iter().map(read).collect()
    }

    /// Properties of all points.
    ///
    /// # Errors
    /// Errors of the scene at the first point that has any.
    pub(super) fn summaries(
        &self,
        points: &[SweepPoint],
        progress: &dyn Progress,
    ) -> Result<Vec<PointSummary>, Failure> {
        let mut all = Vec::with_capacity(points.len());
        for some in points.chunks(AT_A_TIME) {
            let found: Vec<_> = some.par_iter().map(|point| self.summary(point)).collect();
            for (found, point) in found.into_iter().zip(some) {
                all.push(found.map_err(|failure| wrong_at(point, failure))?);
            }
            progress.stage(&format!("reading point {} of {}", all.len(), points.len()));
        }
        Ok(all)
    }

    fn summary(&self, point: &SweepPoint) -> Result<PointSummary, Failure> {
        let (reading, night) = self.sound(self.parsed.read(&self.at(point)))?;
        let params = ScenePath::from("params");
        let swept: Vec<_> = point.params.iter().map(|(name, _)| params.name(name)).collect();
        // A point that changes nothing is no point.
        let unused: Vec<_> =
            reading.diagnostics.iter().filter(|one| swept.contains(&one.path)).cloned().collect();
        if !unused.is_empty() {
            return Err(Failure::Scene(reading.source.render(&unused)));
        }
        let scene = reading.scene;
        let mut hasher = blake3::Hasher::new();
        hasher.update(env!("CARGO_PKG_VERSION").as_bytes());
        hasher.update(&self.options.quality.to_bits().to_le_bytes());
        if self.options.keeps_replicates {
            hasher.update(b"replicates");
        }
        hasher.update(scene.resolved().to_ron().as_bytes());
        for (_, named) in scene.files() {
            // The run reports missing files with their places.
            let Ok(hash) = self.hashes.of(&folder_of(&self.file).join(named)) else { continue };
            hasher.update(hash.as_bytes());
        }
        let sharing = SharingKeys::new(&scene, matches!(night, Some(Night::Dark(_))));
        let key = hasher.finalize().to_hex().to_string();
        Ok(PointSummary { key, sharing, sun: scene.sun, night })
    }

    /// Reading without errors, which may be dark at night.
    fn sound(&self, mut reading: Reading) -> Result<(Reading, Option<Night>), Failure> {
        let Some(why) = reading.darkness() else {
            let reading = sound(reading, &self.file, &self.options)?;
            let night = reading.night_warning().map(Night::WithoutSun);
            return Ok((reading, night));
        };
        let unknown = choose_sensors(&mut reading.scene, &self.options.sensors);
        if unknown.is_empty() {
            Ok((reading, Some(Night::Dark(why))))
        } else {
            Err(Failure::Scene(reading.source.render(&unknown)))
        }
    }

    /// Options of reading a point, whose parameters go before those that are set: where both have a value, it is the same
    /// or one beside it.
    fn at(&self, point: &SweepPoint) -> ReadOptions {
        let mut options =
            ReadOptions { point: point.params.clone(), ..self.options.document.clone() };
        options.set.retain(|(name, _)| !point.params.iter().any(|(known, _)| known == name));
        options
    }
}

/// Failure of the scene at a point.
pub(super) fn wrong_at(point: &SweepPoint, source: Failure) -> Failure {
    Failure::Point { point: point.name(), source: Box::new(source) }
}
