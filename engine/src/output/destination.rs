//! Folder that results are written to, and the place beside or within it where they are made.

use std::ffi::OsString;
use std::path::{Path, PathBuf};
use std::{env, fs, io};

use super::OutputError;
use super::partial::{Partial, stale};
use super::swap::recover;

/// Folder of results, and the place where it is made.
#[derive(Debug)]
pub(super) struct Destination {
    /// Path as the caller wrote it.
    pub(super) folder: PathBuf,
    /// Absolute, links followed.
    pub(super) target: PathBuf,
    /// Folder that the unfinished one is made in, and the name that it is made for.
    around: PathBuf,
    name: OsString,
    /// True if the folder may be exchanged for another one.
    pub(super) may_rename: bool,
    /// Folders around it that did not exist before, outermost first.
    made: Vec<PathBuf>,
}

/// Name within a folder that cannot be replaced as a whole.
pub(super) const INSIDE: &str = "sunfleck";

impl Destination {
    pub(super) fn new(folder: &Path) -> Result<Self, OutputError> {
        if folder.is_file() {
            return Err(OutputError::NotAFolder { path: folder.to_owned() });
        }
        let fail = |source| OutputError::Folder { path: folder.to_owned(), source };
        let absolute = std::path::absolute(folder).map_err(fail)?;
        let target = match absolute.canonicalize() {
            Ok(target) => target,
            Err(_not_there) => absolute,
        };
        let mut place = Self {
            folder: folder.to_owned(),
            around: target.parent().unwrap_or(&target).to_owned(),
            name: target.file_name().unwrap_or_default().to_owned(),
            may_rename: true,
            made: Vec::new(),
            target,
        };
        place.made = place
            .around
            .ancestors()
            .take_while(|path| !path.exists())
            .map(Path::to_owned)
            .collect();
        place.made.reverse();
        if let Err(source) = fs::create_dir_all(&place.around) {
            place.unmake();
            return Err(fail(source));
        }
        // Links in what was not there a moment ago are followed now.
        if !place.target.exists()
            && let Ok(around) = place.around.canonicalize()
        {
            place.target = around.join(&place.name);
            place.around = around;
        }
        let is_here = env::current_dir().is_ok_and(|here| here.starts_with(&place.target));
        if is_here || place.name.is_empty() {
            place.stay();
        }
        Ok(place)
    }

    /// Makes the new files within the folder, which is not renamed.
    fn stay(&mut self) {
        self.may_rename = false;
        self.around.clone_from(&self.target);
        self.name = INSIDE.into();
    }

    pub(super) fn unmake(&self) {
        for folder in self.made.iter().rev() {
            drop(fs::remove_dir(folder));
        }
    }

    /// Ends what killed runs have begun here.
    pub(super) fn recover(&self) {
        for stale in stale(&self.around, &self.name) {
            recover(stale, &self.target);
        }
        for stale in stale(&self.target, INSIDE.as_ref()) {
            recover(stale, &self.target);
        }
    }

    pub(super) fn partial(&mut self) -> io::Result<Partial> {
        match Partial::new(&self.around, &self.name, &self.made) {
            Err(_not_allowed) if self.may_rename && self.target.is_dir() => {
                self.stay();
                Partial::new(&self.around, &self.name, &self.made)
            }
            partial => partial,
        }
    }
}
