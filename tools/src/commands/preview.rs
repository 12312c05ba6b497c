//! `preview`: a map of a scene.

use std::path::{Path, PathBuf};

use anyhow::Context as _;
use clap::Args;
use sunfleck::preview::{MAP_SIZE, SceneMap};
use sunfleck::run::LoadedScene;
use sunfleck::{output, run};

use super::{print, warn};
use crate::arguments::Scene;
use crate::progress::Bars;

#[derive(Args, Debug)]
pub(crate) struct Preview {
    #[command(flatten)]
    scene: Scene,

    /// Folder for the pictures [default: out/<name of the scene file>_preview, with what is set in it]
    #[arg(long, value_name = "DIR")]
    out: Option<PathBuf>,

    /// Longer side of the pictures, pixels
    #[arg(long, value_name = "PX", default_value_t = MAP_SIZE, value_parser = clap::value_parser!(u32).range(200..=8000))]
    size: u32,
}

impl Preview {
    fn folder(&self) -> PathBuf {
        let named = || Path::new("out").join(self.scene.name() + "_preview");
        self.out.clone().unwrap_or_else(named)
    }
}

pub(super) fn preview(arguments: &Preview) -> anyhow::Result<()> {
    let options = run::Options { document: arguments.scene.options(), ..run::Options::default() };
    let folder = arguments.folder();
    output::probe(&folder)?;
    let bars = Bars::new();
    let loaded = LoadedScene::from_file(&arguments.scene.file, &options, &bars);
    bars.clear();
    let loaded = loaded?;
    warn(&loaded.warnings());
    let map = SceneMap::new(&loaded, arguments.size);
    let svg = folder.join("map.svg");
    output::replace(&svg, map.svg())?;
    let png = folder.join("map.png");
    output::replace(
        &png,
        map.png().context("there is no memory for the pixels of the map: lower --size")?,
    )?;
    let contents: String =
        map.contents.iter().flat_map(|line| ["  ", line.as_str(), "\n"]).collect();
    print(&format!("{contents}{}\n{}\n", svg.display(), png.display()))
}
