//! A folder of files that appears all at once.

use std::fs::{self, File};
use std::io::{self, BufWriter};
use std::path::{Path, PathBuf};

use super::OutputError;
use super::destination::{Destination, INSIDE};
use super::manifest::Manifest;
use super::partial::{Partial, Uninterrupted};
use super::staged_file::StagedFile;
use super::swap::{self, Exchange, Others, exchange};

/// Files that are being written for one folder. If it is dropped before [`Staging::commit`] has ended, it removes
/// all of them and the folders that it made.
#[derive(Debug)]
pub(super) struct Staging {
    destination: Destination,
    partial: Partial,
    names: Vec<String>,
}

impl Staging {
    pub(super) fn open(folder: &Path) -> Result<Self, OutputError> {
        let mut destination = Destination::new(folder)?;
        destination.recover();
        let is_new = !destination.target.exists();
        let fail = |source| {
            let path = folder.to_owned();
            if is_new {
                OutputError::Folder { path, source }
            } else {
                OutputError::Write { path, source }
            }
        };
        let partial = destination.partial().inspect_err(|_| destination.unmake()).map_err(fail)?;
        // From here on, dropping it clears away what was made.
        let staging = Self { destination, partial, names: Vec::new() };
        fs::create_dir(&staging.partial.path).map_err(fail)?;
        if !is_new {
            staging.try_target().map_err(fail)?;
        }
        Ok(staging)
    }

    /// Absolute path of the folder.
    pub(super) fn target(&self) -> &Path {
        &self.destination.target
    }

    /// Tries whether files may be made in a folder: its owner may have locked it.
    fn try_target(&self) -> io::Result<()> {
        drop(Partial::new(&self.destination.target, INSIDE.as_ref(), &[])?);
        Ok(())
    }

    /// Names of the files so far.
    pub(super) fn names(&self) -> &[String] {
        &self.names
    }

    /// Fills a file that will be called `name`; returns its size in bytes.
    pub(super) fn file(
        &mut self,
        name: &str,
        fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
    ) -> Result<u64, OutputError> {
        let mut file = self.begin(name)?;
        file.write(fill)?;
        file.finish()
    }

    /// Begins a file that will be called `name`.
    pub(super) fn begin(&mut self, name: &str) -> Result<StagedFile, OutputError> {
        let shown = self.destination.folder.join(name);
        if self.destination.target.join(name).is_dir() && !self.is_result(name) {
            return Err(OutputError::Taken { path: shown });
        }
        self.names.push(name.to_owned());
        let path = self.partial.path.join(name);
        match File::options().read(true).write(true).create(true).truncate(true).open(&path) {
            Ok(file) => Ok(StagedFile { writer: BufWriter::new(file), shown }),
            Err(source) => Err(OutputError::Write { path: shown, source }),
        }
    }

    /// Makes a folder that will be called `name` and is one result; returns its path for now.
    pub(super) fn folder(&mut self, name: &str) -> Result<PathBuf, OutputError> {
        let shown = self.destination.folder.join(name);
        let path = self.partial.path.join(name);
        fs::create_dir(&path).map_err(|source| OutputError::Write { path: shown, source })?;
        self.names.push(name.to_owned());
        Ok(path)
    }

    /// Path that a result will have.
    pub(super) fn shown(&self, name: &str) -> PathBuf {
        self.destination.folder.join(name)
    }

    /// Begins a temporary file, which has no name and is no result.
    pub(super) fn begin_unnamed(&self) -> Result<StagedFile, OutputError> {
        let shown = self.destination.folder.clone();
        match self.scratch() {
            Ok(file) => Ok(StagedFile { writer: BufWriter::new(file), shown }),
            Err(source) => Err(OutputError::Write { path: shown, source }),
        }
    }

    /// A new temporary file without a name, where the results will be.
    pub(super) fn scratch(&self) -> io::Result<File> {
        tempfile::tempfile_in(&self.partial.path)
    }

    /// Puts all files in place of the results in the folder; returns their paths in the order of
    /// writing. What in the folder is no result stays.
    ///
    /// - `over_others`: whether files of the same names that are no results may be replaced
    pub(super) fn commit(self, over_others: bool) -> Result<Vec<PathBuf>, OutputError> {
        self.commit_by(over_others, exchange)
    }

    fn commit_by(
        mut self,
        over_others: bool,
        exchange: Exchange,
    ) -> Result<Vec<PathBuf>, OutputError> {
        let Destination { folder, target, may_rename, .. } = &self.destination;
        let fail = |source| OutputError::Write { path: folder.clone(), source };
        let uninterrupted = Uninterrupted::start();
        for name in Others::read(target).map_err(fail)?.names {
            let (path, found) = (folder.join(&name), target.join(&name));
            if self.names.iter().all(|new| name != **new) {
                continue;
            }
            if found.is_dir() {
                return Err(OutputError::Taken { path });
            }
            if !over_others {
                return Err(OutputError::Foreign { path });
            }
            fs::remove_file(found).map_err(fail)?;
        }
        swap::put(&mut self.partial, target, *may_rename, exchange).map_err(fail)?;
        let written = self.names.iter().map(|name| folder.join(name)).collect();
        self.partial.finish(uninterrupted);
        Ok(written)
    }

