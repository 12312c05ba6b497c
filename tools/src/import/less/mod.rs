//! A project folder of LESS 1.8.8 to a scene.
//!
//! Files are read as their formats are documented; LESS counts x to the east and y to the south from
//! the north-west corner, its models have x to the west, y up and z to the north. Settings that are
//! absent, empty or unknown get LESS's defaults, and the report says so.

mod batch;
mod camera;
mod components;
mod conf;
mod files;
mod instances;
mod light;
mod objects;
mod optics;
mod photons;
mod project;
mod sensor;
mod settings;
mod soil;
mod swept;
mod term;
mod terrain;

use std::path::Path;

use anyhow::{Result, bail};

use super::draft::Draft;
use super::{report, text};
use project::Project;

/// Imports the project in `folder` into `out` and returns a report for a terminal.
pub(super) fn import(folder: &Path, out: &Path) -> Result<String> {
    let file = folder.join("Parameters/input.conf");
    if !file.is_file() {
        bail!("{} is no LESS project: there is no {}", folder.display(), file.display());
    }
    // Made beside it and renamed, so that an import that fails leaves nothing behind.
    let draft = Draft::create_for(out)?;
    let printed = match Project::read(folder, draft.folder()) {
        Ok(mut project) => project.import(folder, out),
        Err(error) => Err(error),
    };
    let printed = printed.map_err(|error| match error.downcast_ref::<optics::Located>() {
        Some(located) => draft.without_its_name(&anyhow::Error::msg(located.to_string()), out),
        None => draft.without_its_name(&error, out),
    })?;
    draft.publish(out)?;
    Ok(printed)
}
