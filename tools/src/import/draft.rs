//! The folder of an import that is not complete.

use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};

use anyhow::{Context as _, Result, bail};

use super::scene::SCENE;

/// A folder for an import that is not complete. It is removed unless it is published.
#[derive(Debug)]
pub(super) struct Draft {
    folder: PathBuf,
}

impl Draft {
    /// Makes a folder beside `out`, which must not be there or be empty.
    pub(super) fn create_for(out: &Path) -> Result<Self> {
        if out.join(SCENE).exists() {
            bail!(
                "{} is there already: name another folder with `--out`",
                out.join(SCENE).display()
            );
        }
        if out.read_dir().is_ok_and(|mut entries| entries.next().is_some()) {
            bail!("{} is not empty: name another folder with `--out`", out.display());
        }
        let mut name = OsString::from(".");
        name.push(out.file_name().unwrap_or_else(|| "imported".as_ref()));
        name.push(format!(".{}.partial", std::process::id()));
        let folder = out.parent().unwrap_or(Path::new("")).join(name);
        let assets = folder.join("assets");
        fs::create_dir_all(&assets).with_context(|| format!("cannot make {}", out.display()))?;
        Ok(Self { folder })
    }

    /// The folder itself.
    pub(super) fn folder(&self) -> &Path {
        &self.folder
    }

    /// Gives the folder its name. An empty folder of that name is replaced.
    pub(super) fn publish(&self, out: &Path) -> Result<()> {
        if out.is_dir() {
            // On Windows a folder cannot be renamed to one that is there.
            fs::remove_dir(out).with_context(|| format!("cannot replace {}", out.display()))?;
        }
        fs::rename(&self.folder, out).with_context(|| format!("cannot make {}", out.display()))
    }

    /// The text of an error, with the name that the folder would have had.
    pub(super) fn without_its_name(&self, error: &anyhow::Error, out: &Path) -> anyhow::Error {
        let text = crate::commands::message(error);
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
