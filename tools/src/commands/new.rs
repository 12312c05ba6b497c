//! `new`: a small commented scene to start from.

use std::path::PathBuf;

use anyhow::bail;
use clap::Args;
use sunfleck::output;

use super::{print, quoted};

/// The scene.
const SCENE: &str = include_str!("new.ron");

#[derive(Args, Debug)]
pub(crate) struct New {
    /// Name of the scene: `stand` makes stand.ron
    #[arg(value_name = "NAME")]
    name: PathBuf,
}

pub(super) fn new(New { name }: &New) -> anyhow::Result<()> {
    let Some(stem) = name.file_stem().and_then(|stem| stem.to_str()) else {
        bail!("{} is no name of a scene: write `sunfleck new stand`", name.display());
    };
    let file = if name.extension().is_some_and(|ending| ending == "ron") {
        name.clone()
    } else {
        let mut file = name.clone().into_os_string();
        file.push(".ron");
        file.into()
    };
    // Also a link to nothing is something that its owner may want to keep.
    if file.symlink_metadata().is_ok() {
        bail!("{} exists: choose another name", file.display());
    }
    let title = stem.replace(['\\', '"'], " ");
    output::replace(&file, SCENE.replace("TITLE", &title))?;
    let shown = file.display();
    let argument = quoted(&shown.to_string());
    print(&format!(
        "{shown}: a stand of generated trees, with comments\n\n  sunfleck check {argument}    what it is, and what is wrong with it\n  sunfleck run {argument}      its results\n"
    ))
}
