//! Format of checkpoint files.
//!
//! All numbers are little-endian. A file is
//!
//! | bytes | |
//! |---|---|
//! | 16 | `sunfleck traced` and a line feed |
//! | 4 | version of this format, 3 |
//! | 4, n | length and text of the version of sunfleck: another one may draw other numbers |
//! | 32 | hash of the scene without what says how long it is measured |
//! | 4, 4 | which share of the run this is, from 0, and of how many |
//! | 4 | number of sensors that have been begun; of each |
//! | 4, n | length and text of its name |
//! | 8, 8 | samples of each randomisation (u64) and seconds (f64) so far |
//! | 8, n | length of what its films hold, and that (`transport::Film::save`) |
//! | 32 | BLAKE3 of all bytes before |

use std::fs::File;
use std::io::{self, Read, Write};
use std::path::Path;
use std::sync::Arc;

use super::{Checkpoint, Section, not_regular, unreadable, wrong};
use crate::output;
use crate::products::data_size;
use crate::run::Failure;
use crate::transport::Partition;

const MAGIC: [u8; 16] = *b"sunfleck traced\n";
const VERSION: u32 = 3;

/// Writer that hashes what it writes.
struct HashingWriter<W> {
    inner: W,
    hasher: blake3::Hasher,
}

impl<W: Write> Write for HashingWriter<W> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        let written = self.inner.write(bytes)?;
        self.hasher.update(&bytes[..written]);
        Ok(written)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.inner.flush()
    }
}

/// Writes a checkpoint.
pub(super) fn write(to: &Checkpoint, hash: [u8; 32], sections: &[Section]) -> io::Result<()> {
    output::replace_file(&to.file, |file| {
        let mut out =
            HashingWriter { inner: io::BufWriter::new(file), hasher: blake3::Hasher::new() };
        out.write_all(&MAGIC)?;
        out.write_all(&VERSION.to_le_bytes())?;
        text(&mut out, env!("CARGO_PKG_VERSION"))?;
        out.write_all(&hash)?;
        out.write_all(&to.share.index.to_le_bytes())?;
        out.write_all(&to.share.count.to_le_bytes())?;
        out.write_all(&(sections.len() as u32).to_le_bytes())?;
        for section in sections {
            text(&mut out, &section.name)?;
            out.write_all(&section.samples.to_le_bytes())?;
            out.write_all(&section.seconds.to_le_bytes())?;
            out.write_all(&(section.state.len() as u64).to_le_bytes())?;
            out.write_all(&section.state)?;
        }
        let sum = out.hasher.finalize();
        out.write_all(sum.as_bytes())?;
        out.flush()
    })
}

fn text(out: &mut impl Write, text: &str) -> io::Result<()> {
    out.write_all(&(text.len() as u32).to_le_bytes())?;
    out.write_all(text.as_bytes())
}

/// Largest size of a checkpoint that is read, bytes: larger films do not fit into memory.
const LARGEST: u64 = 1 << 40;

/// Bytes of a checkpoint; of another file, only the start is read.
fn bytes_of(file: &Path) -> Result<Vec<u8>, Failure> {
    let fail = |source| unreadable(file, source);
    let metadata = std::fs::metadata(file).map_err(fail)?;
    // Opening a pipe would wait for its writer, and a device may have no end.
    if !metadata.is_file() {
        return Err(not_regular(file));
    }
    if metadata.len() > LARGEST {
        let found = format!("holds {}", data_size(metadata.len()));
        return Err(wrong(
            file,
            &found,
            &format!("a checkpoint has {} at most", data_size(LARGEST)),
        ));
    }
    let mut input = File::open(file).map_err(fail)?;
    let mut bytes = Vec::new();
    Read::by_ref(&mut input).take(MAGIC.len() as u64).read_to_end(&mut bytes).map_err(fail)?;
    if bytes != MAGIC {
        // A file that starts otherwise is no checkpoint, unless it was cut off.
        let found = "is no checkpoint of sunfleck";
        return Err(wrong(file, found, "name another file; this one is left as it is"));
    }
    input.take(metadata.len()).read_to_end(&mut bytes).map_err(fail)?;
    Ok(bytes)
}

