//! `export`: the geometry of a scene for other programs.

use std::path::PathBuf;

use anyhow::bail;
use clap::{Args, ValueEnum};
use sunfleck::export::{ExportFormat, ExportSettings, export};
use sunfleck::run::{self, LoadedScene};

use super::{print, warn};
use crate::arguments::{Scene, memory};
use crate::progress::Bars;

#[derive(Args, Debug)]
pub(crate) struct Export {
    #[command(flatten)]
    scene: Scene,

    /// File to write
    #[arg(long, value_name = "FILE")]
    out: PathBuf,

    /// Format [default: by the ending of the file]
    #[arg(long, value_name = "NAME")]
    format: Option<FormatName>,

    /// glTF: write a node per instance, for programs without `EXT_mesh_gpu_instancing`
    #[arg(long)]
    flat: bool,

    /// glTF and PLY: number of sides of the polygons that discs become; they have the same area
    #[arg(long, value_name = "N", default_value_t = 8, value_parser = clap::value_parser!(u32).range(3..=64))]
    disc_sides: u32,

    /// LAS and LAZ: number of points per m² of leaf, counted on one side
    #[arg(long, value_name = "N", default_value_t = 100.0, value_parser = density)]
    points_per_m2: f64,

    /// LAS and LAZ: draw points on wood and ground too
    #[arg(long)]
    all_surfaces: bool,

    /// Largest file, such as 4GiB; larger ones are refused
    #[arg(long, value_name = "SIZE", default_value = "4GiB", value_parser = memory)]
    limit: u64,
}

/// File formats by their endings.
#[derive(Clone, Copy, Debug, ValueEnum)]
enum FormatName {
    Gltf,
    Glb,
    Ply,
    Las,
    Laz,
}

impl From<FormatName> for ExportFormat {
    fn from(name: FormatName) -> Self {
        match name {
            FormatName::Gltf => Self::Gltf,
            FormatName::Glb => Self::Glb,
            FormatName::Ply => Self::Ply,
            FormatName::Las => Self::Las,
            FormatName::Laz => Self::Laz,
        }
    }
}

fn density(text: &str) -> Result<f64, String> {
    match text.parse::<f64>() {
        Ok(number) if number.is_finite() && number > 0.0 => Ok(number),
        _ => Err("write a number of points above 0, such as 100".to_owned()),
    }
}

impl Export {
    fn format(&self) -> anyhow::Result<ExportFormat> {
        let ending = self.out.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
        let by_ending = FormatName::from_str(ending, true).ok();
        match self.format.or(by_ending) {
            Some(name) => Ok(name.into()),
            None => bail!(
                "{}: the ending says no format: end the name in .gltf, .glb, .ply, .las or .laz, or add `--format`",
                self.out.display()
            ),
        }
    }
}

pub(super) fn write(arguments: &Export) -> anyhow::Result<()> {
    let format = arguments.format()?;
    if arguments.out.is_dir() {
        bail!("{} is a folder: name a file", arguments.out.display());
    }
    let options = run::Options { document: arguments.scene.options(), ..run::Options::default() };
    let bars = Bars::new();
    let loaded = LoadedScene::from_file(&arguments.scene.file, &options, &bars);
    let exported = loaded.map(|loaded| {
        let settings = ExportSettings {
            format,
            disc_sides: arguments.disc_sides,
            is_flat: arguments.flat,
            points_per_m2: arguments.points_per_m2,
            has_all_surfaces: arguments.all_surfaces,
            limit: arguments.limit,
        };
        (loaded.warnings(), export(&loaded, &arguments.out, &settings, &bars))
    });
    bars.clear();
    let (warnings, exported) = exported?;
    warn(&warnings);
    let exported = exported?;
    let files = exported.files.iter().map(|file| file.display().to_string());
    let lines: Vec<String> = exported.contents.iter().cloned().chain(files).collect();
    print(&(lines.join("\n") + "\n"))
}
