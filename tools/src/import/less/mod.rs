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
mod report;
mod sensor;
mod settings;
mod soil;
mod swept;
mod term;
mod terrain;
mod text;

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, bail};

use project::{Project, SCENE};

/// Imports the project in `folder` into `out` and returns a report for a terminal.
pub(crate) fn import(folder: &Path, out: &Path) -> Result<String> {
    let file = folder.join("Parameters/input.conf");
    if !file.is_file() {
        bail!("{} is no LESS project: there is no {}", folder.display(), file.display());
    }
    if out.join(SCENE).exists() {
        bail!("{} is there already: name another folder with `--out`", out.join(SCENE).display());
    }
    if out.read_dir().is_ok_and(|mut entries| entries.next().is_some()) {
        bail!("{} is not empty: name another folder with `--out`", out.display());
    }
    // Made beside it and renamed, so that an import that fails leaves nothing behind.
    let draft = Draft::create(out)?;
    let printed = match Project::read(folder, &draft.folder) {
        Ok(mut project) => project.import(folder, out),
        Err(error) => Err(error),
    };
    let printed = printed.map_err(|error| draft.without_its_name(&error, out))?;
    draft.publish(out)?;
    Ok(printed)
}

/// A folder for an import that is not complete. It is removed unless it is published.
#[derive(Debug)]
struct Draft {
    folder: PathBuf,
}

impl Draft {
    fn create(out: &Path) -> Result<Self> {
        let mut name = OsString::from(".");
        name.push(out.file_name().unwrap_or_else(|| "imported".as_ref()));
        name.push(format!(".{}.partial", std::process::id()));
        let folder = out.parent().unwrap_or(Path::new("")).join(name);
        let assets = folder.join("assets");
        fs::create_dir_all(&assets).with_context(|| format!("cannot make {}", out.display()))?;
        Ok(Self { folder })
    }

    /// Gives the folder its name. An empty folder of that name is replaced.
    fn publish(&self, out: &Path) -> Result<()> {
        if out.is_dir() {
            // On Windows a folder cannot be renamed to one that is there.
            fs::remove_dir(out).with_context(|| format!("cannot replace {}", out.display()))?;
        }
        fs::rename(&self.folder, out).with_context(|| format!("cannot make {}", out.display()))
    }

    /// The text of an error, with the name that the folder would have had.
    fn without_its_name(&self, error: &anyhow::Error, out: &Path) -> anyhow::Error {
        let text = match error.downcast_ref::<optics::Located>() {
            Some(located) => located.to_string(),
            None => crate::commands::message(error),
        };
        let (draft, out) = (self.folder.display().to_string(), out.display().to_string());
        let text = text.replace(&draft, &out);
        anyhow::Error::msg(text.strip_prefix("error: ").unwrap_or(&text).to_owned())
    }
}

impl Drop for Draft {
    fn drop(&mut self) {
        // Best effort: there is nothing there once it is published.
        drop(fs::remove_dir_all(&self.folder));
    }
}