/// Contents of a checkpoint.
pub(super) struct Contents {
    /// Hash of the scene.
    pub(super) scene: [u8; 32],
    pub(super) share: Partition,
    pub(super) sections: Vec<Section>,
}

/// Reads a checkpoint of a scene.
pub(super) fn read_of_scene(
    file: &Path,
    hash: [u8; 32],
) -> Result<(Partition, Vec<Section>), Failure> {
    let Contents { scene, share, sections } = read(file)?;
    if scene != hash {
        let found = "is of another scene or of other sensors: only `until`, `samples_per_px`, `samples_per_m2`, \
                     `per_m2` and the quality may differ";
        return Err(wrong(file, found, START_AGAIN));
    }
    Ok((share, sections))
}

const START_AGAIN: &str = "take the file away to trace from the start";

/// Reads a checkpoint.
pub(super) fn read(file: &Path) -> Result<Contents, Failure> {
    let bytes = bytes_of(file)?;
    let damaged =
        || wrong(file, "is damaged: its checksum is not that of what it holds", START_AGAIN);
    let (all, sum) = bytes.split_last_chunk::<32>().ok_or_else(damaged)?;
    if blake3::hash(all) != *sum {
        return Err(damaged());
    }
    let mut rest = &all[MAGIC.len()..];
    let version = number(&mut rest).map_err(|_short| damaged())?;
    if version != VERSION {
        let found = format!("has format {version}, and this version reads format {VERSION}");
        return Err(wrong(file, &found, START_AGAIN));
    }
    let sunfleck = string(&mut rest).map_err(|_short| damaged())?;
    if sunfleck != env!("CARGO_PKG_VERSION") {
        let found = format!(
            "was written by sunfleck {sunfleck}, and this is {}, which may draw other numbers",
            env!("CARGO_PKG_VERSION")
        );
        return Err(wrong(file, &found, START_AGAIN));
    }
    let body = (|| -> io::Result<([u8; 32], Partition, Vec<Section>)> {
        let scene = array(&mut rest)?;
        let share = Partition { index: number(&mut rest)?, count: number(&mut rest)? };
        let count = number(&mut rest)?;
        let sections = (0..count).map(|_| section(&mut rest)).collect::<io::Result<_>>()?;
        Ok((scene, share, sections))
    })();
    let (scene, share, sections) = body.map_err(|_short| damaged())?;
    if share.index >= share.count {
        return Err(damaged());
    }
    Ok(Contents { scene, share, sections })
}

fn section(input: &mut &[u8]) -> io::Result<Section> {
    let name = string(input)?;
    let samples = u64::from_le_bytes(array(input)?);
    let seconds = f64::from_le_bytes(array(input)?);
    let length = u64::from_le_bytes(array(input)?);
    let length = usize::try_from(length).ok().filter(|length| *length <= input.len());
    let (state, rest) = input.split_at(length.ok_or(io::ErrorKind::UnexpectedEof)?);
    *input = rest;
    Ok(Section { name, samples, seconds, state: Arc::new(state.to_vec()) })
}

fn array<const N: usize>(input: &mut &[u8]) -> io::Result<[u8; N]> {
    let mut bytes = [0; N];
    input.read_exact(&mut bytes)?;
    Ok(bytes)
}

fn number(input: &mut &[u8]) -> io::Result<u32> {
    Ok(u32::from_le_bytes(array(input)?))
}

fn string(input: &mut &[u8]) -> io::Result<String> {
    let length = number(input)? as usize;
    let (bytes, rest) = input.split_at_checked(length).ok_or(io::ErrorKind::UnexpectedEof)?;
    *input = rest;
    String::from_utf8(bytes.to_vec())
        .map_err(|error| io::Error::new(io::ErrorKind::InvalidData, error))
}
