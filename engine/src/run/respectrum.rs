//! Results for other spectra, from the coefficients that a run has kept.

use std::path::{Path, PathBuf};

use super::checkpoint::CheckpointStore;
use super::provenance::{FileHashes, scene_hash, without_stop_criteria};
use super::sweep::without_values;
use super::{Failure, Options, Progress, report_of};
use crate::document::{Bands, Diagnostic, Scene, ScenePath};
use crate::extract::Stage;
use crate::products::Report;
use crate::scattering::{PathMisfit, PathSpectra};

/// Ratio of a band to the bands of the run above which a warning is given.
const MUCH_BRIGHTER: f32 = 1.5;

/// Coefficients that a run evaluates.
pub(super) struct KeptCoefficients {
    file: PathBuf,
    spectra: PathSpectra,
}

/// Results of a scene file for the sensors whose coefficients are in `coefficients`, a file that a run of the same scene
/// with other spectra, irradiances or bands has kept ([`Options::keeps_coefficients`]). No ray is traced.
///
/// A sensor of packets in a scene of diffuse surfaces measures, in every cell, a polynomial in the spectra of surfaces and
/// light, whose coefficients do not depend on them. Values and their errors are those of the same paths.
///
/// # Errors
/// All errors of the scene; coefficients of other paths.
pub fn respectrum(
    scene: &Path,
    coefficients: &Path,
    options: &Options,
    progress: &dyn Progress,
) -> Result<Report, Failure> {
    report_of(scene, options, progress, Some(coefficients))
}

impl KeptCoefficients {
    /// Store of a run that evaluates the coefficients in a file, and the scene with the sensors that have some.
    pub(super) fn open(
        file: &Path,
        scene: &Scene,
        folder: &Path,
    ) -> Result<(Self, CheckpointStore, Scene), Failure> {
        let (store, spectra) = CheckpointStore::evaluating(file, paths_hash(scene, folder)?)?;
        let mut chosen = scene.clone();
        chosen.sensors.retain(|name, _| store.sensors().any(|kept| kept == name));
        Ok((Self { file: file.to_owned(), spectra }, store, chosen))
    }

    /// Checks that the paths can measure the spectra of a stage; returns a warning if they measure them badly.
    pub(super) fn check(&self, stage: &Stage) -> Result<Option<String>, Failure> {
        let fail = |what: &str, help: &str| {
            let text = format!("the coefficients in {} {what}", self.file.display());
            Err(Failure::Problems(vec![Diagnostic::error(ScenePath::root(), text).help(help)]))
        };
        match self.spectra.misfit(&stage.models) {
            Some(PathMisfit::OtherSurfaces) => fail(
                "are of other surfaces: a leaf whose sides were alike has two now, or the other way round",
                "run the scene again with `--keep-coefficients`",
            ),
            Some(PathMisfit::NewLight) => fail(
                "are of paths that some surface neither reflected nor transmitted, or some source did not light, \
                 where it does now",
                "run the scene again, with a value that is not zero in all bands, and `--keep-coefficients`",
            ),
            None => {
                let brightest = self.spectra.brightest(&stage.models);
                let much = brightest.filter(|(_, ratio)| *ratio > MUCH_BRIGHTER);
                Ok(much.map(|(_, ratio)| {
                    format!(
                        "some band is {ratio:.1} times as bright on some surface as any band of the run whose coefficients \
                         these are: its error may be larger than its standard error says"
                    )
                }))
            }
        }
    }
}

/// Warning about sensors that have kept no coefficients.
pub(super) fn without_coefficients(report: &Report, store: &CheckpointStore) -> Option<String> {
    let is_missing = |name: &&str| store.collected().all(|kept| kept != *name);
    let names = report.sensors.iter().map(|sensor| &*sensor.name).filter(is_missing);
    let names: Vec<String> = names.map(|name| format!("`{name}`")).collect();
    (!names.is_empty()).then(|| {
        format!(
            "{} kept no coefficients: photons, and directions by packets, have some where all surfaces are diffuse, \
             none is a `ReflectanceMap`, and no light is emitted",
            names.join(", ")
        )
    })
}

/// Hash of all that decides the paths of a scene: not spectra, irradiances, bands of reflected light or stop criteria.
pub(super) fn paths_hash(scene: &Scene, folder: &Path) -> Result<[u8; 32], Failure> {
    let mut paths = without_values(scene);
    without_stop_criteria(&mut paths);
    if paths.bands.iter().all(|band| !band.emits()) {
        paths.bands = Bands::default();
    }
    let files: Vec<_> = paths.files().into_iter().map(|(_, named)| folder.join(named)).collect();
    Ok(*scene_hash(&paths, &files, &FileHashes::default())?.as_bytes())
}
