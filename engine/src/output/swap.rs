//! Exchange of old results for new ones: at any moment a folder holds one or the other, never both.
//!
//! The new folder is complete, beside the old one, when one call of the system exchanges them. Where it
//! cannot (some network file systems, Windows), the old one is renamed first. A folder that cannot be
//! renamed at all (a mount point, the working folder of the process, one in a folder that may not be
//! written to) gets the new files one by one; its `summary.json` goes first and comes last.
//! A note in the lock file says how far that was, and the next run ends what a killed one began.
//!
//! Whatever in the old folder is no result is in the new one too, by a second link to the same file.

use std::fs;
use std::io;
use std::path::Path;

use super::manifest::{Manifest, SUMMARY};
use super::partial::{self, Partial, Stale};

/// Notes in a lock file.
const EXCHANGING: &str = "exchanging";
const MERGING: &str = "merging";

/// Name of the old summary while files are put in place one by one.
const OLD_SUMMARY: &str = ".old.summary.json";

/// Files and folders beside the results that are taken along with them, at most; a folder with more
/// stays where it is.
const MOST_OTHERS: usize = 1000;

/// Exchanges two folders, one of which is complete: both names exist all the time.
#[cfg(any(target_os = "linux", target_os = "android", target_vendor = "apple"))]
pub(super) fn exchange(a: &Path, b: &Path) -> io::Result<()> {
    use rustix::fs::{CWD, RenameFlags, renameat_with};
    Ok(renameat_with(CWD, a, CWD, b, RenameFlags::EXCHANGE)?)
}

/// Exchanges two folders, where the system can.
#[cfg(not(any(target_os = "linux", target_os = "android", target_vendor = "apple")))]
pub(super) fn exchange(_: &Path, _: &Path) -> io::Result<()> {
    Err(io::ErrorKind::Unsupported.into())
}

/// A function like [`exchange`].
pub(super) type Exchange = fn(&Path, &Path) -> io::Result<()>;

/// Puts a complete folder in the place of `target`.
///
/// - `may_rename`: whether `target` may be another folder afterwards
pub(super) fn put(
    new: &mut Partial,
    target: &Path,
    may_rename: bool,
    exchange: Exchange,
) -> io::Result<()> {
    if !target.try_exists()? {
        return fs::rename(&new.path, target);
    }
    let others = Others::read(target)?;
    if !may_rename || !others.can_be_carried {
        new.note(MERGING)?;
        return merge(&new.path, target);
    }
    others.carry(target, &new.path)?;
    fs::set_permissions(&new.path, fs::metadata(target)?.permissions())?;
    new.note(EXCHANGING)?;
    if exchange(&new.path, target).is_ok() {
        return discard(&new.path, target);
    }
    if fs::rename(target, &new.old).is_err() {
        // The folder itself cannot move.
        others.take_back(&new.path);
        new.note(MERGING)?;
        return merge(&new.path, target);
    }
    if let Err(error) = fs::rename(&new.path, target) {
        fs::rename(&new.old, target)?;
        return Err(error);
    }
    discard(&new.old, target)
}

/// Ends what a killed run began, and takes away what it left behind.
pub(super) fn recover(stale: Stale, target: &Path) {
    // What cannot be done here is tried again by the next run, or fails when this one writes.
    if stale.old.is_dir() {
        if target.exists() {
            drop(discard(&stale.old, target));
        } else {
            drop(fs::rename(&stale.old, target));
        }
    }
    if stale.path.is_dir() && target.is_dir() {
        match stale.note.as_str() {
            MERGING => drop(merge(&stale.path, target)),
            EXCHANGING => drop(discard(&stale.path, target)),
            _ => {}
        }
    }
    drop(stale);
}

/// Removes a folder of results that others have taken the place of. What is no result and has come
/// into it since goes to `target`.
fn discard(old: &Path, target: &Path) -> io::Result<()> {
    let manifest = Manifest::read(old);
    let results = manifest.as_ref().map(Manifest::files).unwrap_or_default();
    for entry in fs::read_dir(old)? {
        let entry = entry?;
        let (name, path) = (entry.file_name(), entry.path());
        let is_result = name.to_str().is_some_and(|name| results.contains(name));
        let place = target.join(&name);
        if is_result || is_unfinished(&name.to_string_lossy()) {
            // The summary says which the others are.
            if name != SUMMARY {
                partial::remove(&path)?;
            }
        } else if fs::symlink_metadata(&place).is_err() {
            fs::rename(&path, &place)?;
        } else if entry.file_type()?.is_dir() {
            discard(&path, &place)?;
        } else {
            partial::remove(&path)?;
        }
    }
    partial::remove(&old.join(SUMMARY))?;
    fs::remove_dir(old)
}

