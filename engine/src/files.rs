//! Opening of input files: nothing is read that may never end.

use std::fs::{self, File};
use std::io;
use std::path::Path;

/// Largest input file, bytes. It is beyond what fits into the memory of machines, and below what a
/// mistaken path may lead to.
const LARGEST: u64 = 64 << 30;

/// Opens a regular file for reading.
///
/// # Errors
/// If it is not there, or a folder, a pipe or a device, or larger than 64 GiB.
pub(crate) fn open(path: &Path) -> io::Result<File> {
    // Asked before it is opened: opening a pipe would wait for its writer.
    let metadata = fs::metadata(path)?;
    let refuse = |what: String| Err(io::Error::new(io::ErrorKind::InvalidInput, what));
    if !metadata.is_file() {
        return refuse("it is no regular file but a folder, a pipe or a device".to_owned());
    }
    if metadata.len() > LARGEST {
        let found = metadata.len();
        return refuse(format!(
            "it holds {found} bytes, and an input file may hold 64 GiB at most"
        ));
    }
    File::open(path)
}

#[cfg(test)]
#[allow(clippy::unwrap_used, reason = "a test that cannot go on has failed")]
mod tests {
    use super::*;

    #[test]
    fn only_files_of_a_size_that_can_be_are_opened() {
        let folder = tempfile::tempdir().unwrap();
        let file = folder.path().join("file");
        fs::write(&file, "text").unwrap();
        assert!(open(&file).is_ok());
        assert!(open(folder.path()).unwrap_err().to_string().contains("no regular file"));
        if cfg!(unix) {
            assert!(
                open(Path::new("/dev/zero")).unwrap_err().to_string().contains("no regular file")
            );
        }
        // A file of holes takes no room on the disk.
        File::options().write(true).open(&file).unwrap().set_len(LARGEST + 1).unwrap();
        let error = open(&file).unwrap_err().to_string();
        assert_eq!(error, "it holds 68719476737 bytes, and an input file may hold 64 GiB at most");
        assert_eq!(open(&folder.path().join("none")).unwrap_err().kind(), io::ErrorKind::NotFound);
    }
}
