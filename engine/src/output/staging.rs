//! Files that appear all at once: written under temporary names, then renamed.

use std::fs::{self, File};
use std::io::{self, BufWriter, Write as _};
use std::path::{Path, PathBuf};

use super::OutputError;

/// Files on their way into one folder. Dropped before [`Staging::commit`] has ended, it removes
/// them all, and the folders that it made.
#[derive(Debug)]
pub(super) struct Staging {
    folder: PathBuf,
    /// Folders that did not exist before, outermost first.
    made: Vec<PathBuf>,
    pending: Vec<Pending>,
    committed: bool,
}

#[derive(Debug)]
struct Pending {
    temporary: PathBuf,
    target: PathBuf,
}

impl Staging {
    pub(super) fn open(folder: &Path) -> Result<Self, OutputError> {
        if folder.is_file() {
            return Err(OutputError::NotAFolder { path: folder.to_owned() });
        }
        let mut made: Vec<_> = folder
            .ancestors()
            .take_while(|path| !path.as_os_str().is_empty() && !path.exists())
            .map(Path::to_owned)
            .collect();
        made.reverse();
        // From here on, dropping it clears away what exists of `made`.
        let staging =
            Self { folder: folder.to_owned(), made, pending: Vec::new(), committed: false };
        fs::create_dir_all(folder)
            .map_err(|source| OutputError::Folder { path: folder.to_owned(), source })?;
        Ok(staging)
    }

    /// Fills a file that will be called `name`; returns its size in bytes.
    pub(super) fn file(
        &mut self,
        name: &str,
        fill: impl FnOnce(&mut BufWriter<File>) -> io::Result<()>,
    ) -> Result<u64, OutputError> {
        let target = self.folder.join(name);
        if target.is_dir() {
            return Err(OutputError::Taken { path: target });
        }
        let temporary = self.folder.join(format!(".{name}.{}.partial", std::process::id()));
        self.pending.push(Pending { temporary: temporary.clone(), target: target.clone() });
        let write = || {
            let mut writer = BufWriter::new(File::create(&temporary)?);
            fill(&mut writer)?;
            writer.flush()?;
            // Some file systems report a full disk only here.
            writer.get_ref().sync_all()?;
            Ok(writer.get_ref().metadata()?.len())
        };
        write().map_err(|source: io::Error| OutputError::Write { path: target, source })
    }

    /// Gives all files their names; returns the paths in the order of writing.
    pub(super) fn commit(mut self) -> Result<Vec<PathBuf>, OutputError> {
        let mut written: Vec<PathBuf> = Vec::with_capacity(self.pending.len());
        for Pending { temporary, target } in &self.pending {
            if let Err(source) = fs::rename(temporary, target) {
                // A part of a report beside the rest of an older one would pass for one run.
                for path in &written {
                    drop(fs::remove_file(path));
                }
                return Err(OutputError::Write { path: target.clone(), source });
            }
            written.push(target.clone());
        }
        self.committed = true;
        Ok(written)
    }
}

impl Drop for Staging {
    fn drop(&mut self) {
        if self.committed {
            return;
        }
        // Whatever fails here stands in the way of nothing, and the first error is on its way up.
        for Pending { temporary, .. } in &self.pending {
            drop(fs::remove_file(temporary));
        }
        for folder in self.made.iter().rev() {
            drop(fs::remove_dir(folder));
        }
    }
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
mod tests {
    use super::*;

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
        assert_eq!(fs::read_dir(&folder).unwrap().count(), 2, "both still under temporary names");
        drop(staging);
        assert_eq!(fs::read_dir(root.path()).unwrap().count(), 0, "files and new folders are gone");
    }

    #[test]
    fn a_name_that_cannot_be_given_takes_back_the_others() {
        let root = tempfile::tempdir().unwrap();
        let mut staging = Staging::open(root.path()).unwrap();
        staging.file("first.csv", |file| file.write_all(b"1")).unwrap();
        staging.file("second.csv", |file| file.write_all(b"2")).unwrap();
        fs::create_dir(root.path().join("second.csv")).unwrap();
        assert!(matches!(staging.commit(), Err(OutputError::Write { .. })));
        let left: Vec<_> =
            fs::read_dir(root.path()).unwrap().map(|entry| entry.unwrap().file_name()).collect();
        assert_eq!(left, ["second.csv"], "only the folder in the way");
    }

    #[test]
    fn nothing_has_its_name_before_everything_is_complete() {
        let root = tempfile::tempdir().unwrap();
        let mut staging = Staging::open(root.path()).unwrap();
        staging.file("a.csv", |file| file.write_all(b"a")).unwrap();
        assert!(!root.path().join("a.csv").exists());
        assert_eq!(staging.commit().unwrap(), [root.path().join("a.csv")]);
        assert_eq!(fs::read(root.path().join("a.csv")).unwrap(), b"a");
        assert_eq!(fs::read_dir(root.path()).unwrap().count(), 1);
    }
}
