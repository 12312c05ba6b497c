//! Arguments that several commands share: scene, output folder, options of a run.

use std::collections::BTreeMap;
use std::num::NonZeroUsize;
use std::path::{Path, PathBuf};

use clap::Args;
use sunfleck::document::{self, FileFormat, System};
use sunfleck::output::{OutputError, Results, folder_name};
use sunfleck::run;

use crate::console::Console;

use super::values::{SystemName, default_systems, file_format, memory, quality, setting, system};

#[derive(Args, Debug)]
pub(crate) struct Scene {
    /// Scene file
    #[arg(value_name = "SCENE")]
    pub(crate) file: PathBuf,

    /// Set a parameter of the scene to a number or a text; may be repeated
    #[arg(long = "set", value_name = "NAME=VALUE", value_parser = setting)]
    pub(crate) settings: Vec<(String, document::Param)>,

    /// Apply this variant of the scene
    #[arg(long, value_name = "NAME")]
    pub(crate) variant: Option<String>,
}

impl Scene {
    /// Options for reading the scene.
    pub(crate) fn options(&self) -> document::ReadOptions {
        document::ReadOptions {
            set: self.settings.clone(),
            variant: self.variant.clone(),
            ..document::ReadOptions::default()
        }
    }

    /// Name of the scene and of what is changed in it: `birch_winter_sza=60`.
    pub(crate) fn name(&self) -> String {
        let stem = self.file.file_stem().unwrap_or_default().to_string_lossy().into_owned();
        changed_name(stem, self.variant.as_deref(), &self.settings)
    }
}

/// Name of a folder for results of something that is changed.
pub(super) fn changed_name(
    stem: String,
    variant: Option<&str>,
    settings: &[(String, document::Param)],
) -> String {
    // Only the last value of a parameter counts.
    let settings: BTreeMap<&str, &document::Param> =
        settings.iter().map(|(name, value)| (name.as_str(), value)).collect();
    let settings = settings.iter().map(|(param, value)| format!("{param}={value}"));
    let parts = [stem].into_iter().chain(variant.map(str::to_owned)).chain(settings);
    let name = parts.collect::<Vec<_>>().join("_");
    folder_name(&name, &name)
}

/// Folder of the results.
#[derive(Args, Debug)]
pub(crate) struct Out {
    /// Folder for the results; others of the same scene there are replaced, and files that are no
    /// results are kept [default: out/<name of the scene file>, with `_<variant>`, `_<name>=<value>` of each
    /// --set, and for other commands than run `_<command>`]
    #[arg(long = "out", value_name = "DIR")]
    folder: Option<PathBuf>,

    /// Replace results of another scene
    #[arg(long)]
    pub(crate) force: bool,
}

impl Out {
    /// Folder for the results of a command whose default folders end in `ending`.
    pub(crate) fn folder(&self, scene: &Scene, ending: &str) -> PathBuf {
        let named = || Path::new("out").join(scene.name() + ending);
        self.folder.clone().unwrap_or_else(named)
    }
}

/// File formats of images.
#[derive(Args, Debug)]
pub(crate) struct Formats {
    /// File formats of images, in place of `output` of the scene: `Exr`, `Envi`, `GeoTiff`, `Png`, and `Zarr` and
    /// `NetCdf`, which hold tables too
    #[arg(long = "format", value_name = "NAME,..", value_delimiter = ',', value_parser = file_format)]
    formats: Vec<FileFormat>,
}

impl Formats {
    /// The formats that were named, if any.
    pub(crate) fn chosen(&self) -> Option<Vec<FileFormat>> {
        (!self.formats.is_empty()).then(|| self.formats.clone())
    }

    /// Options for reading a scene whose images are written in these formats.
    pub(crate) fn options(&self, scene: &Scene) -> document::ReadOptions {
        let output = self.chosen();
        document::ReadOptions { output, ..scene.options() }
    }
}

#[derive(Args, Debug)]
pub(crate) struct Run {
    #[command(flatten)]
    pub(crate) scene: Scene,

    /// Measure with this sensor alone; may be repeated [default: all]
    #[arg(long = "sensor", value_name = "NAME")]
    pub(crate) sensors: Vec<String>,

    #[command(flatten)]
    pub(crate) out: Out,

    /// Number of threads [default: all]; results do not depend on it
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<NonZeroUsize>,

    /// Factor for the number of samples: 0.05 for a quick look
    #[arg(long, value_name = "F", default_value_t = 1.0, value_parser = quality)]
    pub(crate) quality: f64,

    #[command(flatten)]
    pub(crate) formats: Formats,

    #[command(flatten)]
    pub(crate) console: Console,

    /// Largest memory for films and results, such as 4GiB; larger runs are refused [default: free memory]
    #[arg(long, value_name = "SIZE", value_parser = memory)]
    pub(crate) memory: Option<u64>,
}

impl Run {
    /// Folder for the results of a command whose default folders end in `ending`.
    pub(crate) fn folder(&self, ending: &str) -> PathBuf {
        self.out.folder(&self.scene, ending)
    }
}

/// A scene, its sensors and transport systems.
#[derive(Args, Debug)]
pub(crate) struct Measured {
    #[command(flatten)]
    pub(crate) scene: Scene,

    /// Transport systems to run
    #[arg(long, value_name = "NAME,..", value_delimiter = ',', default_values_t = default_systems(), value_parser = system)]
    pub(super) systems: Vec<SystemName>,

    /// Run only this sensor; may be repeated [default: all]
    #[arg(long = "sensor", value_name = "NAME")]
    pub(crate) sensors: Vec<String>,

    /// Factor for the number of samples: 0.05 for a quick look
    #[arg(long, value_name = "F", default_value_t = 1.0, value_parser = quality)]
    pub(crate) quality: f64,

    /// Number of threads [default: all]; results do not depend on it
    #[arg(long, value_name = "N")]
    pub(crate) threads: Option<NonZeroUsize>,

    #[command(flatten)]
    out: Out,
}

impl Measured {
    /// Place for the results of a command.
    pub(crate) fn results(&self, command: &'static str) -> Result<Results, OutputError> {
        let folder = self.out.folder(&self.scene, &format!("_{command}"));
        Results::open(&folder, command, &self.scene.file, self.out.force)
    }

    /// Options of the run.
    pub(crate) fn options(&self) -> run::Options {
        run::Options {
            document: self.scene.options(),
            threads: self.threads.map(Into::into),
            quality: self.quality,
            ..run::Options::default()
        }
    }

    /// Each system once, in the order in which they were named.
    pub(crate) fn systems(&self) -> Vec<System> {
        let mut systems = Vec::new();
        for SystemName(system) in &self.systems {
            if !systems.contains(system) {
                systems.push(*system);
            }
        }
        systems
    }
}