    /// Returns true if what has this name in the folder is one of its results.
    fn is_result(&self, name: &str) -> bool {
        self.manifest().is_some_and(|manifest| manifest.files().contains(name))
    }

    /// The results that are in the folder.
    pub(super) fn manifest(&self) -> Option<Manifest> {
        Manifest::read(&self.destination.target)
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
mod tests {
    use std::io::Write as _;

    use super::super::manifest::SUMMARY;
    use super::*;

    fn names(folder: &Path) -> Vec<String> {
        let mut names: Vec<_> = fs::read_dir(folder)
            .unwrap()
            .map(|entry| entry.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    fn cannot(_: &Path, _: &Path) -> io::Result<()> {
        Err(io::ErrorKind::Unsupported.into())
    }

    /// A complete set of files that say which they are.
    fn staged(folder: &Path, files: &[&str], text: &str) -> Staging {
        let mut staging = Staging::open(folder).unwrap();
        for name in files {
            staging.file(name, |file| file.write_all(text.as_bytes())).unwrap();
        }
        let summary = serde_json::json!({ "scene": text, "files": files });
        staging
            .file(SUMMARY, |file| serde_json::to_writer(file, &summary).map_err(Into::into))
            .unwrap();
        staging
    }

    fn assert_holds(folder: &Path, files: &[&str], text: &str) {
        let mut expected = [files, &[SUMMARY]].concat();
        expected.sort_unstable();
        assert_eq!(names(folder), expected, "{text}");
        for name in files.iter().filter(|name| !name.starts_with("notes")) {
            assert_eq!(fs::read_to_string(folder.join(name)).unwrap(), text, "{name}");
        }
    }

    #[test]
    fn a_file_whose_writing_fails_half_way_leaves_nothing() {
        let root = tempfile::tempdir().unwrap();
        let folder = root.path().join("a/b");
        let mut staging = Staging::open(&folder).unwrap();
        staging.file("whole.csv", |file| file.write_all(b"complete")).unwrap();
        let error = staging
            .file("half.csv", |file| {
                file.write_all(b"incompl")?;
                file.flush()?;
                Err(io::Error::from(io::ErrorKind::StorageFull))
            })
            .unwrap_err();
        assert_eq!(
            error.to_string(),
            format!("cannot write {}", folder.join("half.csv").display())
        );
        assert!(!folder.exists(), "nothing has its name yet");
        drop(staging);
        assert_eq!(names(root.path()), [""; 0], "files and new folders are gone");
    }

    #[test]
    fn new_results_take_the_place_of_old_ones_by_every_way() {
        for (exchange, may_rename) in
            [(exchange as Exchange, true), (cannot, true), (exchange, false), (cannot, false)]
        {
            let root = tempfile::tempdir().unwrap();
            let folder = root.path().join("plot");
            staged(&folder, &["a.csv", "gone.csv"], "old").commit(false).unwrap();
            assert_holds(&folder, &["a.csv", "gone.csv"], "old");
            fs::write(folder.join("notes.txt"), "mine").unwrap();
            fs::create_dir(folder.join("notes")).unwrap();
            fs::write(folder.join("notes/deep.txt"), "mine too").unwrap();
            let mut staging = staged(&folder, &["a.csv", "b.csv"], "new");
            if !may_rename {
                staging.destination.may_rename = false;
            }
            let written = staging.commit_by(false, exchange).unwrap();
            assert_eq!(written, ["a.csv", "b.csv", SUMMARY].map(|name| folder.join(name)));
            assert_holds(&folder, &["a.csv", "b.csv", "notes", "notes.txt"], "new");
            assert_eq!(fs::read_to_string(folder.join("notes.txt")).unwrap(), "mine");
            assert_eq!(fs::read_to_string(folder.join("notes/deep.txt")).unwrap(), "mine too");
            assert_eq!(names(root.path()), ["plot"], "nothing is left beside it");
        }
    }

    #[test]
    fn a_file_that_is_no_result_is_not_replaced_without_leave() {
        let root = tempfile::tempdir().unwrap();
        fs::write(root.path().join("a.csv"), "mine").unwrap();
        let error = staged(root.path(), &["a.csv"], "new").commit(false).unwrap_err();
        assert!(
            matches!(error, OutputError::Foreign { path } if path == root.path().join("a.csv"))
        );
        assert_eq!(names(root.path()), ["a.csv"]);
        assert_eq!(fs::read_to_string(root.path().join("a.csv")).unwrap(), "mine");
        staged(root.path(), &["a.csv"], "new").commit(true).unwrap();
        assert_holds(root.path(), &["a.csv"], "new");
        fs::create_dir(root.path().join("d.csv")).unwrap();
        let error = Staging::open(root.path()).unwrap().file("d.csv", |_| Ok(())).unwrap_err();
        assert!(matches!(error, OutputError::Taken { .. }));
    }

    /// What a kill leaves: a lock file that nobody locks, its note, and folders.
    fn killed(root: &Path, note: &str, ending: &str, from: &Path) {
        fs::write(root.join(".plot.4000000-7.lock"), note).unwrap();
        fs::rename(from, root.join(format!(".plot.4000000-7.{ending}"))).unwrap();
    }

    #[test]
    fn the_next_run_ends_what_a_killed_one_began() {
        let start = || {
            let root = tempfile::tempdir().unwrap();
            let folder = root.path().join("plot");
            staged(&folder, &["a.csv", "gone.csv"], "old").commit(false).unwrap();
            let new = root.path().join("new");
            staged(&new, &["a.csv", "b.csv"], "new").commit(false).unwrap();
            (root, folder, new)
        };
        // While files were written.
        let (root, folder, new) = start();
        fs::remove_file(new.join(SUMMARY)).unwrap();
        killed(root.path(), "", "partial", &new);
        drop(Staging::open(&folder).unwrap());
        assert_holds(&folder, &["a.csv", "gone.csv"], "old");
        assert_eq!(names(root.path()), ["plot"]);
        // Just after the exchange; a note was made in the old folder in its last moment.
        let (root, folder, new) = start();
        fs::write(folder.join("notes.txt"), "mine").unwrap();
        killed(root.path(), "exchanging", "partial", &folder);
        fs::rename(&new, &folder).unwrap();
        drop(Staging::open(&folder).unwrap());
        assert_holds(&folder, &["a.csv", "b.csv", "notes.txt"], "new");
        assert_eq!(names(root.path()), ["plot"]);
        // Between two renamings, where there is no exchange.
        let (root, folder, new) = start();
        killed(root.path(), "exchanging", "old", &folder);
        fs::rename(&new, root.path().join(".plot.4000000-7.partial")).unwrap();
        drop(Staging::open(&folder).unwrap());
        assert_holds(&folder, &["a.csv", "gone.csv"], "old");
        assert_eq!(names(root.path()), ["plot"]);
        // After the second.
        let (root, folder, new) = start();
        killed(root.path(), "exchanging", "old", &folder);
        fs::rename(&new, &folder).unwrap();
        drop(Staging::open(&folder).unwrap());
        assert_holds(&folder, &["a.csv", "b.csv"], "new");
        assert_eq!(names(root.path()), ["plot"]);
    }

    #[test]
    fn files_that_were_put_in_place_one_by_one_are_put_there_by_the_next_run() {
        // After each of the steps: the summary is set aside, an old file goes, a new one comes.
        for steps in 0..4 {
            let root = tempfile::tempdir().unwrap();
            let folder = root.path().join("plot");
            staged(&folder, &["a.csv", "gone.csv"], "old").commit(false).unwrap();
            let new = root.path().join("new");
            staged(&new, &["a.csv", "b.csv"], "new").commit(false).unwrap();
            killed(root.path(), "merging", "partial", &new);
            let partial = root.path().join(".plot.4000000-7.partial");
            if steps > 0 {
                fs::rename(folder.join(SUMMARY), partial.join(".old.summary.json")).unwrap();
            }
            if steps > 1 {
                fs::remove_file(folder.join("gone.csv")).unwrap();
            }
            if steps > 2 {
                fs::rename(partial.join("a.csv"), folder.join("a.csv")).unwrap();
            }
            drop(Staging::open(&folder).unwrap());
            assert_holds(&folder, &["a.csv", "b.csv"], "new");
            assert_eq!(names(root.path()), ["plot"]);
        }
    }

    #[test]
    fn what_a_living_run_writes_is_let_be() {
        let root = tempfile::tempdir().unwrap();
        let folder = root.path().join("plot");
        let mut living = Staging::open(&folder).unwrap();
        living.file("a.csv", |file| file.write_all(b"a")).unwrap();
        staged(&folder, &["b.csv"], "b").commit(false).unwrap();
        assert!(living.partial.path.join("a.csv").is_file());
        drop(living);
        assert_holds(&folder, &["b.csv"], "b");
    }

    #[test]
    fn a_link_to_a_folder_stays_one() {
        #[cfg(unix)]
        {
            let root = tempfile::tempdir().unwrap();
            fs::create_dir(root.path().join("far")).unwrap();
            let link = root.path().join("plot");
            std::os::unix::fs::symlink("far", &link).unwrap();
            for text in ["old", "new"] {
                staged(&link, &["a.csv"], text).commit(false).unwrap();
                assert_holds(&root.path().join("far"), &["a.csv"], text);
            }
            assert!(link.is_symlink());
            assert_eq!(names(root.path()), ["far", "plot"]);
        }
    }

    #[test]
    fn exchange_is_what_this_system_can() {
        let root = tempfile::tempdir().unwrap();
        let [a, b] = ["a", "b"].map(|name| root.path().join(name));
        fs::create_dir(&a).unwrap();
        fs::create_dir(&b).unwrap();
        fs::write(a.join("x"), "").unwrap();
        let exchanged = exchange(&a, &b);
        if cfg!(target_os = "linux") {
            exchanged.unwrap();
            assert!(b.join("x").is_file());
        }
    }
}
