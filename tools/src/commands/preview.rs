//! `preview`: a map and a view of a scene.

use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};

use anyhow::Context as _;
use clap::Args;
use sunfleck::components::View;
use sunfleck::preview::{MAP_SIZE, SceneMap, SceneView, ViewSettings, replace_by_boxes};
use sunfleck::run::{LoadedScene, Progress as _};
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

    /// Draw the box around each mesh in place of its leaves, for many or large meshes
    #[arg(long)]
    boxes: bool,

    /// Open the view with the program for pictures of this desktop
    #[arg(long)]
    open: bool,

    /// Longer side of the pictures, pixels
    #[arg(long, value_name = "PX", default_value_t = MAP_SIZE, value_parser = clap::value_parser!(u32).range(200..=8000))]
    size: u32,

    /// Zenith and azimuth of the camera, degrees, such as 60,180 for a look from the south [default: from the side of the sun]
    #[arg(long, value_name = "ZENITH,AZIMUTH", value_parser = view)]
    view: Option<View>,

    /// Samples per pixel of the view
    #[arg(long, value_name = "N", default_value_t = sunfleck::preview::VIEW_SAMPLES, value_parser = clap::value_parser!(u32).range(1..=1024))]
    samples: u32,
}

impl Preview {
    fn folder(&self) -> PathBuf {
        let named = || Path::new("out").join(self.scene.name() + "_preview");
        self.out.clone().unwrap_or_else(named)
    }
}

fn view(text: &str) -> Result<View, String> {
    let wrong = || "write a zenith angle from 0 to 90 and an azimuth, such as 60,180".to_owned();
    let (zenith, azimuth) = text.split_once(',').ok_or_else(wrong)?;
    let number = |text: &str| text.trim().parse::<f64>().ok().filter(|number| number.is_finite());
    match (number(zenith), number(azimuth)) {
        (Some(zenith), Some(azimuth)) if (0.0..=90.0).contains(&zenith) => {
            Ok(View::from_degrees(zenith, azimuth))
        }
        _ => Err(wrong()),
    }
}

pub(super) fn preview(arguments: &Preview) -> anyhow::Result<()> {
    let options = run::Options { document: arguments.scene.options(), ..run::Options::default() };
    let folder = arguments.folder();
    output::probe(&folder)?;
    let bars = Bars::new();
    let drawn = draw(arguments, &options, &folder, &bars);
    bars.clear();
    let (warnings, text) = drawn?;
    warn(&warnings);
    print(&text)?;
    if arguments.open {
        open(&folder.join("view.png"));
    }
    Ok(())
}

/// Draws the pictures; returns warnings, and what was drawn.
fn draw(
    arguments: &Preview,
    options: &run::Options,
    folder: &Path,
    bars: &Bars,
) -> anyhow::Result<(Vec<String>, String)> {
    let mut loaded = LoadedScene::from_file(&arguments.scene.file, options, bars)?;
    let (map, stage) = if arguments.boxes {
        // The map has the colours of all materials of a mesh.
        let map = draw_map(&loaded, arguments.size, folder);
        replace_by_boxes(&mut loaded);
        (map, loaded.isolated_stage(options, bars))
    } else {
        rayon::join(
            || draw_map(&loaded, arguments.size, folder),
            || loaded.isolated_stage(options, bars),
        )
    };
    let (mut lines, stage) = (map?, stage?);
    let settings =
        ViewSettings { width: arguments.size, samples: arguments.samples, towards: arguments.view };
    let view = SceneView::new(&loaded, &stage, settings);
    let file = folder.join("view.png");
    bars.stage("tracing the view");
    view.trace(|png| output::replace(&file, png))?;
    lines.push(file.display().to_string());
    if arguments.boxes {
        lines.push("  boxes around the meshes".to_owned());
    }
    lines.extend(view.contents.iter().map(|line| format!("  {line}")));
    Ok((loaded.warnings(), lines.join("\n") + "\n"))
}

/// Draws the map and writes it; returns what was drawn, a line each.
fn draw_map(loaded: &LoadedScene, size: u32, folder: &Path) -> anyhow::Result<Vec<String>> {
    let map = SceneMap::new(loaded, size);
    let png = map.png().context("there is no memory for the pixels of the map: lower --size")?;
    output::replace(&folder.join("map.svg"), map.svg())?;
    output::replace(&folder.join("map.png"), png)?;
    let written = format!("{}, map.svg", folder.join("map.png").display());
    Ok(std::iter::once(written)
        .chain(map.contents.iter().map(|line| format!("  {line}")))
        .collect())
}

/// Opens a file with the program that the desktop has for it; where that fails, a warning says why.
fn open(file: &Path) {
    let has_display =
        ["DISPLAY", "WAYLAND_DISPLAY"].iter().any(|name| std::env::var_os(name).is_some());
    let needs_display = cfg!(all(unix, not(target_os = "macos")));
    if needs_display && !has_display {
        warn(&[format!(
            "{} is not opened: there is no desktop here (neither DISPLAY nor WAYLAND_DISPLAY is set)",
            file.display()
        )]);
        return;
    }
    let mut command = if cfg!(target_os = "windows") {
        let mut command = Command::new("cmd");
        command.args(["/C", "start", ""]);
        command
    } else {
        Command::new(if cfg!(target_os = "macos") { "open" } else { "xdg-open" })
    };
    let command =
        command.arg(file).stdin(Stdio::null()).stdout(Stdio::null()).stderr(Stdio::null());
    if let Err(error) = command.spawn() {
        warn(&[format!("{} is not opened: {error}", file.display())]);
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn directions_of_views_are_two_angles() {
        assert_eq!(view("60,180"), Ok(View::from_degrees(60.0, 180.0)));
        assert_eq!(view(" 0 , -30.5"), Ok(View::from_degrees(0.0, -30.5)));
        for wrong in ["60", "91,0", "-1,0", "a,b", "60,nan", "60,180,5"] {
            assert!(view(wrong).is_err(), "{wrong}");
        }
    }
}