/// Moves the files of a complete folder into `target` in place of the results there. Called again
/// after it was interrupted, it ends what it began.
fn merge(new: &Path, target: &Path) -> io::Result<()> {
    let (summary, old) = (target.join(SUMMARY), new.join(OLD_SUMMARY));
    if new.join(SUMMARY).is_file() {
        if Manifest::read(target).is_some() && !old.exists() {
            fs::rename(&summary, &old)?;
        }
        let text = fs::read_to_string(&old).unwrap_or_default();
        let manifest = serde_json::from_str::<Manifest>(&text).ok();
        let manifest = manifest.map(|manifest| manifest.with_report(target));
        // Those that are new by now have left the new folder, and are no longer old.
        let new_names: Vec<_> =
            serde_json::from_str::<Manifest>(&fs::read_to_string(new.join(SUMMARY))?)
                .map(|manifest| manifest.files().into_iter().map(str::to_owned).collect())
                .unwrap_or_default();
        for name in manifest.iter().flat_map(Manifest::files) {
            if name != SUMMARY && !new_names.iter().any(|new| new == name) {
                partial::remove(&target.join(name))?;
            }
        }
        for entry in fs::read_dir(new)? {
            let entry = entry?;
            if entry.file_name() != SUMMARY && entry.file_name() != OLD_SUMMARY {
                let place = target.join(entry.file_name());
                // A file replaces a file in one step; a folder has to go first.
                if place.is_dir() || entry.file_type()?.is_dir() {
                    partial::remove(&place)?;
                }
                fs::rename(entry.path(), place)?;
            }
        }
        fs::rename(new.join(SUMMARY), &summary)?;
    }
    partial::remove(&old)?;
    fs::remove_dir(new)
}

/// Name of the lock file of something unfinished.
fn is_lock(name: &str) -> bool {
    name.starts_with('.') && name.strip_suffix(".lock").is_some()
}

/// Name of a file that a version before 0.2 was writing when it was killed.
fn is_unfinished(name: &str) -> bool {
    let stem = name.strip_prefix('.').and_then(|name| name.strip_suffix(".partial"));
    stem.and_then(|stem| stem.rsplit_once('.')).is_some_and(|(_, process)| {
        !process.is_empty() && process.bytes().all(|byte| byte.is_ascii_digit())
    })
}

/// Files of a folder that are no results.
#[derive(Debug)]
pub(super) struct Others {
    /// Names at the top.
    pub(super) names: Vec<std::ffi::OsString>,
    can_be_carried: bool,
}

impl Others {
    /// Lists the files in `folder`, which need not exist.
    pub(super) fn read(folder: &Path) -> io::Result<Self> {
        let mut found = Self { names: Vec::new(), can_be_carried: true };
        if !folder.try_exists()? {
            return Ok(found);
        }
        let manifest = Manifest::read(folder);
        let results = manifest.as_ref().map(Manifest::files).unwrap_or_default();
        for entry in fs::read_dir(folder)? {
            let name = entry?.file_name();
            let text = name.to_string_lossy();
            if !results.contains(text.as_ref()) && !is_unfinished(&text) {
                found.names.push(name);
            }
        }
        let mut left = MOST_OTHERS;
        found.can_be_carried =
            found.names.iter().all(|name| can_link(&folder.join(name), &mut left));
        Ok(found)
    }

    fn carry(&self, from: &Path, to: &Path) -> io::Result<()> {
        self.names.iter().try_for_each(|name| link(&from.join(name), &to.join(name)))
    }

    fn take_back(&self, from: &Path) {
        for name in &self.names {
            drop(partial::remove(&from.join(name)));
        }
    }
}

/// Returns whether [`link`] can give a file or a folder a second name, of no more than `left` entries.
fn can_link(path: &Path, left: &mut usize) -> bool {
    let Ok(metadata) = fs::symlink_metadata(path) else { return false };
    let Some(rest) = left.checked_sub(1) else { return false };
    *left = rest;
    let kind = metadata.file_type();
    // Another run may be writing into a folder within this one.
    if path.file_name().is_some_and(|name| is_lock(&name.to_string_lossy())) {
        return false;
    }
    if !kind.is_dir() {
        return kind.is_file() || cfg!(unix) && kind.is_symlink();
    }
    fs::read_dir(path).is_ok_and(|mut entries| {
        entries.all(|entry| entry.is_ok_and(|entry| can_link(&entry.path(), left)))
    })
}

/// Gives a file, a link or all files of a folder a second name.
fn link(from: &Path, to: &Path) -> io::Result<()> {
    let metadata = fs::symlink_metadata(from)?;
    if metadata.is_dir() {
        fs::create_dir(to)?;
        for entry in fs::read_dir(from)? {
            let entry = entry?;
            link(&entry.path(), &to.join(entry.file_name()))?;
        }
        return fs::set_permissions(to, metadata.permissions());
    }
    #[cfg(unix)]
    if metadata.is_symlink() {
        return std::os::unix::fs::symlink(fs::read_link(from)?, to);
    }
    // Not every file system has links.
    fs::hard_link(from, to).or_else(|_no_links| fs::copy(from, to).map(drop))
}
