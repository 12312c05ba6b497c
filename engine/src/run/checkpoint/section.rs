//! State of the measurement of one sensor in a checkpoint.

use std::io::{self, BufReader, BufWriter, Read, Write};
use std::sync::Arc;

use crate::scratch::{RandomAccessFile, ScratchSpace};

/// State of the measurement of one sensor.
#[derive(Clone)]
pub(in crate::run) struct Section {
    pub(in crate::run) name: String,
    /// Samples of each randomisation.
    pub(in crate::run) samples: u64,
    pub(in crate::run) seconds: f64,
    pub(in crate::run) state: FilmState,
}

/// State of films, in memory or in a file.
#[derive(Clone)]
pub(in crate::run) enum FilmState {
    Memory(Arc<Vec<u8>>),
    /// Part of a file: of a temporary one, or of a checkpoint that was read.
    File {
        file: Arc<RandomAccessFile>,
        place: u64,
        length: u64,
    },
}

/// Size of a buffer between films and a file, bytes.
const BUFFER: usize = 1 << 20;

impl FilmState {
    /// State that a function writes; in memory if it takes at most what images may take.
    ///
    /// - `bytes`: its expected size
    pub(in crate::run) fn save(
        bytes: u64,
        scratch: &ScratchSpace,
        save: impl FnOnce(&mut dyn Write) -> io::Result<()>,
    ) -> io::Result<Self> {
        if is_in_memory(bytes, scratch) {
            let mut state = Vec::with_capacity(bytes as usize);
            save(&mut state)?;
            return Ok(Self::Memory(Arc::new(state)));
        }
        let file = RandomAccessFile::new(&scratch.folder)?;
        let mut writer = BufWriter::with_capacity(BUFFER, file.writer(0));
        save(&mut writer)?;
        writer.flush()?;
        let length = writer.get_ref().place();
        drop(writer);
        Ok(Self::File { file: Arc::new(file), place: 0, length })
    }

    /// Its size, bytes.
    pub(super) fn len(&self) -> u64 {
        match self {
            Self::Memory(bytes) => bytes.len() as u64,
            Self::File { length, .. } => *length,
        }
    }

    /// Writes it.
    pub(super) fn write(&self, out: &mut impl Write) -> io::Result<()> {
        match self {
            Self::Memory(bytes) => out.write_all(bytes),
            Self::File { file, place, length } => {
                let reader = file.reader(*place..place + length);
                io::copy(&mut BufReader::with_capacity(BUFFER, reader), out).map(drop)
            }
        }
    }

    /// Calls a function with its reader; returns true if that has read all of it.
    pub(in crate::run) fn read(
        &self,
        restore: impl FnOnce(&mut dyn Read) -> io::Result<()>,
    ) -> io::Result<bool> {
        match self {
            Self::Memory(bytes) => {
                let mut reader = bytes.as_slice();
                restore(&mut reader)?;
                Ok(reader.is_empty())
            }
            Self::File { file, place, length } => {
                let reader = file.reader(*place..place + length);
                let mut reader = BufReader::with_capacity(BUFFER, reader);
                restore(&mut reader)?;
                Ok(reader.buffer().is_empty() && reader.get_ref().is_at_end())
            }
        }
    }
}

/// Returns whether a state of so many bytes is kept in memory.
pub(in crate::run) const fn is_in_memory(bytes: u64, scratch: &ScratchSpace) -> bool {
    bytes <= scratch.memory
}
