//! Unfinished folders and files: each has a temporary name and a lock file that is locked while its writer runs.
//!
//! For results `plot`, the folder around them holds `.plot.<process>-<n>.partial` and
//! `.plot.<process>-<n>.lock` while they are written. The lock file is made first and removed last, so
//! that whatever a killed run has left behind is found by its lock file, which nobody locks any more.

use std::collections::BTreeMap;
use std::ffi::{OsStr, OsString};
use std::fs::{self, File, TryLockError};
use std::io::{self, Read as _, Seek as _, Write as _};
use std::path::{Path, PathBuf};
use std::sync::atomic::{AtomicU64, Ordering};
use std::sync::{Mutex, MutexGuard, PoisonError};
use std::thread;
use std::time::Duration;

/// Everything that this process is writing, by the number in its name.
static LIVING: Mutex<BTreeMap<u64, Living>> = Mutex::new(BTreeMap::new());

/// Number of the next name.
static NEXT: AtomicU64 = AtomicU64::new(0);

/// Names that are tried before writing fails.
const ATTEMPTS: u32 = 1000;

#[derive(Debug)]
struct Living {
    partial: PathBuf,
    lock: PathBuf,
    /// Folders that were made around it, outermost first.
    made: Vec<PathBuf>,
}

/// Name of something that is being written, and its lock. Dropped, it removes both, and the folders
/// that were made around it if they are empty.
#[derive(Debug)]
pub(super) struct Partial {
    /// The unfinished file or folder.
    pub(super) path: PathBuf,
    /// Second name, for what the finished one takes the place of.
    pub(super) old: PathBuf,
    number: u64,
    /// Locked as long as this process lives.
    file: File,
}

/// Unfinished folder and lock file of a killed run. Dropping it removes those that still exist.
#[derive(Debug)]
pub(super) struct Stale {
    pub(super) path: PathBuf,
    pub(super) old: PathBuf,
    /// The last note of its writer.
    pub(super) note: String,
    lock: PathBuf,
    _file: File,
}

/// Holds up [`clean_up`], and whatever else would begin or end meanwhile.
#[derive(Debug)]
pub(super) struct Uninterrupted(MutexGuard<'static, BTreeMap<u64, Living>>);

impl Partial {
    /// Takes a name in `folder` for what will be called `name`.
    ///
    /// - `made`: folders that were made for it, outermost first
    pub(super) fn new(folder: &Path, name: &OsStr, made: &[PathBuf]) -> io::Result<Self> {
        for _ in 0..ATTEMPTS {
            let number = NEXT.fetch_add(1, Ordering::Relaxed);
            let stem = format!("{}-{number}", std::process::id());
            let [path, old, lock] = ["partial", "old", "lock"]
                .map(|ending| folder.join(sibling(name, &format!("{stem}.{ending}"))));
            let opened = File::options().read(true).write(true).create_new(true).open(&lock);
            let file = match opened {
                Err(error) if error.kind() == io::ErrorKind::AlreadyExists => continue,
                opened => opened?,
            };
            // Another run may have taken it for a dead one's in between.
            if matches!(file.try_lock(), Err(TryLockError::WouldBlock)) || !lock.exists() {
                continue;
            }
            let living = Living { partial: path.clone(), lock, made: made.to_vec() };
            registry().insert(number, living);
            return Ok(Self { path, old, number, file });
        }
        Err(io::Error::new(io::ErrorKind::AlreadyExists, "no free name for an unfinished file"))
    }

    /// Leaves a note for whoever finds this after its run was killed.
    pub(super) fn note(&mut self, text: &str) -> io::Result<()> {
        self.file.rewind()?;
        self.file.set_len(0)?;
        self.file.write_all(text.as_bytes())?;
        self.file.sync_all()
    }

    /// Ends it: what stands under its name is final, and folders around it stay.
    pub(super) fn finish(self, Uninterrupted(mut living): Uninterrupted) {
        if let Some(living) = living.get_mut(&self.number) {
            living.made.clear();
        }
        drop(living);
    }
}

impl Drop for Partial {
    fn drop(&mut self) {
        // Whatever fails here stands in the way of nothing, and the first error is on its way up.
        if let Some(living) = registry().remove(&self.number) {
            living.remove();
        }
    }
}

impl Drop for Stale {
    fn drop(&mut self) {
        drop(remove(&self.path));
        drop(fs::remove_file(&self.lock));
    }
}

impl Living {
    fn remove(&self) {
        // A thread may still be making files in it.
        for _ in 0..ATTEMPTS {
            if remove(&self.partial).is_ok() {
                break;
            }
            thread::sleep(Duration::from_millis(1));
        }
        drop(fs::remove_file(&self.lock));
        for folder in self.made.iter().rev() {
            drop(fs::remove_dir(folder));
        }
    }
}

impl Uninterrupted {
    pub(super) fn start() -> Self {
        Self(registry())
    }
}

/// Removes everything unfinished that this process is writing, and lets it finish nothing more. It is
/// for the end of the process: a thread that writes waits for ever afterwards.
pub fn clean_up() {
    let living = registry();
    living.values().for_each(Living::remove);
    std::mem::forget(living);
}

/// Unfinished folders in `folder` that killed runs made for `name`.
pub(super) fn stale(folder: &Path, name: &OsStr) -> Vec<Stale> {
    let Ok(entries) = fs::read_dir(folder) else { return Vec::new() };
    let start = sibling(name, "");
    let found = entries.filter_map(|entry| {
        let lock = entry.ok()?.path();
        let file_name = lock.file_name()?.to_str()?;
        let stem = file_name.strip_prefix(start.to_str()?)?.strip_suffix(".lock")?;
        let (process, number) = stem.split_once('-')?;
        (process.parse::<u32>().is_ok() && number.parse::<u64>().is_ok()).then_some(())?;
        let mut file = File::options().read(true).write(true).open(&lock).ok()?;
        // Where files cannot be locked, nobody knows who is alive.
        file.try_lock().ok()?;
        let mut note = String::new();
        drop((&mut file).take(1000).read_to_string(&mut note));
        let [path, old] = ["partial", "old"]
            .map(|ending| folder.join(sibling(name, &format!("{stem}.{ending}"))));
        Some(Stale { path, old, note, lock, _file: file })
    });
    found.collect()
}

/// Removes a file or a folder, which need not be there.
pub(super) fn remove(path: &Path) -> io::Result<()> {
    let removed = match fs::symlink_metadata(path) {
        Ok(metadata) if metadata.is_dir() => fs::remove_dir_all(path),
        Ok(_) => fs::remove_file(path),
        Err(error) => Err(error),
    };
    match removed {
        Err(error) if error.kind() == io::ErrorKind::NotFound => Ok(()),
        removed => removed,
    }
}

/// Hidden name beside `name`.
fn sibling(name: &OsStr, ending: &str) -> OsString {
    // File systems allow 255 bytes in all.
    const LONGEST: usize = 180;
    let name = name.to_string_lossy();
    let end = name.floor_char_boundary(LONGEST);
    format!(".{}.{ending}", &name[..end]).into()
}

fn registry() -> MutexGuard<'static, BTreeMap<u64, Living>> {
    LIVING.lock().unwrap_or_else(PoisonError::into_inner)
}

