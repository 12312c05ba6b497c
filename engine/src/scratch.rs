//! Temporary files for numbers that would take too much memory.

use std::fs::File;
use std::io::{Read, Write};
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::{env, io};

/// Folder of temporary files, and the memory above which numbers are kept there.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct ScratchSpace {
    /// Folder that temporary files are made in. They have no names, or lose them at once, so that nothing of them is left
    /// when the process ends, however it does.
    pub folder: PathBuf,
    /// Memory that the sums of all images of a run may take, bytes. Images share it evenly; sums of an image that take
    /// more than its share are kept in a file.
    pub memory: u64,
    /// Size that all temporary files may have, bytes; all that is free on the disk if absent.
    pub disk: Option<u64>,
}

/// Memory that the sums of images may take by default, bytes.
const MEMORY: u64 = 256 << 20;

impl Default for ScratchSpace {
    /// The system's folder for temporary files.
    fn default() -> Self {
        Self { folder: env::temp_dir(), memory: MEMORY, disk: None }
    }
}

impl ScratchSpace {
    /// Space of one of several that share it.
    #[must_use]
    pub fn share(&self, count: usize) -> Self {
        Self { memory: self.memory / count.max(1) as u64, ..self.clone() }
    }

    /// Space in a folder, or in the nearest one around it that exists.
    #[must_use]
    pub fn within(folder: &Path) -> Self {
        let absolute = std::path::absolute(folder).unwrap_or_default();
        let existing = absolute.ancestors().find(|path| path.is_dir());
        let default = Self::default();
        Self { folder: existing.map_or(default.folder, Path::to_owned), ..default }
    }

    /// Size that temporary files may have, bytes; `None` if the system does not say what is free.
    #[must_use]
    pub fn free(&self) -> Option<u64> {
        self.disk.or_else(|| free_on_disk(&self.folder))
    }
}

#[cfg(any(target_os = "linux", target_os = "android", target_vendor = "apple"))]
fn free_on_disk(folder: &Path) -> Option<u64> {
    let disk = rustix::fs::statvfs(folder).ok()?;
    Some(disk.f_bavail.saturating_mul(disk.f_frsize))
}

#[cfg(not(any(target_os = "linux", target_os = "android", target_vendor = "apple")))]
const fn free_on_disk(_: &Path) -> Option<u64> {
    None
}

/// Temporary file that is read and written at places, by several threads at once.
#[derive(Debug)]
pub(crate) struct RandomAccessFile {
    file: File,
    /// Held while the file's cursor is moved, where the system cannot do without.
    #[cfg(not(unix))]
    cursor: std::sync::Mutex<()>,
}

impl From<File> for RandomAccessFile {
    /// A file that need not be temporary.
    fn from(file: File) -> Self {
        Self {
            file,
            #[cfg(not(unix))]
            cursor: std::sync::Mutex::new(()),
        }
    }
}

impl RandomAccessFile {
    /// Empty file in a folder.
    pub(crate) fn new(folder: &Path) -> io::Result<Self> {
        let file = tempfile::tempfile_in(folder).map_err(|error| {
            let what = format!("cannot make a temporary file in {}: {error}", folder.display());
            io::Error::new(error.kind(), what)
        })?;
        Ok(file.into())
    }

    /// Writer from a place on.
    pub(crate) const fn writer(&self, place: u64) -> RandomAccessCursor<'_> {
        RandomAccessCursor { file: self, range: place..u64::MAX }
    }

    /// Reader of a range of places.
    pub(crate) const fn reader(&self, range: Range<u64>) -> RandomAccessCursor<'_> {
        RandomAccessCursor { file: self, range }
    }

    /// Writes all bytes to a place.
    #[cfg(unix)]
    pub(crate) fn write_at(&self, bytes: &[u8], place: u64) -> io::Result<()> {
        std::os::unix::fs::FileExt::write_all_at(&self.file, bytes, place)
    }

    /// Fills `bytes` from a place.
    #[cfg(unix)]
    pub(crate) fn read_at(&self, bytes: &mut [u8], place: u64) -> io::Result<()> {
        std::os::unix::fs::FileExt::read_exact_at(&self.file, bytes, place)
    }

    /// Writes all bytes to a place.
    #[cfg(not(unix))]
    pub(crate) fn write_at(&self, bytes: &[u8], place: u64) -> io::Result<()> {
        use io::Seek as _;
        let _held = self.cursor.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        (&self.file).seek(io::SeekFrom::Start(place))?;
        (&self.file).write_all(bytes)
    }

    /// Fills `bytes` from a place.
    #[cfg(not(unix))]
    pub(crate) fn read_at(&self, bytes: &mut [u8], place: u64) -> io::Result<()> {
        use io::Seek as _;
        let _held = self.cursor.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
        (&self.file).seek(io::SeekFrom::Start(place))?;
        (&self.file).read_exact(bytes)
    }
}

/// Place in a file, and the end of what may be read or written there.
#[derive(Debug)]
pub(crate) struct RandomAccessCursor<'a> {
    file: &'a RandomAccessFile,
    range: Range<u64>,
}

impl RandomAccessCursor<'_> {
    /// Place that the next byte is read from or written to.
    pub(crate) const fn place(&self) -> u64 {
        self.range.start
    }

    /// Returns true if nothing is left to read.
    pub(crate) const fn is_at_end(&self) -> bool {
        self.range.start >= self.range.end
    }
}

impl Write for RandomAccessCursor<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write_at(bytes, self.range.start)?;
        self.range.start += bytes.len() as u64;
        Ok(bytes.len())
    }

    fn flush(&mut self) -> io::Result<()> {
        Ok(())
    }
}

impl Read for RandomAccessCursor<'_> {
    fn read(&mut self, bytes: &mut [u8]) -> io::Result<usize> {
        let left = self.range.end.saturating_sub(self.range.start);
        let count = bytes.len().min(usize::try_from(left).unwrap_or(usize::MAX));
        self.file.read_at(&mut bytes[..count], self.range.start)?;
        self.range.start += count as u64;
        Ok(count)
    }
}

#[cfg(test)]
mod tests {
    use super::RandomAccessFile;

    /// Bytes stay where they were written, and the file has no name that could stay behind.
    #[test]
    fn a_scratch_file_holds_bytes_at_places_and_has_no_name() {
        let folder = tempfile::tempdir().expect("a folder");
        let file = RandomAccessFile::new(folder.path()).expect("a file");
        file.write_at(b"late", 1000).expect("room");
        file.write_at(b"early", 3).expect("room");
        let mut bytes = [1; 5];
        file.read_at(&mut bytes, 3).expect("bytes");
        assert_eq!(&bytes, b"early");
        file.read_at(&mut bytes[..4], 1000).expect("bytes");
        assert_eq!(&bytes[..4], b"late");
        assert!(file.read_at(&mut bytes, 1000).is_err(), "beyond its end");
        let names = std::fs::read_dir(folder.path()).expect("the folder").count();
        assert_eq!(names, 0);
        let error = RandomAccessFile::new(&folder.path().join("missing")).expect_err("no folder");
        assert!(error.to_string().contains("missing"), "{error}");
    }
}