/// Tries whether [`replace_file`] could write a file, and leaves everything as it was.
pub(crate) fn try_file(path: &Path) -> io::Result<()> {
    let (path, folder) = place_of(path)?;
    let partial = Partial::new(&folder, path.file_name().unwrap_or_default(), &[])?;
    File::create(&partial.path).map(drop)
}

/// The file that a link leads to, and its folder.
fn place_of(path: &Path) -> io::Result<(PathBuf, PathBuf)> {
    let path = path.canonicalize().unwrap_or_else(|_not_there| path.to_owned());
    if fs::metadata(&path).is_ok_and(|metadata| !metadata.is_file()) {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "it is no regular file"));
    }
    if path.file_name().is_none() {
        return Err(io::Error::new(io::ErrorKind::InvalidInput, "this path names no file"));
    }
    let folder = path.parent().filter(|folder| !folder.as_os_str().is_empty());
    let folder = folder.unwrap_or(Path::new(".")).to_owned();
    if !folder.is_dir() {
        let what = format!("there is no folder {}", folder.display());
        return Err(io::Error::new(io::ErrorKind::NotFound, what));
    }
    Ok((path, folder))
}

/// A file that appears when it is complete.
///
/// - `fill`: writes its content
pub(crate) fn replace_file<T>(
    path: &Path,
    fill: impl FnOnce(&mut File) -> io::Result<T>,
) -> io::Result<T> {
    let (path, folder) = place_of(path)?;
    let name = path.file_name().unwrap_or_default();
    stale(&folder, name).into_iter().for_each(drop);
    let partial = Partial::new(&folder, name, &[])?;
    let mut file = File::create(&partial.path)?;
    let filled = fill(&mut file)?;
    // Some file systems report a full disk only here.
    file.sync_all()?;
    drop(file);
    let uninterrupted = Uninterrupted::start();
    fs::rename(&partial.path, &path)?;
    partial.finish(uninterrupted);
    // The new name is on the disk when the folder is; where folders cannot be opened, the system
    // takes care of that.
    if let Ok(folder) = File::open(folder) {
        folder.sync_all().or_else(|error| match error.kind() {
            io::ErrorKind::InvalidInput | io::ErrorKind::Unsupported => Ok(()),
            _ => Err(error),
        })?;
    }
    Ok(filled)
}
